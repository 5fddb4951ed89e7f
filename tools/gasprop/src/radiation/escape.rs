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

use std::sync::LazyLock;

use super::voigt::profile;

/// Step of the trapezoidal rule in u.
const STEP: f64 = 0.02;
/// First u: x = 1e-5 Doppler widths, where the integrand no longer counts.
const FIRST: f64 = -2.2;
/// An optical depth at the centre below this absorbs nothing that would show.
const THIN: f64 = 1e-5;
/// How far beyond the distance where its wings are blackened a line is followed.
const BEYOND: f64 = 100.0;

/// Part of a line's emission that leaves, between 0 and 1. `s` as above, `a` Lorentz half width over Doppler width.
///
/// Interpolated by cubics in a table of ln Lambda over the logarithms of the depth at the centre and of a, made once
/// from [`exact`], to 1e-3 (a test).
#[must_use]
pub fn factor(s: f64, a: f64) -> f64 {
    let depth = s * profile(a, 0.0);
    if depth < THIN {
        return 1.0;
    }
    TABLE
        .at(depth.ln(), a.ln())
        .map_or_else(|| exact(s, a), |log| log.exp().min(1.0))
}

static TABLE: LazyLock<Grid> = LazyLock::new(Grid::new);

/// Distance of nodes in both logarithms.
const SPACING: f64 = 0.35;
/// Logarithms of the depth at the first node and the last.
const DEPTHS: [f64; 2] = [-12.5, 32.0];
/// Logarithms of a at the first node and the last.
const WIDTHS: [f64; 2] = [-17.0, 7.0];

/// ln Lambda at nodes; the width runs fastest.
struct Grid {
    widths: usize,
    values: Vec<f64>,
}

impl Grid {
    fn new() -> Self {
        let count = |[from, to]: [f64; 2]| ((to - from) / SPACING) as usize + 1;
        let widths = count(WIDTHS);
        let mut values = Vec::with_capacity(widths * count(DEPTHS));
        for i in 0..count(DEPTHS) {
            let depth = (DEPTHS[0] + SPACING * i as f64).exp();
            for j in 0..widths {
                let a = (WIDTHS[0] + SPACING * j as f64).exp();
                values.push(exact(depth / profile(a, 0.0), a).ln());
            }
        }
        Self { widths, values }
    }

    /// ln Lambda; nothing outside the table.
    fn at(&self, depth: f64, width: f64) -> Option<f64> {
        let (i, u) = cubic(
            (depth - DEPTHS[0]) / SPACING,
            self.values.len() / self.widths,
        )?;
        let (j, v) = cubic((width - WIDTHS[0]) / SPACING, self.widths)?;
        let mut sum = 0.0;
        for (k, part) in u.iter().enumerate() {
            let row = &self.values[(i + k) * self.widths + j..][..4];
            sum += part
                * row
                    .iter()
                    .zip(&v)
                    .map(|(value, part)| value * part)
                    .sum::<f64>();
        }
        Some(sum)
    }
}

/// First of four nodes around `x` (in distances from the first of `n`), and the weight of each in Lagrange's cubic.
fn cubic(x: f64, n: usize) -> Option<(usize, [f64; 4])> {
    if !(1.0..(n - 2) as f64).contains(&x) {
        return None;
    }
    let first = x as usize - 1;
    let t = x - (first + 1) as f64;
    Some((
        first,
        [
            -t * (t - 1.0) * (t - 2.0) / 6.0,
            (t + 1.0) * (t - 1.0) * (t - 2.0) / 2.0,
            -(t + 1.0) * t * (t - 2.0) / 2.0,
            (t + 1.0) * t * (t - 1.0) / 6.0,
        ],
    ))
}

/// [`factor`] by its integral.
///
/// The half line `x = exp(u - exp(-u))` makes the integrand fall off doubly fast towards the centre and exponentially
/// into the wings (Takahasi and Mori 1974): the trapezoidal rule then converges exponentially.
#[must_use]
pub fn exact(s: f64, a: f64) -> f64 {
    integral(s, a, STEP)
}

fn integral(s: f64, a: f64, step: f64) -> f64 {
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
    use super::{exact, factor, integral};

    #[test]
    fn a_thin_line_loses_its_optical_depth() {
        // To first order in s: 1 - s int h^2 dx; int h^2 is 1 / sqrt(2 pi) for Doppler, 1 / (2 pi a) for Lorentz.
        let s = 1e-2;
        let doppler = 1.0 - exact(s, 1e-9);
        assert!((doppler / s * (2.0 * std::f64::consts::PI).sqrt() - 1.0).abs() < 5e-3);
        let lorentz = 1.0 - exact(s * 100.0, 100.0);
        assert!((lorentz / s * (2.0 * std::f64::consts::PI) - 1.0).abs() < 5e-3);
    }

    /// A thick Lorentz line: `Lambda = 1 / sqrt(4 s h')`, since `int h exp(-s h) dx` with `h = a / (pi x^2)` is
    /// `sqrt(a / s)`, which is what Ladenburg and Reiche (1913) found for the growth of such lines.
    #[test]
    fn a_thick_line_escapes_through_its_wings_alone() {
        for (s, a) in [(1e6, 1.0), (1e8, 0.01), (1e10, 1e-3)] {
            assert!((exact(s, a) / (a / s).sqrt() - 1.0).abs() < 0.01, "{s} {a}");
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
    fn the_table_is_the_integral() {
        for i in 0..60 {
            for j in 0..45 {
                let (s, a) = (1e-4 * 1.8_f64.powi(i), 1e-7 * 1.7_f64.powi(j));
                let (table, integral) = (factor(s, a), exact(s, a));
                assert!(
                    (table / integral - 1.0).abs() < 1e-3,
                    "{s} {a}: {table} {integral}"
                );
            }
        }
        // Beyond the table the integral is taken itself.
        assert!((factor(1e18, 1e-3) / exact(1e18, 1e-3) - 1.0).abs() < 1e-12);
    }

    #[test]
    fn a_finer_rule_changes_little() {
        for a in [1e-5, 1e-3, 0.1, 1.0, 30.0] {
            for k in -3..9 {
                let s = 10.0_f64.powi(k);
                let (usual, fine) = (exact(s, a), integral(s, a, 0.005));
                assert!((usual / fine - 1.0).abs() < 2e-4, "{s} {a}: {usual} {fine}");
            }
        }
    }
}
