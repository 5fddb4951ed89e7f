//! A given stress on the surface, as of wind: what it has across the surface presses nothing, what it has along drags.
//!
//! ```text
//! F_a = A_a (tau - (tau . n) n) / V        A_a, n area and normal of the surface at a, tau read there
//! ```

use particles::Matter;
use run::Fault;
use run::property::{Arguments, Curve, Property};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::near::Role;
use crate::patch::{self, Patches};
use crate::stage::{Stage, StageError};
use crate::state::State;
use crate::vector::{dot, plus};

/// A given stress on the surface (key `surface_stress`).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[schemars(rename = "SurfaceStress")]
#[serde(deny_unknown_fields)]
pub struct Parameters {
    /// tau \[Pa\], each component a number or a formula in x, y, z, t.
    #[schemars(extend("x-unit" = "Pa"))]
    pub stress_pa: [Property; 3],
}

/// The stage that drags the surface along.
pub struct SurfaceStress {
    stress: [Curve; 3],
    volume: f64,
}

impl SurfaceStress {
    /// The stress on the surface of `metal`.
    ///
    /// # Errors
    /// A fault at the component that is wrong.
    pub fn new(parameters: &Parameters, metal: Matter) -> Result<Self, Fault> {
        let compiled = |k: usize| {
            let at = format!("/stress_pa/{k}");
            parameters.stress_pa[k].compile(&at, &["x", "y", "z", "t"])
        };
        Ok(Self {
            stress: [compiled(0)?, compiled(1)?, compiled(2)?],
            volume: metal.volume(),
        })
    }

    fn at(&self, x: [f64; 3], time: f64) -> Result<[f64; 3], StageError> {
        let at = Arguments::at(x, time);
        let mut stress = [0.0; 3];
        for (component, curve) in stress.iter_mut().zip(&self.stress) {
            *component = curve
                .value(&at)
                .map_err(|fault| StageError::Data(format!("stress on the surface: {fault}")))?;
        }
        Ok(stress)
    }
}

impl Stage for SurfaceStress {
    fn name(&self) -> &'static str {
        "surface_stress"
    }

    fn declare(&self, state: &mut State) {
        patch::declare(&mut state.metal);
    }

    fn advance(&mut self, state: &mut State, _dt: f64) -> Result<(), StageError> {
        let (near, surface) = (&mut state.near, Patches::of(&state.metal));
        for k in 0..near.len() {
            let a = near.id[k] as usize;
            if near.role[k] != Role::Liquid || surface.area[a] <= 0.0 {
                continue;
            }
            let patch = surface.at(a);
            let stress = self.at(patch.foot(near.position[k]), state.time)?;
            let along = plus(stress, -dot(stress, patch.normal), patch.normal);
            near.force[k] = plus(near.force[k], patch.area / self.volume, along);
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::forces::tests::{on_top, pool};

    #[test]
    fn a_flat_surface_gets_the_stress_along_it_times_its_area() {
        let mut state = pool(|_| 1800.0);
        let d = state.metal.matter.spacing;
        on_top(&mut state, d * d);
        let text = r#"{"stress_pa": [3, {"expr": "-2 + 0*x + t"}, 5]}"#;
        let parameters: Parameters = serde_json::from_str(text).unwrap();
        let mut stage = SurfaceStress::new(&parameters, state.metal.matter).unwrap();
        stage.advance(&mut state, 1e-4).unwrap();
        let area: f64 = Patches::of(&state.metal).area.iter().sum();
        let volume = state.metal.matter.volume();
        for (k, expected) in [3.0, -2.0, 0.0].into_iter().enumerate() {
            let total: f64 = state.near.force.iter().map(|f| f[k] * volume).sum();
            assert!((total - expected * area).abs() < 1e-12 * area, "{total}");
        }
    }

    #[test]
    fn a_stress_of_the_temperature_is_refused_by_name() {
        let text = r#"{"stress_pa": [0, {"expr": "T"}, 0]}"#;
        let parameters: Parameters = serde_json::from_str(text).unwrap();
        let metal = pool(|_| 1800.0).metal.matter;
        let fault = SurfaceStress::new(&parameters, metal).err().unwrap();
        assert!(fault.path().starts_with("/stress_pa/1"), "{fault}");
    }
}
