//! `heat-c-t`: density and specific heat that depend on temperature.

use std::f64::consts::PI;

use serde_json::{Value, json};

use super::heat_exp_x::{held, square_spacing};
use crate::case::{Case, Errors, Measurement, Target};
use crate::heat::frames::{Frames, greater, worst};
use crate::heat::methods::{self, over};
use crate::heat::property::{Exponential, Property, conductivity, fault, number, property};
use crate::heat::stefan::Melting;
use crate::lab::{Finished, Lab, LabError};

/// Terms of the series.
const TERMS: u32 = 400;
/// Half width of the peak that holds the latent heat, over the range of temperature.
const PEAK: f64 = 1e-3;

const METHODS: &[&str] = &[
    "corrected-implicit",
    "corrected-explicit",
    "corrected-stabilised",
    "corrected-implicit-jitter-30",
];

/// The case.
pub(super) struct HeatCT;

impl Case for HeatCT {
    fn name(&self) -> &'static str {
        "heat-c-t"
    }

    fn tool(&self) -> &'static str {
        "heatsph"
    }

    fn reference(&self) -> &'static str {
        "Series in the heat where k and rho c grow alike (Carslaw and Jaeger 1959, 1.6), a manufactured solution, Neumann's front"
    }

    fn methods(&self) -> &'static [&'static str] {
        METHODS
    }

    fn levels(&self, method: &str, asked: &[u32]) -> Vec<u32> {
        // Explicit steps become short with the square of the spacing.
        let most = if method.contains("implicit") { 3 } else { 2 };
        asked.iter().copied().filter(|l| *l <= most).collect()
    }

    fn targets(&self) -> Vec<Target> {
        let mut targets = Vec::new();
        for method in METHODS {
            let balance = if *method == "corrected-explicit" {
                1e-10
            } else {
                1e-6
            };
            targets.push(Target::error("energy_balance", balance).of(*method));
            targets.push(Target::error("front_spacings", 1.0).of(*method));
            if !method.contains("jitter") {
                targets.push(Target::order("diffusivity_linf", 1.8).of(*method));
                targets.push(Target::order("manufactured_linf", 1.8).of(*method));
            }
            for part in ["diffusivity_linf", "manufactured_linf"] {
                targets.push(Target::error(part, 2e-3).at_level(2).of(*method));
            }
        }
        targets
    }

    fn measure(&self, lab: &Lab, level: u32, method: &str) -> Result<Measurement, LabError> {
        let spacing = square_spacing(level);
        let mut errors = Errors::new();
        let (mut all, mut points) = (Vec::new(), 0);
        for (part, scene) in [
            ("diffusivity", json!({})),
            ("manufactured", manufactured()),
            ("melting", melting(spacing)),
        ] {
            let patch = over(
                over(json!({"points": {"spacing_m": spacing}}), &scene),
                &methods::patch(method),
            );
            let label = format!("level{level}-{method}-{part}");
            let run = lab.run(self.tool(), self.name(), &label, &patch)?;
            let frames = Frames::read(&run)?;
            let (key, error) = match part {
                "diffusivity" => ("diffusivity_linf", diffusivity(&run, &frames)?),
                "manufactured" => ("manufactured_linf", sought(&frames)),
                _ => ("front_spacings", front(&run, &frames)? / spacing),
            };
            errors.insert(key.to_owned(), error);
            let balance = errors.entry("energy_balance".to_owned()).or_insert(0.0);
            *balance = greater(*balance, run.closing("energy_balance"));
            points = points.max(frames.points());
            all.push(run);
        }
        Ok(Measurement::over(all, points, spacing, errors))
    }
}

/// Largest error where `k = K exp(aT)` and `rho c = C exp(aT)`: `U = exp(aT)` obeys `U_t = K/C U_xx`.
fn diffusivity(run: &Finished, frames: &Frames) -> Result<f64, LabError> {
    let law = |of: &Property| Exponential::recognise(of).map_err(|what| fault(run, what));
    let k = law(&conductivity(run, 0)?)?;
    let rho = law(&property(run, "/materials/0/density_kg_m3")?)?;
    let c = law(&property(run, "/materials/0/specific_heat_j_kg_k")?)?;
    let a = k.with_temperature;
    let alike = (rho.with_temperature + c.with_temperature - a).abs() <= 1e-12 * a.abs();
    if !alike || k.along_x != 0.0 || rho.along_x != 0.0 || c.along_x != 0.0 {
        let what = "conductivity and density times specific heat must grow alike".to_owned();
        return Err(fault(run, what));
    }
    let alpha = k.scale / (rho.scale * c.scale);
    let from = number(run, "/body/box/min_m/0")?;
    let length = number(run, "/body/box/max_m/0")? - from;
    let ends = held(run)?;
    let start = number(run, "/initial_temperature_k")?;
    let rise = |t: f64| (a * t).exp() - (a * start).exp();
    let [u1, u2] = ends.map(rise);
    let exact = |x: f64, time: f64| {
        let s = (x - from) / length;
        let terms = (1..TERMS).map(|n| {
            let sign = if n % 2 == 0 { 1.0 } else { -1.0 };
            let n = PI * f64::from(n);
            (sign * u2 - u1) / n * (n * s).sin() * (-n * n * alpha * time / (length * length)).exp()
        });
        let u = u1 + (u2 - u1) * s + 2.0 * terms.sum::<f64>();
        (u + (a * start).exp()).ln() / a
    };
    let all = [ends[0], ends[1], start];
    let low = all.iter().copied().fold(f64::INFINITY, f64::min);
    let range = all.iter().copied().fold(f64::NEG_INFINITY, f64::max) - low;
    let mut error = 0.0;
    for (time, found) in frames.after_start() {
        let own = worst(&frames.position, found, range, |p| exact(p[0], time));
        error = greater(error, own);
    }
    Ok(error)
}

