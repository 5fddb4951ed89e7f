//! Harmonics of a potential about a centre: polynomials that are regular there, and what decays of each degree.
//!
//! In space `1 / (4 pi |x - x'|) = sum R(x') F(x)` for `|x| > |x'|`, with `R_lm = r^l P_l^m exp(j m phi) / (l + m)!` and
//! `F_lm = (l - m)! P_l^m exp(j m phi) / (4 pi r^(l+1))` by their recurrences, real and imaginary part of each `m > 0`
//! with the factor two of `-m`. About an axis those of `m = 0` alone are left. In a plane
//! `-ln|z - z'| / (2 pi) = sum R(z') F(z)` with the powers `z^l` and `conj(z)^-l / (2 pi l)`; that of degree 0, the
//! logarithm, is left out: it does not decay.

use std::f64::consts::{PI, TAU};

use num_complex::Complex;

/// A complex number.
type C = Complex<f64>;

/// Largest degree in space: 49 harmonics.
const DEGREE: usize = 6;
/// Largest degree in a plane and about an axis, where a degree is one harmonic or two.
const DEGREE_FLAT: usize = 8;

/// The largest degree and order of solid harmonics.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Largest {
    degree: usize,
    order: usize,
}

/// Those of three coordinates.
const SPATIAL: Largest = Largest {
    degree: DEGREE,
    order: DEGREE,
};
/// Those that are even about an axis.
const COAXIAL: Largest = Largest {
    degree: DEGREE_FLAT,
    order: 0,
};

impl Largest {
    /// Degree and order of each solid harmonic.
    fn each(self) -> impl Iterator<Item = (usize, usize)> {
        (0..=self.degree).flat_map(move |l| (0..=l.min(self.order)).map(move |m| (l, m)))
    }
}

/// Which harmonics there are.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Harmonics {
    /// Those of three coordinates.
    Space,
    /// Those that are even about an axis, of the distance from it and the place along it.
    Axis,
    /// Those of a plane; no logarithm.
    Plane,
}

impl Harmonics {
    /// Of `dimensions` coordinates, the first of which may be the distance from an axis.
    pub(crate) fn of(dimensions: usize, axial: bool) -> Self {
        match (dimensions, axial) {
            (3, _) => Self::Space,
            (_, true) => Self::Axis,
            (_, false) => Self::Plane,
        }
    }

    /// Each regular harmonic at an offset from the centre, with its gradient, in the coordinates of the points.
    pub(crate) fn regular<const D: usize>(self, p: [f64; D]) -> Vec<(f64, [f64; D])> {
        match self {
            Self::Plane => powers(C::new(p[0], p[1])),
            Self::Axis => solid([p[0], 0.0, p[1]], COAXIAL, 2),
            Self::Space => solid([p[0], p[1], p[2]], SPATIAL, 1),
        }
    }

    /// What decays that belongs to each of [`Self::regular`].
    pub(crate) fn decaying<const D: usize>(self, p: [f64; D]) -> Vec<f64> {
        match self {
            Self::Plane => decaying_powers(C::new(p[0], p[1])),
            Self::Axis => decaying_solid([p[0], 0.0, p[1]], COAXIAL),
            Self::Space => decaying_solid([p[0], p[1], p[2]], SPATIAL),
        }
    }

    /// Numbers of the harmonics whose moments are those of a dipole, by coordinate, and what these are multiplied by.
    pub(crate) fn dipole(self) -> &'static [(usize, f64)] {
        match self {
            Self::Plane => &[(0, 1.0), (1, 1.0)],
            // Along the axis.
            Self::Axis => &[(1, 1.0)],
            // R_11 = (x + j y) / 2, R_10 = z.
            Self::Space => &[(2, 2.0), (3, 2.0), (1, 1.0)],
        }
    }
}

/// Numbers by degree and order.
#[derive(Default)]
struct Table([[C; DEGREE_FLAT + 2]; DEGREE_FLAT + 2]);

