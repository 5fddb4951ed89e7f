//! `arc-evaporation`: a tube at whose bottom metal evaporates.

use std::f64::consts::{PI, TAU};

use artefact::Reader;
use serde_json::Value;

use crate::case::{Case, Errors, Measurement, Target};
use crate::lab::{Finished, Lab, LabError};
use crate::plasma::{self, Plasma};

const MOLAR_GAS: f64 = 8.314_462_618;
/// Unit of saturation pressures, and the pressure of a gas that names none \[Pa\].
const ATMOSPHERE: f64 = 101_325.0;

/// The case.
pub(super) struct ArcEvaporation;

/// The exact tube.
#[derive(Debug, Clone, Copy)]
struct Tube {
    /// Length of the gas \[m\].
    length: f64,
    /// Density times diffusion coefficient \[kg/(m s)\].
    product: f64,
    /// Hertz and Knudsen's factor \[s/m\].
    kinetic: f64,
    /// Saturation pressure \[Pa\].
    saturation: f64,
    /// Pressure of gas and vapour \[Pa\].
    pressure: f64,
    /// Molar mass of the gas \[kg/mol\].
    gas: f64,
    /// Molar mass of the metal \[kg/mol\].
    metal: f64,
    /// Whether the vapour adds to the gas.
    adds: bool,
}

impl Tube {
    fn of(run: &Finished, adds: bool) -> Result<Self, LabError> {
        let number = |path: &str| plasma::number(run, path);
        let t = number("/start/temperature_k")?;
        let law = |key: &str| number(&format!("/bodies/metal/anode/evaporation/{key}"));
        let (a, b) = (law("saturation/a")?, law("saturation/b_k")?);
        let metal = law("molar_mass_kg_mol")?;
        let pressure = run.scene.pointer("/gas/given/pressure_pa");
        Ok(Self {
            length: number("/domain/z_m/1")?,
            product: number("/gas/given/density_kg_m3")?
                * number("/gas/given/iron_diffusion_m2_s")?,
            kinetic: (metal / (TAU * MOLAR_GAS * t)).sqrt(),
            saturation: ATMOSPHERE * 10_f64.powf(a - b / t),
            pressure: pressure.and_then(Value::as_f64).unwrap_or(ATMOSPHERE),
            gas: number("/gas/given/molar_mass_kg_mol")?,
            metal,
            adds,
        })
    }

    /// Flux through the gas where the surface has the mass fraction `y` \[kg/(m2 s)\].
    fn flux(&self, y: f64) -> f64 {
        let drop = if self.adds { -(-y).ln_1p() } else { y };
        self.product / self.length * drop
    }

    /// Mass fraction at the surface, at which metal and gas let through as much: by halving.
    fn surface(&self) -> f64 {
        let mole = |y: f64| (y / self.metal) / (y / self.metal + (1.0 - y) / self.gas);
        let (mut low, mut high) = (0.0, 1.0);
        for _ in 0..200 {
            let y = 0.5 * (low + high);
            if self.kinetic * (self.saturation - mole(y) * self.pressure) > self.flux(y) {
                low = y;
            } else {
                high = y;
            }
        }
        low
    }

    fn iron(&self, z: f64) -> f64 {
        let (surface, part) = (self.surface(), 1.0 - z / self.length);
        if z < 0.0 {
            0.0
        } else if self.adds {
            1.0 - (1.0 - surface).powf(part)
        } else {
            surface * part
        }
    }

    /// Errors of profile and flux of one run, each name with `prefix`.
    fn errors(&self, run: &Finished, prefix: &str) -> Result<Errors, LabError> {
        let profile = Plasma::read(run)?.compare("iron_mass_fraction", |_, z| self.iron(z))?;
        let balance = Reader::open_kind(&run.artefact, "arc-source", 1)?.record("/balance")?;
        let area = PI * plasma::number(run, "/domain/r_m/1")?.powi(2);
        let flux = balance.get("iron_surfaces_kg_s")? / area;
        Ok(Errors::from([
            (format!("{prefix}iron_linf"), profile.1),
            (
                format!("{prefix}flux"),
                (flux / self.flux(self.surface()) - 1.0).abs(),
            ),
            (
                format!("{prefix}iron_lost"),
                balance.get("iron_closure")?.abs(),
            ),
        ]))
    }
}

impl Case for ArcEvaporation {
    fn name(&self) -> &'static str {
        "arc-evaporation"
    }

    fn tool(&self) -> &'static str {
        "arcfvm"
    }

    fn reference(&self) -> &'static str {
        "Stefan (1873) in series with Hertz and Knudsen: 1 - Y = (1 - Ys)^(1 - z/L), J = K (p0 - xs p)"
    }

    fn targets(&self) -> Vec<Target> {
        let mut targets = plasma::targets(&["iron_linf", "flux"], 1e-3, 1.9);
        targets.push(Target::error("iron_lost", 1e-8));
        for quantity in [
            "exchanged_iron_linf",
            "exchanged_flux",
            "exchanged_iron_lost",
        ] {
            targets.push(Target::error(quantity, 1e-8));
        }
        targets
    }

    fn measure(&self, lab: &Lab, level: u32, _: &str) -> Result<Measurement, LabError> {
        let spacing = 5e-4 / f64::from(1 << (level - 1));
        let grid = serde_json::json!({"z": spacing});
        let added = serde_json::json!({"grid": grid.clone()});
        let exchanged = serde_json::json!({"grid": grid, "vapour": {"mass": "exchanged"}});
        let run = lab.run("arcfvm", self.name(), &format!("level{level}"), &added)?;
        let mut errors = Tube::of(&run, true)?.errors(&run, "")?;
        let label = format!("exchanged{level}");
        let other = lab.run("arcfvm", self.name(), &label, &exchanged)?;
        errors.append(&mut Tube::of(&other, false)?.errors(&other, "exchanged_")?);
        let fields = Plasma::read(&run)?;
        Ok(plasma::measurement(run, &fields, spacing, errors))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tube(adds: bool) -> Tube {
        Tube {
            length: 0.01,
            product: 2e-3,
            kinetic: 6e-4,
            saturation: 4e4,
            pressure: ATMOSPHERE,
            gas: 0.04,
            metal: 0.055_845,
            adds,
        }
    }

    #[test]
    fn the_profile_carries_one_flux() {
        for adds in [false, true] {
            let (tube, h) = (tube(adds), 1e-6);
            for z in [0.001, 0.005, 0.009] {
                let slope = (tube.iron(z + h) - tube.iron(z - h)) / (2.0 * h);
                let blown = if adds { 1.0 - tube.iron(z) } else { 1.0 };
                let flux = -tube.product * slope / blown;
                assert!((flux / tube.flux(tube.surface()) - 1.0).abs() < 1e-8);
            }
        }
    }

    #[test]
    fn the_surface_is_below_saturation_and_close_to_it() {
        let tube = tube(true);
        let y = tube.surface();
        let mole = (y / tube.metal) / (y / tube.metal + (1.0 - y) / tube.gas);
        let part = mole * tube.pressure / tube.saturation;
        assert!(part < 1.0 && part > 0.98, "{part}");
    }
}
