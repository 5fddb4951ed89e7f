//! How the heat of a torch is distributed.
//!
//! Goldak, Chakravarti and Bibby (1984), eqs 8 and 9, with xi ahead along the path, eta across it and zeta into the body:
//!
//! ```text
//! q = 6 sqrt(3) f P / (pi sqrt(pi) a b c) exp(-3 xi^2/c^2 - 3 eta^2/a^2 - 3 zeta^2/b^2),   zeta >= 0
//! ```
//!
//! with f_f and c_f ahead of the torch, f_r and c_r behind, f_f + f_r = 2. On a surface, with radius R and rho the distance from the axis
//! of the torch,
//!
//! ```text
//! q = 3 P / (pi R^2) exp(-3 rho^2/R^2)
//! ```
//!
//! Half axes and radius are where q has fallen to 5 % (e^-3) of its greatest. Along an axis q is a Gaussian of the variance A = c^2/6;
//! its mean over a cell of the variance B = d^2/12 is one of the variance A + B, and of half a Gaussian
//!
//! ```text
//! int_0^inf exp(-u^2/2A) N(xi - u; B) du = sqrt(A/(A+B)) exp(-xi^2/2(A+B)) erfc(-xi sqrt(A/(2 B (A+B)))) / 2
//! ```

use std::f64::consts::{FRAC_1_SQRT_2, PI};

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::erfc::erfc;

/// Goldak's double ellipsoid.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct DoubleEllipsoid {
    /// a: half width across the path \[m\].
    #[schemars(range(min = 1e-9), extend("x-unit" = "m"))]
    pub half_width_m: f64,
    /// b: depth into the body \[m\].
    #[schemars(range(min = 1e-9), extend("x-unit" = "m"))]
    pub depth_m: f64,
    /// c_f: length ahead of the torch \[m\].
    #[schemars(range(min = 1e-9), extend("x-unit" = "m"))]
    pub front_m: f64,
    /// c_r: length behind it \[m\].
    #[schemars(range(min = 1e-9), extend("x-unit" = "m"))]
    pub rear_m: f64,
    /// f_f: half of it is the share of the heat ahead of the torch. 2 c_f/(c_f + c_r) if absent, which makes q continuous.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0.0, max = 2.0), extend("x-unit" = "1"))]
    pub front_fraction: Option<f64>,
}

/// A Gaussian on the surface.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Gaussian {
    /// R: 95 % of the heat falls within it; the standard deviation is R/sqrt(6) \[m\].
    #[schemars(range(min = 1e-9), extend("x-unit" = "m"))]
    pub radius_m: f64,
}

/// How heat is distributed.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[schemars(rename = "TorchShape")]
pub enum Shape {
    /// In the volume, as Goldak, Chakravarti and Bibby (1984).
    DoubleEllipsoid(DoubleEllipsoid),
    /// On the surface that faces the torch.
    Gaussian(Gaussian),
}

/// Beyond so many half axes nothing is left: exp(-3 reach^2) is 2e-19.
const REACH: f64 = 3.8;

/// A Gaussian of the variance `a`, 1 at 0, as its mean over a cell of the variance `b`.
fn bell(x: f64, a: f64, b: f64) -> f64 {
    (a / (a + b)).sqrt() * (-x * x / (2.0 * (a + b))).exp()
}

/// The half above 0 of the same.
fn half_bell(x: f64, a: f64, b: f64) -> f64 {
    if b <= 0.0 {
        return if x >= 0.0 { bell(x, a, b) } else { 0.0 };
    }
    bell(x, a, b) * 0.5 * erfc(-x * (a / (a + b)).sqrt() / b.sqrt() * FRAC_1_SQRT_2)
}

fn variance(half_axis: f64) -> f64 {
    half_axis * half_axis / 6.0
}

impl DoubleEllipsoid {
    /// q over P \[1/m3\] at (xi, eta, zeta) \[m\], as the mean over a cell of the size `d` \[m\].
    #[must_use]
    pub fn density(&self, place: [f64; 3], d: f64) -> f64 {
        self.spread(place, d * d / 12.0)
    }

