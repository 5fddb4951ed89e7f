//! `em-saturation`: iron with a curve of magnetisation in static fields: a cylinder, a sphere, and a tube about a wire.

use serde_json::{Value, json};

use crate::case::{Case, Errors, Measurement, Target};
use crate::em::driven::Driven;
use crate::em::frames::{Level, Points, measured, number};
use crate::em::saturation::{Law, Round, Tube};
use crate::heat::formula::{At, Formula};
use crate::heat::frames::greater;
use crate::heat::methods::over;
use crate::heat::property::at;
use crate::lab::{Finished, Lab, LabError};

/// The case.
pub(super) struct EmSaturation;

impl Case for EmSaturation {
    fn name(&self) -> &'static str {
        "em-saturation"
    }

    fn tool(&self) -> &'static str {
        "emfield"
    }

    fn reference(&self) -> &'static str {
        "Bodies with uniform magnetisation, Jackson (1999), section 5.11, and Ampere's law"
    }

    fn methods(&self) -> &'static [&'static str] {
        &[
            "cylinder",
            "cylinder-quadratic",
            "tube",
            "tube-quadratic",
            "sphere-axis",
            "sphere",
            "tube-march",
        ]
    }

    fn targets(&self) -> Vec<Target> {
        vec![
            Target::error("flux_iron_linf", 2e-3),
            Target::error("flux_iron_linf", 1e-3).of("tube"),
            Target::order("flux_iron_linf", 2.0).of("tube"),
            Target::order("flux_iron_linf", 1.0).of("cylinder-quadratic"),
            Target::order("flux_iron_linf", 1.0).of("tube-quadratic"),
            Target::error("flux_iron_linf", 2e-2).of("tube-march"),
            Target::order("flux_iron_linf", 2.0).of("tube-march"),
        ]
    }

    fn measure(&self, lab: &Lab, level: u32, method: &str) -> Result<Measurement, LabError> {
        if method == "tube-march" {
            return marched(lab, self, level);
        }
        let row = level.clamp(1, 3) as usize - 1;
        let spacing = match method {
            "sphere" => [0.002, 0.0016, 0.0013],
            _ => [0.001, 0.0007, 0.0005],
        }[row];
        let order = if method.ends_with("quadratic") { 2 } else { 4 };
        let patch = json!({
            "points": {"spacing_m": spacing, "layers": {"first_m": 0.5 * spacing}},
            "method": {"order": order}
        });
        let patch = over(patch, &shape(method));
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

/// What a method changes in the scene.
fn shape(method: &str) -> Value {
    let sphere = json!({"sphere": {"centre_m": [0, 0, 0], "radius_m": 0.01}});
    let curve = json!({"expr": "1/(1 - 0.999/(1 + (B/2)^8)^0.125)"});
    let disc = |r: f64| json!({"disc": {"centre_m": [0, 0], "radius_m": r}});
    match method {
        "sphere-axis" => json!({"geometry": "axisymmetric",
            "eddy_currents": {"applied_flux_density_t": [0, 0.9]}}),
        "sphere" => json!({"geometry": "space",
            "domain": {"sphere": {"centre_m": [0, 0, 0], "radius_m": 0.02}},
            "bodies": [{"name": "iron", "shape": sphere, "relative_permeability": curve}],
            "eddy_currents": {"applied_flux_density_t": [0.6, 0.2, 0.6]}}),
        name if name.starts_with("tube") => json!({
            "domain": {"sphere": {"centre_m": [0, 0], "radius_m": 0.03}},
            "bodies": [
                {"name": "hole", "shape": disc(0.01)},
                {"name": "iron", "shape": disc(0.02), "relative_permeability": curve}],
            "eddy_currents": {"applied_flux_density_t": null, "outer": "zero",
                "coils": [{"wire": {"place_m": [0, 0], "current_a": 1000}}]}}),
        _ => json!({}),
    }
}

/// A tube that conducts, in time.
fn marched(lab: &Lab, case: &dyn Case, level: u32) -> Result<Measurement, LabError> {
    let row = level.clamp(1, 3) as usize - 1;
    let (spacing, step) = ([0.0025, 0.0018, 0.00145][row], [2e-4, 1e-4, 5e-5][row]);
    let tube = shape("tube");
    let mut bodies = tube["bodies"].clone();
    bodies[1]["relative_permeability"] = json!({"expr": "1/(1 - 0.98/(1 + (B/1.5)^4)^0.25)"});
    bodies[1]["conductivity_s_m"] = json!(1e6);
    let patch = over(
        over(
            json!({"points": {"spacing_m": spacing, "layers": {"first_m": 0.5 * spacing}}}),
            &tube,
        ),
        &json!({"bodies": bodies, "eddy_currents": {"static": null, "transient": {"end_s": 5e-3,
            "step_s": step, "wave": {"expr": "sin(100*pi*t)"}}}}),
    );
    measured(
        lab,
        case,
        Level {
            level,
            method: "tube-march",
            spacing,
        },
        &patch,
        in_time,
    )
}

fn in_time(run: &Finished, points: &Points) -> Result<Errors, LabError> {
    let unknown = |what: String| LabError::Content {
        path: run.artefact.clone(),
        what,
    };
    let law = Law::read(at(run, "/bodies/1/relative_permeability")?).map_err(unknown)?;
    let radius = |k: usize| number(run, &format!("/bodies/{k}/shape/disc/radius_m"));
    let tube = Driven {
        radii: [radius(0)?, radius(1)?],
        wall: number(run, "/domain/sphere/radius_m")?,
        conductivity: number(run, "/bodies/1/conductivity_s_m")?,
        law,
    };
    let wave = at(run, "/eddy_currents/transient/wave/expr")?;
    let wave = Formula::parse(wave.as_str().unwrap_or_default()).map_err(unknown)?;
    let current = number(run, "/eddy_currents/coils/0/wire/current_a")?;
    let end = number(run, "/eddy_currents/transient/end_s")?;
    let all = tube.march(end, |t| {
        current
            * wave.value(&At {
                time: t,
                ..At::place([0.0; 3])
            })
    });
    let most = all.iter().fold(0.0, |m: f64, b| m.max(b.abs()));
    let medium = points.frame.f64("medium")?;
    let flux = points.vectors("magnetic_flux_density")?;
    let (mut worst, mut square, mut count) = (0.0, 0.0, 0.0);
    for ((x, found), medium) in points.position.iter().zip(&flux).zip(&medium) {
        let r = x[0].hypot(x[1]);
        if (medium - 2.0).abs() > 0.5 {
            continue;
        }
        let b = tube.between(&all, r) / r;
        let far = (found[0] + x[1] * b).hypot(found[1] - x[0] * b) / most;
        worst = greater(worst, far);
        square += far * far;
        count += 1.0;
    }
    Ok(Errors::from([
        ("flux_iron_linf".to_owned(), worst),
        (
            "flux_iron_l2".to_owned(),
            (square / f64::max(count, 1.0)).sqrt(),
        ),
    ]))
}

/// A flux density \[T\] by place \[m\].
type Flux = Box<dyn Fn([f64; 3]) -> [f64; 3]>;

/// The flux density of a scene.
fn exact(run: &Finished) -> Result<Flux, LabError> {
    let unknown = |what: String| LabError::Content {
        path: run.artefact.clone(),
        what,
    };
    let bodies = at(run, "/bodies")?.as_array().map_or(0, Vec::len);
    let iron = bodies - 1;
    let law = at(run, &format!("/bodies/{iron}/relative_permeability"))?;
    let law = Law::read(law).map_err(unknown)?;
    if bodies == 2 {
        let radius = |k: usize| number(run, &format!("/bodies/{k}/shape/disc/radius_m"));
        let tube = Tube {
            current: number(run, "/eddy_currents/coils/0/wire/current_a")?,
            radii: [radius(0)?, radius(1)?],
            law,
        };
        return Ok(Box::new(move |x| {
            let r = x[0].hypot(x[1]);
            let b = tube.around(r);
            [-x[1] / r * b, x[0] / r * b, 0.0]
        }));
    }
    let flux = |k: usize| number(run, &format!("/eddy_currents/applied_flux_density_t/{k}"));
    let (dimensions, shape, applied) = match at(run, "/geometry")?.as_str() {
        Some("plane") => (2, "disc", [flux(0)?, flux(1)?, 0.0]),
        Some("axisymmetric") => (3, "disc", [0.0, 0.0, flux(1)?]),
        _ => (3, "sphere", [flux(0)?, flux(1)?, flux(2)?]),
    };
    let radius = number(run, &format!("/bodies/0/shape/{shape}/radius_m"))?;
    let round = Round::new(&law, dimensions, radius, applied);
    Ok(Box::new(move |x| round.field(x)))
}

fn errors(run: &Finished, points: &Points) -> Result<Errors, LabError> {
    let wanted = exact(run)?;
    let medium = points.frame.f64("medium")?;
    let iron = medium.iter().fold(0.0, |m: f64, n| m.max(*n));
    let flux = points.vectors("magnetic_flux_density")?;
    let [mut inside, mut outside, mut most] = [0.0; 3];
    for ((x, found), medium) in points.position.iter().zip(&flux).zip(&medium) {
        // The hole of a tube has its own side of the surface, and a wire in it.
        if *medium < iron && *medium > 0.0 {
            continue;
        }
        let b = wanted(*x);
        let far = (0..3)
            .map(|k| (found[k] - b[k]).powi(2))
            .sum::<f64>()
            .sqrt();
        if (medium - iron).abs() < 0.5 {
            inside = greater(inside, far);
            most = greater(most, b.iter().map(|b| b * b).sum::<f64>().sqrt());
        } else {
            outside = greater(outside, far);
        }
    }
    Ok(Errors::from([
        ("flux_iron_linf".to_owned(), inside / most),
        ("flux_air_linf".to_owned(), outside / most),
    ]))
}
