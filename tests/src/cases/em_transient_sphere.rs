//! `em-transient-sphere`: a uniform field is switched on around a conducting sphere, computed about its axis.

use serde_json::json;

use crate::case::{Case, Errors, Measurement, Target};
use crate::em::frames::{Points, flux_along, number};
use crate::em::switched::Switched;
use crate::heat::frames::greater;
use crate::lab::{Lab, LabError};

/// The case.
pub(super) struct EmTransientSphere;

impl Case for EmTransientSphere {
    fn name(&self) -> &'static str {
        "em-transient-sphere"
    }

    fn tool(&self) -> &'static str {
        "emfield"
    }

    fn reference(&self) -> &'static str {
        "Series of modes of free decay, after Landau and Lifshitz (1960), section 45"
    }

    fn targets(&self) -> Vec<Target> {
        vec![
            Target::error("potential_linf", 2e-3),
            Target::error("flux_linf", 5e-3),
            Target::order("potential_linf", 1.95),
            Target::order("flux_linf", 1.95),
        ]
    }

    fn measure(&self, lab: &Lab, level: u32, method: &str) -> Result<Measurement, LabError> {
        let step = 3.2e-6 / f64::from(1 << (level.clamp(1, 6) - 1));
        let patch = json!({"eddy_currents": {"transient": {"step_s": step}}});
        let label = format!("level{level}-{method}");
        let run = lab.run(self.tool(), self.name(), &label, &patch)?;
        let exact = Switched {
            radius: number(&run, "/bodies/0/shape/disc/radius_m")?,
            conductivity: number(&run, "/bodies/0/conductivity_s_m")?,
            flux: flux_along(&run)?,
            rise: None,
        };
        let points = Points::read(&run)?;
        let potential = points.frame.vectors("vector_potential")?;
        let flux = points.frame.vectors("magnetic_flux_density")?;
        let [mut a, mut b] = [0.0; 2];
        for (i, p) in points.position.iter().enumerate() {
            let wanted = exact.potential(p[0], p[2], points.time);
            let far = (potential[i][1] - wanted).abs();
            a = greater(a, far / (exact.flux.abs() * exact.radius));
            let [away, along] = exact.field(p[0], p[2], points.time);
            let far = (flux[i][0] - away).hypot(flux[i][2] - along);
            b = greater(b, far / exact.flux.abs());
        }
        let errors = Errors::from([
            ("potential_linf".to_owned(), a),
            ("flux_linf".to_owned(), b),
        ]);
        // The order is that in time: the step takes the place of the spacing.
        Ok(Measurement::of(run, points.count(), step, errors))
    }
}
