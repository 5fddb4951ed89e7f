//! Weights that are exact for the fields which a conductor carries in a sinusoidal steady state, in a plane.
//!
//! There the equation has solutions of its own in place of polynomials: with `k^2 = j w mu sigma`,
//!
//! ```text
//! lap u = k^2 u,    u_m = (Re, Im) (x + j y)^m  0F1(; m + 1; (k r / 2)^2),    m = 0, 1, 2, ...
//! ```
//!
//! which are `I_m(k r)` times cosine and sine of m times the angle, up to factors (Abramowitz and Stegun 1964, 9.6.10). Where
//! a spacing is not small against the skin depth polynomials err by a part of the wave number, and so by as much in every
//! skin depth that the field has come: 10 % behind eleven of them, where 0.2 % of the field at the surface are missed. The
//! weights w of polynomials become `w + d` with
//!
//! ```text
//! sum_j |d_j|^2 / g_j least    under    sum_j (w_j + d_j) u_m(x_j - x_i) = L u_m(0)    for m up to 6,
//! ```
//!
//! g the weight of the fit, L the Laplacian or a derivative: schemes of solutions that are known near a point (Tsukerman 2006,
//! J. Comput. Phys. 211, 659), which leave the stencils as they are. `L u_m(0)` is `k^2` of `m = 0` for the Laplacian, the
//! components of a direction of `m = 1` for the derivative along it, and else 0. Potentials of sources and of the reaction obey
//! the equation together: weights apply to both.

use wls::Stencils;

use crate::magnetic::diffusion::Conductors;
use crate::magnetic::source::C;
use crate::stencils::region::Region;

/// Highest m.
const HIGHEST: usize = 6;
/// What is left of a condition on a support, over its own size, below which the others say it already.
const ALIKE: f64 = 1e-3;
/// Reach of a support over the skin depth, times the square root of 2, beyond which a field that falls so much from point to
/// point is left to polynomials.
const FARTHEST: f64 = 16.0;
/// Points of a support that do not weigh nothing reach so far beyond it.
const BEYOND: f64 = 1.05;

/// Squares of the wave numbers of conductors.
#[derive(Debug, Clone)]
pub struct Waves {
    /// `j w mu sigma` by medium \[1/m2\]; 0 where nothing conducts.
    squares: Vec<C>,
}

/// What weights give.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Target {
    /// The Laplacian.
    Laplacian,
    /// The derivative along a direction.
    Along([f64; 2]),
}

/// Points of a support, seen from its own.
struct Support {
    /// Offsets over the reach.
    offsets: Vec<[f64; 2]>,
    /// Farthest offset \[m\].
    reach: f64,
    /// Square roots of the weights of the fit.
    roots: Vec<f64>,
}

impl Support {
    fn new<const D: usize>(region: &Region<D>, i: usize, base: &[(usize, f64)]) -> Self {
        let length = |v: &[f64]| v.iter().map(|x| x * x).sum::<f64>().sqrt();
        let offset = |j: usize| -> [f64; D] {
            std::array::from_fn(|k| region.places[j][k] - region.places[i][k])
        };
        let all: Vec<[f64; D]> = base.iter().map(|(j, _)| offset(*j)).collect();
        let scaled = |x: &[f64; D]| length(&region.metrics[i].scaled(*x));
        let wide = BEYOND * all.iter().map(scaled).fold(0.0, f64::max);
        let reach = all.iter().map(|x| length(x)).fold(0.0, f64::max);
        Self {
            roots: all
                .iter()
                .map(|x| wls::quartic(scaled(x) / wide).sqrt())
                .collect(),
            offsets: all.iter().map(|x| [x[0] / reach, x[1] / reach]).collect(),
            reach,
        }
    }

    /// `0F1(; m + 1; q)` at all points for m from 0 to the highest, `q = (k r / 2)^2`: series of the two highest, the others by
    /// `f_(m-1) = f_m + q f_(m+1) / (m (m + 1))`.
    fn radial(&self, square: C) -> Vec<[C; HIGHEST + 1]> {
        let one = |x: &[f64; 2]| {
            let q = square * (0.25 * self.reach * self.reach * (x[0] * x[0] + x[1] * x[1]));
            let mut f = [C::new(0.0, 0.0); HIGHEST + 1];
            for m in [HIGHEST, HIGHEST - 1] {
                f[m] = series(m, q);
            }
            for m in (1..HIGHEST).rev() {
                f[m - 1] = f[m] + q * f[m + 1] / (m * (m + 1)) as f64;
            }
            f
        };
        self.offsets.iter().map(one).collect()
    }

