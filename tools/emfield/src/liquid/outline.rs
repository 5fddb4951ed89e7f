//! The outline of a drop: its radius as a sum of spherical harmonics, by least squares over its surface points.
//!
//! `r(n) = sum c_lm Y_lm(n)` about the centre, for drops whose surface every ray from the centre meets once. Volume, centre,
//! area and moments are integrals of r over all directions, by Gauss's rule.

use std::f64::consts::PI;

use nalgebra::{DMatrix, DVector};

use super::vector::{along, difference, direction, dot, length};

/// Highest degree.
const HIGHEST: usize = 10;
/// Surface points for each harmonic at least.
const ENOUGH: usize = 5;
/// A ray that meets the surface under less than this cosine does not tell its radius.
const GRAZING: f64 = 0.15;
/// Nodes of the integrals beside those of the degree.
const MORE: usize = 10;
/// Step of difference quotients of the radius over a direction.
const STEP: f64 = 1e-4;
/// Rounds that find a radius for a volume.
const ROUNDS: usize = 6;

/// A direction and its share of the sphere.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Node {
    /// The direction.
    pub direction: [f64; 3],
    /// Its share.
    pub weight: f64,
}

/// The outline of a drop in space.
#[derive(Debug, Clone, PartialEq)]
pub struct Outline {
    /// Origin of the rays \[m\].
    pub origin: [f64; 3],
    /// Highest degree of the harmonics.
    pub degree: usize,
    /// Coefficients by degree, in each from -l to l \[m\].
    coefficients: Vec<f64>,
    /// Root of the mean square of what the harmonics leave \[m\].
    pub residual: f64,
}

impl Outline {
    /// The outline of surface points with their unit normals, about `origin`; none where a ray from there grazes the surface
    /// or there are too few points.
    #[must_use]
    pub fn new(points: &[[f64; 3]], normals: &[[f64; 3]], origin: [f64; 3]) -> Option<Self> {
        let most = ((points.len() / ENOUGH) as f64).sqrt() as usize;
        let degree = HIGHEST.min(most.checked_sub(1)?);
        if degree < 2 {
            return None;
        }
        let rays: Vec<[f64; 3]> = points.iter().map(|x| difference(x, &origin)).collect();
        let grazes = |(r, n): (&[f64; 3], &[f64; 3])| dot(r, n) < GRAZING * length(r);
        if rays.iter().zip(normals).any(grazes) {
            return None;
        }
        let many = (degree + 1) * (degree + 1);
        let mut basis = DMatrix::zeros(many, points.len());
        for (k, ray) in rays.iter().enumerate() {
            let values = harmonics(degree, &direction(ray));
            basis.column_mut(k).copy_from_slice(&values);
        }
        let radius = DVector::from_iterator(points.len(), rays.iter().map(length));
        let gram = &basis * basis.transpose();
        let coefficients = gram.cholesky()?.solve(&(&basis * &radius));
        let left = radius - basis.tr_mul(&coefficients);
        Some(Self {
            origin,
            degree,
            coefficients: coefficients.as_slice().to_vec(),
            residual: left.norm() / (points.len() as f64).sqrt(),
        })
    }

    /// Coefficients of the harmonics that are nearest to values at points, by their directions.
    #[must_use]
    pub fn fitted(&self, points: &[[f64; 3]], values: &[f64]) -> Option<Vec<f64>> {
        let many = self.coefficients.len();
        let mut basis = DMatrix::zeros(many, points.len());
        for (k, x) in points.iter().enumerate() {
            let ray = direction(&difference(x, &self.origin));
            let harmonics = harmonics(self.degree, &ray);
            basis.column_mut(k).copy_from_slice(&harmonics);
        }
        let gram = &basis * basis.transpose();
        let found = gram
            .cholesky()?
            .solve(&(&basis * DVector::from_column_slice(values)));
        Some(found.as_slice().to_vec())
    }

    /// The outline whose coefficients of degree l are larger by `by` times `factor(l)`, with the volume of this one.
    #[must_use]
    pub fn moved(&self, by: &[f64], factor: impl Fn(usize) -> f64) -> Self {
        let mut next = self.clone();
        let degree = |k: usize| k.isqrt();
        for (k, (c, by)) in next.coefficients.iter_mut().zip(by).enumerate() {
            *c += factor(degree(k)) * by;
        }
        let wanted = self.volume().0;
        for _ in 0..ROUNDS {
            let larger = (wanted / next.volume().0).cbrt() - 1.0;
            next.coefficients[0] *= 1.0 + larger;
        }
        next
    }

    /// Radius in a direction \[m\].
    #[must_use]
    pub fn radius(&self, n: &[f64; 3]) -> f64 {
        let values = harmonics(self.degree, n);
        values
            .iter()
            .zip(&self.coefficients)
            .map(|(y, c)| y * c)
            .sum()
    }

