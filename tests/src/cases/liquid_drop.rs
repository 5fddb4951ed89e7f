//! `liquid-drop` and `liquid-drop-viscous`: a drop swings about the sphere.

use std::f64::consts::PI;

use serde_json::{Value, json};

use crate::case::{Case, Errors, Measurement, Target};
use crate::drop::swing::{Fit, fit_with_double, zeros};
use crate::drop::viscous::{rates, rayleigh};
use crate::drop::{Series, points};
use crate::em::frames::planned;
use crate::heat::methods::over;
use crate::lab::{Finished, Lab, LabError};
use crate::norms::Worst as _;

/// Without friction.
pub(super) struct LiquidDrop;

/// With friction.
pub(super) struct LiquidDropViscous;

/// Spacings per radius, by level.
const PARTS: [f64; 3] = [6.0, 8.5, 12.0];
/// Amplitude of the swing over the radius.
const AMPLITUDE: f64 = 0.01;
/// Periods of a run.
const PERIODS: f64 = 1.1;
/// Times of slow decay of a drop that creeps.
const CREPT: f64 = 0.3;

impl Case for LiquidDrop {
    fn name(&self) -> &'static str {
        "liquid-drop"
    }

    fn tool(&self) -> &'static str {
        "emfield"
    }

    fn reference(&self) -> &'static str {
        "Rayleigh (1879): omega^2 = l (l-1) (l+2) gamma / (rho R^3)"
    }

    fn methods(&self) -> &'static [&'static str] {
        &["mode-2", "mode-3", "mode-4"]
    }

    fn targets(&self) -> Vec<Target> {
        let mut targets = vec![Target::error("points", 2e4), Target::error("volume", 1e-6)];
        for method in self.methods() {
            targets.push(Target::error("period_zeros", 3e-3).of(*method));
            targets.push(Target::error("period_fit", 3e-3).of(*method));
        }
        targets
    }

    fn measure(&self, lab: &Lab, level: u32, method: &str) -> Result<Measurement, LabError> {
        let mode = if method == "mode-3" {
            3
        } else if method == "mode-4" {
            4
        } else {
            2
        };
        let run = swung(lab, self.name(), method, level, mode, None)?;
        let unit = Unit::new(&run.scene);
        let period = 2.0 * PI / rayleigh(mode) * unit.time;
        let series = Series::read(&run, &format!("mode_{mode}"))?;
        let found = swing(&run, &series, period)?;
        let volume = Series::read(&run, "volume")?.value;
        let drift = volume.iter().map(|v| (v / volume[0] - 1.0).abs());
        let count = points(&run)?;
        let errors = Errors::from([
            ("period_zeros".to_owned(), (found.0 / period - 1.0).abs()),
            (
                "period_fit".to_owned(),
                (found.1.period() / period - 1.0).abs(),
            ),
            ("volume".to_owned(), drift.worst()),
        ]);
        let spacing = unit.radius / PARTS[level.clamp(1, 3) as usize - 1];
        let costs = [("points", count as f64)];
        Ok(Measurement::of(run, count, spacing, errors).at_costs(costs))
    }
}

impl Case for LiquidDropViscous {
    fn name(&self) -> &'static str {
        "liquid-drop-viscous"
    }

    fn tool(&self) -> &'static str {
        "emfield"
    }

    fn reference(&self) -> &'static str {
        "Small swings of a viscous drop without gas, Chandrasekhar (1959), Miller and Scriven (1968)"
    }

    fn methods(&self) -> &'static [&'static str] {
        &["oh-0.02", "oh-0.06", "oh-2e-5", "oh-10"]
    }

    fn targets(&self) -> Vec<Target> {
        vec![
            Target::error("period", 5e-3),
            Target::error("decay", 5e-2),
            Target::error("period", 5e-3).of("oh-0.06"),
            Target::error("decay", 5e-2).of("oh-0.06"),
            Target::error("period", 5e-3).of("oh-2e-5"),
            // At most three times that of Lamb.
            Target::error("decay", 2.0).of("oh-2e-5"),
            Target::error("creeping_rate", 2e-2).of("oh-10"),
        ]
    }

    fn measure(&self, lab: &Lab, level: u32, method: &str) -> Result<Measurement, LabError> {
        let oh: f64 = method.trim_start_matches("oh-").parse().unwrap_or(0.02);
        let run = swung(lab, self.name(), method, level, 2, Some(oh))?;
        let unit = Unit::new(&run.scene);
        let oh = unit.ohnesorge(&run.scene);
        let (decay, frequency) = rates(2, oh);
        let series = Series::read(&run, "mode_2")?;
        let errors = if frequency > 0.0 {
            let period = 2.0 * PI / frequency * unit.time;
            let (_, found) = swing(&run, &series, period)?;
            let slow = found.decay * unit.time / decay - 1.0;
            Errors::from([
                ("period".to_owned(), (found.period() / period - 1.0).abs()),
                ("decay".to_owned(), slow.abs()),
            ])
        } else {
            // What turns in the liquid at the start is gone after a third of the time.
            let last = series.value.len() - 1;
            let from = last / 3;
            let passed = (series.time[last] - series.time[from]) / unit.time;
            let found = (series.value[from] / series.value[last]).ln() / passed;
            Errors::from([("creeping_rate".to_owned(), (found / decay - 1.0).abs())])
        };
        let count = points(&run)?;
        let spacing = unit.radius / PARTS[level.clamp(1, 3) as usize - 1];
        Ok(Measurement::of(run, count, spacing, errors))
    }
}