    /// What is added to the weights `base`.
    fn added(&self, base: &[(usize, f64)], square: C, target: Target) -> Vec<C> {
        let n = base.len();
        let mut bases: Vec<Vec<C>> = Vec::new();
        // Over the roots of the weights.
        let mut added = vec![C::new(0.0, 0.0); n];
        let radial = self.radial(square);
        for (m, part) in (0..=HIGHEST).flat_map(|m| [(m, 0), (m, 1)]) {
            if (m, part) == (0, 1) || bases.len() + 1 >= n {
                continue;
            }
            let wave = |(x, f): (&[f64; 2], &[C; HIGHEST + 1])| {
                let turned = C::new(x[0], x[1]).powu(m as u32);
                f[m] * [turned.re, turned.im][part]
            };
            let waves: Vec<C> = self.offsets.iter().zip(&radial).map(wave).collect();
            let mut left = match (target, m) {
                (Target::Laplacian, 0) => square,
                (Target::Along(way), 1) => C::from(way[part] / self.reach),
                _ => C::new(0.0, 0.0),
            };
            for (k, wave) in waves.iter().enumerate() {
                left -= (added[k] * self.roots[k] + base[k].1) * wave;
            }
            let own = waves.iter().zip(&self.roots).map(|(u, g)| u.conj() * *g);
            let mut own: Vec<C> = own.collect();
            let whole = size(&own);
            // Twice is enough.
            for _ in 0..2 {
                for basis in &bases {
                    let along: C = basis.iter().zip(&own).map(|(b, o)| b.conj() * o).sum();
                    own.iter_mut().zip(basis).for_each(|(o, b)| *o -= along * b);
                }
            }
            let rest = size(&own);
            if rest > ALIKE * whole {
                own.iter_mut().for_each(|o| *o /= rest);
                let share = left / rest;
                added
                    .iter_mut()
                    .zip(&own)
                    .for_each(|(a, o)| *a += share * o);
                bases.push(own);
            }
        }
        added
            .iter()
            .zip(&self.roots)
            .map(|(a, root)| a * *root)
            .collect()
    }
}

fn size(all: &[C]) -> f64 {
    all.iter().map(C::norm_sqr).sum::<f64>().sqrt()
}

/// `0F1(; m + 1; q)`.
fn series(m: usize, q: C) -> C {
    let (mut term, mut sum, mut s) = (C::new(1.0, 0.0), C::new(1.0, 0.0), 0.0);
    while term.norm_sqr() > 1e-34 * sum.norm_sqr() {
        s += 1.0;
        term *= q / (s * (m as f64 + s));
        sum += term;
    }
    sum
}

impl Waves {
    /// Of the conductors that these serve, at an angular frequency; none where there are none, about an axis, and in space.
    #[must_use]
    pub fn new<const D: usize>(
        conductors: &Conductors,
        region: &Region<D>,
        omega: f64,
        serves: impl Fn(u16) -> bool,
    ) -> Option<Self> {
        let square = |(m, mu_sigma): (usize, &f64)| match serves(m as u16) {
            true => C::new(0.0, omega * mu_sigma),
            false => C::new(0.0, 0.0),
        };
        let squares: Vec<C> = conductors.mu_sigma.iter().enumerate().map(square).collect();
        let there = D == 2 && !region.axial && squares.iter().any(|k| k.im != 0.0);
        there.then_some(Self { squares })
    }

    /// Weights at point `i` from those of polynomials, in a medium; none where polynomials serve.
    pub(crate) fn weights<const D: usize>(
        &self,
        region: &Region<D>,
        i: usize,
        medium: u16,
        base: &[(usize, f64)],
        target: Target,
    ) -> Option<Vec<(u32, C)>> {
        let square = self.squares[medium as usize];
        if square.norm() == 0.0 {
            return None;
        }
        let support = Support::new(region, i, base);
        if square.norm().sqrt() * support.reach > FARTHEST {
            return None;
        }
        let added = support.added(base, square, target);
        let both = base.iter().zip(added);
        Some(both.map(|((j, w), d)| (*j as u32, d + w)).collect())
    }