impl Table {
    /// Those up to the largest: `own(m, before)` begins each order at degree m with what the order before it began
    /// with, and `next(l, m, [one, two])` has what stands one and two degrees lower.
    fn up_to(
        largest: Largest,
        own: impl Fn(usize, C) -> C,
        next: impl Fn(usize, usize, [C; 2]) -> C,
    ) -> Self {
        let Largest { degree, order } = largest;
        let mut table = Self::default();
        let mut first = C::default();
        for m in 0..=degree.min(order) {
            first = own(m, first);
            let mut lower = [C::default(); 2];
            let mut value = first;
            for l in m..=degree {
                if l > m {
                    value = next(l, m, lower);
                }
                table.0[l][m] = value;
                lower = [value, lower[0]];
            }
        }
        table
    }

    fn at(&self, l: usize, m: usize) -> C {
        self.0[l][m]
    }
}

/// `(l - m)(l + m) R_lm = (2 l - 1) z R_(l-1)m - r^2 R_(l-2)m`, `2 m R_mm = (x + j y) R_(m-1)(m-1)`.
fn table([x, y, z]: [f64; 3], largest: Largest) -> Table {
    let square = x * x + y * y + z * z;
    let own = |m: usize, before: C| match m {
        0 => C::new(1.0, 0.0),
        _ => before * C::new(x, y) / (2.0 * m as f64),
    };
    // Gradients ask for one order more.
    let more = Largest {
        order: largest.order + 1,
        ..largest
    };
    Table::up_to(more, own, |l, m, [one, two]| {
        let next = one * ((2 * l - 1) as f64 * z) - two * square;
        next / ((l - m) * (l + m)) as f64
    })
}

/// Regular solid harmonics; the gradient has every part, or with a `step` of two those away from an axis and along it.
///
/// `d/dz R_lm = R_(l-1)m`, `(d/dx + j d/dy) R_lm = -R_(l-1)(m+1)`, `(d/dx - j d/dy) R_lm = R_(l-1)(m-1)`.
fn solid<const D: usize>(p: [f64; 3], largest: Largest, step: usize) -> Vec<(f64, [f64; D])> {
    let table = table(p, largest);
    let mut found = Vec::new();
    for (l, m) in largest.each() {
        let lower = |m: usize| match l {
            0 => C::default(),
            _ => table.at(l - 1, m),
        };
        let up = -lower(m + 1);
        let down = match m {
            0 => up.conj(),
            _ => lower(m - 1),
        };
        let slope = [0.5 * (up + down), C::new(0.0, -0.5) * (up - down), lower(m)];
        let part = |of: fn(C) -> f64| std::array::from_fn(|k| of(slope[k * step]));
        found.push((table.at(l, m).re, part(|c| c.re)));
        if m > 0 {
            found.push((table.at(l, m).im, part(|c| c.im)));
        }
    }
    found
}

/// `r^2 S_lm = (2 l - 1) z S_(l-1)m - ((l - 1)^2 - m^2) S_(l-2)m`, `r^2 S_mm = (2 m - 1) (x + j y) S_(m-1)(m-1)`.
fn decaying_solid([x, y, z]: [f64; 3], largest: Largest) -> Vec<f64> {
    let square = x * x + y * y + z * z;
    let own = |m: usize, before: C| match m {
        0 => C::new(1.0 / square.sqrt(), 0.0),
        _ => before * C::new(x, y) * ((2 * m - 1) as f64 / square),
    };
    let table = Table::up_to(largest, own, |l, m, [one, two]| {
        let share = ((l - 1) * (l - 1)) as f64 - (m * m) as f64;
        (one * ((2 * l - 1) as f64 * z) - two * share) / square
    });
    let far = 4.0 * PI;
    let mut found = Vec::new();
    for (l, m) in largest.each() {
        if m == 0 {
            found.push(table.at(l, 0).re / far);
        } else {
            found.push(2.0 * table.at(l, m).re / far);
            found.push(2.0 * table.at(l, m).im / far);
        }
    }
    found
}

