//! Shear by the gas that flows outwards over the surface (Komen 2019, eq. 4.7, fig. 4.2).
//!
//! Gas and liquid meet at half a diameter from the particle and at the height dz' from the gas speed
//! u_gas; with one stress across both layers
//!
//! ```text
//! tau = mu_gas mu (u_gas - u_r) / (mu_gas d/2 + mu dz')        F = tau dA/dV
//! ```
//!
//! u_r = (x u_x + y u_y)/r; the square root in print loses the sign. The shear acts along the
//! surface: what of the direction outwards points along the normal is taken off. r is that of the surface, half a spacing
//! from the particle; undersides are out of reach.

use particles::Matter;
use run::Fault;
use run::property::{Curve, Property};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use shapes::frame::{along, dot};

use crate::motion::Law;
use crate::near::Role;
use crate::patch::{self, Patches};
use crate::source::arc::Radial;
use crate::source::arcs::Burning;
use crate::stage::{Stage, StageError};
use crate::state::{State, TEMPERATURE};

/// Shear by the gas (key `gas_shear`).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Parameters {
    /// mu_gas(T) of the gas \[Pa s\].
    #[schemars(extend("x-unit" = "Pa s"))]
    pub gas_viscosity_pa_s: Property,
}

/// The gas above the surface, over the distance from the axis.
#[derive(Debug, Clone)]
pub struct Gas {
    /// Speed outwards \[m/s\].
    pub speed: Radial,
    /// Height at which it has this speed \[m\].
    pub height: f64,
    /// T of the gas \[K\].
    pub temperature: Radial,
}

/// The stage that drags the surface outwards.
pub struct GasShear {
    /// The gas of each arc, and where and how strongly it burns.
    arcs: Vec<(Gas, Burning)>,
    gas_viscosity: Curve,
    viscosity: Law,
    metal: Matter,
}

impl GasShear {
    /// Shear by the gas of arcs on liquid of a `viscosity`.
    ///
    /// # Errors
    /// A fault at the key that is wrong.
    pub fn new(
        parameters: &Parameters,
        arcs: Vec<(Gas, Burning)>,
        viscosity: Law,
        metal: Matter,
    ) -> Result<Self, Fault> {
        let gas_viscosity = parameters.gas_viscosity_pa_s.compile_positive(
            "/gas_viscosity_pa_s",
            &["T"],
            "Pa s",
        )?;
        Ok(Self {
            arcs,
            gas_viscosity,
            viscosity,
            metal,
        })
    }

    /// tau of a gas \[Pa\] at the distance `r` \[m\] on liquid of the viscosity `own` \[Pa s\] that moves outwards with
    /// `speed` \[m/s\].
    fn stress(&self, above: &Gas, r: f64, own: f64, speed: f64) -> Result<f64, StageError> {
        // Beyond the table the gas rests and is cold: no shear.
        let kelvin = above.temperature.at(r);
        if kelvin <= 0.0 {
            return Ok(0.0);
        }
        let gas = self
            .gas_viscosity
            .at_temperature(kelvin)
            .map_err(|e| StageError::Data(format!("viscosity of the gas: {e}")))?;
        let resistance = 0.5 * gas * self.metal.spacing + own * above.height;
        Ok(gas * own * (above.speed.at(r) - speed) / resistance)
    }
}

impl Stage for GasShear {
    fn name(&self) -> &'static str {
        "gas_shear"
    }

    fn declare(&self, state: &mut State) {
        patch::declare(&mut state.metal);
    }

    fn advance(&mut self, state: &mut State, dt: f64) -> Result<(), StageError> {
        let Some(source) = state.source else {
            return Ok(());
        };
        let (near, surface) = (&mut state.near, Patches::of(&state.metal));
        let temperatures = state.metal.column(&TEMPERATURE);
        for (gas, burning) in &self.arcs {
            let (axis, level) = (burning.place(source), burning.level(state.time, dt));
            if level <= 0.0 {
                continue;
            }
            for k in 0..near.len() {
                let a = near.id[k] as usize;
                if near.role[k] != Role::Liquid || surface.area[a] <= 0.0 {
                    continue;
                }
                let patch = surface.at(a);
                let (r, [x, y]) = axis.around(patch.foot(near.position[k]));
                let outward = [x, y, 0.0];
                let own = self.viscosity.at(temperatures, a);
                let stress = level * self.stress(gas, r, own, dot(near.velocity[k], outward))?;
                let tangential = along(outward, -dot(outward, patch.normal), patch.normal);
                let per_volume = stress * patch.reached() * patch.area / self.metal.volume();
                near.force[k] = along(near.force[k], per_volume, tangential);
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::forces::tests::{on_top, pool};

    fn stage(metal: Matter, viscosity: f64) -> GasShear {
        let flat = |value| Radial::new(vec![0.0, 1.0], vec![value, value]);
        let gas = Gas {
            speed: flat(50.0),
            height: 3e-5,
            temperature: flat(1e4),
        };
        let parameters = Parameters {
            gas_viscosity_pa_s: Property::Constant(2e-4),
        };
        let arcs = vec![(gas, Burning::default())];
        GasShear::new(&parameters, arcs, Law::Uniform(viscosity), metal).unwrap()
    }

    #[test]
    fn stiff_liquid_feels_the_newtonian_stress_of_the_gas() {
        let mut state = pool(|_| 1800.0);
        let d = state.metal.matter.spacing;
        on_top(&mut state, d * d);
        // mu_gas u/dz' = 333.3 Pa once the liquid layer no longer yields.
        stage(state.metal.matter, 1e6)
            .advance(&mut state, 1e-4)
            .unwrap();
        for (k, force) in state.near.force.iter().enumerate() {
            let patch = Patches::of(&state.metal).at(state.near.id[k] as usize);
            let expected = if state.near.role[k] == Role::Liquid && patch.area > 0.0 {
                2e-4 * 50.0 / 3e-5
            } else {
                0.0
            };
            let found = (force[0] * force[0] + force[1] * force[1]).sqrt() * d;
            assert!((found - expected).abs() < 1e-5 * 333.0, "{found}");
            let x = state.near.position[k];
            assert!(force[0] * x[0] + force[1] * x[1] >= 0.0 && force[2].abs() < 1e-9);
        }
    }

    #[test]
    fn one_stress_crosses_both_layers() {
        let metal = pool(|_| 0.0).metal.matter;
        let stage = stage(metal, 4e-3);
        let tau = stage.stress(&stage.arcs[0].0, 1e-3, 4e-3, 0.2).unwrap();
        let wall = 50.0 - tau * 3e-5 / 2e-4;
        let inside = wall - tau * 0.5 * metal.spacing / 4e-3;
        assert!((inside - 0.2).abs() < 1e-12);
    }
}
