//! Fits of points that have moved, by the chain rule.
//!
//! Points that a smooth map x(s) has moved keep the fits that were made where they stood, at s. With the slopes of the map by the
//! same fits, `J_ak = D_k x_a`, and their inverse K,
//!
//! ```text
//! du/dx_a = sum_k K_ka D_k u,
//! lap u   = sum_jk G_jk D_jk u + sum_k c_k D_k u,      G = K K^T,      c_k = - sum_a K_ka sum_jl G_jl D_jl x_a.
//! ```
//!
//! What is linear in x has its slopes and no Laplacian, but for rounding, and the order of the fits stays. A row takes some sums
//! where a fit takes the factors of a matrix.

use nalgebra::{SMatrix, SVector};
use rayon::prelude::*;

use crate::functional::{Columns, Wants};
use crate::stencils::{Spot, Stencils};

/// What a map does about one point.
#[derive(Debug, Clone, Copy)]
struct Map<const D: usize> {
    /// J, by new and old axis.
    slopes: SMatrix<f64, D, D>,
    /// K, by old and new axis.
    inverse: SMatrix<f64, D, D>,
    /// G.
    square: SMatrix<f64, D, D>,
    /// c over the inverse spacing.
    bend: [f64; D],
    strain: f64,
}

/// What the map that moves points does about each of them.
#[derive(Debug, Clone)]
pub struct Moved<const D: usize> {
    maps: Vec<Option<Map<D>>>,
}

impl<const D: usize> Moved<D> {
    /// Of points that are now at `places`, by fits that were made before, with slopes and all second derivatives.
    #[must_use]
    pub fn new(fits: &Stencils<D>, places: &[[f64; D]]) -> Self {
        let rows = (0..fits.rows()).into_par_iter();
        Self {
            maps: rows.map(|i| Map::new(fits, places, i)).collect(),
        }
    }

    /// Points, those without fits among them.
    #[must_use]
    pub fn len(&self) -> usize {
        self.maps.len()
    }

    /// No points at all.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.maps.is_empty()
    }

    /// The same without the fits of points about which the map strains more than this ([`Self::strain`]).
    #[must_use]
    pub fn within(mut self, strain: f64) -> Self {
        for map in &mut self.maps {
            *map = map.filter(|map| map.strain <= strain);
        }
        self
    }

    /// How much lengths about a point change with their direction: the product of the mean sizes of J and of its inverse less one,
    /// zero where all change alike, and how fast that changes within a spacing. Nothing where a point has no fit, or the map
    /// folds there.
    #[must_use]
    pub fn strain(&self, i: usize) -> Option<f64> {
        self.maps[i].as_ref().map(|map| map.strain)
    }

    /// Points with the weights of the Laplacian of point `i`.
    ///
    /// # Panics
    /// Where it has no fit, or the map folds.
    pub fn laplacian<'a>(
        &'a self,
        fits: &'a Stencils<D>,
        i: usize,
    ) -> impl Iterator<Item = (usize, f64)> + 'a {
        let (row, map) = (Parts::of(fits, i), self.map(i));
        let factor = row.inverse_spacing * row.inverse_spacing;
        let neighbours = fits.neighbours(i).iter().enumerate();
        neighbours.map(move |(m, j)| (*j as usize, factor * row.laplacian(map, m)))
    }

    /// How far neighbours of point `i` within `near` \[m\] lie from where the slopes of the map there put them, over that
    /// distance: maps that move each point in its own way carry no fits, though their slopes be small. Points were at `before`.
    #[must_use]
    pub fn roughness(
        &self,
        fits: &Stencils<D>,
        [before, places]: [&[[f64; D]]; 2],
        i: usize,
        near: f64,
    ) -> Option<f64> {
        let map = self.maps[i].as_ref()?;
        let away =
            |of: &[[f64; D]], j: usize| SVector::<f64, D>::from_fn(|a, _| of[j][a] - of[i][a]);
        let strays = fits.neighbours(i).iter().filter_map(|&j| {
            let was = away(before, j as usize);
            let lies = || (away(places, j as usize) - map.slopes * was).norm() / near;
            (was.norm() < near).then(lies)
        });
        Some(strays.fold(0.0, f64::max))
    }

    /// Rows of slopes and Laplacians at all points that have fits.
    ///
    /// # Panics
    /// Where a point has a fit and the map folds.
    #[must_use]
    pub fn rows(&self, fits: &Stencils<D>) -> Stencils<D> {
        let wants = Wants {
            gradient: true,
            laplacian: true,
            ..Wants::default()
        };
        let mut rows = Stencils {
            spots: vec![Spot::default(); fits.rows()],
            neighbours: Vec::new(),
            weights: Vec::new(),
            columns: Columns::new::<D>(wants),
            report: fits.report,
        };
        self.fill(fits, &mut rows, |i| fits.spots[i].count > 0);
        rows
    }

    /// Gives rows to those of `into` that lack one and are wanted.
    ///
    /// # Panics
    /// Where such a point has no fit, or the map folds, and where `into` has operators that are not carried.
    pub fn fill(
        &self,
        fits: &Stencils<D>,
        into: &mut Stencils<D>,
        wanted: impl Fn(usize) -> bool + Sync,
    ) {
        let columns = into.columns;
        let lacks = |i: &usize| into.spots[*i].count == 0 && wanted(*i);
        let rows: Vec<usize> = (0..fits.rows()).filter(lacks).collect();
        let made = rows.par_iter().map(|&i| self.weights(fits, i, columns));
        let made: Vec<Vec<f64>> = made.collect();
        for (i, weights) in rows.into_iter().zip(made) {
            into.spots[i] = Spot {
                start: into.neighbours.len(),
                weights: into.weights.len(),
                shares: 0,
                ..fits.spots[i]
            };
            into.neighbours.extend_from_slice(fits.neighbours(i));
            into.weights.extend(weights);
        }
    }

    /// The weights of the operators of point `i`, one after another.
    fn weights(&self, fits: &Stencils<D>, i: usize, columns: Columns) -> Vec<f64> {
        let (row, map) = (Parts::of(fits, i), self.map(i));
        let mut weights = vec![0.0; row.count * columns.count];
        let mut put = |column: usize, m: usize, weight| weights[column * row.count + m] = weight;
        assert!(
            columns.hessian.is_none() && columns.value.is_none(),
            "values and second derivatives are not carried"
        );
        for m in 0..row.count {
            if let Some(gradient) = columns.gradient {
                for (axis, slope) in row.slopes(map, m).into_iter().enumerate() {
                    put(gradient + axis, m, slope);
                }
            }
            if let Some(laplacian) = columns.laplacian {
                put(laplacian, m, row.laplacian(map, m));
            }
        }
        weights
    }

    #[track_caller]
    fn map(&self, i: usize) -> &Map<D> {
        let map = self.maps[i].as_ref();
        assert!(map.is_some(), "point {i} has no fit that could be carried");
        map.unwrap_or_else(|| unreachable!())
    }
}

