//! Widths of lines: what a collision or the end of a state's life makes of a sharp frequency.
//!
//! Every part is a damping rate Gamma \[1/s\]; a Lorentz line has the half width `Gamma / (4 pi)` \[Hz\], and rates add.
//!
//! - natural: `sum A` of both levels over the lines known;
//! - quadratic Stark effect of electrons and ions, in the impact limit of Lindholm: `Gamma = 11.37 C4^(2/3) v^(1/3) n`
//!   with `C4 = e^2/(4 pi eps0) a0^3 2 pi/(18 h Z^4) ((n_u (5 n_u^2 + 1))^2 - (n_l (5 n_l^2 + 1))^2)` after Traving
//!   (1960, Ueber die Theorie der Druckverbreiterung von Spektrallinien, p. 93), as in Hubeny and Mihalas (2014, ch. 8);
//! - van der Waals' force of neutrals: `Gamma = 8.08 C6^(2/5) v^(3/5) n` with `C6 = e^2/(4 pi eps0) alpha
//!   (<r^2>_u - <r^2>_l) / hbar` and `<r^2> = a0^2 n^2 (5 n^2 + 1) / (2 Z^2)` (Unsoeld 1955; Mihalas 1978, p. 282);
//! - resonance with atoms of the same kind, where a level is linked to the ground level: `Gamma = 1.92 r_e c lambda_r
//!   f_r sqrt(g_0/g_r) n_0` (Ali and Griem 1965, Phys. Rev. 140, A1044; erratum 1966, 144, 366).
//!
//! `n_u`, `n_l` are effective principal quantum numbers `Z sqrt(Ry / (I - E))`. Neglected: the quasi-static field of the
//! ions, the angular momentum in `<r^2>` (unknown to the list of lines), shifts. Widths of argon's red lines come out
//! within a factor of two of those measured (a test); a thick line's emission goes as the root of its width.

use std::f64::consts::PI;

use crate::constants::{
    BOLTZMANN, ELECTRON_VOLT, ELEMENTARY_CHARGE, LIGHT_SPEED, PERMITTIVITY, PLANCK,
};

/// Rydberg's energy, J.
const RYDBERG: f64 = 13.605_693 * ELECTRON_VOLT;
/// Bohr's radius, m.
const BOHR: f64 = 5.291_772_109e-11;
/// Classical radius of the electron, m.
const ELECTRON_RADIUS: f64 = 2.817_940_326e-15;
/// Beyond this effective quantum number (or above the limit of ionisation) a level counts as having it.
const OUTERMOST: f64 = 12.0;

/// `e^2 / (4 pi eps0)`, J m.
fn coulomb() -> f64 {
    ELEMENTARY_CHARGE * ELEMENTARY_CHARGE / (4.0 * PI * PERMITTIVITY)
}

/// What makes the lines of an atom or ion wide: energies of its states.
#[derive(Debug, Clone, Copy)]
pub struct Core {
    /// Charge that the jumping electron sees from afar: 1 for an atom, 2 for a single ion.
    pub charge: f64,
    /// Energy of ionisation from the ground state, J.
    pub ionisation: f64,
}

impl Core {
    fn quantum_number(&self, energy: f64) -> f64 {
        let bound = RYDBERG * (self.charge / OUTERMOST).powi(2);
        self.charge * (RYDBERG / (self.ionisation - energy).max(bound)).sqrt()
    }

    /// `11.37 C4^(2/3)`: the Stark damping is this times `v^(1/3) n`.
    #[must_use]
    pub fn stark(&self, lower: f64, upper: f64) -> f64 {
        let weight = |energy: f64| {
            let n = self.quantum_number(energy);
            (n * (5.0 * n * n + 1.0)).powi(2)
        };
        let scale = coulomb() * BOHR.powi(3) * 2.0 * PI / (18.0 * PLANCK * self.charge.powi(4));
        11.37 * (scale * (weight(upper) - weight(lower)).abs()).powf(2.0 / 3.0)
    }

    /// `8.08 (C6 / alpha)^(2/5)`: the damping by neutrals is this times `alpha^(2/5) v^(3/5) n`.
    #[must_use]
    pub fn van_der_waals(&self, lower: f64, upper: f64) -> f64 {
        let radius = |energy: f64| {
            let n = self.quantum_number(energy);
            (BOHR * n / self.charge).powi(2) * (5.0 * n * n + 1.0) / 2.0
        };
        let scale = coulomb() * 2.0 * PI / PLANCK;
        8.08 * (scale * (radius(upper) - radius(lower)).abs()).powf(0.4)
    }
}

