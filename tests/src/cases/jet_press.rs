//! `jet-press`: a jet that rises slowly presses on a half plane that does not break.

use std::f64::consts::PI;

use artefact::Reader;
use serde_json::json;

use super::jet_plate::{free_jet, soundless};
use crate::case::{Case, Errors, Measurement, Target};
use crate::lab::{Lab, LabError};
use crate::solid::{changed, fault, frames};

/// Width of the jet \[m\].
const WIDTH: f64 = 0.01;
/// Its speed \[m/s\], where water without sound has none to refer to.
const SPEED: f64 = 5.0;
/// Depths at which strains are compared, in widths: bands of a fifth.
const DEPTHS: usize = 10;
/// The strains are means from this part of the run on.
const FROM: f64 = 0.75;

/// The case.
pub(super) struct JetPress;

impl Case for JetPress {
    fn name(&self) -> &'static str {
        "jet-press"
    }

    fn tool(&self) -> &'static str {
        "jetsph"
    }

    fn reference(&self) -> &'static str {
        "half plane (Flamant 1892, Johnson 1985, section 2.5) under the pressure of a plane free jet (Milne-Thomson 1968)"
    }

    fn methods(&self) -> &'static [&'static str] {
        &["default", "soundless"]
    }

    fn targets(&self) -> Vec<Target> {
        vec![
            Target::error("strain", 0.1).at_level(2),
            Target::error("strain", 0.1).at_level(3),
            Target::error("strain", 0.1).at_level(2).of("soundless"),
            Target::error("strain", 0.1).at_level(3).of("soundless"),
        ]
    }

    fn measure(&self, lab: &Lab, level: u32, method: &str) -> Result<Measurement, LabError> {
        // Solid of 4, 2 and 1 mm, water of half of it.
        let spacing = 0.004 / f64::from(1 << (level.clamp(1, 4) - 1));
        let mut patch = changed(lab, self.name(), |solid| {
            solid["spacing_m"] = json!(spacing)
        })?;
        patch["water"] = json!({"spacing_m": 0.5 * spacing});
        let mut label = format!("level{level}");
        if method == "soundless" {
            soundless(&mut patch);
            patch["water"]["reference_speed_m_s"] = json!(null);
            label = format!("soundless-{level}");
        }
        let run = lab.run("jetsph", self.name(), &label, &patch)?;
        let (solid, water) = (&run.scene["solids"][0], &run.scene["water"]);
        let number = |value: &serde_json::Value| value.as_f64().unwrap_or(f64::NAN);
        let speed = water["reference_speed_m_s"].as_f64().unwrap_or(SPEED);
        let head = 0.5 * number(&water["density_kg_m3"]) * speed * speed;
        let (modulus, ratio) = (
            number(&solid["elastic"]["youngs_modulus_pa"]),
            number(&solid["elastic"]["poisson_ratio"]),
        );
        let end = number(&run.scene["time"]["end_s"]);
        let all = frames(&run.artefact, "ground")?;
        let start = all.first().ok_or_else(|| fault(&run, "has no frame"))?;
        let mut sums = [(0.0, 0.0); DEPTHS];
        let rest = start.position_vectors()?;
        for frame in all.iter().filter(|frame| frame.time_s >= FROM * end) {
            for (x, strain) in rest.iter().zip(frame.f64("equivalent_strain")?) {
                let band = (-x[1] / (0.2 * WIDTH)) as usize;
                if x[0].abs() < 0.15 * WIDTH.max(4.0 * spacing) && band < DEPTHS {
                    sums[band].0 += strain;
                    sums[band].1 += 1.0;
                }
            }
        }
        // Each band at the mean depth of its particles.
        let (mut worst, mut most, mut greatest) = (0.0_f64, 0.0_f64, 0.0_f64);
        for (band, (sum, count)) in sums.iter().enumerate().filter(|(_, s)| s.1 > 0.0) {
            let inside = |x: &&[f64; 3]| (-x[1] / (0.2 * WIDTH)) as usize == band;
            let depths: Vec<f64> = rest.iter().filter(inside).map(|x| -x[1]).collect();
            let depth = depths.iter().sum::<f64>() / depths.len() as f64;
            let exact = head * mises(depth / WIDTH, ratio) * (1.0 + ratio) / (1.5 * modulus);
            worst = worst.max((sum / count - exact).abs());
            (most, greatest) = (most.max(exact), greatest.max(sum / count));
        }
        let errors = Errors::from([
            ("strain".to_owned(), (greatest / most - 1.0).abs()),
            ("profile".to_owned(), worst / most),
        ]);
        let reader = Reader::open_kind(&run.artefact, "jet-frames", 1)?;
        let drops = reader.frames("/water")?.last();
        let drops = drops.transpose()?.map_or(0, |frame| frame.len());
        Ok(Measurement::of(
            run,
            (rest.len() + drops) as u64,
            spacing,
            errors,
        ))
    }
}

/// Equivalent stress on the axis at a depth in widths, over the pressure of stagnation, in plane strain: the pressures
/// p(s) of the jet put
///
/// ```text
/// s_z = -2 z^3/pi int p/(s^2 + z^2)^2 ds,   s_x = -2 z/pi int p s^2/(s^2 + z^2)^2 ds,   s_y = nu (s_x + s_z)
/// ```
fn mises(depth: f64, ratio: f64) -> f64 {
    let (steps, reach) = (20_000, 4.0);
    let step = reach / f64::from(steps);
    let (mut along, mut across) = (0.0, 0.0);
    for i in 0..steps {
        let s = (f64::from(i) + 0.5) * step;
        // Both sides of the axis.
        let part = 2.0 * step * free_jet(s) / (s * s + depth * depth).powi(2);
        along -= 2.0 * depth.powi(3) / PI * part;
        across -= 2.0 * depth / PI * part * s * s;
    }
    let other = ratio * (along + across);
    let square = |a: f64, b: f64| (a - b) * (a - b);
    (0.5 * (square(along, across) + square(across, other) + square(other, along))).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn near_the_face_all_of_the_pressure_is_borne_and_far_below_the_force() {
        // At the face s_x = s_z = -p.
        assert!(
            (mises(0.02, 0.0) - 1.0).abs() < 0.06,
            "{}",
            mises(0.02, 0.0)
        );
        // A line load of twice the pressure of stagnation: s_z = -2 P/(pi z).
        let far = 2.0 * 2.0 / (PI * 60.0);
        assert!((mises(60.0, 0.0) / far - 1.0).abs() < 0.01);
    }
}
