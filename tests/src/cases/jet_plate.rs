//! `jet-plate`: a jet of water meets a plate, in the plane at four speeds and in space.

use artefact::{Frame, Reader};
use serde_json::{Value, json};

use crate::case::{Case, Errors, Measurement, Target};
use crate::lab::{Lab, LabError};

/// A method: its name, whether the jet is one in space, its speed \[m/s\] and whether its water has sound.
type Jet = (&'static str, bool, f64, bool);
/// All methods.
const METHODS: [Jet; 8] = [
    ("plane-5", false, 5.0, true),
    ("plane-12", false, 12.0, true),
    ("plane-50", false, 50.0, true),
    ("plane-500", false, 500.0, true),
    ("space-5", true, 5.0, true),
    ("soundless-5", false, 5.0, false),
    ("soundless-50", false, 50.0, false),
    ("soundless-space-5", true, 5.0, false),
];
/// Widths of the jet that the water goes in a run.
const WIDTHS: f64 = 20.0;
/// Frames of a run. The pressure under a jet swings with the sound that it holds, over a twentieth of a run: each swing is met often.
const FRAMES: f64 = 400.0;
/// Bands of the profile, each a fifth of the width, from the axis out.
const BANDS: usize = 8;

/// The case.
pub(super) struct JetPlate;

impl Case for JetPlate {
    fn name(&self) -> &'static str {
        "jet-plate"
    }

    fn tool(&self) -> &'static str {
        "jetsph"
    }

    fn reference(&self) -> &'static str {
        "momentum of the jet, rho A V^2; pressure of a plane free jet on a wall (Milne-Thomson 1968, section 11.42)"
    }

    fn methods(&self) -> &'static [&'static str] {
        &[
            "plane-5",
            "plane-12",
            "plane-50",
            "plane-500",
            "space-5",
            "soundless-5",
            "soundless-50",
            "soundless-space-5",
        ]
    }

    fn levels(&self, method: &str, asked: &[u32]) -> Vec<u32> {
        // A jet in space of 40 particles across takes an hour.
        let most = if method.contains("space") { 2 } else { 3 };
        asked.iter().copied().filter(|l| *l <= most).collect()
    }

    fn targets(&self) -> Vec<Target> {
        let plane = METHODS.iter().filter(|(_, space, ..)| !space);
        let each = plane.flat_map(|(method, ..)| {
            [
                ("force", 0.02),
                ("stagnation_pressure", 0.05),
                ("profile", 0.08),
            ]
            .map(|(what, most)| Target::error(what, most).at_level(2).of(*method))
        });
        let space = METHODS.iter().filter(|(_, space, ..)| *space);
        each.chain(space.map(|(method, ..)| Target::error("force", 0.02).at_level(2).of(*method)))
            .collect()
    }

    fn measure(&self, lab: &Lab, level: u32, method: &str) -> Result<Measurement, LabError> {
        let chosen = METHODS.iter().find(|(name, ..)| *name == method);
        let (_, space, speed, has_sound) = *chosen.unwrap_or(&METHODS[0]);
        // 10, 20 and 40 particles across.
        let spacing = 1e-3 / f64::from(1 << (level.clamp(1, 4) - 1));
        let width = 0.01;
        let end = WIDTHS * width / speed;
        let mut patch = json!({
            "time": {"end_s": end},
            "water": {"spacing_m": spacing},
            "output": {"frames_interval_s": end / FRAMES, "balance_interval_s": end / 600.0}
        });
        if !has_sound {
            soundless(&mut patch);
        }
        if space {
            in_space(&mut patch);
        }
        let (exit, down) = if space {
            (json!([0, 0, 0.03]), json!([0, 0, -1]))
        } else {
            (json!([0, 0.03]), json!([0, -1]))
        };
        patch["water"]["nozzles"] = json!([{"name": "jet", "exit_m": exit, "direction": down, "width_m": width, "speed_m_s": speed}]);
        let run = lab.run("jetsph", self.name(), &format!("{method}-{level}"), &patch)?;
        let reader = Reader::open_kind(&run.artefact, "jet-frames", 1)?;
        let density = run.scene["water"]["density_kg_m3"]
            .as_f64()
            .unwrap_or(f64::NAN);
        let head = density * speed * speed;
        let area = if space {
            0.25 * std::f64::consts::PI * width * width
        } else {
            width
        };
        let force = -force(&reader, if space { 'z' } else { 'y' }, end)?;
        let mut errors = Errors::from([("force".to_owned(), (force / (head * area) - 1.0).abs())]);
        let mut points = 0;
        let mut seen = Vec::new();
        for frame in reader.frames("/water")? {
            let frame = frame?;
            points = points.max(frame.len() as u64);
            if frame.time_s > 0.5 * end {
                seen.push(frame);
            }
        }
        let stagnation = mean_pressure(&seen, space, 0.0, 0.1 * width, 1.5 * spacing)?;
        errors.insert(
            "stagnation_pressure".to_owned(),
            (stagnation / (0.5 * head) - 1.0).abs(),
        );
        if !space {
            let mut worst = 0.0_f64;
            for band in 0..BANDS {
                let [low, high] = [band, band + 1].map(|b| 0.2 * width * b as f64);
                let found = mean_pressure(&seen, false, low, high, 1.5 * spacing)?;
                let exact = free_jet(0.5 * (low + high) / width);
                worst = worst.max((found / (0.5 * head) - exact).abs());
            }
            errors.insert("profile".to_owned(), worst);
        }
        Ok(Measurement::of(run, points, spacing, errors))
    }
}

