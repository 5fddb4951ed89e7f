//! `em-bar`: bars along z with given net currents.

use std::f64::consts::PI;

use serde_json::{Value, json};

use crate::case::{Case, Errors, Measurement, Target};
use crate::em::C;
use crate::em::bar::{Bar, weak_heat};
use crate::em::frames::{Level, Points, measured, number, number_or, totals};
use crate::heat::frames::greater;
use crate::heat::methods::over;
use crate::lab::{Finished, Lab, LabError};

/// The case.
pub(super) struct EmBar;

const QUARTIC: &str = "quartic";
const QUADRATIC: &str = "quadratic";
const DIRECT: &str = "direct";
/// Two bars in a slow field across, which nothing joins, and whose ends are joined.
const ISOLATED: &str = "isolated";
const JOINED: &str = "joined";
/// Distance of their middles from the axis between them \[m\].
const ASIDE: f64 = 0.015;

impl Case for EmBar {
    fn name(&self) -> &'static str {
        "em-bar"
    }

    fn tool(&self) -> &'static str {
        "emfield"
    }

    fn reference(&self) -> &'static str {
        "Current in a round bar by modified Bessel functions, Smythe (1950), chapter XI; bars in a slow field"
    }

    fn methods(&self) -> &'static [&'static str] {
        &[QUARTIC, QUADRATIC, DIRECT, ISOLATED, JOINED]
    }

    fn targets(&self) -> Vec<Target> {
        vec![
            Target::error("current_linf", 5e-5).of(QUARTIC),
            Target::error("resistance", 5e-5).of(QUARTIC),
            Target::error("impedance", 2e-4).of(QUARTIC),
            Target::order("impedance", 2.5).of(QUARTIC),
            Target::error("impedance", 1.5e-2).of(QUADRATIC),
            Target::error("resistance", 1e-5).of(QUADRATIC),
            Target::order("impedance", 1.5).of(QUADRATIC),
            Target::error("resistance", 1e-5).of(DIRECT),
            Target::order("resistance", 2.0).of(DIRECT),
            Target::error("heat", 2e-5).of(ISOLATED),
            Target::order("heat", 2.0).of(ISOLATED),
            Target::error("odd", 1e-6).of(ISOLATED),
            Target::error("heat", 2e-5).of(JOINED),
            Target::order("heat", 2.0).of(JOINED),
        ]
    }

    fn measure(&self, lab: &Lab, level: u32, method: &str) -> Result<Measurement, LabError> {
        let spacing = 0.01 / [10.0, 14.0, 20.0][level.clamp(1, 3) as usize - 1];
        let points = json!({"spacing_m": spacing, "layers": {"first_m": 0.5 * spacing}});
        let patch = over(json!({"points": points}), &method_patch(method));
        measured(
            lab,
            self,
            Level {
                level,
                method,
                spacing,
            },
            &patch,
            errors,
        )
    }
}

fn method_patch(method: &str) -> Value {
    let bars = |net: Value| {
        let bar = |name: &str, x: f64| {
            over(
                json!({"name": name, "conductivity_s_m": 1e7,
                    "shape": {"disc": {"centre_m": [x, 0], "radius_m": 0.01}}}),
                &net,
            )
        };
        json!({
            "bodies": [bar("left", -ASIDE), bar("right", ASIDE)],
            "domain": {"sphere": {"radius_m": 0.05}},
            "eddy_currents": {"harmonic": {"frequency_hz": 0.01}, "applied_flux_density_t": [0, 0.02, 0]}
        })
    };
    match method {
        QUADRATIC => json!({"method": {"order": 2}}),
        DIRECT => json!({"eddy_currents": {"harmonic": {"frequency_hz": 1e-3}}}),
        ISOLATED => bars(json!({"net_current_a": 0})),
        JOINED => bars(json!({})),
        _ => json!({}),
    }
}

fn errors(run: &Finished, points: &Points) -> Result<Errors, LabError> {
    let bar = Bar {
        radius: number(run, "/bodies/0/shape/disc/radius_m")?,
        conductivity: number(run, "/bodies/0/conductivity_s_m")?,
        frequency: number(run, "/eddy_currents/harmonic/frequency_hz")?,
        current: number_or(run, "/bodies/0/net_current_a", 0.0),
    };
    let found = totals(run)?;
    let heat = found.get("power_volume")?;
    let voltage = |name: &str| -> Result<C, LabError> {
        let part = |part: &str| found.get(&format!("bar_voltage_{name}_{part}"));
        Ok(C::new(part("real")?, part("imag")?))
    };
    if run.scene["bodies"].as_array().is_some_and(|b| b.len() > 1) {
        let flux = number(run, "/eddy_currents/applied_flux_density_t/1")?;
        let aside = number(run, "/bodies/1/shape/disc/centre_m/0")?;
        let apart = run.scene.pointer("/bodies/0/net_current_a").is_some();
        let lever = if apart { 0.0 } else { aside.powi(2) };
        let exact = weak_heat(&bar, flux, 2.0, lever);
        let mut errors = Errors::from([("heat".to_owned(), (heat / exact - 1.0).abs())]);
        if apart {
            let [left, right] = [voltage("left")?, voltage("right")?];
            errors.insert("odd".to_owned(), (left + right).norm() / left.norm());
        }
        return Ok(errors);
    }
    let current = points.phasors("current_density")?;
    let mut worst = 0.0;
    for (p, found) in points.position.iter().zip(&current) {
        let r = p[0].hypot(p[1]);
        if r <= bar.radius * (1.0 + 1e-9) {
            worst = greater(worst, (found[2] - bar.density(r)).norm());
        }
    }
    // A is that of a wire at 1 m.
    let inside = voltage("bar")? / bar.current - bar.outside(1.0);
    let exact = bar.impedance();
    let resistance = heat / bar.current.powi(2);
    let slow = 1.0 / (bar.conductivity * PI * bar.radius.powi(2));
    let wanted = if bar.frequency < 0.01 { slow } else { exact.re };
    Ok(Errors::from([
        (
            "current_linf".to_owned(),
            worst / bar.density(bar.radius).norm(),
        ),
        ("resistance".to_owned(), (resistance / wanted - 1.0).abs()),
        (
            "impedance".to_owned(),
            (inside - exact).norm() / exact.norm(),
        ),
    ]))
}
