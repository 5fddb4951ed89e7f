//! `flow-layers`: two liquids that do not mix: a wave between them, both dragged by a plate, a drop of one in the other, a layer
//! of one upon the other.

use std::f64::consts::PI;
use std::path::Path;

use serde_json::json;

use crate::case::{Case, Errors, Measurement, Target};
use crate::flow::period;
use crate::lab::{Finished, Lab, LabError, Subject, read_json};
use crate::norms::Worst;
use crate::particles::{Frames, mean, measurement, number};

/// The case.
pub(super) struct FlowLayers;

/// Spacings over that of the scene, by level.
const FINER: [f64; 3] = [1.0, 0.5, 1.0 / 3.0];
/// The same of the drop: 6, 9 and 12 spacings of radius.
const FINER_DROP: [f64; 3] = [1.0, 2.0 / 3.0, 0.5];
/// The tank is looked at from this part of the run on.
const SETTLED: f64 = 0.6;
/// Parts of the radius within which, and from which on, the pressure of a drop is read.
const INSIDE: f64 = 0.7;
const OUTSIDE: f64 = 1.25;

impl Case for FlowLayers {
    fn name(&self) -> &'static str {
        "flow-layers"
    }

    fn tool(&self) -> &'static str {
        "poolsph"
    }

    fn reference(&self) -> &'static str {
        "waves between two liquids: omega^2 = g k (rho_1 - rho_2)/(rho_1 coth k h_1 + rho_2 coth k h_2), Lamb (1932), section 231; the same shear stress in both; Young and Laplace; the weight of what lies above"
    }

    fn methods(&self) -> &'static [&'static str] {
        &["wave", "channel", "drop", "tank"]
    }

    fn targets(&self) -> Vec<Target> {
        vec![
            Target::error("period", 0.01).of("wave"),
            Target::order("period", 1.3).of("wave"),
            Target::error("grown", 0.05).of("wave"),
            Target::error("profile", 0.005).of("channel"),
            Target::error("pressure", 0.02).of("drop"),
            Target::error("blurred", 0.5).of("drop"),
            Target::error("mixed", 0.0).of("tank"),
            Target::error("pressure", 0.02).of("tank"),
            Target::error("tilt", 0.5).of("tank"),
        ]
    }

    fn levels(&self, method: &str, asked: &[u32]) -> Vec<u32> {
        // A second of the tank takes minutes on the second level.
        let most = if method == "tank" { 1 } else { 3 };
        asked
            .iter()
            .copied()
            .filter(|level| *level <= most)
            .collect()
    }

    fn measure(&self, lab: &Lab, level: u32, method: &str) -> Result<Measurement, LabError> {
        let (scene, finer) = match method {
            "channel" => (method, FINER),
            "drop" => (method, FINER_DROP),
            "tank" => (method, FINER),
            _ => ("scene", FINER),
        };
        let finer = finer[level.clamp(1, 3) as usize - 1];
        let scene = format!("pipelines/verify/{}/{scene}.json", self.name());
        let planned = read_json(&lab.root.join(&scene))?;
        let spacing = finer * planned["spacing_m"].as_f64().unwrap_or(f64::NAN);
        let mut patch = json!({"spacing_m": spacing});
        if method == "tank" {
            let mut bodies = planned["bodies"].clone();
            bodies[0]["shape"]["container"]["thickness_m"] = json!(2.0 * spacing);
            patch["bodies"] = bodies;
        }
        let of = Subject::new(self.tool(), self.name(), Path::new(&scene));
        let run = lab.run_scene(of, &format!("{method}-level{level}"), &patch, &[])?;
        let frames = Frames::read(&run.artefact, "pressure")?;
        let slag = Frames::read(&run.artefact, "slag")?;
        let slag: Vec<bool> = slag.scalar[0].iter().map(|mark| *mark > 0.5).collect();
        let errors = match method {
            "channel" => channel(&run, &frames, &slag)?,
            "drop" => drop(&run, &frames, &slag)?,
            "tank" => tank(&run, &frames, &slag)?,
            _ => wave(&run, &frames, &slag)?,
        };
        measurement(run, frames.liquid.len(), errors)
    }
}

fn named<const N: usize>(errors: [(&str, f64); N]) -> Errors {
    errors.map(|(name, error)| (name.to_owned(), error)).into()
}

/// Period of the mode by its zeros, and how far a later greatest speed exceeds the first.
fn wave(run: &Finished, frames: &Frames, slag: &[bool]) -> Result<Errors, LabError> {
    let at = |key: &str| number(run, key);
    let (long, high) = (at("/faces/max_m/0")?, at("/faces/max_m/2")?);
    let level = at("/bodies/0/shape/box/max_m/2")?;
    let (lower, upper) = (at("/density_kg_m3")?, at("/slag/density_kg_m3")?);
    let (k, g) = (PI / long, -at("/flow/gravity_m_s2/2")?);
    let deep = [level, high - level].map(|h| 1.0 / (k * h).tanh());
    let exact = 2.0 * PI / (g * k * (lower - upper) / (lower * deep[0] + upper * deep[1])).sqrt();
    let mode = |x: &[f64; 3], slag: bool| {
        let part = if slag {
            (k * (high - x[2])).sinh() / (k * (high - level)).sinh()
        } else {
            (k * x[2]).sinh() / (k * level).sinh()
        };
        (k * x[0]).cos() * part
    };
    let swing = |f: usize| {
        let rows = frames.position[f].iter().zip(&frames.velocity[f]).zip(slag);
        mean(rows.map(|((x, u), slag)| u[2] * mode(x, *slag)))
    };
    let swing: Vec<f64> = (0..frames.time.len()).map(swing).collect();
    let period = period(run, &frames.time, &swing)?;
    let later = frames.time.iter().zip(&swing);
    let most = later
        .filter(|(t, _)| **t > 0.25 * exact)
        .map(|(_, u)| u.abs());
    Ok(named([
        ("period", (period / exact - 1.0).abs()),
        ("grown", (most.worst() / swing[0].abs() - 1.0).max(0.0)),
    ]))
}

