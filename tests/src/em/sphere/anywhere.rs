//! A conducting sphere among loops that lie anywhere.
//!
//! What the sphere does to a field of degree n does not depend on its orientation. The sources are known by
//! their radial flux density on the sphere, which the rule of Gauss times that of equal parts splits into
//! degrees by `P_n` (addition theorem). Of their potential the part `r x grad psi_n`, with
//! `psi_n = -R B_n / (n (n+1))` on the sphere, drives currents; the rest, which points out of the sphere,
//! is met by charges on its surface.

use std::f64::consts::PI;

use super::{Body, C, MU0, Solution, Sources};

/// A loop anywhere outside the sphere.
#[derive(Debug, Clone, Copy)]
pub struct Coil {
    /// Centre \[m\], from that of the sphere.
    pub centre: [f64; 3],
    /// Unit axis, right-handed with the current.
    pub axis: [f64; 3],
    /// Radius \[m\].
    pub radius: f64,
    /// Current \[A\].
    pub current: f64,
}

impl Coil {
    /// Places along the loop, and the tangents times the current and a piece's length \[A m\].
    fn pieces(&self, count: usize) -> Vec<[[f64; 3]; 2]> {
        let least = (0..3).fold(0, |m, k| {
            if self.axis[k].abs() < self.axis[m].abs() {
                k
            } else {
                m
            }
        });
        let mut other = [0.0; 3];
        other[least] = 1.0;
        let u = cross(other, self.axis);
        let size = dot(u, u).sqrt();
        let u = u.map(|x| x / size);
        let v = cross(self.axis, u);
        let step = 2.0 * PI / count as f64;
        let piece = |k: usize| {
            let (s, c) = (step * k as f64).sin_cos();
            let away = [0, 1, 2].map(|i| c * u[i] + s * v[i]);
            let along = [0, 1, 2].map(|i| c * v[i] - s * u[i]);
            let place = [0, 1, 2].map(|i| self.centre[i] + self.radius * away[i]);
            [place, along.map(|t| t * step * self.radius * self.current)]
        };
        (0..count).map(piece).collect()
    }
}

/// Pieces of a loop.
const PIECES: usize = 720;
/// Highest degree.
const TERMS: usize = 28;

/// The solution.
#[derive(Debug, Clone)]
pub struct Anywhere {
    body: Body,
    /// Of every degree one.
    unit: Solution,
    /// Directions, their weights times the radial flux density of the sources \[T\].
    nodes: Vec<([f64; 3], f64)>,
    coils: Vec<Coil>,
}

impl Anywhere {
    /// Solves; loops are at least 1.4 radii from the centre.
    #[must_use]
    pub fn of(body: Body, coils: Vec<Coil>) -> Self {
        let mut unit = Solution::of(body, Sources::default());
        let terms = TERMS;
        let x = unit.k * body.radius;
        unit.given = vec![1.0; terms];
        unit.ratios = super::spherical_ratios(terms, x);
        unit.within = (0..terms).map(|n| (2 * n + 3) as f64 / x).collect();
        unit.reaction = (0..terms)
            .map(|n| unit.within[n] * unit.ratios[n] - 1.0)
            .collect();
        let pieces: Vec<_> = coils.iter().flat_map(|c| c.pieces(PIECES)).collect();
        let mut nodes = Vec::new();
        let rows = 2 * terms;
        for (z, weight) in gauss(rows) {
            let s = (1.0 - z * z).sqrt();
            for m in 0..2 * rows {
                let angle = PI * m as f64 / rows as f64;
                let n = [s * angle.cos(), s * angle.sin(), z];
                let b = biot_savart(&pieces, n.map(|n| n * body.radius));
                let weight = weight * PI / rows as f64;
                nodes.push((n, weight * dot(b, n)));
            }
        }
        Self {
            body,
            unit,
            nodes,
            coils,
        }
    }

