//! `dem-rolling`: a sphere that slides on a floor until it rolls, also with back-spin, and with another inertia.

use serde_json::json;

use crate::case::{Case, Errors, Measurement, Target};
use crate::grains::{fault, frames};
use crate::lab::{Finished, Lab, LabError};
use crate::particles::number;

/// The case.
pub(super) struct DemRolling;

const METHODS: [&str; 3] = ["scene", "back-spin", "inertia-1/2"];

impl Case for DemRolling {
    fn name(&self) -> &'static str {
        "dem-rolling"
    }

    fn tool(&self) -> &'static str {
        "poolsph"
    }

    fn reference(&self) -> &'static str {
        "Coulomb friction on a ball: slides until t = (u + r w)/(mu g (1 + 1/c)), then rolls"
    }

    fn methods(&self) -> &'static [&'static str] {
        &METHODS
    }

    fn targets(&self) -> Vec<Target> {
        let each = |method: &&'static str| {
            [
                Target::error("speed", 0.005).of(*method),
                Target::error("time", 0.01).of(*method),
            ]
        };
        METHODS.iter().flat_map(each).collect()
    }

    fn measure(&self, lab: &Lab, level: u32, method: &str) -> Result<Measurement, LabError> {
        let steps = 20.0 * f64::from(1 << (level.clamp(1, 5) - 1));
        let mut patch = json!({"grains": {"steps_per_contact": steps}});
        match method {
            "back-spin" => {
                let run = lab.run("poolsph", self.name(), &format!("start{level}"), &patch)?;
                let (u, r) = (start(&run)?[0], number(&run, "/grains/bodies/0/radius_m")?);
                let spin = json!([0.0, -0.5 * u / r, 0.0]);
                let mut body = run.scene["grains"]["bodies"][0].clone();
                body["spin_rad_s"] = spin;
                patch["grains"]["bodies"] = json!([body]);
            }
            "inertia-1/2" => patch["grains"]["inertia_factor"] = json!(0.5),
            _ => {}
        }
        let label = format!("{}-level{level}", method.replace('/', "-"));
        let run = lab.run("poolsph", self.name(), &label, &patch)?;
        let errors = errors(&run)?;
        let spacing = 2.0 * number(&run, "/grains/bodies/0/radius_m")?;
        Ok(Measurement::of(run, steps as u64, spacing, errors))
    }
}

/// Speed along x and spin about y at the start.
fn start(run: &Finished) -> Result<[f64; 2], LabError> {
    let speed = number(run, "/grains/bodies/0/velocity_m_s/0")?;
    let spin = number(run, "/grains/bodies/0/spin_rad_s/1").unwrap_or(0.0);
    Ok([speed, spin])
}

fn errors(run: &Finished) -> Result<Errors, LabError> {
    let frames = frames(&run.artefact)?;
    let at = |key: &str| number(run, &format!("/grains/{key}"));
    let (r, mu) = (at("bodies/0/radius_m")?, at("contact/friction")?);
    let c = at("inertia_factor").unwrap_or(0.4);
    let g = -at("gravity_m_s2/2")?;
    let [u, w] = start(run)?;
    let slip = u - r * w;
    let exact_time = slip / (mu * g * (1.0 + 1.0 / c));
    let exact_speed = u - mu * g * exact_time;
    let mut course = Vec::new();
    for frame in &frames {
        let (velocity, spin) = (
            frame.vectors("velocity")?[0][0],
            frame.vectors("spin")?[0][1],
        );
        course.push((frame.time_s, velocity, velocity - r * spin));
    }
    // The slip falls evenly: its straight line through the middle of the slide tells the end.
    let near = |part: f64| {
        course
            .iter()
            .find(|(_, _, left)| *left < part * slip)
            .ok_or_else(|| fault(run, "ends before the sphere rolls"))
    };
    let (early, late) = (near(0.75)?, near(0.25)?);
    let rate = (early.2 - late.2) / (late.0 - early.0);
    let time = late.0 + late.2 / rate;
    let last = course.last().ok_or_else(|| fault(run, "has no frame"))?;
    Ok(Errors::from([
        ("time".to_owned(), (time / exact_time - 1.0).abs()),
        ("speed".to_owned(), (last.1 / exact_speed - 1.0).abs()),
        ("slip".to_owned(), (last.2 / slip).abs()),
    ]))
}
