//! `em-ellipsoid`: the uniform field in an ellipsoid, and that around it.

use serde_json::{Value, json};

use crate::case::{Case, Errors, Measurement, Target};
use crate::em::ellipsoid::Ellipsoid;
use crate::em::frames::{Level, Points, measured, planned};
use crate::heat::frames::greater;
use crate::heat::methods::over;
use crate::lab::{Finished, Lab, LabError};

/// The case.
pub(super) struct EmEllipsoid;

/// Spheroids about their axis, an ellipse in a plane, ellipsoids in space.
const METHODS: &[&str] = &[
    "needle",
    "needle-quartic",
    CONDUCTOR,
    SHAKEN,
    "disc",
    "ellipse",
    SPACE,
    "space-shaken",
    "space-quadratic",
    NEEDLE,
];

/// A conducting needle about its axis.
const CONDUCTOR: &str = "conductor";

/// The same on points that are shifted at random.
const SHAKEN: &str = "conductor-shaken";

/// Three unequal axes, a field along none of them.
const SPACE: &str = "space";

/// A conducting needle in space.
const NEEDLE: &str = "space-needle";

/// Greatest errors at the third level and least orders, by method: of the field outside on the surface, of that inside, of the
/// potential.
const BOUNDS: &[(&str, [f64; 3], [f64; 3])] = &[
    ("needle", [3.2e-2, 2e-2, 4e-3], [2.4, 2.9, 1.9]),
    ("needle-quartic", [1.6e-2, 1.6e-2, 1.2e-3], [2.1, 2.0, 2.6]),
    (CONDUCTOR, [3.2e-2, 0.0, 4.7e-3], [2.4, 0.0, 1.9]),
    (SHAKEN, [4.4e-2, 0.0, 5.5e-3], [2.0, 0.0, 1.7]),
    ("disc", [4.1e-2, 4.8e-3, 1.6e-3], [1.2, 2.5, 2.3]),
    ("ellipse", [2.3e-2, 6.6e-3, 1.1e-3], [1.5, 2.8, 1.7]),
    (SPACE, [7e-3, 5.7e-3, 4.3e-4], [2.7, 2.6, 3.0]),
    ("space-shaken", [7.6e-3, 6.7e-3, 4e-4], [2.9, 3.0, 3.1]),
    ("space-quadratic", [3.8e-2, 1.4e-2, 3.8e-3], [1.6, 2.7, 1.4]),
    (NEEDLE, [1.2e-2, 0.0, 1.1e-3], [2.3, 0.0, 2.5]),
];

/// Spacings per shortest semi-axis, by level.
const PARTS: [f64; 3] = [8.0, 12.0, 16.0];
/// The same in space.
const FEW: [f64; 3] = [4.0, 6.0, 8.0];
/// Part of the spacing by which points are shifted.
const SHIFT: f64 = 0.3;