    /// Joule heat \[W\].
    #[must_use]
    pub fn power(&self) -> f64 {
        let q = self.unit.omega() * MU0 * self.body.permeability * self.body.conductivity;
        let radius = self.body.radius;
        let mut energy = [0.0; TERMS];
        for (a, f) in &self.nodes {
            // int B_n^2 = int B B_n.
            for (energy, b) in energy.iter_mut().zip(self.degrees(*a)) {
                *energy += f * b;
            }
        }
        let mut sum = 0.0;
        for (n, energy) in energy.iter().enumerate() {
            let degree = (n + 1) as f64;
            let u = self.unit.within[n] * self.unit.ratios[n];
            let slope = (self.unit.k * radius * self.unit.within[n] - (degree + 1.0) * u) / radius;
            let source = radius * radius / (degree * (degree + 1.0)) * energy;
            sum += source * radius * radius * (slope * u.conj()).im / q;
        }
        self.unit.omega().powi(2) * self.body.conductivity * sum
    }

    /// Radial flux density of the sources in a direction on the sphere, by degree n - 1.
    fn degrees(&self, a: [f64; 3]) -> [f64; TERMS] {
        let mut sum = [0.0; TERMS];
        for (b, f) in &self.nodes {
            let x = dot(a, *b);
            let [mut before, mut now] = [1.0, x];
            for (n, sum) in sum.iter_mut().enumerate() {
                *sum += f * now;
                let degree = (n + 1) as f64;
                let next = ((2.0 * degree + 1.0) * x * now - degree * before) / (degree + 1.0);
                (before, now) = (now, next);
            }
        }
        for (n, sum) in sum.iter_mut().enumerate() {
            *sum *= (2 * n + 3) as f64 / (4.0 * PI);
        }
        sum
    }

    /// Current density \[A/m2\] inside the sphere.
    #[must_use]
    pub fn current(&self, p: [f64; 3]) -> [C; 3] {
        let r = dot(p, p).sqrt().max(1e-9 * self.body.radius);
        let a = p.map(|p| p / r);
        // Sums over directions of B P_n' (a x b), by degree.
        let mut sums = [[0.0; 3]; TERMS];
        for (b, f) in &self.nodes {
            let x = dot(a, *b);
            let turn = cross(a, *b).map(|t| t * f);
            let [mut before, mut now] = [1.0, x];
            let [mut slope_before, mut slope] = [0.0, 1.0];
            for (n, sum) in sums.iter_mut().enumerate() {
                for k in 0..3 {
                    sum[k] += slope * turn[k];
                }
                let degree = (n + 1) as f64;
                let next = ((2.0 * degree + 1.0) * x * now - degree * before) / (degree + 1.0);
                let slope_next = slope_before + (2.0 * degree + 1.0) * now;
                (before, now) = (now, next);
                (slope_before, slope) = (slope, slope_next);
            }
        }
        let mut found = [C::new(0.0, 0.0); 3];
        let rate = C::new(0.0, -self.unit.omega() * self.body.conductivity);
        for (n, (radial, sum)) in self.unit.radial(r).iter().zip(&sums).enumerate() {
            let degree = (n + 1) as f64;
            let share =
                -self.body.radius * (2.0 * degree + 1.0) / (4.0 * PI * degree * (degree + 1.0));
            for k in 0..3 {
                found[k] += rate * radial[0] * (share * sum[k]);
            }
        }
        found
    }

    /// Scalar potential of the reaction outside \[T m\]: its flux density is minus the gradient.
    fn scalar(&self, p: [f64; 3]) -> C {
        let r = dot(p, p).sqrt();
        let all = self.degrees(p.map(|p| p / r));
        let q = self.body.radius / r;
        let part = |(n, b): (usize, &f64)| {
            let degree = (n + 1) as f64;
            self.unit.reaction[n] * (self.body.radius / (degree + 1.0) * q.powi(n as i32 + 2) * b)
        };
        all.iter().enumerate().map(part).sum()
    }

