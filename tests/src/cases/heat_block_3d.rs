//! `heat-block-3d`: the plate of `heat-exp-t` as a block in space, also turned.

use serde_json::{Value, json};

use super::heat_exp_t::material;
use super::heat_exp_x::{held, square_spacing};
use crate::case::{Case, Errors, Measurement, Target};
use crate::heat::frames::{Frames, worst};
use crate::heat::methods::{self, STEADY, over};
use crate::heat::plate::Plate;
use crate::heat::property::{Exponential, conductivity, fault, number};
use crate::lab::{Finished, Lab, LabError};

/// a of the paper \[1/K\].
const RATES: [f64; 3] = [1.0, 2.0, 4.0];
/// An error in the plane below this part of the range is round-off of the solver.
const ROUNDING: f64 = 1e-7;

/// The most that is rounding, as part of the range.
const EXACT: f64 = 1e-10;

/// The case.
pub(super) struct HeatBlock3d;

impl Case for HeatBlock3d {
    fn name(&self) -> &'static str {
        "heat-block-3d"
    }

    fn tool(&self) -> &'static str {
        "heatsph"
    }

    fn reference(&self) -> &'static str {
        "Closed form, Rong and Kisu (2010), eq. 7; the plane case at the same spacing"
    }

    fn methods(&self) -> &'static [&'static str] {
        STEADY
    }

    fn levels(&self, _: &str, asked: &[u32]) -> Vec<u32> {
        // Level 3 would have 270,000 points a run.
        asked.iter().copied().filter(|l| *l <= 2).collect()
    }

    fn targets(&self) -> Vec<Target> {
        let mut targets = Vec::new();
        for rate in RATES {
            targets.push(Target::error(format!("of_plane_a{rate}"), 1.5));
        }
        targets.push(Target::error("of_plane_turned", 1.5));
        // The operator is exact for this profile: what is left is rounding, measured below 1e-12.
        for method in ["corrected", "pair", "corrected-jitter-30"] {
            let keys = RATES.map(|rate| format!("a{rate}"));
            let keys = keys.into_iter().chain(["turned".to_owned()]);
            let own = keys.map(|key| Target::error(format!("temperature_linf_{key}"), EXACT));
            targets.extend(own.map(|target| target.of(method)));
        }
        // Pairs on shaken points have an error of their own: 0.063 at the first level.
        let shaken = Target::error("temperature_linf_turned", 0.13).at_level(1);
        targets.push(shaken.of("pair-jitter-30"));
        targets
    }

    fn measure(&self, lab: &Lab, level: u32, method: &str) -> Result<Measurement, LabError> {
        let spacing = square_spacing(level);
        let base = over(
            json!({"points": {"spacing_m": spacing}}),
            &methods::patch(method),
        );
        let mut all = Vec::new();
        let mut errors = Errors::new();
        let mut points = 0;
        for rate in RATES {
            let with = over(base.clone(), &json!({"materials": [material(rate)]}));
            let plane = self.plane(lab, &format!("block-level{level}-{method}-a{rate}"), &with)?;
            let turn = [("", json!({})), ("turned", turned())];
            for (name, patch) in turn.iter().take(if rate > 3.0 { 2 } else { 1 }) {
                let label = format!("level{level}-{method}-a{rate}{name}");
                let run = lab.run(self.tool(), self.name(), &label, &over(with.clone(), patch))?;
                let frames = Frames::read(&run)?;
                let error = block_error(&run, &frames)?;
                let key = if name.is_empty() {
                    format!("a{rate}")
                } else {
                    (*name).to_owned()
                };
                errors.insert(format!("temperature_linf_{key}"), error);
                errors.insert(format!("of_plane_{key}"), error / plane.max(ROUNDING));
                points = frames.points();
                all.push(run);
            }
        }
        Ok(Measurement::over(all, points, spacing, errors))
    }
}

impl HeatBlock3d {
    /// The error of the plane case with the same patch.
    fn plane(&self, lab: &Lab, label: &str, patch: &Value) -> Result<f64, LabError> {
        let run = lab.run(self.tool(), "heat-exp-t", label, patch)?;
        let frames = Frames::read(&run)?;
        let plate = super::heat_exp_x::plate(&run)?;
        Ok(super::heat_exp_x::steady_error(&plate, &frames))
    }
}

/// The same block turned by 30 degrees about z. A merge patch takes the plain box away.
fn turned() -> Value {
    json!({"body": {"box": null, "turned": {
        "shape": {"box": {"min_m": [0, 0, 0], "max_m": [1, 1, 0.5]}},
        "axis": "z", "angle_deg": 30}}})
}

/// The largest error over the range; along the block's own x where it is turned.
fn block_error(run: &Finished, frames: &Frames) -> Result<f64, LabError> {
    let (shape, angle) = match run.scene.pointer("/body/turned") {
        Some(_) => (
            "/body/turned/shape/box",
            number(run, "/body/turned/angle_deg")?.to_radians(),
        ),
        None => ("/body/box", 0.0),
    };
    let exponential = Exponential::recognise(&conductivity(run, 0)?);
    let plate = Plate {
        conductivity: exponential.map_err(|what| fault(run, what))?,
        faces: [
            number(run, &format!("{shape}/min_m/0"))?,
            number(run, &format!("{shape}/max_m/0"))?,
        ],
        held: held(run)?,
    };
    let range = (plate.held[1] - plate.held[0]).abs();
    let along = |p: &[f64; 3]| p[0] * angle.cos() + p[1] * angle.sin();
    Ok(worst(&frames.position, frames.last(), range, |p| {
        plate.temperature(along(p))
    }))
}
