//! `em-sphere-uniform-ac`: a conducting sphere in a uniform alternating field.

use serde_json::json;

use super::em_sphere_loops::{body, flux_error};
use crate::case::{Case, Errors, Measurement, Target};
use crate::em::frames::{Points, number, totals};
use crate::em::sphere::{Solution, Sources};
use crate::lab::{Lab, LabError};

/// The case.
pub(super) struct EmSphereUniformAc;

impl Case for EmSphereUniformAc {
    fn name(&self) -> &'static str {
        "em-sphere-uniform-ac"
    }

    fn tool(&self) -> &'static str {
        "emfield"
    }

    fn reference(&self) -> &'static str {
        "Spherical Bessel functions, Smythe (1950), chapter XI"
    }

    fn targets(&self) -> Vec<Target> {
        vec![
            Target::error("power_volume", 1e-2),
            Target::error("power_poynting", 1e-2),
            Target::error("flux_linf", 1e-2),
        ]
    }

    fn measure(&self, lab: &Lab, level: u32, method: &str) -> Result<Measurement, LabError> {
        let spacing = [5.6e-4, 4e-4, 2.8e-4][level.clamp(1, 3) as usize - 1];
        let layers = json!({"first_m": 0.3 * spacing});
        let patch = json!({"points": {"spacing_m": spacing, "layers": layers}});
        let label = format!("level{level}-{method}");
        let run = lab.run(self.tool(), self.name(), &label, &patch)?;
        let applied = number(&run, "/eddy_currents/applied_flux_density_t/2")?;
        let sources = Sources {
            loops: Vec::new(),
            uniform: applied,
        };
        let exact = Solution::of(body(&run)?, sources);
        let points = Points::read(&run)?;
        let found = totals(&run)?;
        let power = |name: &str| Ok::<_, LabError>((found.get(name)? / exact.power() - 1.0).abs());
        let errors = Errors::from([
            ("power_volume".to_owned(), power("power_volume")?),
            ("power_poynting".to_owned(), power("power_poynting")?),
            (
                "flux_linf".to_owned(),
                flux_error(&points, &exact, f64::INFINITY)? / applied.abs(),
            ),
        ]);
        Ok(Measurement::of(run, points.count(), spacing, errors))
    }
}
