//! What the gas loses by light: net emission `4 pi eps` of a state, W/m3.
//!
//! In local thermodynamic equilibrium a line of a species with n particles per volume and partition function Q gives
//! off `n/Q g_u A h nu exp(-E_u/kT)`. In an optically thin gas that is all: the sum over lines and the continuum of
//! free electrons. With an absorption length R the gas is seen from the centre of a homogeneous sphere of radius R
//! (Lowke 1974, J. Quant. Spectrosc. Radiat. Transfer 14, 111): each line leaves by its [`escape::factor`], with a
//! Voigt profile of Doppler and collision [`width`], the absorption integrated over the line being
//! `K = lambda^2/(8 pi) g_u A n/Q (exp(-E_l/kT) - exp(-E_u/kT))` (Kirchhoff). Resonance lines in the far ultraviolet
//! are absorbed by this model, not by an assumption.
//!
//! Neglected: overlap of lines (each is alone: an upper bound of what leaves), bands of molecules (CO, C2, FeO; no
//! data), lines of ions beyond the first, free-bound light below 200 nm.

use serde_json::Value;

use crate::constants::{BOLTZMANN, LIGHT_SPEED, PLANCK};
use crate::mixture::{Kind, Species};

pub mod continuum;
pub mod escape;
pub mod lines;
pub mod voigt;
pub mod width;

use lines::{Line, Spectrum};
use width::Disturbance;

/// The strongest lines of each species: wavelength, energies, weight, transition rate.
const LINES: &str = include_str!("../../data/lines.json");

/// What is wrong with the data of radiation.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum RadiationError {
    /// Something is missing or is no number.
    #[error("radiation data: cannot read {0}")]
    Data(String),
}

/// Parts of `4 pi eps`, W/m3.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Emission {
    /// Lines known one by one.
    pub lines: f64,
    /// Lines known in lumps.
    pub lumps: f64,
    /// Continuum above 200 nm.
    pub continuum: f64,
}

impl Emission {
    /// The sum.
    #[must_use]
    pub fn total(&self) -> f64 {
        self.lines + self.lumps + self.continuum
    }
}

/// A species that emits lines.
#[derive(Debug, Clone)]
struct Emitter {
    /// Its place among the species.
    place: usize,
    spectrum: Spectrum,
    /// Weight of the ground level.
    ground: f64,
}

/// Radiation of a mixture.
#[derive(Debug, Clone)]
pub struct Radiation {
    emitters: Vec<Emitter>,
}

impl Radiation {
    /// The lines of `species` from the data (`data` is the whole of `species.json`).
    ///
    /// # Errors
    /// What in the data cannot be read.
    pub fn new(data: &Value, species: &[Species]) -> Result<Self, RadiationError> {
        let list: Value =
            serde_json::from_str(LINES).map_err(|e| RadiationError::Data(e.to_string()))?;
        let mut emitters = Vec::new();
        for (place, one) in species.iter().enumerate() {
            if let Some(spectrum) = lines::spectrum(&one.name, data, &list)? {
                let ground = data["species"][&one.name]["levels_eV_g"][0][1]
                    .as_f64()
                    .unwrap_or(1.0);
                emitters.push(Emitter {
                    place,
                    spectrum,
                    ground,
                });
            }
        }
        Ok(Self { emitters })
    }

    /// Names of species that emit lines, and how many lines of each are known one by one.
    pub fn emitters<'a>(
        &'a self,
        species: &'a [Species],
    ) -> impl Iterator<Item = (&'a str, usize)> {
        self.emitters
            .iter()
            .map(|e| (species[e.place].name.as_str(), e.spectrum.listed))
    }

    /// `4 pi eps` at `t` K with `number` particles of each species \[1/m3\]; `length` is the absorption length R \[m\],
    /// absent in an optically thin gas.
    #[must_use]
    pub fn net_emission(
        &self,
        species: &[Species],
        t: f64,
        number: &[f64],
        length: Option<f64>,
    ) -> Emission {
        let mut sum = Emission::default();
        for emitter in &self.emitters {
            let own = &species[emitter.place];
            let per_state = number[emitter.place] * (-own.internal(t).ln_partition).exp();
            let gas = Surroundings {
                t,
                per_state,
                ground: per_state * emitter.ground,
                mass: own.mass,
                around: length.map(|_| disturbance(species, t, number, own.mass)),
                length: length.unwrap_or(0.0),
            };
            for (k, line) in emitter.spectrum.lines.iter().enumerate() {
                let part = gas.leaves(line);
                if k < emitter.spectrum.listed {
                    sum.lines += part;
                } else {
                    sum.lumps += part;
                }
            }
        }
        sum.continuum = continuum::loss(t, charges(species, number), length);
        sum
    }
}

/// `n_e sum(n_i z^2)` over positive ions, 1/m6.
fn charges(species: &[Species], number: &[f64]) -> f64 {
    let pairs = || species.iter().zip(number);
    let electrons: f64 = pairs()
        .filter(|(s, _)| s.kind == Kind::Electron)
        .map(|(_, n)| n)
        .sum();
    let ions = pairs().filter(|(s, _)| s.charge > 0);
    electrons
        * ions
            .map(|(s, n)| n * f64::from(s.charge).powi(2))
            .sum::<f64>()
}

/// Everything that collides with an emitter of mass `mass`.
fn disturbance(species: &[Species], t: f64, number: &[f64], mass: f64) -> Disturbance {
    let mut around = Disturbance::default();
    for (one, n) in species.iter().zip(number) {
        match (one.charge, one.polarisability) {
            (0, Some(alpha)) => around.neutral(t, mass, one.mass, alpha, *n),
            (0, None) => {}
            _ => around.charged(t, mass, one.mass, *n),
        }
    }
    around
}

/// What a line of one species meets.
struct Surroundings {
    t: f64,
    /// `n / Q`, 1/m3.
    per_state: f64,
    /// Number of the ground level, 1/m3.
    ground: f64,
    mass: f64,
    /// Absent in a thin gas.
    around: Option<Disturbance>,
    length: f64,
}

impl Surroundings {
    /// What leaves of a line, W/m3.
    fn leaves(&self, line: &Line) -> f64 {
        let thermal = BOLTZMANN * self.t;
        let emitted = self.per_state * line.power() * (-line.upper / thermal).exp();
        let Some(around) = &self.around else {
            return emitted;
        };
        if emitted <= 0.0 {
            return 0.0;
        }
        let photon = PLANCK * LIGHT_SPEED / line.wavelength;
        let populated = (-line.upper / thermal).exp() * (photon / thermal).exp_m1();
        let area = line.wavelength.powi(2) / (8.0 * std::f64::consts::PI) * line.rate;
        let doppler = width::doppler(self.t, self.mass, line.wavelength);
        let damping = line.natural
            + line.stark * around.charges
            + line.van_der_waals * around.neutrals
            + line.resonance * self.ground;
        let a = (damping / (4.0 * std::f64::consts::PI * doppler)).max(1e-8);
        emitted * escape::factor(area * self.per_state * populated * self.length / doppler, a)
    }
}

#[cfg(test)]
mod tests;
