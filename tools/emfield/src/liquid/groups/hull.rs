//! Volume, centre and moments of a drop of any shape, by Gauss's theorem over its surface points.
//!
//! Each point has the part of the surface that is nearer to it than to any other, and beside it stands the sphere that touches
//! the surface there, of curvature b. Rays from the centre of that sphere meet the tangent plane at g = (s, t). There the bisector
//! of the way d to another point of the sphere is the straight line `g . d = d . d/2`, so that shadows of parts tile a sphere without gap or
//! overlap. From an origin, with the place p of the point, its normal n and `mu = 1/sqrt(1 + b^2 g^2)`, three times the volume
//! of the cone to a part is
//!
//! ```text
//! integral mu^3 (mu p . n + mu b p . g + (1 - mu)/b) ds dt = p . n (A - 2 b^2 J) + b p . m + b J/2,
//! m = integral g,   J = integral g^2
//! ```
//!
//! and the area of a part `A - 3/2 b^2 J`, both to third order.

use nalgebra::{DMatrix, DVector};

use crate::liquid::cell::{Bisector, cell, twice};
use crate::liquid::surface::{Patch, tangents};
use crate::liquid::vector::{along, difference, dot, length};

/// Volume of a surface point over that of one inside, about.
pub const HALF: f64 = 0.35;

/// Ways with a shadow shorter than this part of them cross a crease: their bisectors stand across the way along the surface.
const STEEP: f64 = 0.9;
/// J/A^2 of a long part at most; that of a square is 1/6.
const LONG: f64 = 0.5;

/// What surface points enclose.
#[derive(Debug, Clone, PartialEq)]
pub struct Hull {
    /// Volume \[m3\].
    pub volume: f64,
    /// Centre \[m\].
    pub centre: [f64; 3],
    /// Area \[m2\].
    pub area: f64,
    /// Integrals of x_a x_b from the centre \[m5\].
    squares: [[f64; 3]; 3],
}

/// Integrals over the shadow of a part of the surface.
#[derive(Debug, Clone, Copy, Default)]
struct Shadow {
    area: f64,
    first: [f64; 2],
    second: f64,
}

impl Shadow {
    fn of(corners: &[[f64; 2]]) -> Self {
        let mut sum = Self::integrals(corners);
        sum.second = sum.second.min(LONG * sum.area * sum.area);
        sum
    }

    fn integrals(corners: &[[f64; 2]]) -> Self {
        let mut sum = Self {
            area: 0.5 * twice(corners),
            ..Self::default()
        };
        for (k, a) in corners.iter().enumerate() {
            let b = corners[(k + 1) % corners.len()];
            let cross = a[0] * b[1] - a[1] * b[0];
            for c in 0..2 {
                sum.first[c] += cross * (a[c] + b[c]) / 6.0;
                sum.second += cross * (a[c] * a[c] + a[c] * b[c] + b[c] * b[c]) / 12.0;
            }
        }
        sum
    }
}

impl Hull {
    /// That of surface points with their patches, some spacing apart; none where they enclose nothing.
    #[must_use]
    pub fn new(points: &[[f64; 3]], patches: &[Patch<3>], spacing: f64) -> Option<Self> {
        let share = (points.len() as f64).recip();
        let origin = points.iter().fold([0.0; 3], |o, x| along(&o, share, x));
        let (mut volume, mut area) = (0.0, 0.0);
        let (mut first, mut squares) = ([0.0; 3], [[0.0; 3]; 3]);
        for (x, patch) in points.iter().zip(patches) {
            let axes = tangents(&patch.normal);
            let bisectors = bisectors(x, points, patch, axes);
            let shadow = Shadow::of(&cell(bisectors, spacing));
            if shadow.area <= 0.0 {
                continue;
            }
            // No part is larger than its sphere.
            let most = shadow.area.sqrt().recip();
            let bow = (0.5 * patch.curvature).clamp(-most, most);
            let [s, t] = shadow.first;
            let round = bow * bow * shadow.second;
            let from = difference(x, &origin);
            let slid = dot(&from, &axes[0]) * s + dot(&from, &axes[1]) * t;
            let high = dot(&from, &patch.normal);
            let cone = high * (shadow.area - 2.0 * round) + bow * (slid + 0.5 * shadow.second);
            // The middle of the part.
            let over = shadow.area.recip();
            let aside = along(&axes[0].map(|a| a * s * over), t * over, &axes[1]);
            let middle = along(&from, 1.0, &aside);
            let middle = along(&middle, -0.5 * bow * shadow.second * over, &patch.normal);
            let spread = 0.5 * shadow.second * over;
            volume += cone / 3.0;
            area += shadow.area - 1.5 * round;
            first = along(&first, 0.25 * cone, &middle);
            for (a, row) in squares.iter_mut().enumerate() {
                // Over the part its places are spread across the normal.
                let mut apart = patch.normal.map(|c| -spread * patch.normal[a] * c);
                apart[a] += spread;
                let products = along(&apart, middle[a], &middle);
                *row = along(row, 0.2 * cone, &products);
            }
        }
        if volume.is_nan() || volume <= 0.0 {
            return None;
        }
        let way = first.map(|c| c / volume);
        for (a, row) in squares.iter_mut().enumerate() {
            *row = along(row, -volume * way[a], &way);
        }
        let centre = along(&origin, 1.0, &way);
        Some(Self {
            volume,
            centre,
            area,
            squares,
        })
    }

