//! A conducting sphere in the field of coaxial loops, or in a uniform field.
//!
//! The potential is `A = A_phi(r, theta)` around the axis z. Outside, sources give
//! `sum c_n r^n P_n^1`, the reaction `sum b_n r^(-n-1) P_n^1`; inside, `lap A = k^2 A` with
//! `k^2 = j w mu sigma` has `sum a_n i_n(k r) P_n^1` with modified spherical Bessel functions. A and
//! `d(r A)/dr / mu` are continuous, so that with `q_n = i_n / i_{n-1}` at `x = k R` and mu over that outside
//! `a_n i_{n-1}(x) ((x - n q_n) / mu + n q_n) = (2n+1) c_n R^n`, `b_n = (a_n i_n(x) - c_n R^n) R^(n+1)`
//! (Smythe 1950, chapter XI; Brisley and Thornton 1963). `P_n^1 = -dP_n/d theta`.

pub mod anywhere;

use std::f64::consts::PI;

use super::bessel::{scaled_i0_spherical, spherical_ratios};
use super::{C, MU0};

/// A loop around the axis z.
#[derive(Debug, Clone, Copy)]
pub struct Loop {
    /// Radius \[m\].
    pub radius: f64,
    /// Height above the centre of the sphere \[m\].
    pub height: f64,
    /// Current \[A\].
    pub current: f64,
}

impl Loop {
    /// The same current spread evenly over a round wire: filaments by the rule of Gauss along its
    /// radius and of equal parts around.
    #[must_use]
    pub fn thick(self, wire_radius: f64) -> Vec<Self> {
        let nodes = [-0.906_179_845_938_664, -0.538_469_310_105_683, 0.0];
        let weights = [
            0.236_926_885_056_189_1,
            0.478_628_670_499_366_5,
            0.568_888_888_888_888_9,
        ];
        let around = 12;
        let mut found = Vec::new();
        for k in 0..5_usize {
            let node = if k < 3 { nodes[k] } else { -nodes[4 - k] };
            let r = wire_radius * 0.5 * (1.0 + node);
            let share = weights[k.min(4 - k)] * r / wire_radius;
            for m in 0..around {
                let angle = 2.0 * PI * f64::from(m) / f64::from(around);
                found.push(Self {
                    radius: self.radius + r * angle.cos(),
                    height: self.height + r * angle.sin(),
                    current: self.current * share / f64::from(around),
                });
            }
        }
        found
    }

    /// Distance from the centre \[m\], and cosine of the polar angle.
    fn place(&self) -> (f64, f64) {
        let d = self.radius.hypot(self.height);
        (d, self.height / d)
    }
}

/// The sphere; its centre is the origin.
#[derive(Debug, Clone, Copy)]
pub struct Body {
    /// Radius \[m\].
    pub radius: f64,
    /// Conductivity \[S/m\].
    pub conductivity: f64,
    /// Permeability over that of vacuum, which is outside.
    pub permeability: f64,
    /// Frequency \[Hz\].
    pub frequency: f64,
}

/// What surrounds it.
#[derive(Debug, Clone, Default)]
pub struct Sources {
    /// Loops, all further from the centre than the surface.
    pub loops: Vec<Loop>,
    /// Uniform flux density along z \[T\].
    pub uniform: f64,
}

/// The solution. Phasors go as `exp(j w t)`; all are rms values if currents and fields are.
#[derive(Debug, Clone)]
pub struct Solution {
    body: Body,
    sources: Sources,
    k: C,
    /// `c_n R^n` by n - 1.
    given: Vec<f64>,
    /// `a_n i_{n-1}(k R)` by n - 1.
    within: Vec<C>,
    /// `b_n R^(-n-1)` by n - 1.
    reaction: Vec<C>,
    /// `i_n(k R) / i_{n-1}(k R)` by n - 1.
    ratios: Vec<C>,
}

