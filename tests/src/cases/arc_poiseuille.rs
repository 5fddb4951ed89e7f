//! `arc-poiseuille`: developed flow in a pipe, of an even viscosity and of one that grows outward.

use serde_json::json;

use crate::case::{Case, Errors, Measurement, Target};
use crate::lab::{Finished, Lab, LabError};
use crate::norms;
use crate::plasma::{self, Plasma};

/// Speed on the axis that both profiles are fed in with \[m/s\].
const AXIS_SPEED: f64 = 2.0;

/// Speed of a viscosity `mu (1 + x^2)`, `x = r/R`: the integral of `dw/dr = (dp/dz) r / (2 mu (1 + x^2))`.
fn growing(x: f64) -> f64 {
    AXIS_SPEED * (1.0 - (x * x).ln_1p() / 2.0_f64.ln())
}

/// Speed of an even viscosity.
fn even(x: f64) -> f64 {
    AXIS_SPEED * (1.0 - x * x)
}

/// The case.
pub(super) struct ArcPoiseuille;

impl Case for ArcPoiseuille {
    fn name(&self) -> &'static str {
        "arc-poiseuille"
    }

    fn tool(&self) -> &'static str {
        "arcfvm"
    }

    fn reference(&self) -> &'static str {
        "Hagen (1839), Poiseuille (1840), and its integral for a viscosity mu (1 + r^2/R^2)"
    }

    fn targets(&self) -> Vec<Target> {
        let mut targets = plasma::targets(&["velocity_linf", "pressure_gradient"], 5e-3, 1.9);
        for quantity in ["even_velocity_linf", "even_pressure_gradient"] {
            targets.push(Target::error(quantity, 1e-4));
        }
        targets
    }

    fn measure(&self, lab: &Lab, level: u32, _: &str) -> Result<Measurement, LabError> {
        let spacing = 5e-4 / f64::from(1 << (level - 1));
        let grid = json!({"grid": {"r": spacing, "z": 2.0 * spacing}});
        let steady = lab.run("arcfvm", self.name(), &format!("even{level}"), &grid)?;
        let patch = json!({
            "grid": {"r": spacing, "z": 2.0 * spacing},
            "gas": {"given": {"viscosity_pa_s": {"expr": "0.001*(1 + (r/0.005)^2)"}}},
            "flow": {"edges": {"bottom": [
                {"velocity_m_s": [0, {"expr": "2*(1 - ln(1 + (r/0.005)^2)/ln(2))"}]}
            ]}},
        });
        let run = lab.run("arcfvm", self.name(), &format!("growing{level}"), &patch)?;
        let radius = plasma::number(&steady, "/domain/r_m/1")?;
        let viscosity = plasma::number(&steady, "/gas/given/viscosity_pa_s")?;
        let fall = -4.0 * viscosity * AXIS_SPEED / radius.powi(2);
        let mut errors = errors_of(&steady, "even_", &|r| even(r / radius), fall)?;
        // Of the growing viscosity 1e-3 Pa s on the axis; the slope of ln(1 + x^2) is 2x at small x.
        let fall = -4.0 * 1e-3 * AXIS_SPEED / 2.0_f64.ln() / radius.powi(2);
        errors.append(&mut errors_of(&run, "", &|r| growing(r / radius), fall)?);
        let fields = Plasma::read(&run)?;
        Ok(plasma::measurement(run, &fields, spacing, errors))
    }
}

/// Errors in the middle half of the pipe: cells near the ends have other neighbours.
fn errors_of(
    run: &Finished,
    prefix: &str,
    speed: &dyn Fn(f64) -> f64,
    fall: f64,
) -> Result<Errors, LabError> {
    let fields = Plasma::read(run)?;
    let middle: Vec<usize> = (fields.height.len() / 4..3 * fields.height.len() / 4).collect();
    let (low, high) = (middle[0], middle[middle.len() - 1]);
    let along = fields.field("axial_velocity_m_s")?;
    let pressure = fields.field("pressure_pa")?;
    let (mut found, mut exact, mut gradients) = (Vec::new(), Vec::new(), Vec::new());
    for (i, r) in fields.radius.iter().enumerate() {
        found.extend(middle.iter().map(|j| along[fields.at(i, *j)]));
        exact.resize(found.len(), speed(*r));
        let rise = pressure[fields.at(i, high)] - pressure[fields.at(i, low)];
        gradients.push(rise / (fields.height[high] - fields.height[low]));
    }
    let velocity = norms::relative(&found, &exact);
    let gradient = norms::relative(&gradients, &vec![fall; gradients.len()]);
    Ok(Errors::from([
        (format!("{prefix}velocity_l2"), velocity.0),
        (format!("{prefix}velocity_linf"), velocity.1),
        (format!("{prefix}pressure_gradient"), gradient.1),
    ]))
}