/// Oscillator strength in absorption of a line from the ground level, from `g_u A` \[1/s\] and its wavelength \[m\].
fn oscillator(wavelength: f64, rate: f64, ground_weight: f64) -> f64 {
    let area = 8.0 * PI * PI * ELECTRON_RADIUS * LIGHT_SPEED;
    rate * wavelength * wavelength / (area * ground_weight)
}

/// Damping by atoms of the same kind in their ground level, per number density of these \[m3/s\]: that of a line from
/// the ground level with `g_u A` = `rate` and upper weight `upper_weight`.
#[must_use]
pub fn resonance(wavelength: f64, rate: f64, upper_weight: f64, ground_weight: f64) -> f64 {
    let f = oscillator(wavelength, rate, ground_weight);
    1.92 * ELECTRON_RADIUS * LIGHT_SPEED * wavelength * f * (ground_weight / upper_weight).sqrt()
}

/// Particles that disturb, summed for one emitter.
#[derive(Debug, Clone, Copy, Default)]
pub struct Disturbance {
    /// `sum n v^(1/3)` over electrons and ions.
    pub charges: f64,
    /// `sum n alpha^(2/5) v^(3/5)` over neutrals.
    pub neutrals: f64,
}

impl Disturbance {
    /// Adds charged particles of `mass` kg, `number` 1/m3, at `t` K to those that disturb an emitter of mass `emitter`.
    pub fn charged(&mut self, t: f64, emitter: f64, mass: f64, number: f64) {
        self.charges += number * speed(t, emitter, mass).cbrt();
    }

    /// Adds neutrals of polarisability `alpha` m3.
    pub fn neutral(&mut self, t: f64, emitter: f64, mass: f64, alpha: f64, number: f64) {
        self.neutrals += number * alpha.powf(0.4) * speed(t, emitter, mass).powf(0.6);
    }
}

/// Mean relative speed, m/s.
fn speed(t: f64, one: f64, other: f64) -> f64 {
    (8.0 * BOLTZMANN * t / PI * (1.0 / one + 1.0 / other)).sqrt()
}

/// Doppler width `nu sqrt(2 k T / m) / c`, Hz.
#[must_use]
pub fn doppler(t: f64, mass: f64, wavelength: f64) -> f64 {
    (2.0 * BOLTZMANN * t / mass).sqrt() / wavelength
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::constants::{ATOMIC_MASS, ELECTRON_MASS};

    const ARGON: Core = Core {
        charge: 1.0,
        ionisation: 15.759_612 * ELECTRON_VOLT,
    };

    /// The 696.5 nm line has a full Stark width of 0.0814 nm at 1e23 electrons/m3 (Konjevic et al. 2002, J. Phys. Chem.
    /// Ref. Data 31, 819, recommend values about this).
    #[test]
    fn a_red_line_of_argon_is_as_wide_as_measured_within_a_factor_of_two() {
        let mut around = Disturbance::default();
        let mass = 39.948 * ATOMIC_MASS;
        around.charged(1e4, mass, ELECTRON_MASS, 1e23);
        around.charged(1e4, mass, mass, 1e23);
        let damping =
            ARGON.stark(11.548_35 * ELECTRON_VOLT, 13.327_86 * ELECTRON_VOLT) * around.charges;
        let wavelength = 696.735e-9_f64;
        let width = wavelength * wavelength * damping / (2.0 * PI * LIGHT_SPEED);
        assert!((0.5..2.0).contains(&(width / 0.0814e-9)), "{width}");
    }

    /// Lyman alpha: half width over frequency of `f/(3/4) 2.07e-24/(3/4)` cm3, as Barklem and Piskunov (2003) took it
    /// from Ali and Griem.
    #[test]
    fn resonance_broadening_of_hydrogen_is_that_of_ali_and_griem() {
        let wavelength = 121.567e-9_f64;
        let f = 0.4162;
        let rate = f * 2.0 * 8.0 * PI * PI * ELECTRON_RADIUS * LIGHT_SPEED / wavelength.powi(2);
        let half = resonance(wavelength, rate, 6.0, 2.0) / (4.0 * PI) * wavelength / LIGHT_SPEED;
        let known = f * 2.07e-30 / 0.5625;
        assert!((half / known - 1.0).abs() < 5e-3, "{half} {known}");
    }

    #[test]
    fn the_oscillator_strength_of_argon_at_106_7_nm_is_that_of_its_transition_rate() {
        // NIST: A = 1.19e8 1/s, f = 0.0609.
        let f = oscillator(106.666e-9, 3.0 * 1.19e8, 1.0);
        assert!((f - 0.0609).abs() < 3e-4, "{f}");
    }
}