    /// The same as the mean over a cloud of the variance `b` \[m2\].
    #[must_use]
    pub fn spread(&self, [xi, eta, zeta]: [f64; 3], b: f64) -> f64 {
        let (front, rear) = (self.front_m, self.rear_m);
        let ahead = self.front_fraction.unwrap_or(2.0 * front / (front + rear));
        let lengthwise = ahead / front * half_bell(xi, variance(front), b)
            + (2.0 - ahead) / rear * half_bell(-xi, variance(rear), b);
        let section =
            bell(eta, variance(self.half_width_m), b) * bell(zeta, variance(self.depth_m), b);
        let whole = 6.0 * 3.0_f64.sqrt() / (PI * PI.sqrt() * self.half_width_m * self.depth_m);
        whole * lengthwise * section
    }

    /// Part of the greatest q that is left of it as the mean over a cell of the size `d` \[m\].
    fn peak(&self, d: f64) -> f64 {
        let b = d * d / 12.0;
        let left = |half_axis: f64| bell(0.0, variance(half_axis), b);
        let (front, rear) = (self.front_m, self.rear_m);
        let ahead = self.front_fraction.unwrap_or(2.0 * front / (front + rear));
        let sides = [ahead / front, (2.0 - ahead) / rear];
        let lengthwise = sides[0] * left(front) + sides[1] * left(rear);
        lengthwise / (sides[0] + sides[1]) * left(self.half_width_m) * left(self.depth_m)
    }
}

impl Gaussian {
    /// q over P \[1/m2\] at the distance `rho` from the axis \[m\], as the mean over a patch of the size `d` \[m\].
    #[must_use]
    pub fn density(&self, rho: f64, d: f64) -> f64 {
        self.spread(rho, d * d / 12.0)
    }

    /// The same as the mean over a cloud of the variance `b` \[m2\].
    #[must_use]
    pub fn spread(&self, rho: f64, b: f64) -> f64 {
        let a = variance(self.radius_m);
        // Two axes across: the factor in front is that of one squared.
        3.0 / (PI * self.radius_m * self.radius_m) * a / (a + b)
            * (-rho * rho / (2.0 * (a + b))).exp()
    }
}

impl Shape {
    /// Least half axis \[m\].
    #[must_use]
    pub fn least(&self) -> f64 {
        match self {
            Self::DoubleEllipsoid(e) => [e.half_width_m, e.depth_m, e.front_m, e.rear_m]
                .into_iter()
                .fold(f64::INFINITY, f64::min),
            Self::Gaussian(g) => g.radius_m,
        }
    }

    /// q over P \[1/m3\] at (xi, eta, zeta) \[m\] once it has spread by the variance `b` \[m2\] along every axis.
    #[must_use]
    pub fn spread(&self, [xi, eta, zeta]: [f64; 3], b: f64) -> f64 {
        match self {
            Self::DoubleEllipsoid(e) => e.spread([xi, eta, zeta], b),
            // All heat of the surface goes into the half space.
            Self::Gaussian(g) => {
                let into = 2.0 * (-zeta * zeta / (2.0 * b)).exp() / (2.0 * PI * b).sqrt();
                g.spread(xi.hypot(eta), b) * into
            }
        }
    }

    /// Part of its greatest q that points of the spacing `d` \[m\] show: 1 where they are fine, and ever less the more they widen it.
    #[must_use]
    pub fn peak(&self, d: f64) -> f64 {
        match self {
            Self::DoubleEllipsoid(e) => e.peak(d),
            Self::Gaussian(g) => g.density(0.0, d) / g.density(0.0, 0.0),
        }
    }

    /// Greatest half axis \[m\].
    pub(crate) fn greatest(&self) -> f64 {
        match self {
            Self::DoubleEllipsoid(e) => [e.half_width_m, e.depth_m, e.front_m, e.rear_m]
                .into_iter()
                .fold(0.0, f64::max),
            Self::Gaussian(g) => g.radius_m,
        }
    }

