//! `liquid-flow`: a liquid between faces: plates, rows of vortices, at rest in a basin, sloshing.

use std::f64::consts::PI;
use std::path::Path;

use artefact::Reader;
use serde_json::json;

use crate::case::{Case, Errors, Measurement, Target};
use crate::drop::swing::zeros;
use crate::drop::{Series, points};
use crate::em::frames::number;
use crate::lab::{Finished, Lab, LabError, Subject};
use crate::norms::Worst as _;

/// The case.
pub(super) struct LiquidFlow;

/// Spacings along the box, by level.
const PARTS: [f64; 3] = [16.0, 24.0, 36.0];
/// Terms of the start of a flow between plates.
const TERMS: u32 = 400;

impl Case for LiquidFlow {
    fn name(&self) -> &'static str {
        "liquid-flow"
    }

    fn tool(&self) -> &'static str {
        "emfield"
    }

    fn reference(&self) -> &'static str {
        "Poiseuille's flow from its start; Taylor and Green (1937) in the plane; p = p_gas + rho g (H - y); waves on a liquid of finite depth: omega^2 = g k tanh(k H) (Airy)"
    }

    fn methods(&self) -> &'static [&'static str] {
        &["poiseuille", "taylor-green", "hydrostatic", "sloshing"]
    }

    fn targets(&self) -> Vec<Target> {
        let bound = |name: &str, method: &str| {
            [
                Target::error(name, 0.01).of(method),
                Target::order(name, 1.8).or_error_below(1e-4).of(method),
            ]
        };
        let all = [
            ("velocity", "poiseuille"),
            ("velocity", "taylor-green"),
            ("pressure", "taylor-green"),
            ("pressure", "hydrostatic"),
            ("velocity", "hydrostatic"),
            ("period", "sloshing"),
            ("amplitude", "sloshing"),
        ];
        all.iter().flat_map(|(n, m)| bound(n, m)).collect()
    }

    fn measure(&self, lab: &Lab, level: u32, method: &str) -> Result<Measurement, LabError> {
        let parts = PARTS[level.clamp(1, 3) as usize - 1];
        let scene = match method {
            "taylor-green" | "hydrostatic" | "sloshing" => method,
            _ => "scene",
        };
        let scene = format!("pipelines/verify/{}/{scene}.json", self.name());
        let planned = crate::lab::read_json(&lab.root.join(&scene))?;
        let long = planned["liquid"]["shape"]["box"]["max_m"][0].as_f64();
        let spacing = long.unwrap_or(f64::NAN) / parts;
        let patch = json!({"points": {"spacing_m": spacing}});
        let label = format!("level{level}-{method}");
        let of = Subject::new(self.tool(), self.name(), Path::new(&scene));
        let run = lab.run_scene(of, &label, &patch, &[])?;
        let errors = match method {
            "taylor-green" => vortices(&run)?,
            "hydrostatic" => rest(&run)?,
            "sloshing" => sloshing(&run)?,
            _ => plates(&run)?,
        };
        let count = points(&run)?;
        Ok(Measurement::of(run, count, spacing, errors))
    }
}

/// A frame of all points.
struct Instant {
    time: f64,
    place: Vec<[f64; 3]>,
    velocity: Vec<[f64; 3]>,
    pressure: Vec<f64>,
}

/// All frames but the first.
fn instants(run: &Finished) -> Result<Vec<Instant>, LabError> {
    let reader = Reader::open_kind(&run.artefact, "point-fields", 1)?;
    let each = (1..reader.count("/points")).map(|k| {
        let frame = reader.frame("/points", k)?;
        Ok(Instant {
            time: reader.time("/points", k)?,
            place: frame.position_vectors()?,
            velocity: frame.vectors("velocity")?,
            pressure: frame.f64("pressure")?,
        })
    });
    each.collect()
}

/// Largest of all values.
fn most(values: impl Iterator<Item = f64>) -> f64 {
    values.worst()
}

fn size(u: [f64; 3]) -> f64 {
    u.iter().map(|c| c * c).sum::<f64>().sqrt()
}

/// Largest difference of the velocity over the final speed in the middle.
fn plates(run: &Finished) -> Result<Errors, LabError> {
    let wide = number(run, "/liquid/shape/box/max_m/1")?;
    let nu = number(run, "/liquid/viscosity_pa_s")? / number(run, "/liquid/density_kg_m3")?;
    let g = number(run, "/liquid/gravity_m_s2/0")?;
    let fastest = g * wide * wide / (8.0 * nu);
    let exact = |y: f64, t: f64| {
        let lost: f64 = (0..TERMS)
            .map(|k| {
                let n = f64::from(2 * k + 1) * PI;
                8.0 / n.powi(3) * (-n * n * nu * t / (wide * wide)).exp() * (n * y / wide).sin()
            })
            .sum();
        g * wide * wide / nu * (0.5 * y / wide * (1.0 - y / wide) - 0.5 * lost)
    };
    let worst = most(instants(run)?.iter().map(|now| {
        let pairs = now.place.iter().zip(&now.velocity);
        most(pairs.map(|(x, u)| size([u[0] - exact(x[1], now.time), u[1], u[2]])))
    }));
    Ok(Errors::from([("velocity".to_owned(), worst / fastest)]))
}