impl Case for EmEllipsoid {
    fn name(&self) -> &'static str {
        "em-ellipsoid"
    }

    fn tool(&self) -> &'static str {
        "emfield"
    }

    fn reference(&self) -> &'static str {
        "Depolarisation of an ellipsoid, Stratton (1941), sections 3.25 to 3.29"
    }

    fn methods(&self) -> &'static [&'static str] {
        METHODS
    }

    fn targets(&self) -> Vec<Target> {
        let quantities = ["field_beyond_linf", "field_inside_linf", "potential_linf"];
        let mut targets = Vec::new();
        for (method, errors, orders) in BOUNDS {
            for (k, quantity) in quantities.iter().enumerate() {
                // There is no field in a conductor.
                if errors[k] > 0.0 {
                    targets.push(Target::error(*quantity, errors[k]).of(*method));
                    targets.push(Target::order(*quantity, orders[k]).of(*method));
                }
            }
        }
        targets
    }

    fn measure(&self, lab: &Lab, level: u32, method: &str) -> Result<Measurement, LabError> {
        let patch = method_patch(method);
        let scene = planned(lab, self.name(), &patch)?;
        let known = |scene: &Value| known(scene).map_err(|what| content(lab.root.clone(), what));
        let body = known(&scene)?;
        let space = scene["geometry"] == "space";
        let all = if space { FEW } else { PARTS };
        let parts = all[level.clamp(1, 3) as usize - 1];
        let shortest = body.half.iter().copied().fold(f64::INFINITY, f64::min);
        let spacing = shortest / parts;
        let mut points = json!({"spacing_m": spacing});
        if method == NEEDLE {
            points["refinements"] = tips(&body, 0.5 * spacing);
        }
        let mut patch = over(patch, &json!({"points": points}));
        if scene["electrostatics"]["applied_field_v_m"].is_null() {
            let formula = body
                .formula()
                .map_err(|what| content(lab.root.clone(), what))?;
            let scale = body.field[1].abs().max(body.field[2].abs());
            let walls = json!([{"potential_v": {"expr": format!("{scale:e}*({formula})")}}]);
            patch = over(patch, &json!({"electrostatics": {"outer": walls}}));
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
            |run, points| errors(run, points, &known(&run.scene)?),
        )
    }
}

/// Balls about the tips of a needle with points of their own, twice as wide as the tips are sharp.
fn tips(body: &Ellipsoid, spacing: f64) -> Value {
    let [across, _, along] = body.half;
    let sharp = across * across / along;
    let ball = |sign: f64| {
        let centre = [0.0, 0.0, sign * (along - sharp)];
        json!({"shape": {"sphere": {"centre_m": centre, "radius_m": 2.0 * sharp}}, "spacing_m": spacing})
    };
    json!([ball(-1.0), ball(1.0)])
}

fn content(path: std::path::PathBuf, what: String) -> LabError {
    LabError::Content { path, what }
}

fn method_patch(method: &str) -> Value {
    // A list is replaced as a whole.
    let bodies = |half: &[f64], more: Value| {
        let centre = vec![0.0; half.len()];
        let shape = json!({"ellipsoid": {"centre_m": centre, "semi_axes_m": half}});
        json!({"bodies": [over(json!({"name": "body", "shape": shape}), &more)]})
    };
    let dielectric = json!({"relative_permittivity": 80});
    let needle = [2.5e-5, 1e-4];
    let shaken = json!({"points": {"jitter": SHIFT}});
    let space = |half: [f64; 3]| {
        let triaxial = json!({
            "geometry": SPACE,
            "domain": {"sphere": {"centre_m": [0, 0, 0], "radius_m": 1.6e-3}, "box": null},
            "electrostatics": {"applied_field_v_m": [6e5, -3e5, 8e5], "outer": null},
            "method": {"order": 4}
        });
        over(bodies(&half, dielectric.clone()), &triaxial)
    };
    let thick = [4e-5, 3e-5, 2e-5];
    match method {
        "needle-quartic" => json!({"method": {"order": 4}}),
        CONDUCTOR => bodies(&needle, json!({"potential_v": 0})),
        SHAKEN => over(bodies(&needle, json!({"potential_v": 0})), &shaken),
        "disc" => bodies(&[1e-4, 2.5e-5], dielectric),
        "ellipse" => over(
            bodies(&needle, dielectric),
            &json!({
                "geometry": "plane",
                "domain": {"box": {"min_m": [-4e-4, -4e-4], "max_m": [4e-4, 4e-4]}}
            }),
        ),
        SPACE => space(thick),
        "space-shaken" => over(space(thick), &shaken),
        "space-quadratic" => over(space(thick), &json!({"method": {"order": 2}})),
        NEEDLE => over(
            bodies(&[2.5e-5, 2.5e-5, 1e-4], json!({"potential_v": 0})),
            &json!({
                "geometry": SPACE,
                "domain": {"box": {"min_m": [-4e-4, -4e-4, -4e-4], "max_m": [4e-4, 4e-4, 4e-4]}},
                "method": {"order": 4}
            }),
        ),
        _ => json!({}),
    }
}

