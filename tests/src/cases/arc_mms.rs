//! `arc-mms`: a manufactured solution of all fields at once.

use serde_json::Value;

use crate::case::{Case, Errors, Measurement, Target};
use crate::lab::{Lab, LabError, read_json};
use crate::plasma::{self, Plasma};

const MU0: f64 = 1.256_637_062_12e-6;

/// The case.
pub(super) struct ArcMms;

fn temperature(r: f64, z: f64) -> f64 {
    1000.0 + 100.0 * r * r * (1.0 - z.powi(3))
}

/// From the stream function `r^2 (2 - r^2) (1 + z^2) / 4` of the mass flux.
fn velocity(r: f64, z: f64) -> [f64; 2] {
    let volume = temperature(r, z) / 1000.0;
    let radial = -r * (2.0 - r * r) * z / 2.0;
    let axial = (1.0 - r * r) * (1.0 + z * z);
    [volume * radial, volume * axial]
}

fn pressure(r: f64, z: f64) -> f64 {
    2.0 * r * r * z * z
}

fn potential(r: f64, z: f64) -> f64 {
    z + r.powi(4) * z * z / 10.0
}

/// `mu0 / r int j_z r dr` with `j_z = -T (1 + r^4 z / 5)`.
fn magnetic(r: f64, z: f64) -> f64 {
    let g = 100.0 * (1.0 - z.powi(3));
    let even = 500.0 * r * r + g * r.powi(4) / 4.0;
    let mode = z / 5.0 * (1000.0 * r.powi(6) / 6.0 + g * r.powi(8) / 8.0);
    -MU0 * (even + mode) / r
}

/// Relative errors of every field of one run, each name with `prefix`.
fn errors_of(fields: &Plasma, prefix: &str) -> Result<Errors, LabError> {
    let radial = |r, z| velocity(r, z)[0];
    let axial = |r, z| velocity(r, z)[1];
    let found = [
        ("temperature", fields.compare("temperature_k", temperature)?),
        (
            "radial_velocity",
            fields.compare("radial_velocity_m_s", radial)?,
        ),
        (
            "axial_velocity",
            fields.compare("axial_velocity_m_s", axial)?,
        ),
        ("pressure", fields.compare_shifted("pressure_pa", pressure)?),
        ("potential", fields.compare("potential_v", potential)?),
        ("magnetic", fields.compare("magnetic_field_t", magnetic)?),
    ];
    let mut errors = Errors::new();
    for (name, (l2, linf)) in found {
        errors.insert(format!("{prefix}{name}_l2"), l2);
        errors.insert(format!("{prefix}{name}_linf"), linf);
    }
    Ok(errors)
}

impl Case for ArcMms {
    fn name(&self) -> &'static str {
        "arc-mms"
    }

    fn tool(&self) -> &'static str {
        "arcfvm"
    }

    fn reference(&self) -> &'static str {
        "manufactured polynomials of T, u, p, phi with variable properties (Roache 2002)"
    }

    fn targets(&self) -> Vec<Target> {
        let central = [
            "temperature_l2",
            "radial_velocity_l2",
            "axial_velocity_l2",
            "pressure_l2",
            "potential_l2",
            "magnetic_l2",
        ];
        let upwind = [
            "upwind_temperature_l2",
            "upwind_radial_velocity_l2",
            "upwind_axial_velocity_l2",
            "upwind_pressure_l2",
            "upwind_potential_l2",
            "upwind_magnetic_l2",
        ];
        let mut targets = plasma::targets(&central, 5e-3, 1.9);
        targets.extend(plasma::targets(&upwind, 5e-3, 1.0));
        targets
    }

    fn measure(&self, lab: &Lab, level: u32, _: &str) -> Result<Measurement, LabError> {
        let spacing = 0.1 / f64::from(1 << (level - 1));
        let grid = serde_json::json!({"r": spacing, "z": spacing});
        let folder = lab.root.join("pipelines/verify").join(self.name());
        let mut upwind: Value = read_json(&folder.join("upwind.patch.json"))?;
        // The upwind branch shows its order only on finer grids.
        upwind["grid"] = serde_json::json!({"r": spacing / 4.0, "z": spacing / 4.0});
        let central = serde_json::json!({ "grid": grid });
        let run = lab.run("arcfvm", self.name(), &format!("level{level}"), &central)?;
        let fields = Plasma::read(&run)?;
        let mut errors = errors_of(&fields, "")?;
        let other = lab.run("arcfvm", self.name(), &format!("upwind{level}"), &upwind)?;
        errors.append(&mut errors_of(&Plasma::read(&other)?, "upwind_")?);
        Ok(plasma::measurement(run, &fields, spacing, errors))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_mass_flux_is_free_of_divergence() {
        let flux = |r: f64, z: f64| velocity(r, z).map(|u| u * 1000.0 / temperature(r, z));
        let (r, z, h) = (0.6, 0.4, 1e-5);
        let radial = ((r + h) * flux(r + h, z)[0] - (r - h) * flux(r - h, z)[0]) / (2.0 * h * r);
        let axial = (flux(r, z + h)[1] - flux(r, z - h)[1]) / (2.0 * h);
        assert!((radial + axial).abs() < 1e-8);
    }

    #[test]
    fn the_magnetic_field_obeys_the_law_of_ampere() {
        let (r, z, h) = (0.6, 0.4, 1e-5);
        let curl = ((r + h) * magnetic(r + h, z) - (r - h) * magnetic(r - h, z)) / (2.0 * h * r);
        let slope = (potential(r, z + h) - potential(r, z - h)) / (2.0 * h);
        let density = -temperature(r, z) * slope;
        assert!((curl / (MU0 * density) - 1.0).abs() < 1e-6);
    }
}
