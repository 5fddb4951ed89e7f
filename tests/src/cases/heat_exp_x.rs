//! `heat-exp-x`: a plate whose conductivity grows along x, steady.

use serde_json::json;

use crate::case::{Case, Errors, Measurement, Target};
use crate::heat::frames::{Frames, greater, worst};
use crate::heat::methods::{self, STEADY, over};
use crate::heat::plate::Plate;
use crate::heat::property::{Exponential, conductivity, fault, number};
use crate::lab::{Finished, Lab, LabError};

/// B of the paper's three curves \[1/m\].
const RATES: [f64; 3] = [-0.2, 0.5, 1.0];

/// The case.
pub(super) struct HeatExpX;

impl Case for HeatExpX {
    fn name(&self) -> &'static str {
        "heat-exp-x"
    }

    fn tool(&self) -> &'static str {
        "heatsph"
    }

    fn reference(&self) -> &'static str {
        "Closed form, Rong and Kisu (2010), eq. 6 with + T1"
    }

    fn methods(&self) -> &'static [&'static str] {
        STEADY
    }

    fn targets(&self) -> Vec<Target> {
        let targets = vec![
            Target::error("temperature_linf", 1e-4).at_level(2),
            Target::order("temperature_linf", 1.8).or_error_below(1e-9),
        ];
        methods::also_jittered(targets, STEADY)
    }

    fn measure(&self, lab: &Lab, level: u32, method: &str) -> Result<Measurement, LabError> {
        let spacing = square_spacing(level);
        let mut all = Vec::new();
        let mut errors = Errors::new();
        let mut points = 0;
        for rate in RATES {
            let material = json!({"name": "plate", "density_kg_m3": 1, "specific_heat_j_kg_k": 1,
                "conductivity_w_m_k": {"expr": format!("1*exp({rate}*x)")}});
            let patch = over(
                json!({"points": {"spacing_m": spacing}, "materials": [material]}),
                &methods::patch(method),
            );
            let label = format!("level{level}-{method}-b{rate}");
            let run = lab.run(self.tool(), self.name(), &label, &patch)?;
            let frames = Frames::read(&run)?;
            let plate = plate(&run)?;
            let found = steady_error(&plate, &frames);
            errors.insert(format!("temperature_linf_b{rate}"), found);
            let worst = errors.entry("temperature_linf".to_owned()).or_insert(0.0);
            *worst = greater(*worst, found);
            points = frames.points();
            all.push(run);
        }
        Ok(Measurement::over(all, points, spacing, errors))
    }
}

/// 21, 41, 81 points across a metre.
pub(super) fn square_spacing(level: u32) -> f64 {
    0.05 / f64::from(1 << (level.clamp(1, 6) - 1))
}

/// The plate of a scene: its box along x, held at its first two boundaries, x- and x+.
pub(super) fn plate(run: &Finished) -> Result<Plate, LabError> {
    let conductivity = Exponential::recognise(&conductivity(run, 0)?);
    Ok(Plate {
        conductivity: conductivity.map_err(|what| fault(run, what))?,
        faces: [
            number(run, "/body/box/min_m/0")?,
            number(run, "/body/box/max_m/0")?,
        ],
        held: held(run)?,
    })
}

/// The temperatures of the first two boundaries, which must be x- and x+ \[K\].
pub(super) fn held(run: &Finished) -> Result<[f64; 2], LabError> {
    for (i, face) in ["x-", "x+"].iter().enumerate() {
        let on = run.scene.pointer(&format!("/boundaries/{i}/on/0"));
        if on.and_then(serde_json::Value::as_str) != Some(face) {
            return Err(fault(run, format!("boundary {i} must be that on {face}")));
        }
    }
    Ok([
        number(run, "/boundaries/0/temperature_k")?,
        number(run, "/boundaries/1/temperature_k")?,
    ])
}

/// Largest error of the last frame over the difference of the held temperatures.
pub(super) fn steady_error(plate: &Plate, frames: &Frames) -> f64 {
    let range = (plate.held[1] - plate.held[0]).abs();
    worst(&frames.position, frames.last(), range, |p| {
        plate.temperature(p[0])
    })
}
