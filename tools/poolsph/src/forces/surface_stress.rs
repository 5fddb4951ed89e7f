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
use shapes::frame::{along, dot};

use crate::mean;
use crate::near::Role;
use crate::patch::{self, Patches};
use crate::stage::{Stage, StageError};
use crate::state::State;

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
    /// Whether something of a stress that varies in time may have been missed.
    missed: bool,
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
            missed: false,
        })
    }

    /// Its mean at a place from a time on over `dt` \[s\], and whether all of it was found.
    fn at(&self, x: [f64; 3], time: f64, dt: f64) -> Result<([f64; 3], bool), StageError> {
        let at = Arguments::at(x, time);
        let (mut stress, mut all) = ([0.0; 3], true);
        for (component, curve) in stress.iter_mut().zip(&self.stress) {
            let (mean, found) = mean::in_time(curve, &at, dt)
                .map_err(|fault| StageError::Data(format!("stress on the surface: {fault}")))?;
            (*component, all) = (mean, all && found);
        }
        Ok((stress, all))
    }
}

impl Stage for SurfaceStress {
    fn name(&self) -> &'static str {
        "surface_stress"
    }

    fn declare(&self, state: &mut State) {
        patch::declare(&mut state.metal);
    }

    fn advance(&mut self, state: &mut State, dt: f64) -> Result<(), StageError> {
        let (near, surface) = (&mut state.near, Patches::of(&state.metal));
        for k in 0..near.len() {
            let a = near.id[k] as usize;
            if near.role[k] != Role::Liquid || surface.area[a] <= 0.0 {
                continue;
            }
            let patch = surface.at(a);
            let (stress, found) = self.at(patch.foot(near.position[k]), state.time, dt)?;
            self.missed |= !found;
            let tangential = along(stress, -dot(stress, patch.normal), patch.normal);
            near.force[k] = along(near.force[k], patch.area / self.volume, tangential);
        }
        Ok(())
    }

    fn warnings(&self) -> Vec<String> {
        let missed =
            "stress_pa changes faster in time than could be followed: impulse may be missed";
        self.missed.then(|| missed.to_owned()).into_iter().collect()
    }

    fn save(&self) -> Vec<f64> {
        vec![f64::from(u8::from(self.missed))]
    }

    fn restore(&mut self, saved: &[f64]) {
        self.missed = saved.first().is_some_and(|missed| *missed > 0.0);
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
        // The mean over the step.
        for (k, expected) in [3.0, -2.0 + 0.5e-4, 0.0].into_iter().enumerate() {
            let total: f64 = state.near.force.iter().map(|f| f[k] * volume).sum();
            assert!((total - expected * area).abs() < 1e-12 * area, "{total}");
        }
    }

    #[test]
    fn a_stress_that_turns_within_a_step_acts_with_its_mean() {
        let mut state = pool(|_| 1800.0);
        let d = state.metal.matter.spacing;
        on_top(&mut state, d * d);
        let text = r#"{"stress_pa": [{"expr": "3 + 50*cos(2*pi*1000*t)"}, 0, 0]}"#;
        let parameters: Parameters = serde_json::from_str(text).unwrap();
        let mut stage = SurfaceStress::new(&parameters, state.metal.matter).unwrap();
        stage.advance(&mut state, 1e-3).unwrap();
        let area: f64 = Patches::of(&state.metal).area.iter().sum();
        let volume = state.metal.matter.volume();
        let total: f64 = state.near.force.iter().map(|f| f[0] * volume).sum();
        assert!((total - 3.0 * area).abs() < 1e-2 * area, "{total}");
        assert!(stage.warnings().is_empty());
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