fn powers<const D: usize>(z: C) -> Vec<(f64, [f64; D])> {
    let mut found = Vec::new();
    let mut before = C::new(1.0, 0.0);
    for l in 1..=DEGREE_FLAT {
        // d/dx z^l = l z^(l-1), d/dy z^l = j l z^(l-1).
        let slope = before * l as f64;
        let along = [slope, slope * C::i()];
        before *= z;
        found.push((before.re, std::array::from_fn(|k| along[k].re)));
        found.push((before.im, std::array::from_fn(|k| along[k].im)));
    }
    found
}

fn decaying_powers(z: C) -> Vec<f64> {
    let mut found = Vec::new();
    let mut power = C::new(1.0, 0.0);
    for l in 1..=DEGREE_FLAT {
        power *= z;
        let far = TAU * l as f64 * power.norm_sqr();
        found.extend([power.re / far, power.im / far]);
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sum<const D: usize>(of: Harmonics, near: [f64; D], far: [f64; D]) -> f64 {
        let pairs = of.regular(near).into_iter().zip(of.decaying(far));
        pairs.map(|(near, far)| near.0 * far).sum()
    }

    #[test]
    fn they_add_up_to_the_potential_of_a_charge() {
        let [near, far]: [[f64; 3]; 2] = [[0.1, -0.05, 0.08], [1.0, 0.7, -0.9]];
        let away: f64 = (0..3).map(|k| (near[k] - far[k]).powi(2)).sum();
        let exact = 1.0 / (4.0 * PI * away.sqrt());
        assert!((sum(Harmonics::Space, near, far) / exact - 1.0).abs() < 1e-7);
        let [near, far]: [[f64; 2]; 2] = [[0.1, -0.05], [1.0, 0.7]];
        let away = (near[0] - far[0]).hypot(near[1] - far[1]);
        let exact = (far[0].hypot(far[1]) / away).ln() / TAU;
        assert!((sum(Harmonics::Plane, near, far) / exact - 1.0).abs() < 1e-8);
        // A ring seen from the axis.
        let (near, far) = ([0.1, -0.05], [0.0, 0.8]);
        let exact = 1.0 / (4.0 * PI * 0.1_f64.hypot(0.85));
        assert!((sum(Harmonics::Axis, near, far) / exact - 1.0).abs() < 1e-7);
    }

    /// Gradients are those of the values, by differences that are exact for polynomials up to the eighth degree.
    #[test]
    fn gradients_are_those_of_values() {
        fn check<const D: usize>(of: Harmonics, at: [f64; D]) {
            let found = of.regular(at);
            for axis in 0..D {
                let value = |step: f64| {
                    let mut beside = at;
                    beside[axis] += step;
                    of.regular(beside)
                };
                let weights: [f64; 4] = [672.0, -168.0, 32.0, -3.0];
                for (l, (_, slope)) in found.iter().enumerate() {
                    let mut exact = 0.0_f64;
                    for (n, weight) in (1..=4).zip(weights) {
                        let step = 0.1 * f64::from(n);
                        exact += weight * (value(step)[l].0 - value(-step)[l].0) / (840.0 * 0.1);
                    }
                    let away = (slope[axis] - exact).abs();
                    assert!(away < 1e-11, "{of:?} {l} {axis}: {} {exact}", slope[axis]);
                }
            }
        }
        check(Harmonics::Space, [0.4, -0.7, 0.5]);
        check(Harmonics::Axis, [0.6, 0.3]);
        check(Harmonics::Plane, [0.6, -0.3]);
    }

    #[test]
    fn moments_of_a_dipole_are_its_own() {
        let at = [0.3, -0.2, 0.5];
        let found = Harmonics::Space.regular(at);
        for ((number, factor), x) in Harmonics::Space.dipole().iter().zip(at) {
            assert!((found[*number].0 * factor - x).abs() < 1e-15);
        }
        assert!((Harmonics::Axis.regular([0.3, 0.5])[1].0 - 0.5).abs() < 1e-15);
        let found = Harmonics::Plane.regular([0.3, -0.2]);
        assert!((found[0].0 - 0.3).abs() < 1e-15 && (found[1].0 + 0.2).abs() < 1e-15);
    }
}