    /// What harmonics of each degree give of the radius in a direction \[m\].
    #[must_use]
    pub fn shares(&self, n: &[f64; 3]) -> Vec<f64> {
        let values = harmonics(self.degree, n);
        let share = |l: usize| {
            let own = l * l..(l + 1) * (l + 1);
            let terms = values[own.clone()].iter().zip(&self.coefficients[own]);
            terms.map(|(y, c)| y * c).sum()
        };
        (0..=self.degree).map(share).collect()
    }

    /// Unit normal where a ray in a direction meets the surface: along n - grad r / r.
    #[must_use]
    pub fn normal(&self, n: &[f64; 3]) -> [f64; 3] {
        let r = self.radius(n);
        let ways = super::surface::tangents(n).into_iter();
        let tilted = ways
            .zip(self.rise(n))
            .fold(*n, |sum, (way, rise)| along(&sum, -rise / r, &way));
        direction(&tilted)
    }

    /// How the radius grows over the tangents of a direction \[m\].
    fn rise(&self, n: &[f64; 3]) -> [f64; 2] {
        super::surface::tangents(n).map(|t| {
            let [ahead, behind] = [STEP, -STEP].map(|s| self.radius(&direction(&along(n, s, &t))));
            (ahead - behind) / (2.0 * STEP)
        })
    }

    /// Amplitude of the mode of degree `l` about the z axis: r = ... + a P_l(cos theta) \[m\].
    #[must_use]
    pub fn mode(&self, l: usize) -> f64 {
        let middle = l * l + l;
        let c = self.coefficients.get(middle).copied().unwrap_or(0.0);
        c * ((2 * l + 1) as f64 / (4.0 * PI)).sqrt()
    }

    /// Root of the sum of squares of all modes of degree `l`, as an amplitude of P_l \[m\].
    #[must_use]
    pub fn strength(&self, l: usize) -> f64 {
        let all = self.coefficients.get(l * l..(l + 1) * (l + 1));
        let square: f64 = all.map_or(0.0, |all| all.iter().map(|c| c * c).sum());
        (square * (2 * l + 1) as f64 / (4.0 * PI)).sqrt()
    }

    /// Directions with their shares of the sphere, by Gauss's rule.
    #[must_use]
    pub fn nodes(&self) -> Vec<Node> {
        let count = self.degree + MORE;
        let round = 2 * count;
        let mut nodes = Vec::with_capacity(count * round);
        for (z, weight) in gauss(count) {
            let ring = (1.0 - z * z).sqrt();
            for k in 0..round {
                let angle = 2.0 * PI * (k as f64 + 0.5) / round as f64;
                nodes.push(Node {
                    direction: [ring * angle.cos(), ring * angle.sin(), z],
                    weight: weight * 2.0 * PI / round as f64,
                });
            }
        }
        nodes
    }

    /// Volume \[m3\] and centre \[m\].
    #[must_use]
    pub fn volume(&self) -> (f64, [f64; 3]) {
        let (mut volume, mut first) = (0.0, [0.0; 3]);
        for node in self.nodes() {
            let r = self.radius(&node.direction);
            volume += node.weight * r.powi(3) / 3.0;
            first = along(&first, node.weight * r.powi(4) / 4.0, &node.direction);
        }
        (volume, along(&self.origin, volume.recip(), &first))
    }

    /// Velocity of the centre of a drop whose surface `points` move at `velocity` \[m/s\]. The radius grows by `r' = u . n/(e . n)` in
    /// the direction e, with the normal n, so that
    ///
    /// ```text
    /// V dc/dt = integral of r^2 r' (r e + o - c) over all directions, o the origin and c the centre
    /// ```
    ///
    /// Without sources this is momentum over mass; sums over points err where a stream is one point deep.
    #[must_use]
    pub fn centre_velocity(
        &self,
        points: &[[f64; 3]],
        normals: &[[f64; 3]],
        velocity: &[[f64; 3]],
    ) -> Option<[f64; 3]> {
        let (volume, centre) = self.volume();
        let all = points.iter().zip(normals).zip(velocity);
        let rates: Vec<f64> = all
            .map(|((x, n), u)| {
                let ray = direction(&difference(x, &self.origin));
                dot(u, n) / dot(&ray, n)
            })
            .collect();
        let rates = self.fitted(points, &rates)?;
        let aside = difference(&self.origin, &centre);
        let mut first = [0.0; 3];
        for node in self.nodes() {
            let values = harmonics(self.degree, &node.direction);
            let rate: f64 = values.iter().zip(&rates).map(|(y, c)| y * c).sum();
            let r = self.radius(&node.direction);
            let way = along(&aside, r, &node.direction);
            first = along(&first, node.weight * r * r * rate, &way);
        }
        Some(first.map(|c| c / volume))
    }

