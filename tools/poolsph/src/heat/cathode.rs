//! Electrons and ions on a cathode as hot as the metal is (Komen 2019, last terms of eq. 4.10, eq. 4.11).
//!
//! ```text
//! j_e = min(|j|, A_R T_a^2 exp(-e phi / (k_B T_a)))        j_i = |j| - j_e
//! q = -j_e phi + j_i V_i
//! ```
//!
//! j and V_i are those of the arc input over the distance from its axis. The hotter the metal, the
//! more of the current its electrons carry and the less heat it takes: the feedback is negative.

use props::Table;
use run::Fault;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::radial::column;

/// e / k_B \[K/V\].
const KELVIN_PER_VOLT: f64 = 1.602_176_634e-19 / 1.380_649e-23;

/// The metal as the cathode of the arc input (key `arc.cathode`).
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Cathode {
    /// Work function phi of the metal.
    #[schemars(extend("x-unit" = "V"), range(min = 0.1, max = 20.0))]
    pub work_function_v: f64,
    /// Richardson constant A_R.
    #[schemars(extend("x-unit" = "A/(m2 K2)"), range(min = 0.0, max = 1e8))]
    pub richardson_a_m2_k2: f64,
}

/// A cathode under the current of an arc.
#[derive(Debug, Clone)]
pub(super) struct Emitter {
    cathode: Cathode,
    /// |j| over the distance from the axis \[A/m2\].
    current: Table,
    /// V_i \[V\].
    ionisation: Table,
}

impl Emitter {
    /// # Errors
    /// A fault at the key `cathode` if the input lacks the current or the ionisation voltage.
    pub(super) fn new(cathode: Cathode, surface: &artefact::Table) -> Result<Self, Fault> {
        let at = |what| Fault::at("/cathode", what);
        Ok(Self {
            cathode,
            current: column(surface, "current_density_a_m2", f64::abs).map_err(at)?,
            ionisation: column(surface, "ionisation_voltage_v", |v| v).map_err(at)?,
        })
    }

    /// Distance beyond which there is no current \[m\].
    pub(super) fn reach(&self) -> f64 {
        self.current.last()
    }

    /// A_R T^2 exp(-e phi / (k_B T)) \[A/m2\].
    fn thermionic(&self, t: f64) -> f64 {
        let t = t.max(0.0);
        let barrier = KELVIN_PER_VOLT * self.cathode.work_function_v;
        self.cathode.richardson_a_m2_k2 * t * t * (-barrier / t).exp()
    }

    /// Heat of the electrons at the distance `r` \[m\] on metal of `t` \[K\] \[W/m2\], a loss.
    pub(super) fn electrons(&self, r: f64, t: f64) -> f64 {
        -self.thermionic(t).min(self.current.held(r)) * self.cathode.work_function_v
    }

    /// Heat of the ions \[W/m2\].
    pub(super) fn ions(&self, r: f64, t: f64) -> f64 {
        let current = self.current.held(r);
        (current - self.thermionic(t).min(current)) * self.ionisation.held(r)
    }

