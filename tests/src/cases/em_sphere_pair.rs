//! `em-sphere-pair`: two electrodes a hundredth of a radius apart, their forces and the field between them.

use artefact::Reader;
use serde_json::{Value, json};

use crate::case::{Case, Errors, Measurement, Target};
use crate::em::frames::{Level, Points, measured, planned, totals};
use crate::em::pair::{Pair, Sphere};
use crate::heat::frames::greater;
use crate::heat::methods::over;
use crate::lab::{Finished, Lab, LabError};

/// The case.
pub(super) struct EmSpherePair;

/// Polynomials in space, then spheres of two sizes, and the half plane about the axis.
const METHODS: &[&str] = &["quartic", QUADRATIC, UNEQUAL, AXIS];
const QUADRATIC: &str = "quadratic";
const UNEQUAL: &str = "unequal";
const AXIS: &str = "axisymmetric";

/// Images of each sphere that the formula of the walls has one by one.
const IMAGES: usize = 40;
/// Name of the probe halfway between the spheres.
const PROBE: &str = "middle";

impl Case for EmSpherePair {
    fn name(&self) -> &'static str {
        "em-sphere-pair"
    }

    fn tool(&self) -> &'static str {
        "emfield"
    }

    fn reference(&self) -> &'static str {
        "Images of two charged spheres, Maxwell (1873), arts. 172 to 174"
    }

    fn methods(&self) -> &'static [&'static str] {
        METHODS
    }

    fn targets(&self) -> Vec<Target> {
        let mut targets = Vec::new();
        for method in METHODS {
            targets.push(Target::error("force", 5e-3).of(*method));
            targets.push(Target::error("force_apart", 2e-3).of(*method));
        }
        for (method, error, order) in [
            ("quartic", 1e-3, 2.0),
            (AXIS, 1e-3, 2.0),
            // The gap is half as wide beside the greater sphere.
            (UNEQUAL, 5e-3, 2.0),
            // Its width doubles within eight spacings.
            (QUADRATIC, 2e-2, 1.8),
        ] {
            targets.push(Target::error("field_between", error).of(method));
            targets.push(Target::order("field_between", order).of(method));
        }
        for method in ["quartic", QUADRATIC, AXIS] {
            targets.push(Target::order("potential_linf", 2.0).of(method));
        }
        targets
    }

    fn measure(&self, lab: &Lab, level: u32, method: &str) -> Result<Measurement, LabError> {
        // About the axis points are few.
        let finer = if method == AXIS { 2.0 } else { 1.0 };
        let parts = finer * [5.0, 7.5, 10.0][level.clamp(1, 3) as usize - 1];
        let patch = method_patch(method);
        let scene = planned(lab, self.name(), &patch)?;
        let pair = pair(&scene).ok_or_else(|| unknown(lab.root.clone()))?;
        let radius = pair.spheres[0].radius.min(pair.spheres[1].radius);
        let spacing = radius / parts;
        let points = json!({"spacing_m": spacing});
        // Each sphere has points for its own size.
        let mut bodies = scene["bodies"].clone();
        for (body, sphere) in bodies
            .as_array_mut()
            .into_iter()
            .flatten()
            .zip(pair.spheres)
        {
            body["spacing_m"] = json!(sphere.radius / parts);
        }
        let patch = over(patch, &given(&pair, method));
        let patch = over(patch, &json!({"points": points, "bodies": bodies}));
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

fn method_patch(method: &str) -> Value {
    let electrode = |name: &str, shape: Value, potential: f64| json!({"name": name, "shape": shape, "potential_v": potential});
    match method {
        QUADRATIC => json!({"method": {"order": 2}}),
        UNEQUAL => {
            let ball = |z: f64, radius: f64| json!({"sphere": {"centre_m": [0, 0, z], "radius_m": radius}});
            json!({"bodies": [
                electrode("lower", ball(-5.0125e-5, 5e-5), 3000.0),
                electrode("upper", ball(2.5125e-5, 2.5e-5), -500.0)
            ]})
        }
        AXIS => {
            let ball = |z: f64| json!({"disc": {"centre_m": [0, z], "radius_m": 5e-5}});
            json!({
                "geometry": AXIS,
                "domain": {"box": {"min_m": [0, -2e-4], "max_m": [2e-4, 2e-4]}},
                "bodies": [
                    electrode("lower", ball(-5.025e-5), 3000.0),
                    electrode("upper", ball(5.025e-5), -500.0)
                ]
            })
        }
        _ => json!({}),
    }
}

/// The exact potential on the walls, and a probe halfway between the spheres.
fn given(pair: &Pair, method: &str) -> Value {
    let (square, place) = if method == AXIS {
        ("r^2", json!([0, pair.middle()]))
    } else {
        ("(x^2 + y^2)", json!([0, 0, pair.middle()]))
    };
    json!({
        "electrostatics": {"outer": [{"potential_v": {"expr": pair.formula(square, IMAGES)}}]},
        "output": {"probes": [{"name": PROBE, "place_m": place}]}
    })
}

fn unknown(path: std::path::PathBuf) -> LabError {
    LabError::Content {
        path,
        what: "its scene has no two electrodes, spheres on the axis, the lower one first"
            .to_owned(),
    }
}

/// The pair of a scene.
fn pair(scene: &Value) -> Option<Pair> {
    let sphere = |body: &Value| {
        let shape = &body["shape"];
        let round = ["sphere", "disc"].map(|kind| &shape[kind]);
        let round = round.into_iter().find(|round| round.is_object())?;
        let centre = round["centre_m"].as_array()?;
        let (z, aside) = centre.split_last()?;
        if aside.iter().any(|c| c.as_f64() != Some(0.0)) {
            return None;
        }
        Some(Sphere {
            z: z.as_f64()?,
            radius: round["radius_m"].as_f64()?,
            potential: body["potential_v"].as_f64()?,
        })
    };
    match scene["bodies"].as_array().map(Vec::as_slice) {
        Some([low, high]) => Pair::of([sphere(low)?, sphere(high)?]),
        _ => None,
    }
}

fn errors(run: &Finished, points: &Points) -> Result<Errors, LabError> {
    let pair = pair(&run.scene).ok_or_else(|| unknown(run.artefact.clone()))?;
    let force = pair.force();
    let found = totals(run)?;
    let lower = -found.get("electric_force_lower_z")? / force - 1.0;
    let upper = found.get("electric_force_upper_z")? / force - 1.0;
    let reader = Reader::open_kind(&run.artefact, "point-fields", 1)?;
    let field = reader
        .record("/probes")?
        .get(&format!("{PROBE}.electric_field_z"))?;
    let middle = field / pair.field(0.0, pair.middle()) - 1.0;
    let [low, high] = pair.spheres;
    let range = (low.potential - high.potential).abs();
    let potential = points.frame.f64("potential")?;
    let kind = points.frame.u8("kind")?;
    let mut worst = 0.0;
    for (i, p) in points.position.iter().enumerate() {
        let radial = p[0].hypot(p[1]);
        let within = |s: &Sphere| radial.hypot(p[2] - s.z) < s.radius * (1.0 + 1e-9);
        if kind[i] == 1 || pair.spheres.iter().any(within) {
            continue;
        }
        let exact = pair.potential(radial, p[2]);
        worst = greater(worst, (potential[i] - exact).abs() / range);
    }
    Ok(Errors::from([
        ("force".to_owned(), greater(lower.abs(), upper.abs())),
        ("force_apart".to_owned(), (lower - upper).abs()),
        ("field_between".to_owned(), middle.abs()),
        ("potential_linf".to_owned(), worst),
    ]))
}
