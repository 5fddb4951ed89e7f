//! `em-sphere-pull`: force on a dielectric sphere in a field that grows, over surfaces around it.

use std::f64::consts::PI;

use serde_json::{Value, json};

use crate::case::{Case, Errors, Measurement, Target};
use crate::em::EPS0;
use crate::em::frames::{measured, number, number_or, totals};
use crate::heat::frames::greater;
use crate::heat::methods::over;
use crate::lab::{Finished, Lab, LabError};

/// The case.
pub(super) struct EmSpherePull;

/// Ways to form derivatives, then a bubble in a liquid, and the half plane about the axis.
const METHODS: &[&str] = &["quartic", "quadratic", "bubble", AXIS];
const AXIS: &str = "axisymmetric";

/// Radius \[m\], field \[V/m\] and its slope \[V/m2\].
const RADIUS: f64 = 1e-3;
const FIELD: f64 = 1e6;
const SLOPE: f64 = 2e8;

impl Case for EmSpherePull {
    fn name(&self) -> &'static str {
        "em-sphere-pull"
    }

    fn tool(&self) -> &'static str {
        "emfield"
    }

    fn reference(&self) -> &'static str {
        "Multipoles of a dielectric sphere, Jackson (1998), section 4.4, and the force on its dipole"
    }

    fn methods(&self) -> &'static [&'static str] {
        METHODS
    }

    fn targets(&self) -> Vec<Target> {
        let mut targets = Vec::new();
        for method in METHODS {
            targets.push(Target::error("force", 5e-3).of(*method));
            targets.push(Target::error("force_apart", 5e-3).of(*method));
            targets.push(Target::order("force", 2.0).of(*method));
            targets.push(Target::order("force_apart", 2.0).of(*method));
        }
        targets
    }

    fn measure(&self, lab: &Lab, level: u32, method: &str) -> Result<Measurement, LabError> {
        let parts = [4.0, 6.0, 9.0][level.clamp(1, 3) as usize - 1];
        let spacing = RADIUS / parts;
        // All spacings by the same ratio, those far away too.
        let ratio = 4.0 / parts;
        let points = json!({
            "spacing_m": spacing, "outward": 0.25 * ratio, "largest_m": 8e-4 * ratio
        });
        let patch = over(json!({"points": points}), &method_patch(method));
        measured(lab, self, (level, method), (&patch, spacing), |run, _| {
            errors(run)
        })
    }
}

fn method_patch(method: &str) -> Value {
    match method {
        "quadratic" => over(
            walls(80.0, "z", "x^2 + y^2"),
            &json!({"method": {"order": 2}}),
        ),
        "bubble" => over(
            walls(1.0 / 80.0, "z", "x^2 + y^2"),
            &json!({
                "surroundings": {"relative_permittivity": 80},
                "bodies": [{"name": "sphere",
                    "shape": {"sphere": {"centre_m": [0, 0, 0], "radius_m": RADIUS}}}]
            }),
        ),
        AXIS => over(walls(80.0, "z", "r^2"), &axisymmetric()),
        _ => walls(80.0, "z", "x^2 + y^2"),
    }
}

/// The exact potential on the walls, for a ratio of permittivities.
fn walls(ratio: f64, along: &str, across: &str) -> Value {
    let share = |n: f64| n * (ratio - 1.0) / (n * (ratio + 1.0) + 1.0);
    let part = |n: i32| {
        let moment = share(f64::from(n)) * RADIUS.powi(2 * n + 1);
        let power = f64::from(2 * n + 1) / 2.0;
        format!("(1 - {moment:e}/({across} + {along}^2)^{power})")
    };
    let expr = format!(
        "-{FIELD:e}*{along}*{} - {:e}*({along}^2 - 0.5*({across}))*{}",
        part(1),
        0.5 * SLOPE,
        part(2)
    );
    json!({"electrostatics": {"outer": [{"potential_v": {"expr": expr}}]}})
}

/// The same about the axis.
fn axisymmetric() -> Value {
    json!({
        "geometry": AXIS,
        "domain": {"box": {"min_m": [0, -4e-3], "max_m": [4e-3, 4e-3]}},
        "bodies": [{"name": "sphere", "relative_permittivity": 80,
            "shape": {"disc": {"centre_m": [0, 0], "radius_m": RADIUS}}}],
        "output": {"enclosures": [
            {"name": "near", "surface": {"around": {"body": "sphere", "distance_m": 4e-4}}},
            {"name": "far", "surface": {"shape": {"box": {"min_m": [0, -2e-3], "max_m": [2e-3, 2e-3]}}}}
        ]}
    })
}

fn errors(run: &Finished) -> Result<Errors, LabError> {
    let outer = number_or(run, "/surroundings/relative_permittivity", 1.0);
    let ratio = number_or(run, "/bodies/0/relative_permittivity", 1.0) / outer;
    let radius = match number(run, "/bodies/0/shape/sphere/radius_m") {
        Ok(radius) => radius,
        Err(_) => number(run, "/bodies/0/shape/disc/radius_m")?,
    };
    let dipole = 4.0 * PI * EPS0 * outer * radius.powi(3) * (ratio - 1.0) / (ratio + 2.0) * FIELD;
    let exact = dipole * SLOPE;
    let found = totals(run)?;
    let near = found.get("near.electric_force_z")? / exact;
    let far = found.get("far.electric_force_z")? / exact;
    let own = found.get("electric_force_sphere_z")? / exact;
    let worst = greater((near - 1.0).abs(), (far - 1.0).abs());
    Ok(Errors::from([
        ("force".to_owned(), worst),
        ("force_near".to_owned(), (near - 1.0).abs()),
        ("force_far".to_owned(), (far - 1.0).abs()),
        ("force_apart".to_owned(), (near - far).abs()),
        ("force_traction".to_owned(), (own - 1.0).abs()),
    ]))
}
