//! `arc-wire-joule`: a fed wire that its current heats.

use std::f64::consts::PI;

use artefact::Reader;
use serde_json::json;

use crate::case::{Case, Errors, Measurement, Target};
use crate::lab::{Finished, Lab, LabError};
use crate::plasma::{self, Plasma};

/// The case.
pub(super) struct ArcWireJoule;

/// The exact wire: Joule heat, conduction and feed, warm as its guide above and losing by
/// conduction nothing below.
struct Wire {
    /// Height of the tip and of the guide \[m\].
    tip: f64,
    guide: f64,
    /// Temperature at the guide \[K\].
    start: f64,
    /// Slope far from the tip \[K/m\].
    slope: f64,
    /// Conductivity over heat capacity fed \[m\].
    reach: f64,
    /// Voltage over the wire \[V\].
    voltage: f64,
}

impl Wire {
    fn of(run: &Finished) -> Result<Self, LabError> {
        let number = |path: &str| plasma::number(run, path);
        let material = "/bodies/wire/material";
        let of = |name: &str| plasma::number(run, &format!("{material}/{name}"));
        let (tip, guide) = (
            number("/bodies/wire/shape/ring/z_m/0")?,
            number("/bodies/wire/shape/ring/z_m/1")?,
        );
        let section = PI * number("/bodies/wire/shape/ring/r_m/1")?.powi(2);
        let current = number("/current/edges/top/0/total_current_a")?;
        let sigma = of("electric_conductivity_s_m")?;
        let fed = of("density_kg_m3")?
            * of("specific_heat_j_kg_k")?
            * number("/bodies/wire/feed/speed_m_s")?;
        Ok(Self {
            tip,
            guide,
            start: number("/heat/edges/top/0/temperature_k")?,
            slope: (current / section).powi(2) / sigma / fed,
            reach: of("thermal_conductivity_w_m_k")? / fed,
            voltage: current * (guide - tip) / (sigma * section),
        })
    }

    fn temperature(&self, z: f64) -> f64 {
        let length = self.guide - self.tip;
        let along = (self.guide - z).clamp(0.0, length);
        let layer = ((along - length) / self.reach).exp() - (-length / self.reach).exp();
        self.start + self.slope * (along - self.reach * layer)
    }
}

impl Case for ArcWireJoule {
    fn name(&self) -> &'static str {
        "arc-wire-joule"
    }

    fn tool(&self) -> &'static str {
        "arcfvm"
    }

    fn reference(&self) -> &'static str {
        "k T'' - rho c v T' + j^2/sigma = 0 along the feed, T = T0 at the guide, T' = 0 at the tip"
    }

    fn targets(&self) -> Vec<Target> {
        let mut all = plasma::targets(&["temperature_linf"], 1e-4, 1.9);
        all.push(Target::error("voltage", 1e-6));
        all
    }

    fn measure(&self, lab: &Lab, level: u32, _: &str) -> Result<Measurement, LabError> {
        let spacing = 1e-4 / f64::from(1 << (level - 1));
        let grid = json!({"grid": {"z": spacing}});
        let run = lab.run("arcfvm", self.name(), &format!("level{level}"), &grid)?;
        let exact = Wire::of(&run)?;
        let fields = Plasma::read(&run)?;
        let temperature = fields.compare("temperature_k", |_, z| exact.temperature(z))?;
        let balance = Reader::open_kind(&run.artefact, "arc-source", 1)?.record("/balance")?;
        let voltage = balance.get("voltage_column_v")?;
        let errors = Errors::from([
            ("temperature_l2".to_owned(), temperature.0),
            ("temperature_linf".to_owned(), temperature.1),
            ("voltage".to_owned(), (voltage / exact.voltage - 1.0).abs()),
        ]);
        Ok(plasma::measurement(run, &fields, spacing, errors))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_exact_wire_holds_its_equation() {
        let wire = Wire {
            tip: 0.001,
            guide: 0.011,
            start: 300.0,
            slope: 1.5e5,
            reach: 2e-3,
            voltage: 0.0,
        };
        let h = 1e-5;
        for z in [0.0015, 0.004, 0.0105] {
            let [below, here, above] = [z - h, z, z + h].map(|z| wire.temperature(z));
            // Along the feed, which is downward.
            let first = (below - above) / (2.0 * h);
            let second = (below - 2.0 * here + above) / (h * h);
            let rest = wire.reach * second - first + wire.slope;
            assert!(rest.abs() < 1e-4 * wire.slope, "{z}: {rest}");
        }
        assert!((wire.temperature(0.011) - 300.0).abs() < 1e-9);
        let tip = wire.temperature(0.001 + h) - wire.temperature(0.001);
        assert!(tip.abs() < 1e-2 * wire.slope * h);
    }
}