    /// Area \[m2\]: the integral of r sqrt(r^2 + |grad r|^2) over all directions.
    #[must_use]
    pub fn area(&self) -> f64 {
        let mut area = 0.0;
        for node in self.nodes() {
            let n = &node.direction;
            let r = self.radius(n);
            let rise = self.rise(n);
            area += node.weight * r * (r * r + rise[0] * rise[0] + rise[1] * rise[1]).sqrt();
        }
        area
    }

    /// Integrals over the drop of 1, x, y, z, xx, xy, xz, yy, yz, zz from the origin \[m3, m4, m5\].
    #[must_use]
    pub fn moments(&self) -> [f64; 10] {
        let mut all = [0.0; 10];
        for node in self.nodes() {
            let r = self.radius(&node.direction);
            for (sum, (value, degree)) in all.iter_mut().zip(monomials(&node.direction)) {
                *sum += node.weight * value * r.powi(3 + degree) / f64::from(3 + degree);
            }
        }
        all
    }

    /// Volumes of points, with which quadratics have their integrals over the drop: the nearest to `guess` over itself
    /// \[m3\].
    #[must_use]
    pub fn volumes(&self, points: &[[f64; 3]], guess: &[f64]) -> Option<Vec<f64>> {
        let scale = self.coefficients[0].abs();
        let mut basis = DMatrix::zeros(10, points.len());
        for (k, x) in points.iter().enumerate() {
            let s = difference(x, &self.origin).map(|c| c / scale);
            for (m, (value, _)) in monomials(&s).into_iter().enumerate() {
                basis[(m, k)] = value;
            }
        }
        let degrees = monomials(&[0.0; 3]).map(|m| m.1);
        let wanted = self.moments();
        let wanted = DVector::from_fn(10, |m, _| wanted[m] / scale.powi(degrees[m]));
        let guess = DVector::from_column_slice(guess);
        let mut weighted = basis.clone();
        for (k, g) in guess.iter().enumerate() {
            weighted.column_mut(k).scale_mut(*g);
        }
        let lack = wanted - &basis * &guess;
        let gram = &weighted * basis.transpose();
        let multipliers = gram.cholesky()?.solve(&lack);
        let volumes = &guess + weighted.tr_mul(&multipliers);
        Some(volumes.as_slice().to_vec())
    }
}

/// Monomials up to degree 2 and their degrees.
fn monomials(x: &[f64; 3]) -> [(f64, i32); 10] {
    let [x, y, z] = *x;
    [
        (1.0, 0),
        (x, 1),
        (y, 1),
        (z, 1),
        (x * x, 2),
        (x * y, 2),
        (x * z, 2),
        (y * y, 2),
        (y * z, 2),
        (z * z, 2),
    ]
}

/// Real spherical harmonics of length 1 over the sphere up to a degree, at a unit vector: in each degree from -l (sines) to
/// l (cosines).
pub(super) fn harmonics(degree: usize, n: &[f64; 3]) -> Vec<f64> {
    let z = n[2];
    let ring = n[0].hypot(n[1]);
    let (cosine, sine) = if ring > 0.0 {
        (n[0] / ring, n[1] / ring)
    } else {
        (1.0, 0.0)
    };
    let mut values = vec![0.0; (degree + 1) * (degree + 1)];
    let (mut around, mut sectoral) = ((1.0, 0.0), (4.0 * PI).sqrt().recip());
    for m in 0..=degree {
        if m > 0 {
            around = (
                around.0 * cosine - around.1 * sine,
                around.0 * sine + around.1 * cosine,
            );
            sectoral *= ring * ((2 * m + 1) as f64 / (2 * m) as f64).sqrt();
        }
        let root = if m == 0 { 1.0 } else { 2.0_f64.sqrt() };
        let (mut before, mut now) = (0.0, sectoral);
        for l in m..=degree {
            if l > m {
                let (l, m) = (l as f64, m as f64);
                let a = ((4.0 * l * l - 1.0) / (l * l - m * m)).sqrt();
                let b =
                    (((l - 1.0) * (l - 1.0) - m * m) / (4.0 * (l - 1.0) * (l - 1.0) - 1.0)).sqrt();
                let b = if b.is_finite() { b } else { 0.0 };
                (before, now) = (now, a * (z * now - b * before));
            }
            values[l * l + l + m] = root * now * around.0;
            if m > 0 {
                values[l * l + l - m] = root * now * around.1;
            }
        }
    }
    values
}

