//! `em-axisymmetric-sphere`: lift and heat of a sphere among coaxial loops, computed about their axis.

use serde_json::json;

use super::em_sphere_loops::{body, errors, loops};
use crate::case::{Case, Measurement, Target};
use crate::em::frames::Points;
use crate::em::sphere::Solution;
use crate::lab::{Lab, LabError};

/// The case.
pub(super) struct EmAxisymmetricSphere;

/// Frequencies, and layers beside the surface over those at 100 kHz.
const METHODS: &[&str] = &["100-khz", "30-khz", "1-mhz"];

impl Case for EmAxisymmetricSphere {
    fn name(&self) -> &'static str {
        "em-axisymmetric-sphere"
    }

    fn tool(&self) -> &'static str {
        "emfield"
    }

    fn reference(&self) -> &'static str {
        "Spherical harmonics and Bessel functions, Smythe (1950), chapter XI"
    }

    fn methods(&self) -> &'static [&'static str] {
        METHODS
    }

    fn targets(&self) -> Vec<Target> {
        let mut targets = Vec::new();
        for method in METHODS {
            for quantity in [
                "lift_volume",
                "lift_maxwell",
                "lift_coil",
                "power_volume",
                "power_poynting",
                "largest_current",
            ] {
                targets.push(Target::error(quantity, 5e-3).of(*method));
            }
            targets.push(Target::order("flux_linf", 2.0).of(*method));
        }
        for method in ["100-khz", "30-khz"] {
            targets.push(Target::error("flux_linf", 5e-3).of(method));
        }
        targets
    }

    fn measure(&self, lab: &Lab, level: u32, method: &str) -> Result<Measurement, LabError> {
        let spacing = [2e-4, 1.4e-4, 1e-4][level.clamp(1, 3) as usize - 1];
        let (frequency, first) = match method {
            "30-khz" => (3e4, 0.3),
            "1-mhz" => (1e6, 0.15),
            _ => (1e5, 0.3),
        };
        let patch = json!({
            "points": {"spacing_m": spacing, "layers": {"first_m": first * spacing}},
            "eddy_currents": {"harmonic": {"frequency_hz": frequency}}
        });
        let label = format!("level{level}-{method}");
        let run = lab.run(self.tool(), self.name(), &label, &patch)?;
        let exact = Solution::of(body(&run)?, loops(&run)?);
        let points = Points::read(&run)?;
        let errors = errors(&run, &points, &exact)?;
        Ok(Measurement::of(run, points.count(), spacing, errors))
    }
}