    /// Greatest fall of the heat of both with temperature, anywhere below `hottest` \[K\] \[W/(m2 K)\].
    ///
    /// The thermionic current is convex in T, so that its slope is greatest where the electrons
    /// come to carry the greatest current, or at `hottest`.
    pub(super) fn steepest(&self, hottest: f64) -> f64 {
        let greatest = |table: &Table| table.values().iter().copied().fold(0.0, f64::max);
        let (current, voltage) = (greatest(&self.current), greatest(&self.ionisation));
        let (mut low, mut high) = (1.0, hottest.clamp(1.0, 1e5));
        if self.thermionic(high) > current {
            for _ in 0..60 {
                let middle = 0.5 * (low + high);
                if self.thermionic(middle) > current {
                    high = middle;
                } else {
                    low = middle;
                }
            }
        }
        let barrier = KELVIN_PER_VOLT * self.cathode.work_function_v;
        let rise = self.thermionic(high) * (2.0 / high + barrier / (high * high));
        rise * (self.cathode.work_function_v + voltage)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Komen (2019), table 4.2; current and voltage fall along the radius, the current negative.
    fn emitter() -> Emitter {
        let surface = artefact::Table::new(3)
            .column("radius_m", "m", [0.0, 0.005, 0.01])
            .column("current_density_a_m2", "A/m2", [-9e6, -4e6, 0.0])
            .column("ionisation_voltage_v", "V", [7.9, 15.68, 15.68]);
        let cathode = Cathode {
            work_function_v: 3.85,
            richardson_a_m2_k2: 1.2e6,
        };
        Emitter::new(cathode, &surface).unwrap()
    }

    #[test]
    fn cold_metal_takes_ions_alone() {
        let cold = emitter();
        for (r, j, v) in [(0.0, 9e6, 7.9), (0.0025, 6.5e6, 11.79), (0.005, 4e6, 15.68)] {
            assert!((cold.ions(r, 300.0) / (j * v) - 1.0).abs() < 1e-12);
            assert!(cold.electrons(r, 300.0).abs() < 1e-40);
            assert!(cold.electrons(r, 0.0).abs() <= 0.0);
        }
    }

    #[test]
    fn hot_metal_gives_electrons_alone() {
        let hot = emitter();
        for (r, j) in [(0.0, 9e6), (0.005, 4e6)] {
            assert!((hot.electrons(r, 5000.0) / (-j * 3.85) - 1.0).abs() < 1e-12);
            assert!(hot.ions(r, 5000.0).abs() <= 0.0);
        }
    }

    #[test]
    fn in_between_the_current_divides_by_richardsons_law() {
        // 1.2e6 T^2 exp(-11604.5 phi/T) at 2800 K.
        let j = 1.2e6 * 2800.0_f64.powi(2) * (-3.85 * 11_604.518_121_55 / 2800.0_f64).exp();
        assert!(j > 1e6 && j < 4e6, "{j}");
        let (electrons, ions) = (
            emitter().electrons(0.005, 2800.0),
            emitter().ions(0.005, 2800.0),
        );
        assert!((electrons / (-j * 3.85) - 1.0).abs() < 1e-9);
        assert!((ions / ((4e6 - j) * 15.68) - 1.0).abs() < 1e-9);
    }

    #[test]
    fn an_input_without_current_is_refused() {
        let bare = artefact::Table::new(2).column("radius_m", "m", [0.0, 1.0]);
        let fault = Emitter::new(emitter().cathode, &bare)
            .unwrap_err()
            .to_string();
        assert!(
            fault.contains("/cathode") && fault.contains("current_density_a_m2"),
            "{fault}"
        );
    }

    proptest! {
        #[test]
        fn the_heat_never_rises_with_temperature_and_falls_within_its_bound(
            r in 0.0..0.01_f64, t in 300.0..6000.0_f64, step in 1e-2..500.0_f64
        ) {
            let emitter = emitter();
            let heat = |t| emitter.electrons(r, t) + emitter.ions(r, t);
            let fall = heat(t) - heat(t + step);
            prop_assert!(fall >= -1e-6);
            prop_assert!(fall <= emitter.steepest(6000.0) * step * (1.0 + 1e-9) + 1e-6);
        }

        #[test]
        fn colder_metal_has_a_smaller_bound(hottest in 500.0..3000.0_f64, below in 0.0..1.0_f64) {
            let emitter = emitter();
            let t = 300.0 + below * (hottest - 301.0);
            let heat = |t| emitter.electrons(0.0, t) + emitter.ions(0.0, t);
            let slope = heat(t) - heat(t + 1.0);
            prop_assert!(slope <= emitter.steepest(hottest) * (1.0 + 1e-9) + 1e-6);
            prop_assert!(emitter.steepest(hottest) <= emitter.steepest(6000.0));
        }
    }
}
