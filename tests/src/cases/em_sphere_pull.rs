//! `em-sphere-pull`: force on a dielectric sphere in a field that grows, over surfaces around it.

use std::f64::consts::PI;
use std::path::Path;

use serde_json::{Value, json};

use crate::case::{Case, Errors, Measurement, Target};
use crate::em::EPS0;
use crate::em::frames::{Level, measured, planned, totals};
use crate::em::walls::amounts;
use crate::heat::frames::greater;
use crate::heat::methods::over;
use crate::lab::{Finished, Lab, LabError};

/// The case.
pub(super) struct EmSpherePull;

/// Ways to form derivatives, then a bubble in a liquid, and the half plane about the axis.
const METHODS: &[&str] = &["quartic", "quadratic", "bubble", AXIS];
const AXIS: &str = "axisymmetric";

/// Field \[V/m\] and its slope \[V/m2\] that the walls are given.
const FIELD: f64 = 1e6;
const SLOPE: f64 = 2e8;

/// A sphere of a permittivity `ratio` times that around it.
struct Sphere {
    /// \[m\]
    radius: f64,
    ratio: f64,
    /// Relative permittivity around it.
    outer: f64,
}

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
        let patch = method_patch(method);
        let sphere = Sphere::of(&planned(lab, self.name(), &patch)?, &lab.root)?;
        let spacing = sphere.radius / parts;
        let points = json!({"spacing_m": spacing});
        let patch = over(
            over(json!({"points": points}), &patch),
            &sphere.walls(method),
        );
        measured(
            lab,
            self,
            Level {
                level,
                method,
                spacing,
            },
            &patch,
            |run, _| errors(run),
        )
    }
}

fn method_patch(method: &str) -> Value {
    match method {
        "quadratic" => json!({"method": {"order": 2}}),
        "bubble" => json!({
            "surroundings": {"relative_permittivity": 80},
            "bodies": [{"name": "sphere",
                "shape": {"sphere": {"centre_m": [0, 0, 0], "radius_m": 1e-3}}}]
        }),
        AXIS => json!({
            "geometry": AXIS,
            "domain": {"box": {"min_m": [0, -4e-3], "max_m": [4e-3, 4e-3]}},
            "bodies": [{"name": "sphere", "relative_permittivity": 80,
                "shape": {"disc": {"centre_m": [0, 0], "radius_m": 1e-3}}}],
            "output": {"enclosures": [
                {"name": "near", "surface": {"around": {"body": "sphere", "distance_m": 4e-4}}},
                {"name": "far", "surface": {"shape": {"box": {"min_m": [0, -2e-3], "max_m": [2e-3, 2e-3]}}}}
            ]}
        }),
        _ => json!({}),
    }
}

impl Sphere {
    /// The sphere of a scene; `path` is told where it has none.
    fn of(scene: &Value, path: &Path) -> Result<Self, LabError> {
        let read = |pointer: &str| scene.pointer(pointer).and_then(Value::as_f64);
        let radius = read("/bodies/0/shape/sphere/radius_m")
            .or_else(|| read("/bodies/0/shape/disc/radius_m"))
            .ok_or_else(|| LabError::Content {
                path: path.to_owned(),
                what: "the body of its scene is no sphere".to_owned(),
            })?;
        let outer = read("/surroundings/relative_permittivity").unwrap_or(1.0);
        Ok(Self {
            radius,
            ratio: read("/bodies/0/relative_permittivity").unwrap_or(1.0) / outer,
            outer,
        })
    }

    /// The moment of order `n` that a field of that order makes, over the field's amount \[m^(2n+1)\].
    fn moment(&self, n: i32) -> f64 {
        let order = f64::from(n);
        let share = order * (self.ratio - 1.0) / (order * (self.ratio + 1.0) + 1.0);
        share * self.radius.powi(2 * n + 1)
    }

    /// What the sphere leaves of a potential of order `n` at a distance \[m\].
    fn left(&self, n: i32, distance: f64) -> f64 {
        1.0 - self.moment(n) / distance.powi(2 * n + 1)
    }

    /// A patch with the exact potential on the walls.
    fn walls(&self, method: &str) -> Value {
        let across = if method == AXIS { "r^2" } else { "x^2 + y^2" };
        let part = |n: i32| {
            let power = f64::from(2 * n + 1) / 2.0;
            format!("(1 - {:e}/({across} + z^2)^{power})", self.moment(n))
        };
        let expr = format!(
            "-{FIELD:e}*z*{} - {:e}*(z^2 - 0.5*({across}))*{}",
            part(1),
            0.5 * SLOPE,
            part(2)
        );
        json!({"electrostatics": {"outer": [{"potential_v": {"expr": expr}}]}})
    }

    /// Force along z in a field and its slope \[N\].
    fn force(&self, [field, slope]: [f64; 2]) -> f64 {
        let dipole = 4.0 * PI * EPS0 * self.outer * self.moment(1) * field;
        dipole * slope
    }
}

fn errors(run: &Finished) -> Result<Errors, LabError> {
    let sphere = Sphere::of(&run.scene, &run.artefact)?;
    let distance = |p: [f64; 3]| p.iter().map(|x| x * x).sum::<f64>().sqrt();
    let even = |p: [f64; 3]| -p[2] * sphere.left(1, distance(p));
    let growing = |p: [f64; 3]| {
        let part = p[2] * p[2] - 0.5 * (p[0] * p[0] + p[1] * p[1]);
        -0.5 * part * sphere.left(2, distance(p))
    };
    let fault = |what| LabError::Content {
        path: run.artefact.clone(),
        what,
    };
    let exact = sphere.force(amounts(&run.scene, [&even, &growing]).map_err(fault)?);
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
