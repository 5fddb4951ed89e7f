//! What self-absorption leaves of a line.
//!
//! Net emission at the centre of a homogeneous isothermal sphere of radius R (Lowke 1974, J. Quant. Spectrosc. Radiat.
//! Transfer 14, 111): `eps = int B k' exp(-k' R) d nu`. Over one isolated line B hardly changes, so that
//! `eps = eps_thin Lambda` with
//!
//! `Lambda(s, a) = int h(a, x) exp(-s h(a, x)) dx`,  `s = K R / doppler`,
//!
//! K the absorption integrated over the line \[Hz/m\], `doppler` the Doppler width \[Hz\], x the distance from the
//! centre in Doppler widths. `Lambda` is 1 in a thin gas, falls with s, and never lets more out than
//! `B doppler (width in x) / (e R)`.

use super::voigt::profile;

/// Step of the trapezoidal rule in u.
const STEP: f64 = 0.05;
/// First u: x = 1e-5 Doppler widths, where the integrand no longer counts.
const FIRST: f64 = -2.2;
/// An optical depth at the centre below this absorbs nothing that would show.
const THIN: f64 = 1e-5;
/// How far beyond the distance where its wings are blackened a line is followed.
const BEYOND: f64 = 100.0;

/// Part of a line's emission that leaves, between 0 and 1. `s` as above, `a` Lorentz half width over Doppler width.
///
/// The half line `x = exp(u - exp(-u))` makes the integrand fall off doubly fast towards the centre and exponentially
/// into the wings (Takahasi and Mori 1974): the trapezoidal rule then converges exponentially.
#[must_use]
pub fn factor(s: f64, a: f64) -> f64 {
    integral(s, a, STEP)
}

fn integral(s: f64, a: f64, step: f64) -> f64 {
    if s * profile(a, 0.0) < THIN {
        return 1.0;
    }
    // Beyond x = reach the line is thin and h = a / (pi x^2): what is left is a / (pi x).
    let reach = BEYOND * (1.0 + a + (s * a).sqrt());
    let last = reach.ln();
    let steps = ((last - FIRST) / step).ceil();
    let step = (last - FIRST) / steps;
    let mut sum = 0.0;
    let mut k = 0.0;
    while k <= steps {
        let u = FIRST + k * step;
        let inverse = (-u).exp();
        let x = (u - inverse).exp();
        let h = profile(a, x);
        let weight = if k < steps { 1.0 } else { 0.5 };
        sum += weight * h * (-s * h).exp() * x * (1.0 + inverse);
        k += 1.0;
    }
    let left = a / (std::f64::consts::PI * (last - (-last).exp()).exp());
    (2.0 * (sum * step + left)).min(1.0)
}

#[cfg(test)]
mod tests {
    use super::{factor, integral};

    #[test]
    fn a_thin_line_loses_its_optical_depth() {
        // To first order in s: 1 - s int h^2 dx; int h^2 is 1 / sqrt(2 pi) for Doppler, 1 / (2 pi a) for Lorentz.
        let s = 1e-2;
        let doppler = 1.0 - factor(s, 1e-9);
        assert!((doppler / s * (2.0 * std::f64::consts::PI).sqrt() - 1.0).abs() < 5e-3);
        let lorentz = 1.0 - factor(s * 100.0, 100.0);
        assert!((lorentz / s * (2.0 * std::f64::consts::PI) - 1.0).abs() < 5e-3);
    }

    /// A thick Lorentz line: `Lambda = 1 / sqrt(4 s h')`, since `int h exp(-s h) dx` with `h = a / (pi x^2)` is
    /// `sqrt(a / s)`, which is what Ladenburg and Reiche (1913) found for the growth of such lines.
    #[test]
    fn a_thick_line_escapes_through_its_wings_alone() {
        for (s, a) in [(1e6, 1.0), (1e8, 0.01), (1e10, 1e-3)] {
            assert!(
                (factor(s, a) / (a / s).sqrt() - 1.0).abs() < 0.01,
                "{s} {a}"
            );
        }
    }

    #[test]
    fn more_absorption_lets_less_through() {
        for a in [1e-4, 1e-2, 1.0, 100.0] {
            let mut last = 1.0 + 1e-12;
            for k in -40..60 {
                let now = factor(10.0_f64.powf(0.2 * f64::from(k)), a);
                assert!(
                    now <= last && now > 0.0,
                    "a {a}, step {k}: {now} after {last}"
                );
                last = now;
            }
        }
    }

    #[test]
    fn a_finer_rule_changes_little() {
        for a in [1e-5, 1e-3, 0.1, 1.0, 30.0] {
            for k in -3..9 {
                let s = 10.0_f64.powi(k);
                let (usual, fine) = (factor(s, a), integral(s, a, 0.005));
                assert!((usual / fine - 1.0).abs() < 2e-3, "{s} {a}: {usual} {fine}");
            }
        }
    }
}
