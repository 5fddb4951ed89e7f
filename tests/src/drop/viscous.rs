//! Small swings of a viscous drop without gas, exactly (Chandrasekhar 1959; Miller and Scriven 1968).
//!
//! All in units of R, rho and gamma; Oh = mu/sqrt(rho gamma R). With exp(-s t) and k^2 = s/Oh, velocities along and across r
//! of the mode l are
//!
//! ```text
//! U = A r^(l-1) + B l (l+1) j_l(k r)/r,     V = A r^(l-1)/l + B (r j_l(k r))'/r
//! ```
//!
//! No shear: `r (V/r)' + U/r = 0`; normal stress: `-s A/l + 2 Oh U' = (l-1) (l+2) U/s`, at r = 1.

use num_complex::Complex;

type C = Complex<f64>;

/// Rounds of the secant method.
const ROUNDS: usize = 80;

/// Frequency of a drop without friction (Rayleigh 1879).
#[must_use]
pub fn rayleigh(l: u32) -> f64 {
    let l = f64::from(l);
    (l * (l - 1.0) * (l + 2.0)).sqrt()
}

/// j_(l+1)/j_l by the recurrence from far above.
fn ratio(l: u32, z: C) -> C {
    let far = l + z.norm() as u32 + 60;
    let mut r = C::new(0.0, 0.0);
    for m in (l + 1..=far).rev() {
        r = (C::from(f64::from(2 * m + 1)) / z - r).inv();
    }
    r
}

fn lack(s: C, l: u32, oh: f64) -> C {
    let k = (s / oh).sqrt();
    let n = f64::from(l);
    let first = k * (C::from(n) / k - ratio(l, k));
    let second = -first * 2.0 - (k * k - n * (n + 1.0));
    // B: j_l(k) = 1.
    let radial = n * (n + 1.0);
    let radial_slope = (first - 1.0) * radial;
    let across = first + 1.0;
    let across_slope = first - 1.0 + second;
    let shear_a = (n - 1.0) / n - 1.0 / n + 1.0;
    let shear_b = across_slope - across + radial;
    let (a, b) = (shear_b, C::from(-shear_a));
    let u = a + b * radial;
    let slope = a * (n - 1.0) + b * radial_slope;
    -s * a / n + slope * 2.0 * oh - u * (n - 1.0) * (n + 2.0) / s
}

/// Rate of decay and frequency of mode `l`; the slow rate and 0 where it creeps.
#[must_use]
pub fn rates(l: u32, oh: f64) -> (f64, f64) {
    let n = f64::from(l);
    let creeping = n * (n + 2.0) * (2.0 * n + 1.0) / (2.0 * (2.0 * n * n + 4.0 * n + 3.0)) / oh;
    let slow = oh > 2.0;
    let mut before = if slow {
        C::from(0.9 * creeping)
    } else {
        C::new((n - 1.0) * (2.0 * n + 1.0) * oh, rayleigh(l))
    };
    let mut now = before * (1.0 + 1e-4);
    let mut value = lack(before, l, oh);
    for _ in 0..ROUNDS {
        let next_value = lack(now, l, oh);
        let change = next_value * (now - before) / (next_value - value);
        if !change.is_finite() || change.norm() < 1e-14 * now.norm() {
            break;
        }
        (before, value) = (now, next_value);
        now -= change;
    }
    (now.re, now.im)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_limits_are_those_of_lamb_and_of_creeping_flow() {
        for l in 2..5 {
            let n = f64::from(l);
            let (decay, frequency) = rates(l, 1e-5);
            let lamb = (n - 1.0) * (2.0 * n + 1.0) * 1e-5;
            assert!((decay / lamb - 1.0).abs() < 0.01, "{decay} {lamb}");
            assert!((frequency / rayleigh(l) - 1.0).abs() < 1e-5);
        }
        let (decay, frequency) = rates(2, 100.0);
        assert!((decay * 100.0 * 19.0 / 20.0 - 1.0).abs() < 1e-4 && frequency.abs() < 1e-12);
    }

    #[test]
    fn a_drop_of_35_micrometres_is_as_others_find() {
        let time = (1000.0 * 35e-6_f64.powi(3) / 0.07196).sqrt();
        let (decay, frequency) = rates(2, 0.02);
        assert!((2.0 * std::f64::consts::PI / frequency * time / 54.371e-6 - 1.0).abs() < 1e-4);
        assert!((decay / time / 3791.0 - 1.0).abs() < 1e-3);
    }
}
