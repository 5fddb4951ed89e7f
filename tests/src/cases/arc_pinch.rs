//! `arc-pinch`: the pressure that a current puts on a gas at rest.

use std::f64::consts::PI;

use serde_json::json;

use crate::case::{Case, Errors, Measurement, Target};
use crate::lab::{Lab, LabError};
use crate::plasma::{self, Plasma};

const MU0: f64 = 1.256_637_062_12e-6;
/// Growth of the conductivity towards the wall in the second run of each level.
const GROWTH: f64 = 2.0;

/// The case.
pub(super) struct ArcPinch;

/// Pressure above that on the axis, for a current density `j0 (1 + growth x^2)`, `x = r/R` \[Pa\]:
/// `-mu0 j0^2 R^2 (x^2/4 + 3 growth x^4/16 + growth^2 x^6/24)`, the integral of `-j B`.
fn pressure(current: f64, radius: f64, growth: f64, r: f64) -> f64 {
    let density = current / (2.0 * PI * radius.powi(2) * (0.5 + growth / 4.0));
    let x2 = (r / radius).powi(2);
    let shape = x2 / 4.0 + 3.0 * growth * x2 * x2 / 16.0 + growth.powi(2) * x2.powi(3) / 24.0;
    -MU0 * (density * radius).powi(2) * shape
}

impl Case for ArcPinch {
    fn name(&self) -> &'static str {
        "arc-pinch"
    }

    fn tool(&self) -> &'static str {
        "arcfvm"
    }

    fn reference(&self) -> &'static str {
        "Bennett (1934): p(0) - p(R) = mu0 j^2 R^2 / 4 for an even current density"
    }

    fn methods(&self) -> &'static [&'static str] {
        &["multigrid", "sor", "incomplete"]
    }

    fn targets(&self) -> Vec<Target> {
        let mut targets = plasma::targets(&["pressure_linf"], 5e-3, 1.9);
        targets.push(Target::error("even_pressure_linf", 1e-6));
        targets
    }

    fn measure(&self, lab: &Lab, level: u32, method: &str) -> Result<Measurement, LabError> {
        let spacing = 5e-4 / f64::from(1 << (level - 1));
        let iterate = json!({"solver": method});
        let even = json!({"grid": {"r": spacing}, "iterate": iterate});
        let even = lab.run(
            "arcfvm",
            self.name(),
            &format!("even-{method}{level}"),
            &even,
        )?;
        let radius = plasma::number(&even, "/domain/r_m/1")?;
        let conductivity = "/gas/given/electric_conductivity_s_m";
        let axis = plasma::property(&even, conductivity, 0.0, 300.0)?;
        let growing = json!({"gas": {"given": {"electric_conductivity_s_m":
            {"expr": format!("{axis}*(1 + {GROWTH}*(r/{radius})^2)")}}}});
        let run = lab.varied(&even, &format!("growing-{method}{level}"), &growing)?;
        let mut errors = Errors::new();
        for (name, run, growth) in [("even_", &even, 0.0), ("", &run, GROWTH)] {
            let current = plasma::number(run, "/current/edges/top/0/total_current_a")?;
            let (l2, linf) = Plasma::read(run)?
                .compare_shifted("pressure_pa", |r, _| pressure(current, radius, growth, r))?;
            errors.insert(format!("{name}pressure_l2"), l2);
            errors.insert(format!("{name}pressure_linf"), linf);
        }
        let fields = Plasma::read(&run)?;
        Ok(plasma::measurement(run, &fields, spacing, errors))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_even_current_gives_the_pinch_pressure() {
        let density = 300.0 / (PI * 0.005_f64.powi(2));
        let drop = MU0 * density.powi(2) * 0.005_f64.powi(2) / 4.0;
        let found = -pressure(300.0, 0.005, 0.0, 0.005);
        assert!((found / drop - 1.0).abs() < 1e-12);
    }

    #[test]
    fn the_pressure_balances_the_force_of_a_growing_current() {
        let (current, radius, growth, r) = (300.0, 0.005, 2.0, 0.003);
        let j0 = current / (2.0 * PI * radius * radius * (0.5 + growth / 4.0));
        let x2 = (r / radius) * (r / radius);
        let field = MU0 * j0 * (r / 2.0 + growth * r * x2 / 4.0);
        let force = -j0 * (1.0 + growth * x2) * field;
        let h = 1e-7;
        let up = pressure(current, radius, growth, r + h);
        let down = pressure(current, radius, growth, r - h);
        assert!(((up - down) / (2.0 * h) / force - 1.0).abs() < 1e-6);
    }
}
