//! `saw-float`: a grain floats on metal as deep as Archimedes says, and a layer of grains lies on it and does not mix with it.

use std::f64::consts::PI;
use std::path::Path;

use artefact::Reader;
use serde_json::{Value, json};

use crate::case::{Case, Errors, Measurement, Target};
use crate::grains::{fault, frames};
use crate::lab::{Finished, Lab, LabError, read_json};
use crate::norms::Worst;
use crate::particles::number;

/// The case.
pub(super) struct SawFloat;

/// Spacings over that of the scene, by level.
const SPACINGS: [f64; 3] = [1.0, 5.0 / 6.0, 2.0 / 3.0];
/// The depth is the mean from this part of the run on.
const FROM: f64 = 0.6;
/// Sides and depth of the tank under a layer, in spacings.
const TANK: f64 = 6.0;
const DEEP: f64 = 4.0;
/// The layer is looked at from here on \[s\], and at the end.
const SETTLED: f64 = 1.0;
const END: f64 = 5.0;

impl Case for SawFloat {
    fn name(&self) -> &'static str {
        "saw-float"
    }

    fn tool(&self) -> &'static str {
        "poolsph"
    }

    fn reference(&self) -> &'static str {
        "Archimedes: the metal in the place of the cap below the level weighs as much as the grain; what is lighter stays on top"
    }

    fn targets(&self) -> Vec<Target> {
        vec![
            Target::error("draught", 0.02),
            Target::error("layer_sunk", 0.0),
            Target::error("layer_drift", 0.1),
            Target::error("layer_tilt", 0.5),
        ]
    }

    fn levels(&self, _: &str, asked: &[u32]) -> Vec<u32> {
        asked.iter().copied().filter(|level| *level <= 3).collect()
    }

    fn measure(&self, lab: &Lab, level: u32, _: &str) -> Result<Measurement, LabError> {
        let finer = SPACINGS[level.clamp(1, 3) as usize - 1];
        let scene = Path::new("pipelines/verify").join(self.name());
        let scene = read_json(&lab.root.join(scene).join("scene.json"))?;
        let spacing = finer * scene["spacing_m"].as_f64().unwrap_or(0.0);
        let mut bodies = scene["bodies"].clone();
        bodies[0]["shape"]["container"]["thickness_m"] = json!(2.0 * spacing);
        let grain = json!({"spacing_m": spacing, "bodies": bodies});
        let run = lab.run("poolsph", self.name(), &format!("level{level}"), &grain)?;
        let (found, points) = draught(&run)?;
        let exact = exact(number(&run, "/grains/density_kg_m3")? / number(&run, "/density_kg_m3")?);
        let layer = layer(spacing);
        let lain = lab.run("poolsph", self.name(), &format!("layer{level}"), &layer)?;
        let [sunk, drift, tilt] = lies(&lain)?;
        let errors = Errors::from([
            ("draught".to_owned(), (found / exact - 1.0).abs()),
            ("layer_sunk".to_owned(), sunk),
            ("layer_drift".to_owned(), drift),
            ("layer_tilt".to_owned(), tilt),
        ]);
        let measured = Measurement::over(vec![run, lain], points, spacing, errors);
        Ok(measured.at_costs([("depth_over_diameter", found)]))
    }
}

/// Depth over diameter of a ball that is `ratio` times as heavy as what it floats on: `3 f^2 - 2 f^3 = ratio`.
fn exact(ratio: f64) -> f64 {
    let (mut low, mut high) = (0.0_f64, 1.0_f64);
    for _ in 0..60 {
        let f = 0.5 * (low + high);
        if 3.0 * f * f - 2.0 * f * f * f < ratio {
            low = f;
        } else {
            high = f;
        }
    }
    low
}

/// Metal without walls, frame by frame.
fn metal(run: &Finished) -> Result<Vec<Vec<[f64; 3]>>, LabError> {
    let reader = Reader::open_kind(&run.artefact, "particle-frames", 1)?;
    let mut found = Vec::new();
    for frame in reader.frames("/particles")? {
        let frame = frame?;
        let places = frame.position_vectors()?;
        let walls = frame.u8("wall")?;
        let own = places.into_iter().zip(walls);
        found.push(
            own.filter(|(_, wall)| **wall == 0)
                .map(|(x, _)| x)
                .collect(),
        );
    }
    Ok(found)
}

