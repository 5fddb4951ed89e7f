//! `em-axisymmetric-sphere`: lift and heat of a sphere among coaxial loops, computed about their axis.

use serde_json::{Value, json};

use super::em_sphere_loops::{coaxial, errors};
use crate::case::{Case, Measurement, Target};
use crate::em::frames::{Level, measured, planned};
use crate::lab::{Lab, LabError};

/// The case.
pub(super) struct EmAxisymmetricSphere;

/// Frequencies, and layers beside the surface over those at 100 kHz.
const METHODS: &[&str] = &[
    "100-khz", "30-khz", "1-mhz", THIN, REGIONS, LINEAR, IRON, PLAIN,
];

/// At 100 kHz, with wires so thin that no rule for currents over their section stands between tool and reference.
const THIN: &str = "100-khz-thin-wires";

/// At 100 kHz, with coils that are regions of points instead of exact sources.
const REGIONS: &str = "100-khz-coils-of-points";

/// Of a hundred times the permeability, at 1 kHz, where the skin is as thin as at 100 kHz, with thin wires.
const IRON: &str = "iron";

/// The same of which nothing but the spacing is given: points far away are as the program has them.
const PLAIN: &str = "iron-plain";

/// At 100 kHz, with slopes of linear polynomials, on points half as far apart.
const LINEAR: &str = "100-khz-linear";

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
        for method in METHODS.iter().filter(|m| ![LINEAR, PLAIN].contains(m)) {
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
        for method in ["100-khz", "30-khz", THIN, IRON] {
            targets.push(Target::error("flux_linf", 1e-3).of(method));
        }
        for quantity in ["lift_maxwell", "lift_coil", "power_poynting"] {
            targets.push(Target::order(quantity, 2.0).of(THIN));
        }
        for quantity in ["lift_enclosed", "power_enclosed"] {
            targets.push(Target::error(quantity, 5e-4).of(THIN));
        }
        for quantity in ["lift_volume", "lift_maxwell", "lift_coil", "power_volume"] {
            targets.push(Target::order(quantity, 1.8).of(IRON));
        }
        targets.push(Target::order("flux_linf", 2.5).of(IRON));
        for quantity in ["lift_volume", "lift_coil", "power_volume"] {
            targets.push(Target::order(quantity, 1.5).of(PLAIN));
        }
        targets.push(Target::error("flux_linf", 2e-3).of(REGIONS));
        targets.push(Target::order("lift_enclosed", 1.5).of(THIN));
        targets.push(Target::order("flux_linf", 2.5).of(THIN));
        targets.push(Target::order("flux_linf", 2.0).of("1-mhz"));
        for quantity in [
            "lift_volume",
            "lift_enclosed",
            "power_volume",
            "power_enclosed",
        ] {
            targets.push(Target::error(quantity, 0.03).of(LINEAR));
        }
        for quantity in [
            "lift_volume",
            "power_volume",
            "largest_current",
            "flux_linf",
        ] {
            targets.push(Target::order(quantity, 0.8).of(LINEAR));
        }
        targets
    }

    fn measure(&self, lab: &Lab, level: u32, method: &str) -> Result<Measurement, LabError> {
        let finer = if method == LINEAR { 0.5 } else { 1.0 };
        let spacing = finer * [2e-4, 1.4e-4, 1e-4][level.clamp(1, 3) as usize - 1];
        let (frequency, first) = match method {
            "30-khz" => (3e4, 0.3),
            "1-mhz" => (1e6, 0.15),
            IRON | PLAIN => (1e3, 0.3),
            _ => (1e5, 0.3),
        };
        let mut patch = json!({
            "points": {"spacing_m": spacing, "layers": {"first_m": first * spacing}},
            "eddy_currents": {"harmonic": {"frequency_hz": frequency}}
        });
        if method == PLAIN {
            patch["points"]["outward"] = Value::Null;
            patch["method"] = Value::Null;
        }
        if method == IRON || method == PLAIN {
            let mut scene = planned(lab, self.name(), &patch)?;
            let mut bodies = scene["bodies"].take();
            bodies[0]["relative_permeability"] = json!(100.0);
            patch["bodies"] = bodies;
        }
        if [THIN, IRON, PLAIN].contains(&method) {
            let mut scene = planned(lab, self.name(), &patch)?;
            let coils = scene["eddy_currents"]["coils"].take();
            patch["eddy_currents"]["coils"] = thin(coils);
        }
        let scene = planned(lab, self.name(), &patch)?;
        if method == LINEAR {
            patch["method"] = json!({"order": 1});
        }
        if method == REGIONS {
            regions(&scene, &mut patch);
        }
        measured(
            lab,
            self,
            Level {
                level,
                method,
                spacing,
            },
            &patch,
            |run, points| errors(run, points, coaxial(&scene, run)?),
        )
    }
}

/// The coils of a scene as bodies of points, in a domain that holds them.
fn regions(scene: &Value, patch: &mut Value) {
    let mut bodies = vec![scene["bodies"][0].clone()];
    let mut coils = Vec::new();
    for coil in scene["eddy_currents"]["coils"]
        .as_array()
        .into_iter()
        .flatten()
    {
        let (wire, name) = (&coil["loop"], format!("coil{}", coils.len() + 1));
        let disc = json!({
            "centre_m": [wire["radius_m"], wire["centre_m"][1]], "radius_m": wire["wire_radius_m"]
        });
        bodies.push(json!({"name": name, "shape": {"disc": disc}}));
        coils.push(json!({"region": {"body": name, "current_a": wire["current_a"]}}));
    }
    patch["bodies"] = Value::Array(bodies);
    patch["eddy_currents"]["coils"] = Value::Array(coils);
    patch["domain"] = json!({"sphere": {"radius_m": 0.0125}});
    patch["points"]["outward"] = Value::Null;
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
