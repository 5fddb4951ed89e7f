//! `dem-silo`: a silo runs out through a hole in its flat bottom as Beverloo, Leniger and van de Velde (1961) say.

use std::f64::consts::PI;
use std::path::Path;

use serde_json::{Value, json};

use crate::case::{Case, Errors, Measurement, Target};
use crate::grains::{fault, frames};
use crate::lab::{Finished, Lab, LabError, read_json};
use crate::particles::number;

/// The case.
pub(super) struct DemSilo;

/// Holes over the diameter of a grain, at the first level.
const HOLES: [f64; 3] = [6.0, 7.5, 9.0];
/// Silos and holes over those of the first level.
const WIDER: [f64; 3] = [1.0, 1.3, 1.6];
/// What is known of C and k.
const C: [f64; 2] = [0.55, 0.65];
const K: [f64; 2] = [1.2, 1.6];
/// Parts of the grains that have run out while the flow is measured: after it has begun, and before the surface comes down to the hole.
const BETWEEN: [f64; 2] = [0.08, 0.3];

impl Case for DemSilo {
    fn name(&self) -> &'static str {
        "dem-silo"
    }

    fn tool(&self) -> &'static str {
        "poolsph"
    }

    fn reference(&self) -> &'static str {
        "Beverloo, Leniger and van de Velde (1961): W = C rho_b sqrt(g) (D - k d)^(5/2)"
    }

    fn targets(&self) -> Vec<Target> {
        vec![
            Target::error("exponent", 0.15),
            Target::error("c_beyond_band", 0.0),
            Target::error("k_beyond_band", 0.0),
        ]
    }

    fn levels(&self, _: &str, asked: &[u32]) -> Vec<u32> {
        asked.iter().copied().filter(|level| *level <= 3).collect()
    }

    fn measure(&self, lab: &Lab, level: u32, _: &str) -> Result<Measurement, LabError> {
        let wider = WIDER[level.clamp(1, 3) as usize - 1];
        let scene = Path::new("pipelines/verify").join(self.name());
        let scene = read_json(&lab.root.join(scene).join("scene.json"))?;
        let mut runs = Vec::new();
        let mut found = Vec::new();
        for (k, hole) in HOLES.into_iter().enumerate() {
            let patch = patch(&scene, wider, hole);
            let run = lab.run("poolsph", self.name(), &format!("level{level}-{k}"), &patch)?;
            found.push(Outflow::of(&run)?);
            runs.push(run);
        }
        let d = found[0].diameter;
        // ln W over ln(D - 1.4 d), and W^(2/5) = a (D - k d).
        let middle = 0.5 * (K[0] + K[1]);
        let logs = found
            .iter()
            .map(|o| ((o.hole - middle * d).ln(), o.flow.ln()));
        let [exponent, _] = line(&logs.collect::<Vec<_>>());
        let roots = found.iter().map(|o| (o.hole, o.flow.powf(0.4)));
        let [slope, at_zero] = line(&roots.collect::<Vec<_>>());
        let k = -at_zero / (slope * d);
        let beyond = |value: f64, [low, high]: [f64; 2]| (low - value).max(value - high).max(0.0);
        // C hangs on k more than three holes tell of both: it is that of the middle k.
        let c = found.iter().map(|o| o.coefficient(middle)).sum::<f64>() / found.len() as f64;
        let errors = Errors::from([
            ("exponent".to_owned(), (exponent - 2.5).abs()),
            ("c_beyond_band".to_owned(), beyond(c, C)),
            ("k_beyond_band".to_owned(), beyond(k, K)),
        ]);
        let grains = found[0].grains;
        let measured = Measurement::over(runs, grains, d, errors);
        Ok(measured.at_costs([("c", c), ("k", k)]))
    }
}