    /// Derivatives of a field at a point of a conductor along the coordinates, from the stencils of polynomials there.
    pub(crate) fn slope<const D: usize>(
        &self,
        region: &Region<D>,
        i: usize,
        medium: u16,
        stencils: &Stencils<D>,
        field: impl Fn(usize) -> C,
    ) -> Option<[C; D]> {
        let mut slopes = [C::new(0.0, 0.0); D];
        for (axis, slope) in slopes.iter_mut().enumerate() {
            let base: Vec<(usize, f64)> = stencils.derivative(i, axis).iter().collect();
            let mut way = [0.0; 2];
            way[axis] = 1.0;
            let weights = self.weights(region, i, medium, &base, Target::Along(way))?;
            *slope = weights.iter().map(|(j, w)| w * field(*j as usize)).sum();
        }
        Some(slopes)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::stencils::region::Kind;
    use crate::stencils::sides::{Form, Sides};

    /// A patch of a plane, of rows that are shifted to and fro, of medium 1 throughout.
    fn patch() -> Region<2> {
        let mut region = Region::default();
        for (row, column) in (-6..=6).flat_map(|row| (-6..=6).map(move |column| (row, column))) {
            let (x, y) = (f64::from(column), f64::from(row));
            let off = 0.13 * (2.3 * x + 1.7 * y).sin();
            region.places.push([x + off, y - 0.11 * (1.9 * x).cos()]);
            region.metrics.push(wls::Metric::round(1.0));
            region.kinds.push(Kind::Inside(1));
            region.wall_normals.push([0.0; 2]);
        }
        region
    }

    fn conductors(square: f64) -> Conductors {
        Conductors {
            mu_sigma: vec![0.0, square],
            axial: None,
            permeable: None,
        }
    }

    /// Errors of the Laplacian and of the slope of a wave `exp(k n x)` at the middle, over `|k|^2` and `|k|`, with the
    /// weights of polynomials and with those of waves.
    fn errors(square: f64, turn: f64) -> [[f64; 2]; 2] {
        let region = patch();
        let form = Form {
            order: 4,
            ..Form::default()
        };
        let sides = Sides::new(&region, &form).unwrap();
        let conductors = conductors(square);
        let waves = Waves::new(&conductors, &region, 1.0, |_| true).unwrap();
        let k = C::new(0.0, square).sqrt();
        let i = region.len() / 2;
        let field = |j: usize| {
            let [x, y] = region.places[j];
            let [a, b] = region.places[i];
            (k * ((x - a) * turn.cos() + (y - b) * turn.sin())).exp()
        };
        let base: Vec<(usize, f64)> = sides.own.laplacian(i).iter().collect();
        let weights = waves
            .weights(&region, i, 1, &base, Target::Laplacian)
            .unwrap();
        let found: C = weights.iter().map(|(j, w)| w * field(*j as usize)).sum();
        let plain = sides.own.laplacian(i).apply_with(field);
        let slope = waves.slope(&region, i, 1, &sides.own, field).unwrap();
        let bare = sides.own.derivative(i, 0).apply_with(field);
        let along = k * turn.cos();
        let off = |a: C, b: C, scale: f64| (a - b).norm() / scale;
        [
            [off(plain, k * k, square), off(bare, along, square.sqrt())],
            [
                off(found, k * k, square),
                off(slope[0], along, square.sqrt()),
            ],
        ]
    }

    #[test]
    fn waves_of_any_direction_obey_their_equation() {
        for turn in [0.0, 0.4, 1.1, 2.9] {
            let [[bare, slope], [laplacian, along]] = errors(0.5, turn);
            assert!(
                bare > 3e-4 && slope > 1e-3,
                "{turn}: {bare:.2e} {slope:.2e}"
            );
            assert!(
                laplacian < 0.1 * bare,
                "{turn}: {laplacian:.2e}, {bare:.2e}"
            );
            assert!(along < 0.02 * slope, "{turn}: {along:.2e}, {slope:.2e}");
        }
        // Where a spacing is small against the skin depth polynomials serve as well.
        let [[bare, _], [laplacian, _]] = errors(1e-4, 0.3);
        assert!(
            bare < 1e-6 && laplacian < 1e-9,
            "{bare:.2e} {laplacian:.2e}"
        );
    }

    #[test]
    fn series_are_those_of_bessel() {
        // 0F1(; 1; q) = I_0(2 sqrt q), 0F1(; 2; q) = I_1(2 sqrt q) / sqrt q; at q = 1 I_0(2) and I_1(2).
        let [zero, one] = [0, 1].map(|m| series(m, C::new(1.0, 0.0)).re);
        assert!((zero - 2.279_585_302_336_067).abs() < 1e-14);
        assert!((one - 1.590_636_854_637_329).abs() < 1e-14);
    }

    #[test]
    fn what_is_not_asked_for_has_none() {
        let region = patch();
        let none = |conductors: &Conductors| Waves::new(conductors, &region, 1.0, |_| true);
        assert!(none(&conductors(0.0)).is_none());
        let waves = none(&conductors(0.5)).unwrap();
        let base = [(region.len() / 2, -1.0), (0, 1.0)];
        let weights = |medium, square: f64| {
            let waves = Waves {
                squares: waves.squares.iter().map(|k| k * square).collect(),
            };
            waves.weights(&region, region.len() / 2, medium, &base, Target::Laplacian)
        };
        assert!(weights(0, 1.0).is_none());
        assert!(weights(1, 1.0).is_some());
        // The skin depth is a small part of the support.
        assert!(weights(1, 1e3).is_none());
        assert!(Waves::new(&conductors(0.5), &region, 1.0, |_| false).is_none());
        let space = Region::<3>::default();
        assert!(Waves::new(&conductors(0.5), &space, 1.0, |_| true).is_none());
        let about = Region::<2> {
            axial: true,
            ..patch()
        };
        assert!(Waves::new(&conductors(0.5), &about, 1.0, |_| true).is_none());
    }
}
