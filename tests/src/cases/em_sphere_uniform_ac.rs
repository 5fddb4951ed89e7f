//! `em-sphere-uniform-ac`: a conducting sphere in a uniform alternating field.

use serde_json::json;

use super::em_sphere_loops::{body, flux_error};
use crate::case::{Case, Errors, Measurement, Target};
use crate::em::axes::Axes;
use crate::em::frames::{Points, planned, totals};
use crate::em::sphere::{Solution, Sources};
use crate::lab::{Lab, LabError};

/// Quartics at 100 kHz, finer by level; quadratics at 1 MHz, whose layers get thinner by level on the same surface:
/// 0.075 to 0.0075 spacings, while the sphere bends by 0.5 within a support.
const METHODS: &[&str] = &["quartic", "thin-layers", IRON];

/// Of a hundred times the permeability, at 1 kHz, where the skin is as thin as at 100 kHz.
const IRON: &str = "iron";

/// The case.
pub(super) struct EmSphereUniformAc;

impl Case for EmSphereUniformAc {
    fn name(&self) -> &'static str {
        "em-sphere-uniform-ac"
    }

    fn tool(&self) -> &'static str {
        "emfield"
    }

    fn reference(&self) -> &'static str {
        "Spherical Bessel functions, Smythe (1950), chapter XI"
    }

    fn methods(&self) -> &'static [&'static str] {
        METHODS
    }

    fn targets(&self) -> Vec<Target> {
        vec![
            Target::error("power_volume", 1e-2).of("quartic"),
            Target::error("power_poynting", 1e-2).of("quartic"),
            Target::error("flux_linf", 1e-2).of("quartic"),
            Target::order("power_volume", 2.5).of("quartic"),
            Target::order("power_poynting", 2.5).of("quartic"),
            Target::order("flux_linf", 2.5).of("quartic"),
            Target::error("power_volume", 5e-3).of(IRON),
            Target::error("power_poynting", 5e-3).of(IRON),
            Target::error("flux_linf", 2.5e-2).of(IRON),
            Target::order("power_volume", 2.5).of(IRON),
            Target::order("power_poynting", 2.5).of(IRON),
            Target::order("flux_linf", 2.5).of(IRON),
            Target::error("power_volume", 2e-2).of("thin-layers"),
            Target::error("power_poynting", 2e-2).of("thin-layers"),
        ]
    }

    fn measure(&self, lab: &Lab, level: u32, method: &str) -> Result<Measurement, LabError> {
        let level_of = |all: [f64; 3]| all[level.clamp(1, 3) as usize - 1];
        let (spacing, patch) = if method == "thin-layers" {
            let first = level_of([3e-5, 1e-5, 3e-6]);
            let patch = json!({"points": {"layers": {"first_m": first}}, "method": {"order": 2},
                "eddy_currents": {"harmonic": {"frequency_hz": 1e6}}});
            (first, patch)
        } else {
            let spacing = level_of([5.6e-4, 4e-4, 2.8e-4]);
            let layers = json!({"first_m": 0.3 * spacing});
            let mut patch = json!({"points": {"spacing_m": spacing, "layers": layers}});
            if method == IRON {
                let mut bodies = planned(lab, self.name(), &patch)?["bodies"].take();
                bodies[0]["relative_permeability"] = json!(100.0);
                patch["bodies"] = bodies;
                patch["eddy_currents"] = json!({"harmonic": {"frequency_hz": 1e3}});
            }
            (spacing, patch)
        };
        let label = format!("level{level}-{method}");
        let run = lab.run(self.tool(), self.name(), &label, &patch)?;
        let (applied, axes) = Axes::of_applied(&run)?;
        let sources = Sources {
            loops: Vec::new(),
            uniform: applied,
        };
        let exact = Solution::of(body(&run)?, sources);
        let points = Points::read(&run)?.seen_from(axes);
        let found = totals(&run)?;
        let power = |name: &str| Ok::<_, LabError>((found.get(name)? / exact.power() - 1.0).abs());
        let errors = Errors::from([
            ("power_volume".to_owned(), power("power_volume")?),
            ("power_poynting".to_owned(), power("power_poynting")?),
            (
                "flux_linf".to_owned(),
                flux_error(&points, &exact, f64::INFINITY)? / applied.abs(),
            ),
        ]);
        Ok(Measurement::of(run, points.count(), spacing, errors))
    }
}
