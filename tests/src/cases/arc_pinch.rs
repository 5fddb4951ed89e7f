//! `arc-pinch`: the pressure that a current puts on a gas at rest.

use std::f64::consts::PI;

use serde_json::json;

use crate::case::{Case, Errors, Measurement, Target};
use crate::lab::{Finished, Lab, LabError};
use crate::plasma::{self, Plasma};

const MU0: f64 = 1.256_637_062_12e-6;
/// Growth of the conductivity towards the wall in the second run of each level, where the scene's is even.
const GROWTH: f64 = 2.0;
/// Where the conductivity that a scene gives is read to tell its growth \[K\].
const READ_AT_K: f64 = 300.0;

/// Conductivity of the gas, `axis (1 + growth (r/R)^2)`.
struct Shape {
    /// \[m\].
    radius: f64,
    /// \[S/m\].
    axis: f64,
    growth: f64,
}

impl Shape {
    /// That of the scene that ran, if it has this form.
    fn of(run: &Finished) -> Result<Self, LabError> {
        let radius = plasma::number(run, "/domain/r_m/1")?;
        let pointer = "/gas/given/electric_conductivity_s_m";
        let over_axis = |x: f64| plasma::property(run, pointer, x * radius, READ_AT_K);
        let axis = over_axis(0.0)?;
        let growth = |x: f64| Ok::<_, LabError>((over_axis(x)? / axis - 1.0) / (x * x));
        let shape = Self {
            radius,
            axis,
            growth: growth(1.0)?,
        };
        if (growth(0.5)? - shape.growth).abs() > 1e-9 {
            return Err(LabError::Content {
                path: run.artefact.clone(),
                what: format!("its scene at {pointer}: the exact solution wants a (1 + b r^2)"),
            });
        }
        Ok(shape)
    }

    /// A patch with another growth.
    fn grown(&self, growth: f64) -> serde_json::Value {
        let Self { radius, axis, .. } = self;
        json!({"gas": {"given": {"electric_conductivity_s_m":
            {"expr": format!("{axis}*(1 + {growth}*(r/{radius})^2)")}}}})
    }
}

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
        let grid = json!({"grid": {"r": spacing}, "iterate": {"solver": method}});
        let given = lab.run("arcfvm", self.name(), &format!("{method}{level}"), &grid)?;
        let shape = Shape::of(&given)?;
        let (even, run, growth) = if shape.growth == 0.0 {
            let run = lab.varied(
                &given,
                &format!("growing-{method}{level}"),
                &shape.grown(GROWTH),
            )?;
            (given, run, GROWTH)
        } else {
            let even = lab.varied(&given, &format!("even-{method}{level}"), &shape.grown(0.0))?;
            (even, given, shape.growth)
        };
        let radius = shape.radius;
        let mut errors = Errors::new();
        for (name, run, growth) in [("even_", &even, 0.0), ("", &run, growth)] {
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