    /// What points stand for, those of the surface first: the nearest to equal shares inside, and to `HALF` of them on the
    /// surface, with which linear functions have their integrals over the drop, and squares nearly \[m3\].
    #[must_use]
    pub fn volumes(&self, points: &[[f64; 3]], surface: usize) -> Option<Vec<f64>> {
        let share = |i: usize| if i < surface { HALF } else { 1.0 };
        let whole: f64 = (0..points.len()).map(share).sum();
        let guess = DVector::from_fn(points.len(), |i, _| self.volume * share(i) / whole);
        let scale = self.volume.cbrt();
        let mut basis = DMatrix::zeros(10, points.len());
        for (i, x) in points.iter().enumerate() {
            let s = difference(x, &self.centre).map(|c| c / scale);
            for (m, value) in quadratics(&s).into_iter().enumerate() {
                basis[(m, i)] = value;
            }
        }
        let q = |a: usize, b: usize| self.squares[a][b] / (scale * scale);
        let squares = [q(0, 0), q(0, 1), q(0, 2), q(1, 1), q(1, 2), q(2, 2)];
        let mut wanted = DVector::zeros(10);
        wanted[0] = self.volume;
        wanted.rows_mut(4, 6).copy_from_slice(&squares);
        let mut weighted = basis.clone();
        for (i, g) in guess.iter().enumerate() {
            weighted.column_mut(i).scale_mut(*g);
        }
        let lack = wanted - &basis * &guess;
        let gram = &weighted * basis.transpose();
        let multipliers = gram.cholesky()?.solve(&lack);
        let volumes = &guess + weighted.tr_mul(&multipliers);
        Some(volumes.as_slice().to_vec())
    }
}

/// Where the part of a point ends, in the plane of its axes.
fn bisectors(
    x: &[f64; 3],
    points: &[[f64; 3]],
    patch: &Patch<3>,
    axes: [[f64; 3]; 2],
) -> Vec<Bisector> {
    let ways = patch.neighbours.iter().filter_map(|&j| {
        let d = difference(&points[j as usize], x);
        let way = axes.map(|a| dot(&d, &a));
        let (far, shadow) = (length(&d), way[0].hypot(way[1]));
        (far > 0.0).then(|| Bisector {
            way,
            half: 0.5 * far * far.min(shadow / STEEP),
        })
    });
    ways.collect()
}

/// 1, x, y, z, xx, xy, xz, yy, yz, zz.
fn quadratics(x: &[f64; 3]) -> [f64; 10] {
    let [x, y, z] = *x;
    [1.0, x, y, z, x * x, x * y, x * z, y * y, y * z, z * z]
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use super::*;
    use crate::liquid::fill::fill;
    use crate::liquid::surface::patches;
    use shapes::Body;
    use shapes::shape::{EllipsoidShape, Shape};

    fn spheroid(ratio: f64, spacing: f64) -> (Hull, Vec<f64>, Vec<[f64; 3]>) {
        let wide = ratio.cbrt().recip();
        let shape = Shape::Ellipsoid(EllipsoidShape {
            name: None,
            centre_m: vec![1.0, -2.0, 0.5],
            semi_axes_m: vec![wide, wide, ratio * wide],
        });
        let filled = fill::<3>(&Body::new(&shape, 3), spacing);
        let surface = filled.normal.len();
        let skin = &filled.position[..surface];
        let hull = Hull::new(
            skin,
            &patches(skin, &filled.normal, spacing).unwrap(),
            spacing,
        )
        .unwrap();
        let volumes = hull.volumes(&filled.position, surface).unwrap();
        (hull, volumes, filled.position)
    }

    #[test]
    fn spheroids_have_their_volume_centre_and_area() {
        for (ratio, most) in [(1.0, 2e-4), (1.5, 1e-3), (2.0, 2e-3), (0.6, 2e-3)] {
            let (hull, ..) = spheroid(ratio, 0.2);
            let error = hull.volume / (4.0 / 3.0 * PI) - 1.0;
            assert!(error.abs() < most, "{ratio}: {error:e}");
            let aside = difference(&hull.centre, &[1.0, -2.0, 0.5]);
            assert!(dot(&aside, &aside).sqrt() < 3e-4, "{ratio}: {aside:?}");
            println!(
                "{ratio} {error:e} {aside:?} {:e}",
                hull.area / (4.0 * PI) - 1.0
            );
        }
        let (hull, ..) = spheroid(1.0, 0.2);
        assert!((hull.area / (4.0 * PI) - 1.0).abs() < 1e-3, "{}", hull.area);
    }

    #[test]
    fn points_stand_for_volumes_that_integrate_quadratics() {
        let (_, volumes, points) = spheroid(1.0, 0.2);
        let square: f64 = points
            .iter()
            .zip(&volumes)
            .map(|(x, v)| v * (x[2] - 0.5).powi(2))
            .sum();
        assert!((square / (4.0 * PI / 15.0) - 1.0).abs() < 2e-3, "{square}");
        let middle: f64 = points.iter().zip(&volumes).map(|(x, v)| v * x[0]).sum();
        assert!((middle / (4.0 / 3.0 * PI) - 1.0).abs() < 1e-3, "{middle}");
    }
}
