//! Heat in a liquid.

use run::Fault;
use run::property::Property;
use schemars::JsonSchema;
use serde::Deserialize;
use shapes::check::Misfit;

use super::Liquid;
use super::faults::PLACE;

/// What melts.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LiquidMelting {
    /// Melting point.
    #[schemars(extend("x-unit" = "K", "exclusiveMinimum" = 0.0))]
    pub melting_point_k: f64,
    /// Heat that melting takes.
    #[schemars(extend("x-unit" = "J/kg", "exclusiveMinimum" = 0.0))]
    pub latent_heat_j_kg: f64,
}

/// What a surface radiates.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LiquidRadiation {
    /// Emissivity.
    #[schemars(range(max = 1.0), extend("x-unit" = "1", "exclusiveMinimum" = 0.0))]
    pub emissivity: f64,
    /// Temperature of the surroundings.
    #[schemars(range(min = 0.0), extend("x-unit" = "K"))]
    pub surroundings_k: f64,
}

/// Heat in a liquid that marches: of its currents where `magnetic` drives some, by conduction, and out of its surface.
#[derive(Debug, Clone, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LiquidHeat {
    /// Specific heat.
    #[schemars(extend("x-unit" = "J/(kg K)", "exclusiveMinimum" = 0.0))]
    pub specific_heat_j_kg_k: f64,
    /// Conductivity for heat.
    #[schemars(extend("x-unit" = "W/(m K)", "exclusiveMinimum" = 0.0))]
    pub thermal_conductivity_w_m_k: f64,
    /// Temperature at the start, a number or a function of x, y, z, r; at the melting point nothing is molten.
    #[schemars(extend("x-unit" = "K"))]
    pub temperature_k: Property,
    /// What the surface radiates; no heat passes it when it is absent.
    pub radiation: Option<LiquidRadiation>,
    /// Melting; none when it is absent.
    pub melting: Option<LiquidMelting>,
    /// Whether the drop stands still, like a solid, so that only heat is marched, in steps of `step_s`.
    #[serde(default)]
    pub still: bool,
}

impl LiquidHeat {
    pub(super) fn check(&self, liquid: &Liquid, misfits: &mut Vec<Misfit>) {
        const AT: &str = "/liquid/heat";
        let Some(march) = &liquid.march else {
            let what = "heat marches: take \"march\"";
            misfits.push(Misfit::at(AT, what));
            return;
        };
        if self.still && march.step_s.is_none() {
            let what =
                "the steps of a drop that stands still are not known beforehand: say \"step_s\"";
            misfits.push(Misfit::at("/liquid/march", what));
        }
        if self.still && liquid.velocity_m_s.is_some() {
            let what = "a drop that stands still has no velocity: leave it away, or \"still\"";
            misfits.push(Misfit::at("/liquid/velocity_m_s", what));
        }
    }

    pub(super) fn formulas(&self, faults: &mut Vec<Fault>) {
        let at = "/liquid/heat/temperature_k";
        faults.extend(self.temperature_k.compile_temperature(at, &PLACE).err());
    }
}
