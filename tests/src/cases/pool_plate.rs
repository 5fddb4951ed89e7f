//! `pool-plate`: heat along a thin plate whose faces have no names.
//!
//! ```text
//! T = T_m + A sin(pi s/L) exp(-alpha (pi/L)^2 t)
//! ```

use std::f64::consts::PI;

use serde_json::json;

use crate::case::{Case, Errors, Measurement, Target};
use crate::lab::{Finished, Lab, LabError};
use crate::particles::{Frames, measurement, number};

/// Length of the plate \[m\], half of its width and of its thickness.
const LENGTH: f64 = 0.032;
const HALF: [f64; 2] = [0.006, 0.002];
/// Mean temperature and amplitude \[K\].
const MEAN: f64 = 500.0;
const AMPLITUDE: f64 = 100.0;
/// Flat, as a bar whose sides hold as many layers although one is longer, and turned so that faces are staircases.
const METHODS: &[&str] = &["flat", "unlike", "one-to-one", "one-to-two"];
/// Longer side of the bar `unlike` over the shorter one.
const UNLIKE: f64 = 1.03;

/// The case.
pub(super) struct PoolPlate;

impl Case for PoolPlate {
    fn name(&self) -> &'static str {
        "pool-plate"
    }

    fn tool(&self) -> &'static str {
        "poolsph"
    }

    fn reference(&self) -> &'static str {
        "exact decay of a cosine (Carslaw and Jaeger 1959, section 3.3)"
    }

    fn methods(&self) -> &'static [&'static str] {
        METHODS
    }

    fn targets(&self) -> Vec<Target> {
        vec![
            Target::error("conductivity", 0.01).at_level(1),
            Target::error("conductivity", 0.005),
            Target::error("conductivity", 0.03).of("one-to-one"),
            Target::error("conductivity", 0.03).of("one-to-two"),
        ]
    }

    fn measure(&self, lab: &Lab, level: u32, method: &str) -> Result<Measurement, LabError> {
        let layers = [4.0, 6.0, 8.0, 10.0][level.clamp(1, 4) as usize - 1];
        let spacing = 2.0 * HALF[1] / layers;
        let slope: f64 = match method {
            "one-to-one" => 1.0,
            "one-to-two" => 0.5,
            _ => 0.0,
        };
        let angle = slope.atan();
        // Turned about y, so that what lay along x lies along (cos, 0, -sin).
        let way = [angle.cos(), -angle.sin()];
        let [wide, thick] = match method {
            "unlike" => [HALF[1], UNLIKE * HALF[1]],
            _ => HALF,
        };
        let long = 0.5 * LENGTH;
        let plate = json!({"box": {"min_m": [-long, -wide, -thick], "max_m": [long, wide, thick]}});
        let shape = match angle > 0.0 {
            true => {
                json!({"turned": {"axis": "y", "angle_deg": angle.to_degrees(), "shape": plate}})
            }
            false => plate,
        };
        let start = format!(
            "{MEAN} + {AMPLITUDE}*sin(pi*({}*x + {}*z)/{LENGTH})",
            way[0], way[1]
        );
        let patch = json!({
            "spacing_m": spacing,
            "bodies": [{"shape": shape, "state": "solid", "temperature_k": {"expr": start}}],
        });
        let run = lab.run(
            "poolsph",
            self.name(),
            &format!("{method}-level{level}"),
            &patch,
        )?;
        let frames = Frames::read(&run.artefact, "temperature")?;
        let errors = errors(&run, &frames, way)?;
        measurement(run, frames.scalar[0].len(), errors)
    }
}

/// How far the conductivity that the decay tells is off, and the temperatures at the end.
fn errors(run: &Finished, frames: &Frames, way: [f64; 2]) -> Result<Errors, LabError> {
    let capacity = number(run, "/density_kg_m3")? * number(run, "/heat/specific_heat_j_kg_k")?;
    let alpha = number(run, "/heat/thermal_conductivity_w_m_k")? / capacity;
    let last = frames.time.len() - 1;
    let mode = |place: &[f64; 3]| (PI * (way[0] * place[0] + way[1] * place[2]) / LENGTH).sin();
    let amplitude = |frame: usize| {
        let each = frames.position[frame].iter().zip(&frames.scalar[frame]);
        let (sum, square) = each.fold((0.0, 0.0), |(sum, square), (place, t)| {
            let own = mode(place);
            (sum + own * (t - MEAN), square + own * own)
        });
        sum / square
    };
    let decay = alpha * (PI / LENGTH).powi(2) * (frames.time[last] - frames.time[0]);
    let told = (amplitude(0) / amplitude(last)).ln();
    let left = AMPLITUDE * (-decay).exp();
    let each = frames.position[last].iter().zip(&frames.scalar[last]);
    let off = each.map(|(place, t)| ((t - MEAN) / left - mode(place)).powi(2));
    let l2 = (off.sum::<f64>() / frames.scalar[last].len() as f64).sqrt();
    Ok(Errors::from([
        ("conductivity".to_owned(), (told / decay - 1.0).abs()),
        ("temperature_l2".to_owned(), l2),
    ]))
}