/// Largest differences of velocity and pressure over those of the start.
fn vortices(run: &Finished) -> Result<Errors, LabError> {
    let wave = 2.0 * PI / number(run, "/liquid/shape/box/max_m/0")?;
    let density = number(run, "/liquid/density_kg_m3")?;
    let nu = number(run, "/liquid/viscosity_pa_s")? / density;
    let frames = instants(run)?;
    let reader = Reader::open_kind(&run.artefact, "point-fields", 1)?;
    let first = reader.frame("/points", 0)?;
    let mode = |x: &[f64; 3]| {
        let (x, y) = (wave * x[0], wave * x[1]);
        [x.sin() * y.cos(), -x.cos() * y.sin(), 0.0]
    };
    let (mut along, mut square) = (0.0, 0.0);
    for (x, u) in first
        .position_vectors()?
        .iter()
        .zip(first.vectors("velocity")?)
    {
        let m = mode(x);
        along += m[0] * u[0] + m[1] * u[1];
        square += m[0] * m[0] + m[1] * m[1];
    }
    let start = along / square;
    let pressed = 0.5 * density * start * start;
    let (mut speed, mut pressure) = (0.0_f64, 0.0_f64);
    for now in &frames {
        let left = (-2.0 * nu * wave * wave * now.time).exp();
        let pairs = now.place.iter().zip(&now.velocity);
        let off = pairs.map(|(x, u)| {
            let m = mode(x).map(|m| start * left * m);
            size([u[0] - m[0], u[1] - m[1], u[2]])
        });
        speed = speed.max(most(off) / start.abs());
        let exact = |x: &[f64; 3]| {
            let both = (2.0 * wave * x[0]).cos() + (2.0 * wave * x[1]).cos();
            0.5 * pressed * left * left * both
        };
        let lack: Vec<f64> = (now.place.iter().zip(&now.pressure))
            .map(|(x, p)| p - exact(x))
            .collect();
        let mean = lack.iter().sum::<f64>() / lack.len() as f64;
        pressure = pressure.max(most(lack.iter().map(|l| (l - mean).abs())) / pressed);
    }
    Ok(Errors::from([
        ("velocity".to_owned(), speed),
        ("pressure".to_owned(), pressure),
    ]))
}

/// Largest difference of the pressure over that at the bottom, and of the velocity over sqrt(g H).
fn rest(run: &Finished) -> Result<Errors, LabError> {
    let deep = number(run, "/liquid/shape/box/max_m/1")?;
    let density = number(run, "/liquid/density_kg_m3")?;
    let gas = number(run, "/liquid/gas_pressure_pa")?;
    let g = -number(run, "/liquid/gravity_m_s2/1")?;
    let frames = instants(run)?;
    let pressure = most(frames.iter().map(|now| {
        let pairs = now.place.iter().zip(&now.pressure);
        most(pairs.map(|(x, p)| (p - gas - density * g * (deep - x[1])).abs()))
    }));
    let speed = most(
        frames
            .iter()
            .flat_map(|now| &now.velocity)
            .map(|u| size(*u)),
    );
    Ok(Errors::from([
        ("pressure".to_owned(), pressure / (density * g * deep)),
        ("velocity".to_owned(), speed / (g * deep).sqrt()),
    ]))
}

/// The period of the longest wave, from the first zero to the third, and its greatest height after the second over that of small
/// waves with the speed of the start.
fn sloshing(run: &Finished) -> Result<Errors, LabError> {
    let wave = PI / number(run, "/liquid/shape/box/max_m/0")?;
    let deep = number(run, "/liquid/shape/box/max_m/1")?;
    let g = -number(run, "/liquid/gravity_m_s2/1")?;
    let frequency = (g * wave * (wave * deep).tanh()).sqrt();
    let series = Series::read(run, "wave_x_1")?;
    let zeros = zeros(&series);
    let period = match zeros[..] {
        [first, _, third, ..] => third - first,
        _ => f64::NAN,
    };
    let reader = Reader::open_kind(&run.artefact, "point-fields", 1)?;
    let first = reader.frame("/points", 0)?;
    let (mut along, mut square) = (0.0, 0.0);
    for (x, u) in first
        .position_vectors()?
        .iter()
        .zip(first.vectors("velocity")?)
    {
        let m = (wave * x[1]).sinh() * (wave * x[0]).cos();
        along += m * u[1];
        square += m * m;
    }
    let height = along / square * (wave * deep).sinh() / frequency;
    let late = series.time.iter().zip(&series.value);
    let late = late.filter(|(t, _)| zeros.get(1).is_some_and(|zero| *t > zero));
    let highest = most(late.map(|(_, y)| y.abs()));
    Ok(Errors::from([
        (
            "period".to_owned(),
            (period * frequency / (2.0 * PI) - 1.0).abs(),
        ),
        ("amplitude".to_owned(), (highest / height.abs() - 1.0).abs()),
    ]))
}
