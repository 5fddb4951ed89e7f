//! Light of free electrons: slowed by ions, or caught by them.
//!
//! `eps = 1.632e-43 / lambda^2 n_e sum(n_i z^2) / sqrt(T) (xi (1 - e^-x) + G e^-x)` W/(m3 m sr), `x = h c/(lambda k T)`
//! (Cabannes and Chapelle 1971), with Biberman's factor xi for capture and Gaunt's factor G for slowing down as the data
//! give them (about those of argon), for wavelengths above 200 nm. Below, capture into ground states is absorbed by the
//! same atoms within tenths of a millimetre and has no data here: left out. Light that is absorbed on the way out of a
//! sphere of radius R leaves by `exp(-k' R)`, `k' = eps / B`.

use std::f64::consts::PI;

use crate::constants::{BOLTZMANN, LIGHT_SPEED, PLANCK};

/// Shortest wavelength, m.
pub const SHORTEST: f64 = 200e-9;
/// Frequencies of the sum, by the rule of midpoints: at frequency 0 all is absorbed, however thin the gas.
const STEPS: u32 = 256;
const SCALE: f64 = 1.632e-43;
const BIBERMAN: f64 = 1.6;
const GAUNT: f64 = 1.2;

/// Planck's function per frequency, W/(m2 sr Hz).
#[must_use]
pub fn planck(t: f64, frequency: f64) -> f64 {
    let x = PLANCK * frequency / (BOLTZMANN * t);
    2.0 * PLANCK * frequency.powi(3) / LIGHT_SPEED.powi(2) / x.exp_m1()
}

/// Emission per frequency, W/(m3 sr Hz); `charges` is `n_e sum(n_i z^2)`.
fn emission(t: f64, frequency: f64, charges: f64) -> f64 {
    let fall = (-PLANCK * frequency / (BOLTZMANN * t)).exp();
    SCALE / LIGHT_SPEED * charges / t.sqrt() * (BIBERMAN * (1.0 - fall) + GAUNT * fall)
}

/// `4 pi eps` of the continuum, W/m3; `length` is the radius R of the sphere, m, absent in a thin gas.
#[must_use]
pub fn loss(t: f64, charges: f64, length: Option<f64>) -> f64 {
    if charges <= 0.0 {
        return 0.0;
    }
    let step = LIGHT_SPEED / SHORTEST / f64::from(STEPS);
    let mut sum = 0.0;
    for k in 0..STEPS {
        let frequency = (f64::from(k) + 0.5) * step;
        let here = emission(t, frequency, charges);
        let leaves = length.map_or(1.0, |length| (-here / planck(t, frequency) * length).exp());
        sum += here * leaves;
    }
    4.0 * PI * sum * step
}

#[cfg(test)]
mod tests {
    use super::*;

    /// In a thin gas the integral over frequency is known: `xi nu - (xi - G) k T/h (1 - e^-x)` at the shortest wave.
    #[test]
    fn a_thin_continuum_is_its_integral() {
        for t in [3e3, 1e4, 2.5e4] {
            let top = LIGHT_SPEED / SHORTEST;
            let thermal = BOLTZMANN * t / PLANCK;
            let integral =
                BIBERMAN * top - (BIBERMAN - GAUNT) * thermal * (1.0 - (-top / thermal).exp());
            let exact = 4.0 * PI * SCALE / LIGHT_SPEED * 1e46 / t.sqrt() * integral;
            assert!((loss(t, 1e46, None) / exact - 1.0).abs() < 2e-5, "{t}");
        }
    }

    #[test]
    fn absorption_only_takes_and_a_thin_sphere_takes_nothing() {
        let free = loss(1.2e4, 1e46, None);
        assert!((loss(1.2e4, 1e46, Some(1e-9)) / free - 1.0).abs() < 1e-6);
        let mut last = free;
        for length in [1e-4, 1e-3, 1e-2, 1.0] {
            let now = loss(1.2e4, 1e46, Some(length));
            assert!(now < last);
            last = now;
        }
    }

    #[test]
    fn planck_integrates_to_stefan_and_boltzmann() {
        let t = 8000.0;
        let step = 2e12;
        let sum: f64 = (1..2000)
            .map(|k| planck(t, f64::from(k) * step) * step)
            .sum();
        let exact = crate::constants::STEFAN_BOLTZMANN * t.powi(4) / PI;
        assert!((sum / exact - 1.0).abs() < 1e-3);
    }
}