impl Solution {
    /// Solves by as many terms as double precision can see.
    #[must_use]
    pub fn of(body: Body, sources: Sources) -> Self {
        let near = sources
            .loops
            .iter()
            .map(|l| body.radius / l.place().0)
            .fold(0.5, f64::max);
        let terms = ((1e-17_f64.ln() / near.ln()) as usize + 10).min(4000);
        let w = 2.0 * PI * body.frequency;
        let mu = body.permeability;
        let k = C::new(0.0, w * MU0 * mu * body.conductivity).sqrt();
        let x = k * body.radius;
        let given = given(&body, &sources, terms);
        let ratios = spherical_ratios(terms, x);
        let degree = |n: usize| 2.0 * (n + 1) as f64 + 1.0;
        let own = |n: usize| {
            let part = ratios[n] * (n + 1) as f64;
            degree(n) * given[n] / ((x - part) / mu + part)
        };
        let within: Vec<C> = (0..terms).map(own).collect();
        let reaction = (0..terms).map(|n| within[n] * ratios[n] - given[n]);
        let reaction = reaction.collect();
        Self {
            body,
            sources,
            k,
            given,
            within,
            reaction,
            ratios,
        }
    }

    /// Radius of the sphere \[m\].
    #[must_use]
    pub fn radius(&self) -> f64 {
        self.body.radius
    }

    fn omega(&self) -> f64 {
        2.0 * PI * self.body.frequency
    }

    /// `a_n i_n(k r)` and `a_n d(r i_n(k r))/dr` by n - 1, for r up to R.
    fn radial(&self, r: f64) -> Vec<[C; 2]> {
        let [z, x] = [self.k * r, self.k * self.body.radius];
        let inner = spherical_ratios(self.within.len(), z);
        // i_{n-1}(z) / i_{n-1}(x), from n = 1 on.
        let mut share = scaled_i0_spherical(z) / scaled_i0_spherical(x) * (z - x).exp();
        let mut found = Vec::with_capacity(inner.len());
        for (n, ratio) in inner.iter().enumerate() {
            let lower = self.within[n] * share;
            let value = lower * ratio;
            // d(r i_n)/dr = z i_{n-1} - n i_n.
            found.push([value, z * lower - (n + 1) as f64 * value]);
            share *= ratio / self.ratios[n];
        }
        found
    }

    /// Potential around the axis \[V s/m\] at the distance `rho` from it and the height `z`: source and
    /// reaction together; inside the sphere, or outside it and nearer than every loop, or where
    /// there are no loops.
    #[must_use]
    pub fn potential(&self, rho: f64, z: f64) -> C {
        let (r, cosine) = polar(rho, z);
        let angular = Legendre::of(self.given.len(), cosine);
        let radial = self.radial_total(r);
        radial
            .iter()
            .zip(&angular.first)
            .map(|(f, p)| f[0] * p)
            .sum()
    }

    /// Flux density \[T\] away from and along the axis, where [`Self::potential`] holds.
    #[must_use]
    pub fn flux(&self, rho: f64, z: f64) -> [C; 2] {
        let (r, cosine) = polar(rho, z);
        curl(&self.radial_total(r), r, cosine)
    }

    /// Current density around the axis \[A/m2\] inside the sphere.
    #[must_use]
    pub fn current(&self, rho: f64, z: f64) -> C {
        C::new(0.0, -self.omega() * self.body.conductivity) * self.potential(rho, z)
    }

    /// The reaction alone, outside the sphere: flux density away from and along the axis \[T\].
    #[must_use]
    pub fn reaction(&self, rho: f64, z: f64) -> [C; 2] {
        let (r, cosine) = polar(rho, z);
        let parts: Vec<[C; 2]> = self.reaction_radial(r).collect();
        curl(&parts, r, cosine)
    }

    fn reaction_radial(&self, r: f64) -> impl Iterator<Item = [C; 2]> {
        let q = self.body.radius / r;
        self.reaction.iter().enumerate().map(move |(n, b)| {
            let value = b * q.powi(n as i32 + 2);
            [value, -((n + 1) as f64) * value]
        })
    }

    /// Radial factors of A and of d(r A)/dr.
    fn radial_total(&self, r: f64) -> Vec<[C; 2]> {
        if r <= self.body.radius {
            return self.radial(r);
        }
        let q = r / self.body.radius;
        let outer = self.given.iter().enumerate().map(|(n, c)| {
            let value = C::from(c * q.powi(n as i32 + 1));
            [value, value * (n + 2) as f64]
        });
        outer
            .zip(self.reaction_radial(r))
            .map(|(a, b)| [a[0] + b[0], a[1] + b[1]])
            .collect()
    }

    /// Time mean of the force along z on the sphere \[N\]: the opposite of that on the loops. A uniform
    /// field exerts none.
    #[must_use]
    pub fn lift(&self) -> f64 {
        // On a loop: dl x B has -B_rho along z.
        self.sources
            .loops
            .iter()
            .map(|l| 2.0 * PI * l.radius * l.current * self.reaction(l.radius, l.height)[0].re)
            .sum()
    }

