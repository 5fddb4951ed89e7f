//! `heat-patch`: linear fields on every kind of cloud and boundary.

use serde_json::{Value, json};

use crate::case::{Case, Errors, Measurement, Target};
use crate::heat::formula::At;
use crate::heat::frames::{Frames, worst};
use crate::heat::methods::{self, over};
use crate::heat::property::{Property, fault, property};
use crate::lab::{Lab, LabError};

/// A body whose boundaries carry the linear field.
struct Body {
    name: &'static str,
    dimensions: u32,
    patch: fn() -> Value,
}

/// k of the scene \[W/(m K)\].
const CONDUCTIVITY: f64 = 2.5;
/// Gradient of the linear field in the plane and in space \[K/m\].
const SLOPE: [f64; 3] = [2.0, -3.0, 0.5];

const BODIES: [Body; 9] = [
    Body {
        name: "box",
        dimensions: 2,
        patch: || json!({}),
    },
    Body {
        name: "box-mixed",
        dimensions: 2,
        patch: || json!({"boundaries": box_mixed()}),
    },
    Body {
        name: "box-graded",
        dimensions: 2,
        patch: || json!({"points": {"grading": {"x": 1.05, "y": 0.97}}}),
    },
    Body {
        name: "rings",
        dimensions: 2,
        patch: || {
            body(
                json!({"disc": {"centre_m": [0, 0], "radius_m": 0.5}}),
                json!([held(&["rim"])]),
            )
        },
    },
    Body {
        name: "rings-mixed",
        dimensions: 2,
        patch: rings_mixed,
    },
    Body {
        name: "cut-hole",
        dimensions: 2,
        patch: cut_hole,
    },
    Body {
        name: "turned",
        dimensions: 2,
        patch: || {
            let shape = json!({"box": {"min_m": [0, 0], "max_m": [1, 1]}});
            body(
                json!({"turned": {"shape": shape, "angle_deg": 27}}),
                json!([held(&["x-", "x+", "y-", "y+"])]),
            )
        },
    },
    Body {
        name: "sphere",
        dimensions: 3,
        patch: || body(sphere(), json!([held(&["surface"])])),
    },
    Body {
        name: "sphere-mixed",
        dimensions: 3,
        patch: sphere_mixed,
    },
];

/// Methods that must be exact.
const METHODS: &[&str] = &[
    "corrected",
    "corrected-jitter-10",
    "corrected-jitter-30",
    "pair",
];

/// The case.
pub(super) struct HeatPatch;

impl Case for HeatPatch {
    fn name(&self) -> &'static str {
        "heat-patch"
    }

    fn tool(&self) -> &'static str {
        "heatsph"
    }

    fn reference(&self) -> &'static str {
        "Linear fields"
    }

    fn methods(&self) -> &'static [&'static str] {
        METHODS
    }

    fn levels(&self, _: &str, asked: &[u32]) -> Vec<u32> {
        // What is exact on two resolutions is exact.
        asked.iter().copied().filter(|l| *l <= 2).collect()
    }

    fn targets(&self) -> Vec<Target> {
        let exact = METHODS.iter().filter(|m| !m.starts_with("pair"));
        let target = |method: &&str| BODIES.map(|body| Target::error(body.name, 1e-10).of(*method));
        exact.flat_map(target).collect()
    }

    fn measure(&self, lab: &Lab, level: u32, method: &str) -> Result<Measurement, LabError> {
        let spacing = 0.1 / f64::from(1 << (level.clamp(1, 4) - 1));
        let mut all = Vec::new();
        let mut errors = Errors::new();
        let mut points = 0;
        for body in &BODIES {
            let base = json!({"dimensions": body.dimensions, "points": {"spacing_m": spacing}});
            let patch = over(over(base, &(body.patch)()), &methods::patch(method));
            let label = format!("level{level}-{method}-{}", body.name);
            let run = lab.run(self.tool(), self.name(), &label, &patch)?;
            let frames = Frames::read(&run)?;
            // The field is what the first boundary holds.
            let field = property(&run, "/boundaries/0/temperature_k")?;
            let range = range(&field, &frames);
            if !range.is_finite() || range <= 0.0 {
                return Err(fault(&run, "the field must not be constant".to_owned()));
            }
            let error = worst(&frames.position, frames.last(), range, |p| {
                field.value(&At::place(*p))
            });
            errors.insert(body.name.to_owned(), error);
            points = frames.points();
            all.push(run);
        }
        Ok(Measurement::over(all, points, spacing, errors))
    }
}

fn range(field: &Property, frames: &Frames) -> f64 {
    let values = frames.position.iter().map(|p| field.value(&At::place(*p)));
    let high = values.clone().fold(f64::NEG_INFINITY, f64::max);
    high - values.fold(f64::INFINITY, f64::min)
}

/// Another body with its boundaries in place of the box.
fn body(shape: Value, boundaries: Value) -> Value {
    let mut shape = shape;
    shape["box"] = Value::Null;
    json!({"body": shape, "boundaries": boundaries})
}

fn field() -> String {
    format!("10 + {}*x - {}*y + {}*z", SLOPE[0], -SLOPE[1], SLOPE[2])
}

/// The field on these faces.
fn held(on: &[&str]) -> Value {
    json!({"on": on, "temperature_k": {"expr": field()}})
}

/// `k grad T . n` of the field on these faces, `normal` being a formula of each component.
fn flux(on: &[&str], normal: [&str; 3]) -> Value {
    let part = |i: usize| format!("{}*({})", CONDUCTIVITY * SLOPE[i], normal[i]);
    let formula = [part(0), part(1), part(2)].join(" + ");
    json!({"on": on, "heat_flux_w_m2": {"expr": formula}})
}

fn box_mixed() -> Value {
    json!([
        held(&["x-"]),
        flux(&["x+"], ["1", "0", "0"]),
        flux(&["y-"], ["0", "-1", "0"]),
        flux(&["y+"], ["0", "1", "0"]),
    ])
}

fn rings_mixed() -> Value {
    // Beside 0, where points lie: a point may not be held and heated.
    let half = json!({"box": {"min_m": [-9, -9], "max_m": [0.0137, 9]}});
    let other = json!({"box": {"min_m": [0.0137, -9], "max_m": [9, 9]}});
    let mut held = held(&["rim"]);
    held["within"] = half;
    let mut flux = flux(&["rim"], ["x/0.5", "y/0.5", "0"]);
    flux["within"] = other;
    body(
        json!({"disc": {"centre_m": [0, 0], "radius_m": 0.5}}),
        json!([held, flux]),
    )
}

fn cut_hole() -> Value {
    let shape = json!({"difference": [
        {"disc": {"centre_m": [0, 0], "radius_m": 0.5}},
        {"disc": {"name": "hole", "centre_m": [0.13, 0.04], "radius_m": 0.17}}
    ]});
    let mut patch = body(shape, json!([held(&["rim"]), held(&["hole.rim"])]));
    patch["points"] = json!({"arrangement": "cut"});
    patch
}

fn sphere() -> Value {
    json!({"sphere": {"centre_m": [0, 0, 0], "radius_m": 0.5}})
}

fn sphere_mixed() -> Value {
    let below = json!({"box": {"min_m": [-9, -9, -9], "max_m": [9, 9, 0.0137]}});
    let above = json!({"box": {"min_m": [-9, -9, 0.0137], "max_m": [9, 9, 9]}});
    let mut held = held(&["surface"]);
    held["within"] = below;
    let mut flux = flux(&["surface"], ["x/0.5", "y/0.5", "z/0.5"]);
    flux["within"] = above;
    body(sphere(), json!([held, flux]))
}
