//! `pool-surface-heat`: what is put in is what is prescribed.

use artefact::Reader;
use serde_json::{Value, json};

use crate::case::{Case, Errors, Measurement, Target};
use crate::lab::{Finished, Lab, LabError};
use crate::particles::{measurement, number};
use crate::spot::Spot;

/// Radius of the sphere \[m\].
const RADIUS: f64 = 0.018;
/// Half the width of the planes, seen from above \[m\].
const HALF_WIDTH: f64 = 0.02;

/// The case.
pub(super) struct PoolSurfaceHeat;

impl Case for PoolSurfaceHeat {
    fn name(&self) -> &'static str {
        "pool-surface-heat"
    }

    fn tool(&self) -> &'static str {
        "poolsph"
    }

    fn reference(&self) -> &'static str {
        "integral of the flux over the area seen from above"
    }

    fn targets(&self) -> Vec<Target> {
        ["plane", "inclined", "sphere"]
            .into_iter()
            .map(|quantity| Target::error(quantity, 0.01))
            .collect()
    }

    fn measure(&self, lab: &Lab, level: u32, _: &str) -> Result<Measurement, LabError> {
        let spacing = [1e-3, 0.8e-3, 0.5e-3, 0.4e-3][level.clamp(1, 4) as usize - 1];
        let mut errors = Errors::new();
        let mut whole: Option<Measurement> = None;
        for (shape, body) in bodies() {
            let mut patch = json!({"spacing_m": spacing});
            if let Some(body) = body {
                patch["bodies"] = json!([body]);
            }
            let label = format!("{shape}-level{level}");
            let run = lab.run("poolsph", self.name(), &label, &patch)?;
            errors.insert(shape.to_owned(), error(&run, shape)?);
            let points = run_points(&run)?;
            let one = measurement(run, points, Errors::new())?;
            whole = Some(match whole {
                None => one,
                Some(mut sum) => {
                    sum.points += one.points;
                    sum.runs.extend(one.runs);
                    sum
                }
            });
        }
        match whole {
            Some(whole) => Ok(Measurement { errors, ..whole }),
            None => unreachable!("there are three shapes"),
        }
    }
}

/// Name and body; `None`: the body of the scene.
fn bodies() -> [(&'static str, Option<Value>); 3] {
    // Normal of a plane that rises by 30 degrees along x.
    let (sin, cos) = (0.5, 0.75_f64.sqrt());
    let thick = 0.004;
    let inclined = json!({
        "shape": {"box": {"min_m": [-HALF_WIDTH, -HALF_WIDTH, -HALF_WIDTH], "max_m": [HALF_WIDTH, HALF_WIDTH, 0.012]}},
        "state": "solid",
        "temperature_k": 300,
        "cuts": [
            {"point_m": [0, 0, 0], "normal": [-sin, 0, cos]},
            {"point_m": [sin * thick, 0, -cos * thick], "normal": [sin, 0, -cos]}
        ]
    });
    let sphere = json!({
        "shape": {"sphere": {"centre_m": [0, 0, 0], "radius_m": RADIUS}},
        "state": "solid",
        "temperature_k": 300
    });
    [
        ("plane", None),
        ("inclined", Some(inclined)),
        ("sphere", Some(sphere)),
    ]
}

fn error(run: &Finished, shape: &str) -> Result<f64, LabError> {
    let spot = Spot::of(run)?;
    let prescribed = match shape {
        "sphere" => spot.power(RADIUS),
        _ => spot.power_on_square(HALF_WIDTH),
    };
    let reader = Reader::open_kind(&run.artefact, "particle-frames", 1)?;
    let balance = reader.records("/balance")?;
    let Some((time, last)) = balance.last() else {
        return Ok(f64::NAN);
    };
    // From the enthalpies of the particles, not from what the stage says it has put in.
    let taken = last.get("energy_stored_j")?;
    Ok((taken / (prescribed * time) - 1.0).abs())
}

fn run_points(run: &Finished) -> Result<usize, LabError> {
    let reader = Reader::open_kind(&run.artefact, "particle-frames", 1)?;
    let volume = number(run, "/spacing_m")?.powi(3);
    let balance = reader.records("/balance")?;
    let mass = balance.last().map_or(Ok(0.0), |(_, r)| r.get("mass_kg"))?;
    Ok((mass / (number(run, "/density_kg_m3")? * volume)).round() as usize)
}
