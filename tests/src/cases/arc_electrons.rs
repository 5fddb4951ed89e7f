//! `arc-electrons`: enthalpy that electrons carry with the current.

use std::f64::consts::PI;

use crate::case::{Case, Errors, Measurement, Target};
use crate::lab::{Finished, Lab, LabError};
use crate::plasma::{self, Plasma};

/// Enthalpy of an electron over its charge and temperature, 5/2 k/e \[V/K\].
const ENTHALPY: f64 = 2.5 / 11_604.518_12;

/// The case.
pub(super) struct ArcElectrons;

/// `T = first + bend (exp(p z) - 1) + rise z`.
struct Profile {
    first: f64,
    bend: f64,
    /// Of the exponential \[1/m\].
    p: f64,
    /// Of the line \[K/m\].
    rise: f64,
}

impl Profile {
    fn of(run: &Finished) -> Result<Self, LabError> {
        let radius = plasma::number(run, "/domain/r_m/1")?;
        let height = plasma::number(run, "/domain/z_m/1")?;
        let conduction = plasma::number(run, "/gas/given/thermal_conductivity_w_m_k")?;
        let conductivity = plasma::number(run, "/gas/given/electric_conductivity_s_m")?;
        let current = plasma::number(run, "/current/edges/top/0/total_current_a")?;
        let first = plasma::number(run, "/heat/edges/bottom/0/temperature_k")?;
        let last = plasma::number(run, "/heat/edges/top/0/temperature_k")?;
        let density = current / (PI * radius.powi(2));
        let p = ENTHALPY * density / conduction;
        let rise = density / (ENTHALPY * conductivity);
        Ok(Self {
            first,
            bend: (last - first - rise * height) / (p * height).exp_m1(),
            p,
            rise,
        })
    }

    fn temperature(&self, z: f64) -> f64 {
        self.first + self.bend * (self.p * z).exp_m1() + self.rise * z
    }
}

impl Case for ArcElectrons {
    fn name(&self) -> &'static str {
        "arc-electrons"
    }

    fn tool(&self) -> &'static str {
        "arcfvm"
    }

    fn reference(&self) -> &'static str {
        "k T'' - c j T' + j^2/sigma = 0 with c = 5/2 k_B/e between T0 and T1: \
         T = T0 + B (exp(c j z/k) - 1) + j z/(c sigma)"
    }

    fn targets(&self) -> Vec<Target> {
        plasma::targets(&["temperature_l2", "temperature_linf"], 5e-3, 1.9)
    }

    fn measure(&self, lab: &Lab, level: u32, _: &str) -> Result<Measurement, LabError> {
        let spacing = 1e-3 / f64::from(1 << (level - 1));
        let grid = serde_json::json!({"grid": {"z": spacing}});
        let run = lab.run("arcfvm", self.name(), &format!("level{level}"), &grid)?;
        let exact = Profile::of(&run)?;
        let fields = Plasma::read(&run)?;
        let temperature = fields.compare("temperature_k", |_, z| exact.temperature(z))?;
        let errors = Errors::from([
            ("temperature_l2".to_owned(), temperature.0),
            ("temperature_linf".to_owned(), temperature.1),
        ]);
        Ok(plasma::measurement(run, &fields, spacing, errors))
    }
}
