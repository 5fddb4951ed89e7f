//! `em-transient-cylinder`: an axial field is switched on around a conducting cylinder.

use serde_json::json;

use crate::case::{Case, Errors, Measurement, Target};
use crate::em::MU0;
use crate::em::diffusion::Step;
use crate::em::frames::{Points, flux_along, number, number_or};
use crate::heat::frames::greater;
use crate::lab::{Lab, LabError};

/// The case.
pub(super) struct EmTransientCylinder;

impl Case for EmTransientCylinder {
    fn name(&self) -> &'static str {
        "em-transient-cylinder"
    }

    fn tool(&self) -> &'static str {
        "emfield"
    }

    fn reference(&self) -> &'static str {
        "Bessel series, Carslaw and Jaeger (1959), section 7.6"
    }

    fn methods(&self) -> &'static [&'static str] {
        &["default", "adaptive"]
    }

    fn targets(&self) -> Vec<Target> {
        vec![
            Target::error("field_linf", 2e-3),
            Target::order("field_linf", 1.95),
            Target::error("field_linf", 1e-4).of("adaptive"),
            Target::order("field_linf", 1.9).of("adaptive"),
        ]
    }

    fn measure(&self, lab: &Lab, level: u32, method: &str) -> Result<Measurement, LabError> {
        let finer = f64::from(1 << (level.clamp(1, 6) - 1));
        let (step, transient) = if method == "adaptive" {
            // The error of a step falls with its third power.
            let tolerance = 1e-3 / finer.powi(3);
            let adaptive = json!({"tolerance": tolerance});
            (1e-5, json!({"step_s": 1e-5, "adaptive": adaptive}))
        } else {
            let step = 0.004 / finer;
            (step, json!({"step_s": step}))
        };
        let patch = json!({"eddy_currents": {"transient": transient}});
        let label = format!("level{level}-{method}");
        let run = lab.run(self.tool(), self.name(), &label, &patch)?;
        let exact = Step {
            radius: number(&run, "/domain/sphere/radius_m")?,
            conductivity: number(&run, "/surroundings/conductivity_s_m")?,
            permeability: number_or(&run, "/surroundings/relative_permeability", 1.0),
            held: flux_along(&run)? / MU0,
        };
        let points = Points::read(&run)?;
        let field = points.frame.f64("magnetic_field")?;
        let mut linf = 0.0;
        for (p, h) in points.position.iter().zip(&field) {
            let r = p[0].hypot(p[1]).min(exact.radius);
            let far = (h - exact.value(r, points.time)).abs();
            linf = greater(linf, far / exact.held.abs());
        }
        let errors = Errors::from([("field_linf".to_owned(), linf)]);
        // The order is that in time: the step takes the place of the spacing.
        let step = if method == "adaptive" {
            run.closing("step_mean")
        } else {
            step
        };
        Ok(Measurement::of(run, points.count(), step, errors))
    }
}
