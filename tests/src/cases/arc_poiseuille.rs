//! `arc-poiseuille`: developed flow in a pipe.

use crate::case::{Case, Errors, Measurement, Target};
use crate::lab::{Lab, LabError};
use crate::norms;
use crate::plasma::{self, Plasma};

/// Mean speed of the profile that the scene feeds in \[m/s\].
const MEAN_SPEED: f64 = 1.0;

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
        "Hagen (1839), Poiseuille (1840): w = 2 U (1 - r^2/R^2), dp/dz = -8 mu U / R^2"
    }

    fn targets(&self) -> Vec<Target> {
        plasma::targets(&["velocity_linf", "pressure_gradient"], 5e-3, 1.9)
    }

    fn measure(&self, lab: &Lab, level: u32, _: &str) -> Result<Measurement, LabError> {
        let spacing = 5e-4 / f64::from(1 << (level - 1));
        let grid = serde_json::json!({"grid": {"r": spacing, "z": 2.0 * spacing}});
        let run = lab.run("arcfvm", self.name(), &format!("level{level}"), &grid)?;
        let radius = plasma::number(&run, "/domain/r_m/1")?;
        let viscosity = plasma::number(&run, "/gas/given/viscosity_pa_s")?;
        let fields = Plasma::read(&run)?;
        // Cells near the ends have other neighbours than the flow inside.
        let middle: Vec<usize> = (fields.height.len() / 4..3 * fields.height.len() / 4).collect();
        let (low, high) = (middle[0], middle[middle.len() - 1]);
        let speed = fields.field("axial_velocity_m_s")?;
        let pressure = fields.field("pressure_pa")?;
        let (mut found, mut exact) = (Vec::new(), Vec::new());
        let mut gradients = Vec::new();
        for (i, r) in fields.radius.iter().enumerate() {
            for j in &middle {
                found.push(speed[fields.at(i, *j)]);
                exact.push(2.0 * MEAN_SPEED * (1.0 - (r / radius).powi(2)));
            }
            let rise = pressure[fields.at(i, high)] - pressure[fields.at(i, low)];
            gradients.push(rise / (fields.height[high] - fields.height[low]));
        }
        let fall = vec![-8.0 * viscosity * MEAN_SPEED / radius.powi(2); gradients.len()];
        let velocity = norms::relative(&found, &exact);
        let gradient = norms::relative(&gradients, &fall);
        let errors = Errors::from([
            ("velocity_l2".to_owned(), velocity.0),
            ("velocity_linf".to_owned(), velocity.1),
            ("pressure_gradient".to_owned(), gradient.1),
        ]);
        plasma::measurement(&run, &fields, spacing, errors)
    }
}