/// Depth over diameter at which the grain floats, and the particles of metal.
fn draught(run: &Finished) -> Result<(f64, u64), LabError> {
    let at = |key: &str| number(run, key);
    let radius = at("/grains/bodies/0/radius_m")?;
    let d = at("/spacing_m")?;
    let box_ = "/bodies/0/shape/container";
    let side = |k: usize| {
        Ok::<f64, LabError>(at(&format!("{box_}/max_m/{k}"))? - at(&format!("{box_}/min_m/{k}"))?)
    };
    let area = side(0)? * side(1)?;
    let bottom = at(&format!("{box_}/min_m/2"))?;
    let (grains, metal) = (frames(&run.artefact)?, metal(run)?);
    let from = (FROM * grains.len() as f64) as usize;
    let (mut sum, mut count, mut points) = (0.0, 0.0, 0);
    for (grain, metal) in grains.iter().zip(&metal).skip(from) {
        let low = grain.position_vectors()?[0][2] - radius;
        points = metal.len() as u64;
        let own = metal.len() as f64 * d.powi(3);
        // The level rises with the cap, which hangs on the level.
        let mut level = bottom + own / area;
        for _ in 0..100 {
            let h = (level - low).clamp(0.0, 2.0 * radius);
            level = bottom + (own + PI * h * h * (radius - h / 3.0)) / area;
        }
        sum += (level - low) / (2.0 * radius);
        count += 1.0;
    }
    if count < 1.0 {
        return Err(fault(run, "has no frames of grain and metal"));
    }
    Ok((sum / count, points))
}

/// Two layers of grains of one spacing \[m\] on metal.
fn layer(d: f64) -> Value {
    let half = 0.5 * TANK * d;
    let tank = json!({"min_m": [-half, -half, 0], "max_m": [half, half, (DEEP + 4.0) * d],
        "thickness_m": 2.0 * d, "open": ["z+"]});
    let aside = half - 0.1 * d;
    json!({
        "spacing_m": d, "time": {"end_s": END},
        "bodies": [
            {"shape": {"container": tank}, "state": "wall"},
            {"shape": {"box": {"min_m": [-half, -half, 0], "max_m": [half, half, DEEP * d]}}, "state": "liquid"}
        ],
        "grains": {
            "contact": {"friction": 0.3},
            "bodies": [{"shape": {"box": {"min_m": [-aside, -aside, (DEEP + 0.1) * d], "max_m": [aside, aside, (DEEP + 2.3) * d]}},
                "radius_m": 0.5 * d, "spacing_m": 1.05 * d, "jitter": 0.02}],
            "walls": [{"shape": {"box": {"min_m": [-half, -half, 0], "max_m": [half, half, 50.0 * d]}}, "hollow": true}]
        },
        "output": {"particles_interval_s": 0.5}
    })
}

/// Share of grains whose middle is deeper than a spacing below the level of the metal, ever; how far the mean height goes after the layer has
/// settled, and the most that the quarters of the tank differ, over a spacing.
fn lies(run: &Finished) -> Result<[f64; 3], LabError> {
    let d = number(run, "/spacing_m")?;
    let (grains, metal) = (frames(&run.artefact)?, metal(run)?);
    let level = metal
        .first()
        .map_or(0.0, |metal| metal.len() as f64 * d / (TANK * TANK));
    let (mut sunk, mut tilts) = (0.0_f64, Vec::new());
    let mut heights = Vec::new();
    for frame in grains.iter().filter(|frame| frame.time_s >= SETTLED - 1e-9) {
        let places = frame.position_vectors()?;
        let count = places.len() as f64;
        let deep = places.iter().filter(|x| x[2] < level - d).count() as f64;
        sunk = sunk.max(deep / count);
        let mut quarters = [(0.0, 0.0); 4];
        for x in &places {
            let own = &mut quarters[usize::from(x[0] > 0.0) + 2 * usize::from(x[1] > 0.0)];
            *own = (own.0 + x[2], own.1 + 1.0);
        }
        let means = quarters.map(|(sum, count)| sum / count);
        let [low, high] = [
            means.into_iter().fold(f64::INFINITY, f64::min),
            means.into_iter().worst(),
        ];
        tilts.push((high - low) / d);
        heights.push(places.iter().map(|x| x[2]).sum::<f64>() / count);
    }
    let (Some(first), Some(last)) = (heights.first(), heights.last()) else {
        return Err(fault(run, "has no frames of the layer at rest"));
    };
    Ok([sunk, (last - first).abs() / d, tilts.into_iter().worst()])
}

#[cfg(test)]
mod tests {
    use super::exact;

    #[test]
    fn half_as_heavy_is_half_as_deep() {
        assert!((exact(0.5) - 0.5).abs() < 1e-12);
        assert!((exact(0.417) - 0.4444).abs() < 1e-4);
    }
}
