//! Rings of current by elliptic integrals (Jackson 1998, section 5.5; the integrals by the arithmetic and geometric mean,
//! Abramowitz and Stegun 1964, section 17.6).

use std::f64::consts::{FRAC_PI_2, PI};

use super::MU0;

/// The complete elliptic integrals K and E of the parameter `m = 1 - complement`.
fn elliptic(complement: f64) -> [f64; 2] {
    let (mut a, mut b) = (1.0, complement.sqrt());
    let (mut sum, mut power) = (0.5 * (1.0 - complement), 1.0);
    while (a - b).abs() > 1e-15 * a {
        let c = 0.5 * (a - b);
        (a, b) = (0.5 * (a + b), (a * b).sqrt());
        sum += power * c * c;
        power *= 2.0;
    }
    let k = FRAC_PI_2 / a;
    [k, k * (1.0 - sum)]
}

/// Flux density of 1 A in a loop of this radius at a distance from its axis and a height above it, away from the axis and
/// along it \[T/A\].
#[must_use]
pub fn ring(radius: f64, rho: f64, height: f64) -> [f64; 2] {
    let far = (radius + rho).powi(2) + height * height;
    let near = (radius - rho).powi(2) + height * height;
    let [k, e] = elliptic(near / far);
    let size = MU0 / (2.0 * PI * far.sqrt());
    let along = k + (radius * radius - rho * rho - height * height) / near * e;
    let away = if rho > 1e-9 * radius {
        height / rho * ((radius * radius + rho * rho + height * height) / near * e - k)
    } else {
        0.0
    };
    [size * away, size * along]
}

/// A section of a ring.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Section {
    /// Round, of this radius \[m\].
    Round(f64),
    /// A rectangle of these half widths, away from the axis and along it \[m\].
    Rectangle([f64; 2]),
}

/// Parts of a section along a side or radius, and half those around.
const PARTS: u32 = 24;

/// Distances from the middle of a section, with shares of its area: middles of equal parts.
#[must_use]
pub fn parts(section: Section) -> Vec<([f64; 2], f64)> {
    let count = f64::from(PARTS);
    let middle = |k: u32| (f64::from(k) + 0.5) / count;
    let mut found = Vec::new();
    match section {
        Section::Rectangle(half) => {
            for i in 0..PARTS {
                for j in 0..PARTS {
                    let part = [i, j].map(|k| 2.0 * middle(k) - 1.0);
                    let at = [half[0] * part[0], half[1] * part[1]];
                    found.push((at, 1.0 / (count * count)));
                }
            }
        }
        Section::Round(radius) => {
            for i in 0..PARTS {
                for j in 0..2 * PARTS {
                    let (r, angle) = (radius * middle(i), PI * middle(j));
                    let at = [r * angle.cos(), r * angle.sin()];
                    found.push((at, middle(i) / (count * count)));
                }
            }
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_loop_has_its_field_on_the_axis_and_far_away_that_of_a_dipole() {
        let [a, z] = [0.3_f64, 0.4_f64];
        let exact = 0.5 * MU0 * a * a / (a * a + z * z).powf(1.5);
        let found = ring(a, 0.0, z);
        assert!((found[1] / exact - 1.0).abs() < 1e-13 && found[0].abs() < 1e-30);
        let moment = PI * a * a * MU0 / (4.0 * PI);
        let (rho, z) = (60.0, 80.0);
        let found = ring(a, rho, z);
        let r = 100.0_f64;
        assert!((found[0] / (3.0 * moment * rho * z / r.powi(5)) - 1.0).abs() < 1e-4);
        let along = moment * (3.0 * z * z - r * r) / r.powi(5);
        assert!((found[1] / along - 1.0).abs() < 1e-4);
    }

    #[test]
    fn the_field_has_no_curl_beside_the_loop() {
        let (a, rho, z, h) = (1.0, 0.7, 0.4, 1e-5);
        let up = (ring(a, rho, z + h)[0] - ring(a, rho, z - h)[0]) / (2.0 * h);
        let out = (ring(a, rho + h, z)[1] - ring(a, rho - h, z)[1]) / (2.0 * h);
        assert!((up / out - 1.0).abs() < 1e-6, "{up} {out}");
    }

    #[test]
    fn shares_of_a_section_add_up_to_one() {
        for section in [Section::Round(0.3), Section::Rectangle([0.3, 0.2])] {
            let sum: f64 = parts(section).iter().map(|p| p.1).sum();
            assert!((sum - 1.0).abs() < 1e-12, "{section:?}: {sum}");
        }
    }
}
