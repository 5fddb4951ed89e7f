//! `arc-poiseuille`: developed flow in a pipe, of an even viscosity and of one that grows outward.

use serde_json::json;

use crate::case::{Case, Errors, Measurement, Target};
use crate::lab::{Finished, Lab, LabError};
use crate::norms;
use crate::plasma::{self, Plasma};

/// A viscosity `mu (1 + x^2)`, `x = r/R`: the integral of `dw/dr = (dp/dz) r / (2 mu (1 + x^2))` over
/// the speed on the axis.
fn growing(x: f64) -> f64 {
    1.0 - (x * x).ln_1p() / 2.0_f64.ln()
}

/// An even viscosity.
fn even(x: f64) -> f64 {
    1.0 - x * x
}

/// What both runs share.
struct Pipe {
    /// \[m\].
    radius: f64,
    /// Speed on the axis \[m/s\].
    axis: f64,
    /// Viscosity there \[Pa s\].
    viscosity: f64,
}

impl Pipe {
    fn of(run: &Finished) -> Result<Self, LabError> {
        let radius = plasma::number(run, "/domain/r_m/1")?;
        let inflow = |r| plasma::property(run, "/flow/edges/bottom/0/velocity_m_s/1", r, 300.0);
        let axis = inflow(0.0)?;
        if (inflow(0.5 * radius)? / axis - even(0.5)).abs() > 1e-9 {
            return Err(LabError::Content {
                path: run.artefact.clone(),
                what: "its gas does not come in developed, as w0 (1 - r^2/R^2)".to_owned(),
            });
        }
        let viscosity = plasma::number(run, "/gas/given/viscosity_pa_s")?;
        Ok(Self {
            radius,
            axis,
            viscosity,
        })
    }

    /// The same flow through a viscosity that grows outward.
    fn growing(&self) -> serde_json::Value {
        let Self {
            radius,
            axis,
            viscosity,
        } = self;
        json!({
            "gas": {"given": {"viscosity_pa_s":
                {"expr": format!("{viscosity}*(1 + (r/{radius})^2)")}}},
            "flow": {"edges": {"bottom": [{"velocity_m_s":
                [0, {"expr": format!("{axis}*(1 - ln(1 + (r/{radius})^2)/ln(2))")}]}]}},
        })
    }
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
        let pipe = Pipe::of(&steady)?;
        let run = lab.varied(&steady, &format!("growing{level}"), &pipe.growing())?;
        let fall = -4.0 * pipe.viscosity * pipe.axis / pipe.radius.powi(2);
        let pipe = &pipe;
        let speed = |shape: fn(f64) -> f64| move |r: f64| pipe.axis * shape(r / pipe.radius);
        let mut errors = errors_of(&steady, "even_", &speed(even), fall)?;
        // The slope of ln(1 + x^2) is 2x at small x.
        let fall = fall / 2.0_f64.ln();
        errors.append(&mut errors_of(&run, "", &speed(growing), fall)?);
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