/// The ellipsoid about the origin of a scene, in a field along the last axis of 1 MV/m where no other is applied.
fn known(scene: &Value) -> Result<Ellipsoid, String> {
    let numbers = |value: &Value| -> Option<Vec<f64>> {
        value.as_array()?.iter().map(Value::as_f64).collect()
    };
    let body = &scene["bodies"][0];
    let shape = &body["shape"]["ellipsoid"];
    let centre = numbers(&shape["centre_m"]).unwrap_or_default();
    let half = numbers(&shape["semi_axes_m"]).unwrap_or_default();
    let half = match (scene["geometry"].as_str(), &half[..]) {
        (Some("plane"), [a, b]) => [*a, *b, f64::INFINITY],
        (Some("axisymmetric"), [a, c]) => [*a, *a, *c],
        (Some("space"), [a, b, c]) => [*a, *b, *c],
        _ => return Err("the first body of its scene is no ellipsoid".to_owned()),
    };
    if centre.iter().any(|c| c.abs() > 0.0) {
        return Err("known is an ellipsoid about the origin".to_owned());
    }
    let permittivity = |of: &Value| of["relative_permittivity"].as_f64().unwrap_or(1.0);
    let ratio = match body["potential_v"].as_f64() {
        Some(_) => f64::INFINITY,
        None => permittivity(body) / permittivity(&scene["surroundings"]),
    };
    let applied = numbers(&scene["electrostatics"]["applied_field_v_m"]);
    let field = match (applied.as_deref(), half[2].is_finite()) {
        (Some([x, y, z]), _) => [*x, *y, *z],
        (Some(_), _) => return Err("known are fields of three components".to_owned()),
        (None, true) => [0.0, 0.0, 1e6],
        (None, false) => [0.0, 1e6, 0.0],
    };
    Ok(Ellipsoid { half, ratio, field })
}

fn length(v: [f64; 3]) -> f64 {
    v.iter().map(|x| x * x).sum::<f64>().sqrt()
}

/// Errors over the greatest of what is compared: potential at all points over its rise across the body, field inside and at all
/// points, field on the outer side of the surface, and area.
fn errors(run: &Finished, points: &Points, exact: &Ellipsoid) -> Result<Errors, LabError> {
    let potential = points.frame.f64("potential")?;
    let field = points.frame.vectors("electric_field")?;
    let kind = points.frame.u8("kind")?;
    let far = |found: [f64; 3], wanted: [f64; 3]| length([0, 1, 2].map(|k| found[k] - wanted[k]));
    let size: f64 = (0..3)
        .filter(|k| exact.half[*k].is_finite())
        .map(|k| exact.field[k].abs() * exact.half[k])
        .sum();
    let (mut v, mut inside) = (0.0, 0.0);
    for i in 0..points.position.len() {
        // Points on the surface carry the inner field.
        let shrink = if kind[i] == 1 { 1.0 - 1e-9 } else { 1.0 };
        let p = points.position[i].map(|x| x * shrink);
        v = greater(v, (potential[i] - exact.potential(p)).abs() / size);
        if exact.holds(p) {
            inside = greater(inside, far(field[i], exact.inside()));
        }
    }
    let surface = Points::channel(run, "/surface")?;
    let beyond = surface.frame.vectors("electric_field_outer")?;
    let (mut outer, mut most) = (0.0, 0.0_f64);
    for (place, found) in surface.position.iter().zip(&beyond) {
        let wanted = exact.outside(place.map(|x| x * (1.0 + 1e-9)));
        outer = greater(outer, far(*found, wanted));
        most = most.max(length(wanted));
    }
    let scale = length(exact.inside()).max(1e-3 * length(exact.field));
    Ok(Errors::from([
        ("potential_linf".to_owned(), v),
        ("field_inside_linf".to_owned(), inside / scale),
        ("field_beyond_linf".to_owned(), outer / most),
    ]))
}
