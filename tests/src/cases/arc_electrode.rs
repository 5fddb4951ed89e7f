//! `arc-electrode`: how warm the surfaces of a fed wire and of a cathode are.

use artefact::Reader;
use serde_json::json;

use crate::case::{Case, Errors, Measurement, Target};
use crate::lab::{Finished, Lab, LabError};
use crate::plasma::{self, Plasma};

/// Stefan-Boltzmann constant \[W/(m2 K4)\].
const STEFAN_BOLTZMANN: f64 = 5.670_374_419e-8;
/// Charge of the electron over Boltzmann's constant \[K/V\].
const KELVIN_PER_VOLT: f64 = 11_604.518_12;
/// Temperature of the surroundings \[K\].
const AROUND_K: f64 = 300.0;

/// The case.
pub(super) struct ArcElectrode;

/// Gas between a wire and a base, all of them one-dimensional.
struct Exact {
    /// Area \[m2\] and current density \[A/m2\].
    area: f64,
    current: f64,
    /// Gas: conductivity over its thickness \[W/(m2 K)\].
    gas: f64,
    /// Base: conductivity over its thickness, temperature below, emissivity, work function, ionisation voltage and
    /// Richardson's constant.
    base: [f64; 6],
    /// Wire: heat that its tip takes on by the kelvin \[W/(m2 K)\], temperature above, emissivity, work function.
    wire: [f64; 4],
}

impl Exact {
    fn of(run: &Finished) -> Result<Self, LabError> {
        let number = |path: &str| plasma::number(run, path);
        let base = |name: &str| number(&format!("/bodies/base/{name}"));
        let wire = |name: &str| number(&format!("/bodies/wire/{name}"));
        let area = std::f64::consts::PI * number("/domain/r_m/1")?.powi(2);
        let (low, top, tip, end) = (
            number("/domain/z_m/0")?,
            base("shape/ring/z_m/1")?,
            wire("shape/ring/z_m/0")?,
            number("/domain/z_m/1")?,
        );
        let kappa = wire("material/thermal_conductivity_w_m_k")?;
        let fed = wire("material/density_kg_m3")?
            * wire("material/specific_heat_j_kg_k")?
            * wire("feed/speed_m_s")?;
        Ok(Self {
            area,
            current: number("/current/edges/top/0/total_current_a")? / area,
            gas: number("/gas/given/thermal_conductivity_w_m_k")? / (tip - top),
            base: [
                base("material/thermal_conductivity_w_m_k")? / (top - low),
                number("/heat/edges/bottom/0/temperature_k")?,
                base("cathode/emissivity")?,
                base("cathode/work_function_v")?,
                base("cathode/ionisation_voltage_v")?,
                base("cathode/richardson_a_m2_k2")?,
            ],
            // What crosses the tip has warmed on its way: rho c v (T - T0) and the rest of the layer at the guide.
            wire: [
                fed / -(-(end - tip) * fed / kappa).exp_m1(),
                number("/heat/edges/top/0/temperature_k")?,
                wire("anode/emissivity")?,
                wire("anode/work_function_v")?,
            ],
        })
    }

    fn shine(emissivity: f64, t: f64) -> f64 {
        emissivity * STEFAN_BOLTZMANN * (t.powi(4) - AROUND_K.powi(4))
    }

    /// Heat that the base lacks at `base`, the tip being at `wire` \[W/m2\]; falls with the first.
    fn base_lacks(&self, base: f64, wire: f64) -> f64 {
        let [through, below, emissivity, work, ionisation, richardson] = self.base;
        let emitted = richardson * base * base * (-work * KELVIN_PER_VOLT / base).exp();
        let emitted = emitted.min(self.current);
        let ions = (self.current - emitted) * ionisation;
        let gas = self.gas * (wire - base);
        gas + ions - emitted * work - Self::shine(emissivity, base) - through * (base - below)
    }

    /// Heat that the tip lacks; falls with `wire`.
    fn wire_lacks(&self, base: f64, wire: f64) -> f64 {
        let [takes, above, emissivity, work] = self.wire;
        let gas = self.gas * (base - wire);
        gas + self.current * work - Self::shine(emissivity, wire) - takes * (wire - above)
    }