/// `T = 1.5 + 0.5 exp(-t) cos(pi x) cos(pi y)` in the insulated unit square, and the source that makes it so:
/// `rho c T_t - k lap T - k' |grad T|^2`.
fn manufactured() -> Value {
    let t = "(1.5 + 0.5*exp(-t)*cos(pi*x)*cos(pi*y))";
    let wave = "(0.5*exp(-t)*cos(pi*x)*cos(pi*y))";
    let steep = "(0.25*exp(-2*t)*pi^2*((sin(pi*x)*cos(pi*y))^2 + (cos(pi*x)*sin(pi*y))^2))";
    let source = format!(
        "(0 - {wave})*(3 - 0.5*{t})*(1 + {t}^2) + exp(0.4*{t})*(2*pi^2*{wave} - 0.4*{steep})"
    );
    json!({
        "materials": [{"name": "m", "density_kg_m3": {"t_k": [0, 4], "value": [3, 1]},
            "specific_heat_j_kg_k": {"expr": "1 + T^2"}, "conductivity_w_m_k": {"expr": "exp(0.4*T)"}}],
        "initial_temperature_k": {"expr": "1.5 + 0.5*cos(pi*x)*cos(pi*y)"},
        "source_w_m3": {"expr": source}, "boundaries": [],
        "time": {"end_s": 0.5}, "output": {"at_s": [0.1, 0.5]}
    })
}

/// Largest error of the manufactured solution over its range.
fn sought(frames: &Frames) -> f64 {
    let mut error = 0.0;
    for (time, found) in frames.after_start() {
        let own = worst(&frames.position, found, 1.0, |p| {
            1.5 + 0.5 * (-time).exp() * (PI * p[0]).cos() * (PI * p[1]).cos()
        });
        error = greater(error, own);
    }
    error
}

/// The front in a bar, with the latent heat in a peak of the specific heat.
const STEFAN: Melting = Melting {
    diffusivity: 1.0,
    // Over the heat of the whole range of temperature.
    latent: 2.0,
    melting: 0.5,
};

fn melting(spacing: f64) -> Value {
    let (latent, at) = (STEFAN.latent, STEFAN.melting);
    let peak = format!("1 + {latent}/({PEAK}*sqrt(pi))*exp(-((T - {at})/{PEAK})^2)");
    json!({
        "body": {"box": {"min_m": [0, 0], "max_m": [1, 4.0 * spacing]}},
        "materials": [{"name": "m", "density_kg_m3": 1, "specific_heat_j_kg_k": {"expr": peak},
            "conductivity_w_m_k": 1}],
        "initial_temperature_k": 0, "boundaries": [{"on": ["x-"], "temperature_k": 1}],
        "time": {"end_s": 0.04}, "output": {"at_s": [0.02, 0.04]}
    })
}

/// Largest distance of the front from where Neumann has it \[m\].
fn front(run: &Finished, frames: &Frames) -> Result<f64, LabError> {
    let mut error = 0.0;
    for (time, found) in frames.after_start() {
        let mut row: Vec<(f64, f64)> = (frames.position.iter().zip(found))
            .map(|(p, t)| (p[0], *t))
            .collect();
        row.sort_by(|a, b| a.0.total_cmp(&b.0));
        // The last place that is at least as warm as the melting point, and the next one.
        let last = row.iter().rposition(|(_, t)| *t >= STEFAN.melting);
        let (Some(last), true) = (last, row[0].1 > STEFAN.melting) else {
            return Err(fault(run, "nothing has melted".to_owned()));
        };
        let (x, t) = row[last];
        let next = row[last..].iter().find(|(other, _)| *other > x + 1e-9);
        let at = next.map_or(x, |(xn, tn)| x + (xn - x) * (t - STEFAN.melting) / (t - tn));
        error = greater(error, (at - STEFAN.front(time)).abs());
    }
    Ok(error)
}
