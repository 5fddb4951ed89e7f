//! What a scene says of the heat of grains.

use std::sync::Arc;

use run::Fault;
use run::property::Property;
use schemars::JsonSchema;
use serde::Deserialize;

use super::metal_parameters::HertzScene;
use super::vapour::VapourScene;
use crate::heat::{self, Caloric};

fn three() -> f64 {
    3.0
}

/// Heat between grains that touch.
#[derive(Debug, Clone, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct GrainHeat {
    /// kappa(T) of the grain itself, not of the bed.
    #[schemars(extend("x-unit" = "W/(m K)"))]
    pub thermal_conductivity_w_m_k: Property,
    /// c(T).
    #[schemars(extend("x-unit" = "J/(kg K)"))]
    pub specific_heat_j_kg_k: Property,
    /// How wide the area is through which a contact conducts.
    #[serde(default)]
    pub contact: ConductanceScene,
    /// kappa(T) of the gas around contacts; absent: it conducts nothing.
    #[schemars(extend("x-unit" = "W/(m K)"))]
    pub gas_conductivity_w_m_k: Option<Property>,
    /// Melting to slag; absent: grains never melt.
    pub melting: Option<GrainMelting>,
    /// Slag wets what it touches: a contact conducts through the whole grain where one of both is molten, both have been, or the other
    /// is metal. Absent: it touches as a grain of powder does.
    #[serde(default)]
    pub slag_wets: bool,
    /// What becomes of the vapour of slag that boils.
    #[serde(default)]
    pub slag_vapour: VapourScene,
}

/// How wide a contact conducts.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum ConductanceScene {
    /// As elastic spheres of the real modulus under the same push; that of soda-lime glass if absent.
    Elastic(HertzScene),
    /// As the overlap (Komen 2019, eq. 5.34).
    Overlap,
    /// As the overlap, and half of what that conducts: eq. 5.35 as printed.
    Printed,
}

impl ConductanceScene {
    /// What makes contacts wide, where that is elasticity.
    #[must_use]
    pub fn elastic(self) -> Option<HertzScene> {
        match self {
            Self::Elastic(elastic) => Some(elastic),
            Self::Overlap | Self::Printed => None,
        }
    }
}

impl Default for ConductanceScene {
    /// Soda-lime glass, the silicate best known: 70 GPa, 0.22.
    fn default() -> Self {
        Self::Elastic(HertzScene {
            youngs_modulus_pa: 70e9,
            poisson_ratio: 0.22,
        })
    }
}

/// Melting of grains to slag, and setting.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct GrainMelting {
    /// T_m.
    #[schemars(extend("x-unit" = "K"), range(min = 1.0, max = 1e4))]
    pub point_k: f64,
    /// L.
    #[schemars(extend("x-unit" = "J/kg"), range(min = 0.0, max = 1e8))]
    pub latent_heat_j_kg: f64,
    /// Thermal conductivity of slag over that of the grain; above 1 to allow for the convection in slag.
    #[serde(default = "three")]
    #[schemars(extend("x-unit" = "1", "exclusiveMinimum" = 0.0))]
    pub slag_conductivity_ratio: f64,
    /// T at which slag boils: further heat goes with its vapour (`slag_vapour`), whose mass is neglected. Absent: it never boils.
    #[schemars(extend("x-unit" = "K"), range(min = 1.0, max = 1e4))]
    pub boiling_k: Option<f64>,
}

impl GrainHeat {
    /// What of slag cannot be.
    #[must_use]
    pub fn unmolten(&self) -> Option<Fault> {
        let condenses = self.slag_vapour == VapourScene::Condenses;
        let Some(melting) = self.melting else {
            let what =
                "grains without 'melting' never are slag: leave it out, or say when they melt";
            let condenses = condenses.then(|| Fault::at("/slag_vapour", what));
            return (self.slag_wets.then(|| Fault::at("/slag_wets", what))).or(condenses);
        };
        if condenses && melting.boiling_k.is_none() {
            let what = "slag that never boils has no vapour: leave it out, or say 'boiling_k' of 'melting'";
            return Some(Fault::at("/slag_vapour", what));
        }
        let boiling = melting.boiling_k.filter(|t| *t <= melting.point_k)?;
        let what = format!(
            "{boiling} K is not above the melting point, {} K",
            melting.point_k
        );
        Some(Fault::at("/melting/boiling_k", what))
    }

    /// Enthalpy and conductivity of the grains.
    ///
    /// # Errors
    /// A property that cannot be.
    pub fn caloric(&self) -> Result<Arc<Caloric>, Fault> {
        heat::Parameters {
            thermal_conductivity_w_m_k: self.thermal_conductivity_w_m_k.clone(),
            specific_heat_j_kg_k: self.specific_heat_j_kg_k.clone(),
            melting: self.melting.map(|melting| heat::MeltingParameters {
                point_k: melting.point_k,
                latent_heat_j_kg: melting.latent_heat_j_kg,
            }),
            rest_interval_steps: 1,
            exchange_tolerance_k: 0.0,
            faces: None,
        }
        .caloric()
    }
}
