//! `arc-vapour`: a manufactured vapour in a flow that follows it.

use serde_json::Value;

use crate::case::{Case, Errors, Measurement, Target};
use crate::lab::{Lab, LabError, read_json};
use crate::plasma::{self, Plasma};

/// The case.
pub(super) struct ArcVapour;

fn iron(r: f64, z: f64) -> f64 {
    0.3 + r * r * (1.0 - z.powi(3)) / 5.0
}

/// From the stream function `r^2 (2 - r^2) (1 + z^2) / 4` of the mass flux.
fn velocity(r: f64, z: f64) -> [f64; 2] {
    let volume = (1.0 + iron(r, z)) / 2.0;
    let radial = -r * (2.0 - r * r) * z / 2.0;
    let axial = (1.0 - r * r) * (1.0 + z * z);
    [volume * radial, volume * axial]
}

fn pressure(r: f64, z: f64) -> f64 {
    2.0 * r * r * z * z
}

impl Case for ArcVapour {
    fn name(&self) -> &'static str {
        "arc-vapour"
    }

    fn tool(&self) -> &'static str {
        "arcfvm"
    }

    fn reference(&self) -> &'static str {
        "manufactured polynomials of Y, u, p with properties that follow Y (Roache 2002)"
    }

    fn targets(&self) -> Vec<Target> {
        let central = [
            "iron_l2",
            "radial_velocity_l2",
            "axial_velocity_l2",
            "pressure_l2",
        ];
        let mut targets = plasma::targets(&central, 5e-3, 1.9);
        targets.push(Target::order("upwind_iron_l2", 0.9));
        targets
    }

    fn measure(&self, lab: &Lab, level: u32, _: &str) -> Result<Measurement, LabError> {
        let spacing = 0.1 / f64::from(1 << (level - 1));
        let grid = serde_json::json!({"r": spacing, "z": spacing});
        let folder = lab.root.join("pipelines/verify").join(self.name());
        let mut upwind: Value = read_json(&folder.join("upwind.patch.json"))?;
        upwind["grid"] = grid.clone();
        let central = serde_json::json!({ "grid": grid });
        let run = lab.run("arcfvm", self.name(), &format!("level{level}"), &central)?;
        let fields = Plasma::read(&run)?;
        let radial = |r, z| velocity(r, z)[0];
        let axial = |r, z| velocity(r, z)[1];
        let iron_error = fields.compare("iron_mass_fraction", iron)?;
        let radial = fields.compare("radial_velocity_m_s", radial)?;
        let axial = fields.compare("axial_velocity_m_s", axial)?;
        let pressure = fields.compare_shifted("pressure_pa", pressure)?;
        let other = lab.run("arcfvm", self.name(), &format!("upwind{level}"), &upwind)?;
        let upwind = Plasma::read(&other)?.compare("iron_mass_fraction", iron)?;
        let found = [
            ("iron", iron_error),
            ("radial_velocity", radial),
            ("axial_velocity", axial),
            ("pressure", pressure),
            ("upwind_iron", upwind),
        ];
        let mut errors = Errors::new();
        for (name, (l2, linf)) in found {
            errors.insert(format!("{name}_l2"), l2);
            errors.insert(format!("{name}_linf"), linf);
        }
        Ok(plasma::measurement(run, &fields, spacing, errors))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_mass_flux_is_free_of_divergence() {
        let flux = |r: f64, z: f64| velocity(r, z).map(|u| u * 2.0 / (1.0 + iron(r, z)));
        let (r, z, h) = (0.6, 0.4, 1e-5);
        let radial = ((r + h) * flux(r + h, z)[0] - (r - h) * flux(r - h, z)[0]) / (2.0 * h * r);
        let axial = (flux(r, z + h)[1] - flux(r, z - h)[1]) / (2.0 * h);
        assert!((radial + axial).abs() < 1e-8);
    }
}