    /// Mean force on the sphere \[N\]: the opposite of that on the loops in the field of its currents.
    #[must_use]
    pub fn force(&self) -> [f64; 3] {
        let step = 1e-4 * self.body.radius;
        let mut force = [0.0; 3];
        for [place, along] in self.coils.iter().flat_map(|c| c.pieces(48)) {
            let b = [0, 1, 2].map(|k| {
                let [mut low, mut high] = [place, place];
                low[k] -= step;
                high[k] += step;
                (self.scalar(low) - self.scalar(high)).re / (2.0 * step)
            });
            let pull = cross(along, b);
            for k in 0..3 {
                force[k] -= pull[k];
            }
        }
        force
    }
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

fn biot_savart(pieces: &[[[f64; 3]; 2]], p: [f64; 3]) -> [f64; 3] {
    let mut sum = [0.0; 3];
    for [place, along] in pieces {
        let d = [0, 1, 2].map(|k| p[k] - place[k]);
        let cube = dot(d, d).powf(-1.5) * MU0 / (4.0 * PI);
        let b = cross(*along, d);
        for k in 0..3 {
            sum[k] += cube * b[k];
        }
    }
    sum
}

/// Nodes and weights of Gauss on -1 to 1: zeros of `P_n` by Newton's method.
fn gauss(count: usize) -> Vec<(f64, f64)> {
    let node = |k: usize| {
        let mut x = (PI * (k as f64 + 0.75) / (count as f64 + 0.5)).cos();
        let mut slope = 1.0;
        for _ in 0..8 {
            let [mut before, mut now] = [1.0, x];
            for n in 1..count {
                let degree = n as f64;
                let next = ((2.0 * degree + 1.0) * x * now - degree * before) / (degree + 1.0);
                (before, now) = (now, next);
            }
            slope = count as f64 * (x * now - before) / (x * x - 1.0);
            x -= now / slope;
        }
        (x, 2.0 / ((1.0 - x * x) * slope * slope))
    };
    (0..count).map(node).collect()
}

#[cfg(test)]
mod tests {
    use super::super::Loop;
    use super::*;

    fn body() -> Body {
        Body {
            radius: 2.5e-3,
            conductivity: 1e7,
            permeability: 1.0,
            frequency: 1e5,
        }
    }

    fn coaxial(axis: [f64; 3]) -> Anywhere {
        let coil = Coil {
            centre: axis.map(|a| -4e-3 * a),
            axis,
            radius: 4e-3,
            current: 100.0,
        };
        Anywhere::of(body(), vec![coil])
    }

    #[test]
    fn a_coaxial_loop_is_what_it_was_wherever_it_points() {
        let loops = vec![Loop {
            radius: 4e-3,
            height: -4e-3,
            current: 100.0,
        }];
        let known = Solution::of(
            body(),
            Sources {
                loops,
                uniform: 0.0,
            },
        );
        let axis = [0.6, 0.0, 0.8];
        let found = coaxial(axis);
        assert!((found.power() / known.power() - 1.0).abs() < 1e-6);
        let force = dot(found.force(), axis);
        assert!((force / known.lift() - 1.0).abs() < 1e-5, "{force}");
        let found = coaxial([0.0, 0.0, 1.0]);
        let p: [f64; 3] = [1.2e-3, 0.5e-3, -1.4e-3];
        let rho = p[0].hypot(p[1]);
        let around = known.current(rho, p[2]);
        let wanted = [
            around * (-p[1] / rho),
            around * (p[0] / rho),
            C::new(0.0, 0.0),
        ];
        let current = found.current(p);
        let apart = current.iter().zip(wanted);
        for (a, b) in apart {
            assert!((a - b).norm() < 1e-6 * around.norm(), "{a} {b}");
        }
    }

    #[test]
    fn the_rule_of_gauss_is_exact() {
        let sum = |power: i32| -> f64 { gauss(6).iter().map(|(x, w)| w * x.powi(power)).sum() };
        assert!((sum(10) - 2.0 / 11.0).abs() < 1e-14);
        assert!(sum(7).abs() < 1e-14);
    }
}