/// Takes the sound out of the water, and what belongs to it.
pub(super) fn soundless(patch: &mut Value) {
    patch["water"]["method"] = json!("divergence_free");
    patch["water"]["artificial_viscosity"] = Value::Null;
    patch["water"]["density_diffusion"] = Value::Null;
}

/// Makes the jet one in space.
fn in_space(patch: &mut Value) {
    patch["dimensions"] = json!(3);
    patch["water"]["outlets"] = json!([{"name": "around", "beyond": {"cylinder": {
        "centre_m": [0, 0, 0], "radius_m": 0.025, "length_m": 1}}}]);
    patch["walls"] = json!([{"name": "plate", "body": {"half_space": {"point_m": [0, 0, 0], "normal": [0, 0, 1]}}}]);
}

/// Mean force on the plate in the second half of the run, by what it was given \[N\].
fn force(reader: &Reader, axis: char, end: f64) -> Result<f64, LabError> {
    let name = format!("water_impulse_on_plate_{axis}");
    let mut course = Vec::new();
    for (time, record) in reader.records("/balance")? {
        if time >= 0.5 * end {
            course.push((time, record.get(&name)?));
        }
    }
    let ends = course.first().zip(course.last());
    Ok(ends.map_or(f64::NAN, |((from, before), (to, after))| {
        (after - before) / (to - from)
    }))
}

/// Mean pressure of water at a distance from the axis, below a height \[Pa\].
fn mean_pressure(
    frames: &[Frame],
    space: bool,
    low: f64,
    high: f64,
    height: f64,
) -> Result<f64, LabError> {
    let (mut sum, mut count) = (0.0, 0.0);
    for frame in frames {
        for ([x, y, z], pressure) in frame.position_vectors()?.iter().zip(frame.f64("pressure")?) {
            let (along, up) = if space {
                (x.hypot(*y), *z)
            } else {
                (x.abs(), *y)
            };
            if along >= low && along < high && up < height {
                sum += pressure;
                count += 1.0;
            }
        }
    }
    Ok(sum / count)
}

/// p/(rho V^2/2) under a plane jet at a distance from its axis, in widths: with the speed q along the wall over V,
/// `x = (2 arctan q + ln((1 + q)/(1 - q)))/pi`.
pub(super) fn free_jet(x: f64) -> f64 {
    let place = |q: f64| (2.0 * q.atan() + ((1.0 + q) / (1.0 - q)).ln()) / std::f64::consts::PI;
    let (mut low, mut high) = (0.0, 1.0 - 1e-15);
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        if place(middle) < x {
            low = middle;
        } else {
            high = middle;
        }
    }
    1.0 - low * low
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_pressure_of_a_jet_carries_its_momentum() {
        let n = 20_000;
        let step = 8.0 / f64::from(n);
        let force: f64 = (0..n)
            .map(|i| step * free_jet((f64::from(i) + 0.5) * step))
            .sum();
        assert!((force - 1.0).abs() < 1e-6, "{force}");
    }
}