    /// Distance beyond which a cell of the size `d` \[m\] gets nothing \[m\].
    #[must_use]
    pub fn reach(&self, d: f64) -> f64 {
        let greatest = self.greatest();
        // The half axis of the variance of both.
        REACH * (greatest * greatest + 0.5 * d * d).sqrt()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const GOLDAK: DoubleEllipsoid = DoubleEllipsoid {
        half_width_m: 2.0,
        depth_m: 1.5,
        front_m: 1.0,
        rear_m: 3.0,
        front_fraction: None,
    };

    #[test]
    fn the_formula_of_the_source_is_met_and_continuous() {
        let f_f = 2.0 * 1.0 / 4.0;
        let print = |x: [f64; 3], f: f64, c: f64| {
            let exponent =
                -3.0 * (x[0].powi(2) / c.powi(2) + x[1].powi(2) / 4.0 + x[2].powi(2) / 2.25);
            6.0 * 3.0_f64.sqrt() * f / (2.0 * 1.5 * c * PI.powf(1.5)) * exponent.exp()
        };
        let ahead = [0.4, 0.3, 0.2];
        let behind = [-0.4, 0.3, 0.2];
        assert!((GOLDAK.density(ahead, 0.0) / print(ahead, f_f, 1.0) - 1.0).abs() < 1e-14);
        assert!((GOLDAK.density(behind, 0.0) / print(behind, 2.0 - f_f, 3.0) - 1.0).abs() < 1e-14);
        let beside = [1e-12, -1e-12].map(|x| GOLDAK.density([x, 0.1, 0.1], 0.0));
        assert!((beside[0] / beside[1] - 1.0).abs() < 1e-9);
    }

    #[test]
    fn the_half_space_holds_the_whole_power_at_any_spacing() {
        // A sum over a lattice errs on a bell by its first harmonic, 2 exp(-2 pi^2 (A + B)/d^2) along each axis.
        let harmonic = |c: f64, d: f64| {
            let spread = variance(c) + d * d / 12.0;
            2.0 * (-2.0 * PI * PI * spread / (d * d)).exp()
        };
        // Sums over lattices half a spacing below the surface, far finer and coarser than the source.
        for d in [0.25, 0.5, 1.0, 2.0] {
            let n = (24.0 / d) as i32;
            let mut sum = 0.0;
            for i in -n..n {
                for j in -n..n {
                    for k in 0..n {
                        let at = [i, j, k].map(|m| (f64::from(m) + 0.5) * d);
                        sum += GOLDAK.density(at, d) * d.powi(3);
                    }
                }
            }
            let each = [1.0, 1.5, 2.0].map(|c| harmonic(c, d));
            let allowed = 1e-6 + 1.5 * each.iter().sum::<f64>();
            assert!((sum - 1.0).abs() < allowed, "{d}: {sum}");
        }
        let disc = Gaussian { radius_m: 2.0 };
        for d in [0.25, 0.5, 1.0] {
            let n = (20.0 / d) as i32;
            let each = (-n..n).flat_map(|i| (-n..n).map(move |j| (i, j)));
            let sum: f64 = each
                .map(|(i, j)| {
                    let at = [i, j].map(|m| (f64::from(m) + 0.5) * d);
                    disc.density(at[0].hypot(at[1]), d) * d * d
                })
                .sum();
            let allowed = 1e-6 + 1.5 * 2.0 * harmonic(disc.radius_m, d);
            assert!((sum - 1.0).abs() < allowed, "{d}: {sum}");
        }
    }

    #[test]
    fn a_peak_falls_as_its_variances_grow() {
        // (1 + d^2/2R^2)^-1 across both axes; each axis of an ellipsoid has the root of that.
        let disc = Shape::Gaussian(Gaussian { radius_m: 2.0 });
        let deep = Shape::DoubleEllipsoid(GOLDAK);
        assert!((deep.peak(0.0) - 1.0).abs() < 1e-15 && (disc.peak(2.0) - 1.0 / 1.5).abs() < 1e-15);
        let left = |c: f64| (1.0 + 0.5 / (c * c)).sqrt().recip();
        let exact = 0.5 * (left(1.0) + left(3.0)) * left(2.0) * left(1.5);
        assert!((deep.peak(1.0) - exact).abs() < 1e-15);
        assert!(deep.peak(1e6) < 1e-12);
    }

    #[test]
    fn half_bells_make_a_bell_and_hold_what_quadrature_finds() {
        for (x, a, b) in [(0.3, 1.0, 0.2), (-0.9, 0.5, 2.0), (4.0, 1.0, 0.01)] {
            let both = half_bell(x, a, b) + half_bell(-x, a, b);
            assert!((both - bell(x, a, b)).abs() < 1e-15);
            let (n, end) = (200_000, 30.0);
            let step = end / f64::from(n);
            let sum: f64 = (0..n)
                .map(|k| {
                    let u = (f64::from(k) + 0.5) * step;
                    let cell = (-(x - u).powi(2) / (2.0 * b)).exp() / (2.0 * PI * b).sqrt();
                    (-u * u / (2.0 * a)).exp() * cell * step
                })
                .sum();
            assert!((sum - half_bell(x, a, b)).abs() < 1e-8, "{x} {sum}");
        }
    }
}