/// Nodes and weights of Gauss's rule from -1 to 1.
pub(super) fn gauss(count: usize) -> Vec<(f64, f64)> {
    let n = count as f64;
    let node = |k: usize| {
        let mut x = (PI * (k as f64 + 0.75) / (n + 0.5)).cos();
        let mut slope = 1.0;
        for _ in 0..100 {
            let (mut before, mut now) = (1.0, x);
            for l in 2..=count {
                let l = l as f64;
                (before, now) = (now, ((2.0 * l - 1.0) * x * now - (l - 1.0) * before) / l);
            }
            slope = n * (before - x * now) / (1.0 - x * x);
            let step = now / slope;
            x -= step;
            if step.abs() < 1e-15 {
                break;
            }
        }
        (x, 2.0 / ((1.0 - x * x) * slope * slope))
    };
    (0..count).map(node).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn spheroid(count: usize, axes: [f64; 3], centre: [f64; 3]) -> (Vec<[f64; 3]>, Vec<[f64; 3]>) {
        let turn = PI * (3.0 - 5.0_f64.sqrt());
        let each = |k: usize| {
            let z = 1.0 - (2.0 * k as f64 + 1.0) / count as f64;
            let (sine, cosine) = (turn * k as f64).sin_cos();
            let ring = (1.0 - z * z).sqrt();
            let n = [ring * cosine, ring * sine, z];
            let x: [f64; 3] = std::array::from_fn(|c| centre[c] + axes[c] * n[c]);
            (x, direction(&std::array::from_fn(|c| n[c] / axes[c])))
        };
        (0..count).map(each).unzip()
    }

    #[test]
    fn a_spheroid_has_its_volume_area_and_centre() {
        let (points, normals) = spheroid(1500, [1e-3, 1e-3, 1.3e-3], [2e-4, -1e-4, 3e-4]);
        let outline = Outline::new(&points, &normals, [2.1e-4, -1e-4, 3.2e-4]).unwrap();
        let (volume, centre) = outline.volume();
        assert!(
            (volume / (4.0 / 3.0 * PI * 1.3e-9) - 1.0).abs() < 1e-6,
            "{volume:e}"
        );
        for (c, wanted) in centre.iter().zip([2e-4, -1e-4, 3e-4]) {
            assert!((c - wanted).abs() < 1e-9);
        }
        let e = (1.0 - 1.0 / (1.3_f64 * 1.3)).sqrt();
        let area = 2.0 * PI * 1e-6 * (1.0 + 1.3 / e * e.asin());
        assert!((outline.area() / area - 1.0).abs() < 1e-5);
    }

    #[test]
    fn the_centre_moves_with_the_surface_whatever_streams_along_it() {
        let (points, normals) = spheroid(1500, [1e-3, 1e-3, 1.1e-3], [2e-4, -1e-4, 3e-4]);
        let outline = Outline::new(&points, &normals, [2.1e-4, -1e-4, 3.2e-4]).unwrap();
        let whole = [0.01, 0.0, -0.02];
        let moves = |n: &[f64; 3]| {
            // 0.5 m/s along the surface, toward smaller z.
            let down = along(&[0.0, 0.0, -0.5], 0.5 * n[2], n);
            along(&whole, 1.0, &down)
        };
        let velocity: Vec<[f64; 3]> = normals.iter().map(moves).collect();
        let found = outline.centre_velocity(&points, &normals, &velocity);
        for (found, wanted) in found.unwrap().iter().zip(whole) {
            assert!((found - wanted).abs() < 1e-6, "{found} {wanted}");
        }
    }

    #[test]
    fn modes_are_those_of_legendre() {
        let (mut points, _) = spheroid(800, [1.0; 3], [0.0; 3]);
        for x in &mut points {
            let z = x[2];
            let p3 = 0.5 * z * (5.0 * z * z - 3.0);
            *x = x.map(|c| c * (1.0 + 0.02 * p3));
        }
        let normals: Vec<[f64; 3]> = points.iter().map(direction).collect();
        let outline = Outline::new(&points, &normals, [0.0; 3]).unwrap();
        assert!((outline.mode(3) - 0.02).abs() < 1e-12);
        assert!(outline.mode(2).abs() < 1e-12 && (outline.strength(3) - 0.02).abs() < 1e-12);
    }

    #[test]
    fn volumes_integrate_quadratics() {
        let (points, normals) = spheroid(600, [1.0; 3], [0.0; 3]);
        let outline = Outline::new(&points, &normals, [0.0; 3]).unwrap();
        let inner: Vec<[f64; 3]> = points.iter().map(|x| x.map(|c| 0.5 * c)).collect();
        let all = [points, inner].concat();
        let volumes = outline.volumes(&all, &vec![3e-3; all.len()]).unwrap();
        let sum: f64 = all.iter().zip(&volumes).map(|(x, v)| v * x[2] * x[2]).sum();
        assert!((sum - 4.0 * PI / 15.0).abs() < 1e-10);
    }
}