    /// Joule heat \[W\]: `w^2 sigma int |A|^2 dV`, whose radial integrals are in closed form,
    /// `int_0^R |u|^2 r^2 dr = R^2 Im(u' u*) / q` for `lap u = j q u` (after Lommel).
    #[must_use]
    pub fn power(&self) -> f64 {
        let q = self.omega() * MU0 * self.body.permeability * self.body.conductivity;
        let radius = self.body.radius;
        let mut sum = 0.0;
        for n in 0..self.within.len() {
            let degree = (n + 1) as f64;
            let u = self.within[n] * self.ratios[n];
            let slope = (self.k * radius * self.within[n] - (degree + 1.0) * u) / radius;
            let norm = 2.0 * degree * (degree + 1.0) / (2.0 * degree + 1.0);
            sum += norm * radius * radius * (slope * u.conj()).im / q;
        }
        self.omega().powi(2) * self.body.conductivity * 2.0 * PI * sum
    }

    /// Largest current density \[A/m2\], searched on the surface, and the polar angle where it stands.
    #[must_use]
    pub fn largest_current(&self) -> (f64, f64) {
        let at = |angle: f64| {
            let (rho, z) = (angle.sin(), angle.cos());
            let r = self.body.radius * (1.0 - 1e-12);
            self.current(rho * r, z * r).norm()
        };
        let count = 720;
        let angles = (1..count).map(|k| PI * f64::from(k) / f64::from(count));
        angles
            .map(|a| (at(a), a))
            .fold((0.0, 0.0), |m, v| if v.0 > m.0 { v } else { m })
    }
}

/// `c_n R^n` by n - 1.
fn given(body: &Body, sources: &Sources, terms: usize) -> Vec<f64> {
    let mut found = vec![0.0; terms];
    for l in &sources.loops {
        let (d, cosine) = l.place();
        let sine = l.radius / d;
        let legendre = Legendre::of(terms, cosine);
        for (n, c) in found.iter_mut().enumerate() {
            let degree = (n + 1) as f64;
            let q = (body.radius / d).powi(n as i32 + 1);
            let factor = 0.5 * MU0 * l.current * sine / (degree * (degree + 1.0));
            *c += factor * q * legendre.first[n];
        }
    }
    found[0] += 0.5 * sources.uniform * body.radius;
    found
}

/// Flux density away from and along the axis of `sum f_n(r) P_n^1`, from f_n and d(r f_n)/dr.
fn curl(radial: &[[C; 2]], r: f64, cosine: f64) -> [C; 2] {
    let angular = Legendre::of(radial.len(), cosine);
    let zero = C::new(0.0, 0.0);
    let [mut outward, mut polar] = [zero, zero];
    for (n, f) in radial.iter().enumerate() {
        let degree = (n + 1) as f64;
        outward += f[0] * (degree * (degree + 1.0) * angular.zeroth[n]);
        polar -= f[1] * angular.first[n];
    }
    let sine = (1.0 - cosine * cosine).max(0.0).sqrt();
    [
        (outward * sine + polar * cosine) / r,
        (outward * cosine - polar * sine) / r,
    ]
}

fn polar(rho: f64, z: f64) -> (f64, f64) {
    let r = rho.hypot(z).max(f64::MIN_POSITIVE);
    (r, z / r)
}

/// `P_n` and `P_n^1 = sin P_n'` by n - 1.
struct Legendre {
    zeroth: Vec<f64>,
    first: Vec<f64>,
}

impl Legendre {
    fn of(terms: usize, x: f64) -> Self {
        let sine = (1.0 - x * x).max(0.0).sqrt();
        let [mut zeroth, mut first] = [Vec::with_capacity(terms), Vec::with_capacity(terms)];
        let [mut before, mut now] = [1.0, x];
        let [mut slope_before, mut slope] = [0.0, 1.0];
        for n in 1..=terms {
            zeroth.push(now);
            first.push(sine * slope);
            let degree = n as f64;
            let next = ((2.0 * degree + 1.0) * x * now - degree * before) / (degree + 1.0);
            // P_{n+1}' = P_{n-1}' + (2n+1) P_n.
            let slope_next = slope_before + (2.0 * degree + 1.0) * now;
            (before, now) = (now, next);
            (slope_before, slope) = (slope, slope_next);
        }
        Self { zeroth, first }
    }
}

#[cfg(test)]
mod tests;