/// Greatest difference of a speed from the steady one, over that of the plate.
fn channel(run: &Finished, frames: &Frames, slag: &[bool]) -> Result<Errors, LabError> {
    let at = |key: &str| number(run, key);
    let (high, level) = (at("/faces/max_m/2")?, at("/bodies/0/shape/box/max_m/2")?);
    let (mu, mu_slag) = (at("/flow/viscosity_pa_s")?, at("/slag/viscosity_pa_s")?);
    let plate = at("/faces/wall/1/velocity_m_s/0")?;
    let stress = plate / (level / mu + (high - level) / mu_slag);
    let last = frames.time.len() - 1;
    let rows = frames.position[last]
        .iter()
        .zip(&frames.velocity[last])
        .zip(slag);
    let off = rows.map(|((x, u), slag)| {
        let exact = if *slag {
            plate - stress * (high - x[2]) / mu_slag
        } else {
            stress * x[2] / mu
        };
        (u[0] - exact).abs() / plate
    });
    Ok(named([("profile", off.worst())]))
}

/// Difference of the pressures inside and outside from 2 gamma/R in the second half of the run, and how far both liquids reach into one
/// another at the end, over the spacing.
fn drop(run: &Finished, frames: &Frames, slag: &[bool]) -> Result<Errors, LabError> {
    let at = |key: &str| number(run, key);
    let (radius, d) = (at("/bodies/0/shape/sphere/radius_m")?, at("/spacing_m")?);
    let exact = 2.0 * at("/slag/interface_tension_n_m")? / radius;
    let marks = || slag.iter().copied();
    let far = |x: &[f64; 3]| x.iter().map(|x| x * x).sum::<f64>().sqrt() / radius;
    let jump = |f: usize| {
        let rows = || {
            frames.position[f]
                .iter()
                .zip(&frames.scalar[f])
                .zip(marks())
        };
        let inside = rows().filter(|((x, _), slag)| *slag && far(x) < INSIDE);
        let outside = rows().filter(|((x, _), slag)| !*slag && far(x) > OUTSIDE);
        mean(inside.map(|((_, p), _)| *p)) - mean(outside.map(|((_, p), _)| *p))
    };
    let pressure = mean(frames.second_half().map(jump));
    let last = frames.position.last().map_or(&[][..], Vec::as_slice);
    let reach = |own: bool| {
        let places = last
            .iter()
            .zip(marks())
            .filter(move |(_, slag)| *slag == own);
        places.map(|(x, _)| far(x))
    };
    let inner = reach(false).fold(f64::INFINITY, f64::min);
    Ok(named([
        ("pressure", (pressure / exact - 1.0).abs()),
        (
            "blurred",
            ((reach(true).worst() - inner) * radius / d).max(0.0),
        ),
    ]))
}

/// Share of particles more than a spacing on the wrong side of the interface, ever; the pressure at the bottom; how far the mean heights
/// of slag in the quarters of the tank differ, over a spacing. All from the time on at which it has settled.
fn tank(run: &Finished, frames: &Frames, slag: &[bool]) -> Result<Errors, LabError> {
    let at = |key: &str| number(run, key);
    let (d, g) = (at("/spacing_m")?, -at("/flow/gravity_m_s2/2")?);
    let (metal, upper) = (at("/density_kg_m3")?, at("/slag/density_kg_m3")?);
    let level = at("/bodies/1/shape/box/max_m/2")?;
    let high = at("/bodies/2/shape/box/max_m/2")?;
    let middle = [0, 1].map(|k| at(&format!("/bodies/1/shape/box/max_m/{k}")).unwrap_or(0.0) / 2.0);
    let end = frames.time.last().copied().unwrap_or(0.0);
    let from = frames.time.partition_point(|t| *t < SETTLED * end);
    let (mut mixed, mut tilt, mut pressures): (f64, f64, Vec<f64>) = (0.0, 0.0, Vec::new());
    for f in from..frames.time.len() {
        let liquid = frames.liquid();
        let wrong = liquid.iter().filter(|a| {
            let above = frames.position[f][**a][2] - level;
            if slag[**a] { above < -d } else { above > d }
        });
        mixed = mixed.max(wrong.count() as f64 / liquid.len() as f64);
        let mut quarters = [(0.0, 0.0); 4];
        for a in liquid.iter().filter(|a| slag[**a]) {
            let x = frames.position[f][*a];
            let own =
                &mut quarters[usize::from(x[0] > middle[0]) + 2 * usize::from(x[1] > middle[1])];
            *own = (own.0 + x[2], own.1 + 1.0);
        }
        let means = quarters.map(|(sum, count)| sum / count);
        let low = means.into_iter().fold(f64::INFINITY, f64::min);
        tilt = tilt.max((means.into_iter().worst() - low) / d);
        for a in liquid.iter().filter(|a| frames.position[f][**a][2] < d) {
            let depth = level - frames.position[f][*a][2];
            let exact = g * (metal * depth + upper * (high - level));
            pressures.push(frames.scalar[f][*a] / exact);
        }
    }
    Ok(named([
        ("mixed", mixed),
        ("pressure", (mean(pressures.into_iter()) - 1.0).abs()),
        ("tilt", tilt),
    ]))
}
