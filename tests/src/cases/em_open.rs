//! `em-open`: electrostatics in open space, with walls a few radii away.

use serde_json::{Value, json};

use crate::case::{Case, Errors, Measurement, Target};
use crate::em::frames::{Level, Points, measured, totals};
use crate::em::open::Open;
use crate::heat::frames::greater;
use crate::heat::methods::over;
use crate::lab::{Finished, Lab, LabError};

/// The case.
pub(super) struct EmOpen;

/// Bodies and geometries with open walls.
const OPEN: &[&str] = &[
    "sphere",
    QUADRATIC,
    CHARGED,
    AXIS,
    "balls",
    CYLINDER,
    "cylinders",
];
/// The same, and two of them in a plain box, which has no targets: what open walls remove.
const METHODS: &[&str] = &[
    "sphere",
    QUADRATIC,
    CHARGED,
    AXIS,
    "balls",
    CYLINDER,
    "cylinders",
    PLAIN,
    PLAIN_CHARGED,
];
const QUADRATIC: &str = "quadratic";
const CHARGED: &str = "charged";
const AXIS: &str = "axisymmetric";
const CYLINDER: &str = "cylinder";
const PLAIN: &str = "plain-sphere";
const PLAIN_CHARGED: &str = "plain-charged";

/// Spacings per radius, by level.
const PARTS: [f64; 3] = [4.0, 6.0, 9.0];

impl Case for EmOpen {
    fn name(&self) -> &'static str {
        "em-open"
    }

    fn tool(&self) -> &'static str {
        "emfield"
    }

    fn reference(&self) -> &'static str {
        "Spheres and cylinders in open space, Jackson (1998), section 4.4; Maxwell (1873), art. 172; Smythe (1950), section 4.13"
    }

    fn methods(&self) -> &'static [&'static str] {
        METHODS
    }

    fn targets(&self) -> Vec<Target> {
        let mut targets = Vec::new();
        for method in OPEN {
            let (error, seen, order) = match *method {
                QUADRATIC => (1e-3, 1e-2, 2.0),
                "balls" => (4e-4, 3e-4, 3.0),
                _ => (5e-4, 4e-4, 3.5),
            };
            targets.push(Target::error("potential_linf", error).of(*method));
            targets.push(Target::error("seen", seen).of(*method));
            targets.push(Target::order("potential_linf", order).of(*method));
            let order = if *method == "balls" { 2.0 } else { order };
            targets.push(Target::order("seen", order).of(*method));
        }
        targets
    }

    fn measure(&self, lab: &Lab, level: u32, method: &str) -> Result<Measurement, LabError> {
        let parts = PARTS[level.clamp(1, 3) as usize - 1];
        let spacing = 1e-3 / parts;
        let points = json!({"spacing_m": spacing});
        let patch = over(json!({"points": points}), &method_patch(method));
        measured(
            lab,
            self,
            Level {
                level,
                method,
                spacing,
            },
            &patch,
            errors,
        )
    }
}

fn charged() -> Value {
    json!([{"name": "ball", "potential_v": 1000,
        "shape": {"sphere": {"centre_m": [0.0008, 0.0004, -0.0006], "radius_m": 0.001}}}])
}

fn disc(name: &str, centre: [f64; 2], radius: f64, own: &Value) -> Value {
    let shape = json!({"disc": {"centre_m": centre, "radius_m": radius}});
    over(json!({"name": name, "shape": shape}), own)
}

fn method_patch(method: &str) -> Value {
    match method {
        QUADRATIC => json!({"method": {"order": 2}}),
        CHARGED => json!({
            "bodies": charged(),
            "electrostatics": {"applied_field_v_m": null}
        }),
        AXIS => json!({
            "geometry": AXIS,
            "domain": {"box": {"min_m": [0, -2.5e-3], "max_m": [2.5e-3, 2.5e-3]}},
            "bodies": [disc("sphere", [0.0, 4e-4], 1e-3, &json!({"relative_permittivity": 80}))],
            "electrostatics": {"applied_field_v_m": [0, 1e6]}
        }),
        "balls" => json!({
            "geometry": AXIS,
            "domain": {"box": null, "sphere": {"centre_m": [0, 0], "radius_m": 4.5e-3}},
            "bodies": [disc("low", [0.0, -1e-3], 1e-3, &json!({"potential_v": 1000})),
                disc("high", [0.0, 1.6e-3], 8e-4, &json!({"potential_v": 400}))],
            "electrostatics": {"applied_field_v_m": null}
        }),
        CYLINDER => json!({
            "geometry": "plane",
            "domain": {"box": {"min_m": [-2.5e-3, -2.5e-3], "max_m": [2.5e-3, 2.5e-3]}},
            "bodies": [disc("wire", [4e-4, -3e-4], 1e-3, &json!({"potential_v": 0}))],
            "electrostatics": {"applied_field_v_m": [1e6, 0]}
        }),
        "cylinders" => json!({
            "geometry": "plane",
            "domain": {"box": null, "sphere": {"centre_m": [0, 0], "radius_m": 4e-3}},
            "bodies": [disc("left", [-7e-4, 0.0], 1e-3, &json!({"potential_v": 3})),
                disc("right", [1.3e-3, 0.0], 5e-4, &json!({"potential_v": 1}))],
            "electrostatics": {"applied_field_v_m": null}
        }),
        PLAIN => json!({"electrostatics": {"outer": []}}),
        PLAIN_CHARGED => json!({
            "bodies": charged(),
            "electrostatics": {"applied_field_v_m": null, "outer": [{"potential_v": 0}]}
        }),
        _ => json!({}),
    }
}

fn errors(run: &Finished, points: &Points) -> Result<Errors, LabError> {
    let exact = Open::of(&run.scene).map_err(|what| LabError::Content {
        path: run.artefact.clone(),
        what,
    })?;
    let found = points.frame.f64("potential")?;
    let (mut worst, mut low, mut high) = (0.0, f64::INFINITY, f64::NEG_INFINITY);
    for (p, found) in points.position.iter().zip(&found) {
        let wanted = exact.potential(*p);
        worst = greater(worst, (found - wanted).abs());
        (low, high) = (low.min(wanted), high.max(wanted));
    }
    let mut errors = Errors::from([("potential_linf".to_owned(), worst / (high - low))]);
    // A plain box has no such totals.
    let (name, wanted) = exact.seen();
    if run.scene["electrostatics"]["outer"] == "multipole" {
        let found = totals(run)?.get(name)?;
        errors.insert("seen".to_owned(), (found / wanted - 1.0).abs());
    }
    Ok(errors)
}
