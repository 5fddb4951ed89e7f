//! `arc-potential`: potential and magnetic field of two conducting layers.

use crate::case::{Case, Errors, Measurement, Target};
use crate::lab::{Finished, Lab, LabError};
use crate::plasma::{self, Plasma};
use crate::special::bessel_j;

/// First positive zero of J1, so that nothing flows through the side.
const J1_ZERO: f64 = 3.831_705_970_207_512;
const MU0: f64 = 1.256_637_062_12e-6;

/// The case.
pub(super) struct ArcPotential;

/// The exact solution by separation of variables.
struct Layers {
    /// Thickness of the lower layer and height of both \[m\].
    thickness: f64,
    height: f64,
    /// Conductivity below and above \[S/m\].
    sigma: [f64; 2],
    /// Wave number of the mode \[1/m\].
    k: f64,
    /// Voltages of the upper edge: mean and Bessel mode \[V\].
    modes: [f64; 2],
}

/// Mean and Bessel mode of the upper edge's voltage, by its values on the axis and at the side.
fn modes(run: &Finished) -> Result<[f64; 2], LabError> {
    let side = plasma::number(run, "/domain/r_m/1")?;
    let voltage = |r: f64| plasma::property(run, "/current/edges/top/0/voltage_v", r, 300.0);
    let end = bessel_j(0, J1_ZERO);
    let mode = (voltage(0.0)? - voltage(side)?) / (1.0 - end);
    let mean = voltage(0.0)? - mode;
    let half = mean + mode * bessel_j(0, 0.5 * J1_ZERO);
    if (voltage(0.5 * side)? - half).abs() > 1e-6 * (mean.abs() + mode.abs()) {
        return Err(LabError::Content {
            path: run.artefact.clone(),
            what: "the voltage of its upper edge is no constant and Bessel mode J0(3.83 r/R)"
                .into(),
        });
    }
    Ok([mean, mode])
}

impl Layers {
    fn of(run: &Finished) -> Result<Self, LabError> {
        let ring = "/bodies/plate/shape/ring/z_m/1";
        Ok(Self {
            thickness: plasma::number(run, ring)?,
            height: plasma::number(run, "/domain/z_m/1")?,
            sigma: [
                plasma::number(run, "/bodies/plate/material/electric_conductivity_s_m")?,
                plasma::number(run, "/gas/given/electric_conductivity_s_m")?,
            ],
            k: J1_ZERO / plasma::number(run, "/domain/r_m/1")?,
            modes: modes(run)?,
        })
    }

    fn conductivity(&self, z: f64) -> f64 {
        self.sigma[usize::from(z > self.thickness)]
    }

    /// The linear mode without its scale, and its slope.
    fn linear(&self, z: f64) -> (f64, f64) {
        let above = (z - self.thickness).max(0.0);
        let below = z.min(self.thickness);
        (
            below / self.sigma[0] + above / self.sigma[1],
            1.0 / self.conductivity(z),
        )
    }

    /// The hyperbolic mode without its scale, and its slope.
    fn hyperbolic(&self, z: f64) -> (f64, f64) {
        let (k, h) = (self.k, self.thickness);
        if z <= h {
            return ((k * z).sinh(), k * (k * z).cosh());
        }
        let (value, slope) = (
            (k * h).sinh(),
            (k * h).cosh() * self.sigma[0] / self.sigma[1],
        );
        let x = k * (z - h);
        (
            value * x.cosh() + slope * x.sinh(),
            k * (value * x.sinh() + slope * x.cosh()),
        )
    }

    /// Scales of both modes.
    fn scales(&self) -> [f64; 2] {
        [
            self.modes[0] / self.linear(self.height).0,
            self.modes[1] / self.hyperbolic(self.height).0,
        ]
    }

    fn potential(&self, r: f64, z: f64) -> f64 {
        let [a, b] = self.scales();
        a * self.linear(z).0 + b * bessel_j(0, self.k * r) * self.hyperbolic(z).0
    }

    /// `B = mu0 / r int j_z r dr`.
    fn magnetic(&self, r: f64, z: f64) -> f64 {
        let [a, b] = self.scales();
        let mode = b * self.hyperbolic(z).1 * bessel_j(1, self.k * r) / self.k;
        -MU0 * self.conductivity(z) * (a * self.linear(z).1 * r / 2.0 + mode)
    }
}

impl Case for ArcPotential {
    fn name(&self) -> &'static str {
        "arc-potential"
    }

    fn tool(&self) -> &'static str {
        "arcfvm"
    }

    fn reference(&self) -> &'static str {
        "two layers: piecewise linear mode plus J0(kr) sinh mode, and Ampere's law"
    }

    fn methods(&self) -> &'static [&'static str] {
        &["multigrid", "sor", "incomplete"]
    }

    fn targets(&self) -> Vec<Target> {
        let each = |method: &'static str| {
            let targets = plasma::targets(&["potential_linf", "magnetic_linf"], 5e-3, 1.9);
            targets.into_iter().map(move |target| target.of(method))
        };
        self.methods().iter().copied().flat_map(each).collect()
    }

    fn measure(&self, lab: &Lab, level: u32, method: &str) -> Result<Measurement, LabError> {
        let spacing = 1e-3 / f64::from(1 << (level - 1));
        let patch = serde_json::json!({"grid": {"r": spacing, "z": spacing},
            "iterate": {"solver": method}});
        let label = format!("{method}{level}");
        let run = lab.run("arcfvm", self.name(), &label, &patch)?;
        let exact = Layers::of(&run)?;
        let fields = Plasma::read(&run)?;
        let potential = fields.compare("potential_v", |r, z| exact.potential(r, z))?;
        let magnetic = fields.compare("magnetic_field_t", |r, z| exact.magnetic(r, z))?;
        let errors = Errors::from([
            ("potential_l2".to_owned(), potential.0),
            ("potential_linf".to_owned(), potential.1),
            ("magnetic_l2".to_owned(), magnetic.0),
            ("magnetic_linf".to_owned(), magnetic.1),
        ]);
        Ok(plasma::measurement(run, &fields, spacing, errors))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_exact_current_does_not_jump_at_the_interface() {
        let layers = Layers {
            thickness: 0.008,
            height: 0.02,
            sigma: [8000.0, 2000.0],
            k: J1_ZERO / 0.02,
            modes: [4.0, 2.0],
        };
        for mode in [Layers::linear, Layers::hyperbolic] {
            let (below, above) = (mode(&layers, 0.008), mode(&layers, 0.008 + 1e-12));
            assert!((8000.0 * below.1 / (2000.0 * above.1) - 1.0).abs() < 1e-6);
            assert!((below.0 / above.0 - 1.0).abs() < 1e-6);
        }
        let side = layers.magnetic(0.02, 0.01);
        let [a, _] = layers.scales();
        // The Bessel mode carries no net current.
        assert!((side / (-MU0 * a * 0.01) - 1.0).abs() < 1e-9);
    }
}