    /// Temperatures of both surfaces \[K\].
    fn surfaces(&self) -> [f64; 2] {
        let base_at = |wire: f64| zero(|base| self.base_lacks(base, wire));
        let wire = zero(|wire| self.wire_lacks(base_at(wire), wire));
        [base_at(wire), wire]
    }

    /// Temperature of a surface that gives off `power` \[W\].
    fn shining(&self, emissivity: f64, power: f64) -> f64 {
        let flux = power / (self.area * emissivity * STEFAN_BOLTZMANN);
        (flux + AROUND_K.powi(4)).sqrt().sqrt()
    }
}

/// Zero of a falling function of a temperature.
fn zero(of: impl Fn(f64) -> f64) -> f64 {
    let (mut low, mut high) = (1.0, 2e4);
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        if of(middle) > 0.0 {
            low = middle;
        } else {
            high = middle;
        }
    }
    0.5 * (low + high)
}

impl Case for ArcElectrode {
    fn name(&self) -> &'static str {
        "arc-electrode"
    }

    fn tool(&self) -> &'static str {
        "arcfvm"
    }

    fn reference(&self) -> &'static str {
        "both surfaces from k (T_s - T_0)/L = k_g (T_w - T_s)/L_g + (j - j_e) V_i - j_e phi - eps sigma T_s^4 at the base and \
         rho c v (T_w - T_0) = j phi - k_g (T_w - T_s)/L_g - eps sigma T_w^4 at the tip"
    }

    fn methods(&self) -> &'static [&'static str] {
        &["surface", "centre"]
    }

    fn targets(&self) -> Vec<Target> {
        vec![
            Target::error("base", 1e-7).at_level(1),
            Target::error("tip", 1e-7).at_level(1),
            Target::error("base", 1e-7),
            Target::error("tip", 1e-7),
            Target::error("closure", 1e-9),
            // The middle of its cell is colder than the surface by half a cell of conduction.
            Target::order("base", 0.9).of("centre"),
        ]
    }

    fn measure(&self, lab: &Lab, level: u32, method: &str) -> Result<Measurement, LabError> {
        let spacing = 4e-4 / f64::from(1 << (level - 1));
        let patch = json!({"grid": {"z": spacing}, "heat": {"electrode_at": method}});
        let run = lab.run("arcfvm", self.name(), &format!("{method}{level}"), &patch)?;
        let exact = Exact::of(&run)?;
        let balance = Reader::open_kind(&run.artefact, "arc-source", 1)?.record("/balance")?;
        let [base, wire] = exact.surfaces();
        let mut errors = Errors::new();
        for (name, body, emissivity, expected) in [
            ("base", "base", exact.base[2], base),
            ("tip", "wire", exact.wire[2], wire),
        ] {
            let found = exact.shining(emissivity, -balance.get(&format!("{body}_emission_w"))?);
            errors.insert(name.to_owned(), (found / expected - 1.0).abs());
        }
        errors.insert("closure".to_owned(), balance.get("closure")?.abs());
        let fields = Plasma::read(&run)?;
        Ok(plasma::measurement(run, &fields, spacing, errors))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn surfaces_without_current_lie_between_both_ends() {
        let exact = Exact {
            area: 1.0,
            current: 0.0,
            gas: 100.0,
            base: [100.0, 900.0, 0.0, 4.0, 8.0, 1e6],
            wire: [100.0, 300.0, 0.0, 4.0],
        };
        // Three resistances alike, but for what a base of 700 K emits without any current: nothing.
        let [base, wire] = exact.surfaces();
        assert!(
            (base - 700.0).abs() < 1e-9 && (wire - 500.0).abs() < 1e-9,
            "{base} {wire}"
        );
    }

    #[test]
    fn what_shines_tells_its_temperature() {
        let exact = Exact {
            area: 2.0,
            current: 0.0,
            gas: 0.0,
            base: [0.0; 6],
            wire: [0.0; 4],
        };
        let found = exact.shining(0.4, 2.0 * Exact::shine(0.4, 2345.6));
        assert!((found - 2345.6).abs() < 1e-9);
    }
}
