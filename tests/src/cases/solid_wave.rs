//! `solid-wave`: a bar strikes another one end on.

use artefact::Frame;
use serde_json::json;

use crate::case::{Case, Errors, Measurement, Target};
use crate::lab::{Lab, LabError};
use crate::solid::{changed, fault, frames};

/// The case.
pub(super) struct SolidWave;

impl Case for SolidWave {
    fn name(&self) -> &'static str {
        "solid-wave"
    }

    fn tool(&self) -> &'static str {
        "jetsph"
    }

    fn reference(&self) -> &'static str {
        "d'Alembert: rho c v/2 for 2 L/c; Saint-Venant (1867): restitution 1, or the ratio of the lengths"
    }

    fn methods(&self) -> &'static [&'static str] {
        &["equal", "unequal"]
    }

    fn targets(&self) -> Vec<Target> {
        let each = ["equal", "unequal"].into_iter().flat_map(|method| {
            let of = |what: &str| Target::error(what, 0.03).at_level(2).of(method);
            ["stress", "contact_time", "restitution"].map(of)
        });
        each.collect()
    }

    fn measure(&self, lab: &Lab, level: u32, method: &str) -> Result<Measurement, LabError> {
        let by = f64::from(1 << (level.clamp(1, 4) - 1));
        let patch = changed(lab, self.name(), |solid| {
            let spacing = solid["spacing_m"].as_f64().unwrap_or(f64::NAN);
            solid["spacing_m"] = json!(spacing / by);
            if method == "unequal" && solid["name"] == "striker" {
                // Half as long as the other.
                let end = solid["body"]["box"]["max_m"][0]
                    .as_f64()
                    .unwrap_or(f64::NAN);
                solid["body"]["box"]["min_m"][0] = json!(0.5 * end);
            }
        })?;
        let run = lab.run("jetsph", self.name(), &format!("{method}-{level}"), &patch)?;
        let [striker, target] = [0, 1].map(|k| &run.scene["solids"][k]);
        let number = |value: &serde_json::Value| value.as_f64().unwrap_or(f64::NAN);
        let (density, modulus) = (
            number(&target["density_kg_m3"]),
            number(&target["elastic"]["youngs_modulus_pa"]),
        );
        let side = |solid: &serde_json::Value, end: &str| number(&solid["body"]["box"][end][0]);
        let lengths = [striker, target].map(|s| side(s, "max_m") - side(s, "min_m"));
        let speed = number(&striker["velocity_m_s"][0]);
        let sound = (modulus / density).sqrt();
        // The shorter bar's end sends back what parts them.
        let duration = 2.0 * lengths[0].min(lengths[1]) / sound;
        let (first, second) = (
            frames(&run.artefact, "striker")?,
            frames(&run.artefact, "target")?,
        );
        let (Some(start), Some(a), Some(b)) = (second.first(), first.last(), second.last()) else {
            return Err(fault(&run, "has no frame"));
        };
        let apart = (mean(b, "velocity")? - mean(a, "velocity")?) / speed;
        let restitution = lengths[0].min(lengths[1]) / lengths[0].max(lengths[1]);
        let face = side(target, "min_m");
        let middle = second.iter().find(|frame| frame.time_s >= 0.5 * duration);
        let middle = middle.ok_or_else(|| fault(&run, "ends before the front has passed"))?;
        let stress = -behind(start, middle, face, 0.5 * sound * duration)?;
        // The momentum of the target rises at the rate of the force while they touch.
        let mut course = Vec::new();
        for frame in &second {
            course.push((frame.time_s, mean(frame, "velocity")?));
        }
        let rate = rate(&course, 0.25 * duration, 0.75 * duration)
            .ok_or_else(|| fault(&run, "has too few frames"))?;
        let touched = mean(b, "velocity")? / rate;
        let errors = Errors::from([
            (
                "stress".to_owned(),
                (stress / (0.5 * density * sound * speed) - 1.0).abs(),
            ),
            ("contact_time".to_owned(), (touched / duration - 1.0).abs()),
            ("restitution".to_owned(), (apart - restitution).abs()),
        ]);
        let points = (start.len() + a.len()) as u64;
        let spacing = number(&target["spacing_m"]);
        Ok(Measurement::of(run, points, spacing, errors))
    }
}

/// Mean stress along the bars behind the front, which has gone a way from the face \[Pa\].
fn behind(start: &Frame, middle: &Frame, face: f64, way: f64) -> Result<f64, LabError> {
    let places = start.position_vectors()?;
    let all = places.iter().zip(middle.f64("stress_xx")?);
    let within = all.filter(|(x, _)| (0.2..0.6).contains(&((x[0] - face) / way)));
    let (sum, count) = within.fold((0.0, 0.0), |(sum, count), (_, s)| (sum + s, count + 1.0));
    Ok(sum / count)
}

/// Mean velocity along the bars \[m/s\]; all particles have one mass.
fn mean(frame: &Frame, name: &str) -> Result<f64, LabError> {
    let all = frame.vectors(name)?;
    Ok(all.iter().map(|u| u[0]).sum::<f64>() / all.len() as f64)
}

/// Mean rate of a course between two times.
fn rate(course: &[(f64, f64)], from: f64, to: f64) -> Option<f64> {
    let at = |time: f64| course.iter().find(|(t, _)| *t >= time);
    let ((t, value), (later, next)) = (at(from)?, at(to)?);
    Some((next - value) / (later - t))
}
