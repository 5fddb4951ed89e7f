//! `dem-incline`: grains on a slope. One that cannot roll, and a block of glued grains, stick up to tan = mu; a ball rolls, and beyond
//! tan = 3.5 mu slips.

use serde_json::{Value, json};

use crate::case::{Case, Errors, Measurement, Target};
use crate::grains::frames;
use crate::lab::{Finished, Lab, LabError};
use crate::particles::number;

/// The case.
pub(super) struct DemIncline;

/// Grains along the sides of a block: so flat that it does not tip before it slides.
const BLOCK: [f64; 3] = [6.0, 6.0, 2.0];

/// Degrees by which an angle is above or below a limit.
const ASIDE: f64 = 0.5;

impl Case for DemIncline {
    fn name(&self) -> &'static str {
        "dem-incline"
    }

    fn tool(&self) -> &'static str {
        "poolsph"
    }

    fn reference(&self) -> &'static str {
        "Coulomb: a = g (sin - mu cos) where it slides, g sin / (1 + c) where it rolls, which ends at tan = mu (1 + 1/c)"
    }

    fn targets(&self) -> Vec<Target> {
        vec![
            Target::error("creep_over_d", 1e-3),
            Target::error("slide", 0.01),
            Target::error("roll", 0.01),
            Target::error("slip", 0.01),
            Target::error("block_creep_over_d", 1e-3),
            Target::error("block_slide", 0.01),
        ]
    }

    fn measure(&self, lab: &Lab, level: u32, _: &str) -> Result<Measurement, LabError> {
        let steps = 20.0 * f64::from(1 << (level.clamp(1, 5) - 1));
        let patch = json!({"grains": {"steps_per_contact": steps}});
        let scene = lab.run("poolsph", self.name(), &format!("scene{level}"), &patch)?;
        let at = |key: &str| number(&scene, &format!("/grains/{key}"));
        let (mu, c) = (at("contact/friction")?, at("inertia_factor").unwrap_or(0.4));
        let (r, g) = (at("bodies/0/radius_m")?, -at("gravity_m_s2/2")?);
        let stick = mu.atan().to_degrees();
        let slip = (mu * (1.0 + 1.0 / c)).atan().to_degrees();
        let still = json!({"contact": {"rolling": {"coefficient": 1e3}}});
        let free = json!({"contact": {"rolling": null}});
        let block = json!({"bodies": [block(r)]});
        let mut runs = Vec::new();
        let mut tilted = |name: &str, degrees: f64, patch: &Value| -> Result<[f64; 2], LabError> {
            let angle = degrees.to_radians();
            let mut patch = json!({"grains": patch});
            patch["grains"]["gravity_m_s2"] = json!([g * angle.sin(), 0.0, -g * angle.cos()]);
            let run = lab.varied(&scene, &format!("{name}{level}"), &patch)?;
            let found = [way(&run)?, acceleration(&run)?];
            runs.push(run);
            Ok(found)
        };
        let sticks = tilted("stick", stick - ASIDE, &still)?[0];
        let slides = tilted("slide", stick + ASIDE, &still)?[1];
        let rolls = tilted("roll", slip - ASIDE, &free)?[1];
        let slips = tilted("slip", slip + ASIDE, &free)?[1];
        let block_sticks = tilted("block-stick", stick - ASIDE, &block)?[0];
        let block_slides = tilted("block-slide", stick + ASIDE, &block)?[1];
        let sliding = |degrees: f64| {
            let angle = degrees.to_radians();
            g * (angle.sin() - mu * angle.cos())
        };
        let rolling = g * (slip - ASIDE).to_radians().sin() / (1.0 + c);
        let errors = Errors::from([
            ("creep_over_d".to_owned(), sticks / (2.0 * r)),
            (
                "slide".to_owned(),
                (slides / sliding(stick + ASIDE) - 1.0).abs(),
            ),
            ("roll".to_owned(), (rolls / rolling - 1.0).abs()),
            (
                "slip".to_owned(),
                (slips / sliding(slip + ASIDE) - 1.0).abs(),
            ),
            ("block_creep_over_d".to_owned(), block_sticks / (2.0 * r)),
            (
                "block_slide".to_owned(),
                (block_slides / sliding(stick + ASIDE) - 1.0).abs(),
            ),
        ]);
        Ok(Measurement::over(
            runs,
            steps as u64,
            2.0 * r / steps,
            errors,
        ))
    }
}

/// A block of glued grains of the radius `r` \[m\] that just touches the slope.
fn block(r: f64) -> Value {
    let [long, wide, high] = BLOCK.map(|number| 2.0 * r * number);
    let sunk = 1e-4 * r;
    json!({
        "shape": {"box": {"min_m": [0, 0, -sunk], "max_m": [long, wide, high - sunk]}},
        "radius_m": r,
        "glued": true
    })
}

/// How far the grains are from where they were after a tenth of the run, in the mean \[m\].
fn way(run: &Finished) -> Result<f64, LabError> {
    let frames = frames(&run.artefact)?;
    let x = |k: usize| Ok::<f64, LabError>(mean(&frames[k].position_vectors()?));
    let last = frames.len() - 1;
    Ok((x(last)? - x(last / 10)?).abs())
}

/// Mean acceleration over the second half of the run \[m/s2\].
fn acceleration(run: &Finished) -> Result<f64, LabError> {
    let frames = frames(&run.artefact)?;
    let u = |k: usize| Ok::<f64, LabError>(mean(&frames[k].vectors("velocity")?));
    let last = frames.len() - 1;
    Ok((u(last)? - u(last / 2)?) / (frames[last].time_s - frames[last / 2].time_s))
}

/// Mean of the first numbers.
fn mean(vectors: &[[f64; 3]]) -> f64 {
    vectors.iter().map(|v| v[0]).sum::<f64>() / vectors.len() as f64
}