/// A silo `wider` than the scene's with a hole of `hole` diameters on its first level, for as long as it takes.
fn patch(scene: &Value, wider: f64, hole: f64) -> Value {
    let grains = &scene["grains"];
    let of = |value: &Value| value.as_f64().unwrap_or(0.0);
    let (mut body, mut walls) = (grains["bodies"][0].clone(), grains["walls"].clone());
    let d = 2.0 * of(&body["radius_m"]);
    let own = &mut body["shape"]["cylinder"];
    let [radius, length] = ["radius_m", "length_m"].map(|key| wider * of(&own[key]));
    let low = of(&own["centre_m"][2]) - 0.5 * of(&own["length_m"]);
    own["centre_m"][2] = json!(low + 0.5 * length);
    (own["radius_m"], own["length_m"]) = (json!(radius), json!(length));
    walls[0]["shape"]["cylinder"]["radius_m"] = json!(radius);
    walls[1]["shape"]["difference"][1]["cylinder"]["radius_m"] = json!(0.5 * wider * hole * d);
    // As long as Beverloo says for the part that is to run out, and the fall ahead of it.
    let spacing = of(&body["spacing_m"]);
    let matter = of(&grains["density_kg_m3"]) * PI / 6.0
        * (d / spacing).powi(3)
        * PI
        * radius
        * radius
        * length;
    let g = -of(&grains["gravity_m_s2"][2]);
    let bulk = 0.6 * of(&grains["density_kg_m3"]);
    let flow = 0.5
        * (C[0] + C[1])
        * bulk
        * g.sqrt()
        * (wider * hole * d - 0.5 * (K[0] + K[1]) * d).powf(2.5);
    let end = 1.2 * BETWEEN[1] * matter / flow + (2.0 * length / g).sqrt();
    json!({"grains": {"bodies": [body], "walls": walls}, "time": {"end_s": end}})
}

/// How a silo runs out.
struct Outflow {
    /// D \[m\].
    hole: f64,
    /// d \[m\].
    diameter: f64,
    /// g \[m/s2\].
    gravity: f64,
    /// W \[kg/s\].
    flow: f64,
    /// rho_b \[kg/m3\].
    bulk: f64,
    grains: u64,
}

impl Outflow {
    fn of(run: &Finished) -> Result<Self, LabError> {
        let at = |key: &str| number(run, &format!("/grains/{key}"));
        let reader = artefact::Reader::open_kind(&run.artefact, "particle-frames", 1)?;
        let mut left = Vec::new();
        for (time, record) in reader.records("/grains_balance")? {
            left.push((time, record.get("mass_kg")?));
        }
        let first = left.first().map_or(0.0, |(_, mass)| *mass);
        let ran = |mass: f64| (first - mass) / first;
        let [begin, end] = BETWEEN;
        let measured = left
            .iter()
            .filter(|(_, mass)| (begin..=end).contains(&ran(*mass)));
        let measured: Vec<(f64, f64)> = measured.copied().collect();
        let reached = left.last().is_some_and(|(_, mass)| ran(*mass) > end);
        if measured.len() < 8 || !reached {
            return Err(fault(
                run,
                "the silo does not run out as far as the flow is measured",
            ));
        }
        let [slope, _] = line(&measured);
        let diameter = 2.0 * at("bodies/0/radius_m")?;
        let radius = at("walls/0/shape/cylinder/radius_m")?;
        Ok(Self {
            hole: 2.0 * at("walls/1/shape/difference/1/cylinder/radius_m")?,
            diameter,
            gravity: -at("gravity_m_s2/2")?,
            flow: -slope,
            bulk: bulk(run, radius, diameter, measured[0].0)?,
            grains: frames(&run.artefact)?
                .first()
                .map_or(0, artefact::Frame::len) as u64,
        })
    }

    /// C at a k.
    fn coefficient(&self, k: f64) -> f64 {
        let open = self.hole - k * self.diameter;
        self.flow / (self.bulk * self.gravity.sqrt() * open.powf(2.5))
    }
}

/// Mass over volume of what lies in the middle of the height at the first frame after `time` \[s\].
fn bulk(run: &Finished, radius: f64, diameter: f64, time: f64) -> Result<f64, LabError> {
    let frames = frames(&run.artefact)?;
    let frame = frames.iter().find(|frame| frame.time_s >= time);
    let frame = frame.ok_or_else(|| fault(run, "has no frame of the flow"))?;
    let mut heights: Vec<f64> = frame.position_vectors()?.iter().map(|x| x[2]).collect();
    heights.sort_unstable_by(f64::total_cmp);
    let top = heights[heights.len() * 9 / 10];
    let (low, high) = (0.3 * top, 0.7 * top);
    let count = heights.iter().filter(|z| (low..high).contains(*z)).count() as f64;
    let density = number(run, "/grains/density_kg_m3")?;
    let volume = PI * radius * radius * (high - low);
    Ok(count * density * PI / 6.0 * diameter.powi(3) / volume)
}

/// Slope and value at zero of the line through points with the least squares.
fn line(points: &[(f64, f64)]) -> [f64; 2] {
    let count = points.len() as f64;
    let mean = |of: fn(&(f64, f64)) -> f64| points.iter().map(of).sum::<f64>() / count;
    let (x, y) = (mean(|p| p.0), mean(|p| p.1));
    let across = points.iter().map(|p| (p.0 - x) * (p.1 - y)).sum::<f64>();
    let along = points.iter().map(|p| (p.0 - x) * (p.0 - x)).sum::<f64>();
    let slope = across / along;
    [slope, y - slope * x]
}