impl<const D: usize> Map<D> {
    fn new(fits: &Stencils<D>, places: &[[f64; D]], i: usize) -> Option<Self> {
        if fits.spots[i].count == 0 {
            return None;
        }
        let off = |j: usize| Offset(std::array::from_fn(|a| places[j][a] - places[i][a]));
        let slopes: [Offset<D>; D] = std::array::from_fn(|k| fits.derivative(i, k).apply_with(off));
        let jacobian = SMatrix::<f64, D, D>::from_fn(|a, k| slopes[k].0[a]);
        let inverse = invert(&jacobian)?;
        let square = inverse * inverse.transpose();
        let mut second = [0.0; D];
        for a in 0..D {
            for b in a..D {
                let times = if a == b { 1.0 } else { 2.0 };
                let Offset(bent) = fits.second(i, a, b).apply_with(off);
                for (sum, bent) in second.iter_mut().zip(bent) {
                    *sum += times * square[(a, b)] * bent;
                }
            }
        }
        let spacing = fits.spots[i].inverse_spacing.recip();
        let bend: [f64; D] = std::array::from_fn(|k| {
            let all = (0..D).map(|a| inverse[(k, a)] * second[a]);
            -spacing * all.sum::<f64>()
        });
        let size = jacobian.norm() * inverse.norm() / D as f64;
        let turns = bend.iter().map(|c| c * c).sum::<f64>().sqrt();
        Some(Self {
            slopes: jacobian,
            inverse,
            square,
            bend,
            strain: (size - 1.0).max(turns / square.norm()),
        })
    }
}

/// The inverse of the slopes of a map that does not fold.
fn invert<const D: usize>(jacobian: &SMatrix<f64, D, D>) -> Option<SMatrix<f64, D, D>> {
    let mut dynamic = nalgebra::DMatrix::<f64>::from_column_slice(D, D, jacobian.as_slice());
    let folds = dynamic.determinant() <= 0.0;
    (!folds && dynamic.try_inverse_mut())
        .then(|| SMatrix::from_column_slice(dynamic.as_slice()))
        .filter(|inverse: &SMatrix<f64, D, D>| inverse.iter().all(|v| v.is_finite()))
}

/// The weights of one point.
struct Parts<'a> {
    weights: &'a [f64],
    count: usize,
    inverse_spacing: f64,
    gradient: usize,
    hessian: usize,
}

impl<'a> Parts<'a> {
    #[track_caller]
    fn of<const D: usize>(fits: &'a Stencils<D>, i: usize) -> Self {
        let spot = &fits.spots[i];
        let count = spot.count as usize;
        let (Some(gradient), Some(hessian)) = (fits.columns.gradient, fits.columns.hessian) else {
            panic!("slopes and second derivatives are not among what the plan wants");
        };
        Self {
            weights: &fits.weights[spot.weights..spot.weights + fits.columns.count * count],
            count,
            inverse_spacing: spot.inverse_spacing,
            gradient,
            hessian,
        }
    }

    fn weight(&self, column: usize, m: usize) -> f64 {
        self.weights[column * self.count + m]
    }

    /// Of neighbour `m`, in units of the spacing.
    fn slopes<const D: usize>(&self, map: &Map<D>, m: usize) -> [f64; D] {
        std::array::from_fn(|a| {
            let each = (0..D).map(|k| map.inverse[(k, a)] * self.weight(self.gradient + k, m));
            each.sum()
        })
    }

    /// The same.
    fn laplacian<const D: usize>(&self, map: &Map<D>, m: usize) -> f64 {
        let mut sum = 0.0;
        for a in 0..D {
            sum += map.bend[a] * self.weight(self.gradient + a, m);
            for b in a..D {
                let times = if a == b { 1.0 } else { 2.0 };
                let column = self.hessian + Columns::pair::<D>(a, b);
                sum += times * map.square[(a, b)] * self.weight(column, m);
            }
        }
        sum
    }
}

/// A way from a point, as a field.
#[derive(Clone, Copy)]
struct Offset<const D: usize>([f64; D]);

impl<const D: usize> Default for Offset<D> {
    fn default() -> Self {
        Self([0.0; D])
    }
}

impl<const D: usize> std::ops::Add for Offset<D> {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self(std::array::from_fn(|k| self.0[k] + other.0[k]))
    }
}

impl<const D: usize> std::ops::Mul<f64> for Offset<D> {
    type Output = Self;
    fn mul(self, by: f64) -> Self {
        Self(self.0.map(|v| v * by))
    }
}
