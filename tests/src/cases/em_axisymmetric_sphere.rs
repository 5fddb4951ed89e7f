//! `em-axisymmetric-sphere`: lift and heat of a sphere among coaxial loops, computed about their axis.

use serde_json::{Value, json};

use super::em_sphere_loops::{body, errors, loops};
use crate::case::{Case, Measurement, Target};
use crate::em::frames::{measured, planned};
use crate::em::sphere::Solution;
use crate::lab::{Lab, LabError};

/// The case.
pub(super) struct EmAxisymmetricSphere;

/// Frequencies, and layers beside the surface over those at 100 kHz.
const METHODS: &[&str] = &["100-khz", "30-khz", "1-mhz", THIN];

/// At 100 kHz, with wires so thin that no rule for currents over their section stands between tool and reference.
const THIN: &str = "100-khz-thin-wires";

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
                "lift_enclosed",
                "power_volume",
                "power_poynting",
                "power_enclosed",
                "largest_current",
            ] {
                targets.push(Target::error(quantity, 5e-3).of(*method));
            }
        }
        for method in ["100-khz", "30-khz", THIN] {
            targets.push(Target::error("flux_linf", 1e-3).of(method));
        }
        for quantity in ["lift_maxwell", "lift_coil", "power_poynting"] {
            targets.push(Target::order(quantity, 2.0).of(THIN));
        }
        for quantity in ["lift_enclosed", "power_enclosed"] {
            targets.push(Target::error(quantity, 5e-4).of(THIN));
        }
        targets.push(Target::order("lift_enclosed", 1.5).of(THIN));
        targets.push(Target::order("flux_linf", 2.5).of(THIN));
        targets.push(Target::order("flux_linf", 2.0).of("1-mhz"));
        targets
    }

    fn measure(&self, lab: &Lab, level: u32, method: &str) -> Result<Measurement, LabError> {
        let spacing = [2e-4, 1.4e-4, 1e-4][level.clamp(1, 3) as usize - 1];
        let (frequency, first) = match method {
            "30-khz" => (3e4, 0.3),
            "1-mhz" => (1e6, 0.15),
            _ => (1e5, 0.3),
        };
        let mut patch = json!({
            "points": {"spacing_m": spacing, "layers": {"first_m": first * spacing}},
            "eddy_currents": {"harmonic": {"frequency_hz": frequency}}
        });
        if method == THIN {
            let mut scene = planned(lab, self.name(), &patch)?;
            let coils = scene["eddy_currents"]["coils"].take();
            patch["eddy_currents"]["coils"] = thin(coils);
        }
        measured(
            lab,
            self,
            (level, method),
            (&patch, spacing),
            |run, points| errors(run, points, &Solution::of(body(run)?, loops(run)?)),
        )
    }
}

/// The coils of thin wire.
fn thin(mut coils: Value) -> Value {
    for coil in coils.as_array_mut().into_iter().flatten() {
        if let Some(wire) = coil["loop"].as_object_mut() {
            wire.remove("wire_radius_m");
        }
    }
    coils
}