/// Units of a drop.
struct Unit {
    radius: f64,
    /// sqrt(rho R^3/gamma) \[s\].
    time: f64,
    /// sqrt(rho gamma R) \[Pa s\].
    viscosity: f64,
}

impl Unit {
    fn new(scene: &Value) -> Self {
        let liquid = &scene["liquid"];
        let number = |v: &Value| v.as_f64().unwrap_or(f64::NAN);
        let radius = number(&liquid["shape"]["sphere"]["radius_m"]);
        let density = number(&liquid["density_kg_m3"]);
        let tension = number(&liquid["surface_tension_n_m"]);
        Self {
            radius,
            time: (density * radius.powi(3) / tension).sqrt(),
            viscosity: (density * tension * radius).sqrt(),
        }
    }

    fn ohnesorge(&self, scene: &Value) -> f64 {
        scene["liquid"]["viscosity_pa_s"].as_f64().unwrap_or(0.0) / self.viscosity
    }
}

/// Runs a drop that leaves the sphere at the speed of a swing of mode `l`: `u = A grad (r^l P_l)`.
fn swung(
    lab: &Lab,
    case: &str,
    method: &str,
    level: u32,
    l: u32,
    oh: Option<f64>,
) -> Result<Finished, LabError> {
    let parts = PARTS[level.clamp(1, 3) as usize - 1];
    let scene = planned(lab, case, &json!({}))?;
    let unit = Unit::new(&scene);
    let mut liquid = json!({});
    if let Some(oh) = oh {
        liquid["viscosity_pa_s"] = json!(oh * unit.viscosity);
    }
    let oh = oh.unwrap_or(0.0);
    let decay = rates(l, oh.max(1e-9)).0;
    let periods = PERIODS * 2.0 * PI / rayleigh(l);
    let end = if oh > 2.0 { CREPT / decay } else { periods };
    let n = f64::from(l);
    // u_n = A l R^(l-1) P_l is the speed of the amplitude.
    let speed = AMPLITUDE * unit.radius / unit.time * rayleigh(l);
    let a = speed / (n * unit.radius.powi(l as i32 - 1));
    let along = match l {
        2 => ["-x", "-y", "2*z"],
        3 => ["-3*x*z", "-3*y*z", "3*z^2 - 1.5*(x^2 + y^2)"],
        _ => [
            "x*(1.5*(x^2 + y^2) - 6*z^2)",
            "y*(1.5*(x^2 + y^2) - 6*z^2)",
            "4*z^3 - 6*z*(x^2 + y^2)",
        ],
    };
    liquid["velocity_m_s"] = along
        .map(|e| json!({"expr": format!("{a:e}*({e})")}))
        .into();
    liquid["march"] = json!({"end_s": end * unit.time});
    let own = json!({"points": {"spacing_m": unit.radius / parts}});
    let patch = over(own, &json!({"liquid": liquid}));
    lab.run("emfield", case, &format!("level{level}-{method}"), &patch)
}

/// The period by zeros (the start is one), and a fit.
fn swing(run: &Finished, series: &Series, period: f64) -> Result<(f64, Fit), LabError> {
    let zeros = zeros(series);
    let second = zeros.iter().copied().find(|t| *t > 0.75 * period);
    let second = second.ok_or_else(|| LabError::Content {
        path: run.artefact.clone(),
        what: format!("swings through the sphere at {zeros:?} s alone"),
    })?;
    let guess = Fit {
        frequency: 2.0 * PI / period,
        decay: 0.0,
    };
    Ok((second, fit_with_double(series, guess)))
}
