//! Links between the particles of a solid in its reference state: weights that give first and second derivatives.
//!
//! Around each particle a quadratic is fitted to the places of its neighbours, through its own place (weighted least
//! squares). The derivatives of the fit are weighted sums of differences,
//!
//! ```text
//! d^m x / dX^m (i) = sum_j w_ij^m (x_j - x_i)
//! ```
//!
//! exact for every quadratic on any cloud, at free faces too. Weights are those of the reference state and never change
//! while the particle has its neighbours.

use std::collections::BTreeMap;

use nalgebra::{DMatrix, DVector};
use neighbours::Grid;
use particles::Rows;
use rayon::prelude::*;

/// Support of a link in cells of the lattice.
pub const SUPPORT: f64 = 2.3;
/// A slope of which this part or less is left beside the terms before it is not spanned by the neighbours.
const FLAT: f64 = 1e-6;
/// The same of a curvature. Two rows of a straight lattice span none across them; shaking them by a twentieth of a cell leaves
/// at most 0.023 of it, which would be fifty times too stiff. What a straight lattice spans beside cracks leaves 0.05 at least.
const BARELY: f64 = 0.03;

/// An anchor that is nearer stands on a face of the particle's own cell \[cells\].
const OWN: f64 = 0.75;

/// Number of an axis pair among the terms of a quadratic.
#[must_use]
pub const fn second(dimensions: usize, k: usize, l: usize) -> usize {
    let (k, l) = if k < l { (k, l) } else { (l, k) };
    dimensions + k * dimensions - (k * (k + 1)) / 2 + l
}

/// Links with `T` terms: 5 in the plane, 9 in space.
#[derive(Debug, Clone, Default)]
pub struct Links<const T: usize> {
    start: Vec<usize>,
    other: Vec<u32>,
    weight: Vec<[f64; T]>,
    back: Vec<[f64; T]>,
    total: Vec<[f64; T]>,
}

/// The links of one particle.
#[derive(Debug, Clone, Copy)]
pub struct Row<'a, const T: usize> {
    /// Numbers of the neighbours; anchors are counted on behind the particles.
    pub other: &'a [u32],
    /// Weights w_ij of the neighbours in the derivatives of the particle.
    pub weight: &'a [[f64; T]],
    /// Weights w_ji of the particle in the derivatives of the neighbours; zero for anchors.
    pub back: &'a [[f64; T]],
    /// Sum of w_ij.
    pub total: &'a [f64; T],
}

/// Terms of a quadratic at an offset: x, y, (z), x^2/2, xy, ...
#[inline]
#[must_use]
pub fn terms<const T: usize>(offset: [f64; 3]) -> [f64; T] {
    let dimensions = if T == 5 { 2 } else { 3 };
    let mut all = [0.0; T];
    for k in 0..dimensions {
        all[k] = offset[k];
        for l in k..dimensions {
            let half = if k == l { 0.5 } else { 1.0 };
            all[second(dimensions, k, l)] = half * offset[k] * offset[l];
        }
    }
    all
}

impl<const T: usize> Links<T> {
    /// Links of the first `particles` of `places` to each other and to the others, the anchors; `cell` is the size of
    /// the lattice's cells \[m\]. Gives the particles that too few neighbours hold, too.
    #[must_use]
    pub fn new(places: &[[f64; 3]], particles: usize, cell: [f64; 3]) -> (Self, Vec<usize>) {
        // In cells, where the lattice is cubic.
        let scaled: Vec<[f64; 3]> = places
            .iter()
            .map(|x| std::array::from_fn(|k| x[k] / cell[k]))
            .collect();
        let (mut grid, mut rows) = (Grid::new(SUPPORT), Rows::new());
        grid.bin(&scaled);
        rows.within(&scaled[..particles], &grid, SUPPORT);
        let fitted: Vec<(Vec<[f64; T]>, bool)> = (0..particles)
            .into_par_iter()
            .map(|a| fit(&scaled, particles, a, rows.row(a)))
            .collect();
        let mut links = Self {
            start: vec![0],
            ..Self::default()
        };
        let scale = scale::<T>(cell);
        for (a, (weights, _)) in fitted.iter().enumerate() {
            links.other.extend_from_slice(rows.row(a));
            let scaled = weights
                .iter()
                .map(|w| std::array::from_fn(|m| scale[m] * w[m]));
            links.weight.extend(scaled);
            links.start.push(links.other.len());
        }
        links.join(particles);
        let loose = fitted.iter().enumerate().filter(|(_, (_, held))| !held);
        let loose = loose.map(|(a, _)| a).collect();
        (links, loose)
    }

    /// Replaces the links of some particles: their neighbours and the weights in cells.
    pub(super) fn replace(&mut self, new: BTreeMap<usize, Fitted<T>>, cell: [f64; 3]) {
        let scale = scale::<T>(cell);
        let particles = self.total.len();
        let mut links = Self {
            start: vec![0],
            ..Self::default()
        };
        for a in 0..particles {
            if let Some((row, weights)) = new.get(&a) {
                links.other.extend_from_slice(row);
                let scaled = weights
                    .iter()
                    .map(|w| std::array::from_fn(|m| scale[m] * w[m]));
                links.weight.extend(scaled);
            } else {
                let range = self.start[a]..self.start[a + 1];
                links.other.extend_from_slice(&self.other[range.clone()]);
                links.weight.extend_from_slice(&self.weight[range]);
            }
            links.start.push(links.other.len());
        }
        links.join(particles);
        *self = links;
    }

    /// Fills in the weights seen from the other side, and the sums.
    fn join(&mut self, particles: usize) {
        let back = |a: usize, b: usize| {
            let range = if b < particles {
                self.start[b]..self.start[b + 1]
            } else {
                0..0
            };
            let mine = range.clone().find(|at| self.other[*at] as usize == a);
            mine.map_or([0.0; T], |at| self.weight[at])
        };
        let all =
            (0..particles).flat_map(|a| (self.start[a]..self.start[a + 1]).map(move |at| (a, at)));
        self.back = all
            .map(|(a, at)| back(a, self.other[at] as usize))
            .collect();
        let total = |a: usize| {
            let mut total = [0.0; T];
            for weight in &self.weight[self.start[a]..self.start[a + 1]] {
                (0..T).for_each(|m| total[m] += weight[m]);
            }
            total
        };
        self.total = (0..particles).map(total).collect();
    }

    /// The links of particle `a`.
    #[inline(always)]
    #[must_use]
    pub fn row(&self, a: usize) -> Row<'_, T> {
        let range = self.start[a]..self.start[a + 1];
        Row {
            other: &self.other[range.clone()],
            weight: &self.weight[range.clone()],
            back: &self.back[range],
            total: &self.total[a],
        }
    }

    /// Number of links.
    #[must_use]
    pub fn len(&self) -> usize {
        self.other.len()
    }

    /// True without links.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.other.is_empty()
    }

    /// Bytes held.
    #[must_use]
    pub fn bytes(&self) -> usize {
        (4 + 16 * T) * self.other.len() + (8 + 8 * T) * self.total.len()
    }
}

/// Neighbours and their weights in cells.
pub(super) type Fitted<const T: usize> = (Vec<u32>, Vec<[f64; T]>);

/// From weights in cells to weights in metres.
pub(super) fn scale<const T: usize>(cell: [f64; 3]) -> [f64; T] {
    let unit: [f64; T] = terms(cell.map(|c| 1.0 / c));
    // x^2/2 counts d^2 x, not its half.
    std::array::from_fn(|m| {
        let dimensions = if T == 5 { 2 } else { 3 };
        let square = (0..dimensions).any(|k| m == second(dimensions, k, k));
        if square { 2.0 * unit[m] } else { unit[m] }
    })
}

/// Weight of a neighbour in the fit, at a distance in supports: the nearest ones lead by far, so that the fit is that of
/// the closest stencil, and the others complete it where there is none. A held face, half a cell from the first row,
/// is met the better for it.
fn share(distance: f64) -> f64 {
    let rest = 1.0 - distance * distance;
    rest * rest / (distance * distance).powi(4)
}

/// Weights of the neighbours `row` of place `a`, and whether they give its gradient; places behind the `particles` are anchors.
pub(super) fn fit<const T: usize>(
    places: &[[f64; 3]],
    particles: usize,
    a: usize,
    row: &[u32],
) -> (Vec<[f64; T]>, bool) {
    let x = places[a];
    let root = |r: [f64; 3]| {
        let square: f64 = r.iter().map(|x| x * x).sum();
        share(square.sqrt() / SUPPORT).sqrt()
    };
    let offset = |b: &u32| -> [f64; 3] {
        let y = places[*b as usize];
        std::array::from_fn(|k| y[k] - x[k])
    };
    let roots: Vec<f64> = row.iter().map(|b| root(offset(b))).collect();
    let design = DMatrix::from_fn(row.len(), T, |k, m| {
        let p: [f64; T] = terms(offset(&row[k]));
        roots[k] * p[m]
    });
    let whole = |b: &u32| -> f64 {
        let square: f64 = offset(b).iter().map(|x| x * x).sum();
        1.0 - square / (SUPPORT * SUPPORT)
    };
    let even = DMatrix::from_fn(row.len(), T, |k, m| {
        let p: [f64; T] = terms(offset(&row[k]));
        whole(&row[k]) * p[m]
    });
    let dimensions = if T == 5 { 2 } else { 3 };
    let inverse = inverse(&design, &spanned(&even, dimensions));
    let weight = |(k, root): (usize, &f64)| std::array::from_fn(|m| root * inverse[(m, k)]);
    let mut weights: Vec<[f64; T]> = roots.iter().enumerate().map(weight).collect();
    for b in row.iter().filter(|b| **b as usize >= particles) {
        balance(&mut weights, offset(b), dimensions);
    }
    let error = |k: usize, l: usize| {
        let moment: f64 = row
            .iter()
            .zip(&weights)
            .map(|(b, w)| offset(b)[k] * w[l])
            .sum();
        (moment - f64::from(u8::from(k == l))).abs()
    };
    let axes = || (0..dimensions).flat_map(|k| (0..dimensions).map(move |l| (k, l)));
    let held = row.len() >= dimensions && axes().all(|(k, l)| error(k, l) < 1e-6);
    (weights, held)
}

/// Takes the slopes of the cell at a held face where they are in balance with those of the others. Summed over the cells, slopes must be
/// the difference between the faces (the integration constraint, Chen et al. 2001), or an even stress bends the first rows:
///
/// ```text
/// F_1 + F_2 + ... = sum (x_b - x_a)/d    needs   F_1 = ((x_1 + x_2)/2 - x_face)/d = F(quadratic) + d/8 dF/dX
/// ```
///
/// which is an eighth of a cell inwards of its middle.
fn balance<const T: usize>(weights: &mut [[f64; T]], anchor: [f64; 3], dimensions: usize) {
    let square: f64 = anchor.iter().map(|x| x * x).sum();
    // Those of the cell's own face are half a cell away.
    if square > OWN * OWN {
        return;
    }
    for weight in weights {
        for k in 0..dimensions {
            let inwards: f64 = (0..dimensions)
                .map(|l| -0.25 * anchor[l] * weight[second(dimensions, k, l)])
                .sum();
            weight[k] += inwards;
        }
    }
}

/// The terms that the neighbours span: one that they do not beside those before it is left out, the highest ones first, so that
/// linear fields stay exact wherever they can be. Judged with weights that fall slowly: those of the fit, which leave the
/// nearest ones to lead, make what three rows span as small as what shaking does.
fn spanned(design: &DMatrix<f64>, dimensions: usize) -> Vec<usize> {
    let mut kept: Vec<usize> = Vec::new();
    let mut basis: Vec<DVector<f64>> = Vec::new();
    for m in 0..design.ncols() {
        let mut rest: DVector<f64> = design.column(m).into();
        let length = rest.norm();
        // Twice, for the sake of rounding.
        for axis in basis.iter().chain(&basis) {
            let along = axis.dot(&rest);
            rest.axpy(-along, axis, 1.0);
        }
        let least = if m < dimensions { FLAT } else { BARELY };
        if rest.norm() > least * length {
            kept.push(m);
            basis.push(rest.normalize());
        }
    }
    kept
}

/// The matrix that solves a fit of some terms in the sense of least squares; no others are in it.
fn inverse(design: &DMatrix<f64>, kept: &[usize]) -> DMatrix<f64> {
    let mut inverse = DMatrix::zeros(design.ncols(), design.nrows());
    let (q, r) = design.select_columns(kept).qr().unpack();
    if let Some(solved) = r.solve_upper_triangular(&q.transpose()) {
        for (row, m) in solved.row_iter().zip(kept) {
            inverse.set_row(*m, &row);
        }
    }
    inverse
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn terms_are_numbered_one_after_another() {
        assert_eq!(
            [second(2, 0, 0), second(2, 1, 0), second(2, 1, 1)],
            [2, 3, 4]
        );
        let all = [(0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2)];
        assert_eq!(all.map(|(k, l)| second(3, k, l)), [3, 4, 5, 6, 7, 8]);
    }

    fn cloud(dimensions: usize, n: usize, cell: [f64; 3]) -> Vec<[f64; 3]> {
        let depth = if dimensions == 3 { n } else { 1 };
        let shaken = |i: usize| 0.2 * ((i as f64 * 12.9898).sin() * 43758.5453).fract();
        let mut places = Vec::new();
        for i in 0..n * n * depth {
            let at = [i % n, (i / n) % n, i / (n * n)];
            places.push(std::array::from_fn(|k| {
                let free = k < dimensions;
                let shake = if free { shaken(3 * i + k) } else { 0.0 };
                (at[k] as f64 + shake) * cell[k]
            }));
        }
        places
    }

    fn quadratics_are_exact<const T: usize>(dimensions: usize) {
        let cell = [0.01, 0.012, 0.009];
        let places = cloud(dimensions, 5, cell);
        let (links, loose) = Links::<T>::new(&places, places.len(), cell);
        assert!(loose.is_empty());
        let exact: [f64; T] = std::array::from_fn(|m| 1.0 + m as f64);
        let field = |x: [f64; 3], y: [f64; 3]| -> f64 {
            let p: [f64; T] = terms(std::array::from_fn(|k| y[k] - x[k]));
            p.iter().zip(exact).map(|(p, c)| p * c).sum()
        };
        for a in 0..places.len() {
            let row = links.row(a);
            for m in 0..T {
                let others = row.other.iter().zip(row.weight);
                let found: f64 = others
                    .map(|(b, w)| w[m] * field(places[a], places[*b as usize]))
                    .sum();
                assert!((found - exact[m]).abs() < 1e-8, "{m}: {found} {}", exact[m]);
            }
        }
    }

    #[test]
    fn derivatives_of_quadratics_are_exact_on_shaken_clouds() {
        quadratics_are_exact::<5>(2);
        quadratics_are_exact::<9>(3);
    }

    #[test]
    fn linear_fields_are_exact_in_two_rows() {
        let places: Vec<[f64; 3]> = (0..12)
            .map(|i| [f64::from(i % 6), f64::from(i / 6), 0.0])
            .collect();
        let (links, loose) = Links::<5>::new(&places, places.len(), [1.0; 3]);
        assert!(loose.is_empty());
        for a in 0..places.len() {
            let row = links.row(a);
            for m in 0..2 {
                let others = row.other.iter().zip(row.weight);
                let difference = |b: usize, k: usize| places[b][k] - places[a][k];
                let slope = |k: usize| -> f64 {
                    let others = others.clone();
                    others.map(|(b, w)| w[m] * difference(*b as usize, k)).sum()
                };
                for k in 0..2 {
                    let exact = if k == m { 1.0 } else { 0.0 };
                    assert!((slope(k) - exact).abs() < 1e-12);
                }
            }
        }
    }

    #[test]
    fn two_shaken_rows_span_no_curvature_across_and_three_do() {
        let most = |rows: usize| {
            let shaken = |i: usize| 0.05 * ((i as f64 * 12.9898).sin() * 43758.5453).fract();
            let at = |i: usize| [i % 6, i / 6];
            let places: Vec<[f64; 3]> = (0..6 * rows)
                .map(|i| {
                    [
                        at(i)[0] as f64 + shaken(i),
                        at(i)[1] as f64 + shaken(i + 100),
                        0.0,
                    ]
                })
                .collect();
            let (links, loose) = Links::<5>::new(&places, places.len(), [1.0; 3]);
            assert!(loose.is_empty());
            let weights = (0..places.len()).flat_map(|a| links.row(a).weight.to_vec());
            weights.fold(0.0_f64, |most, w| most.max(w[4].abs()))
        };
        assert!(most(2) <= 0.0, "{}", most(2));
        assert!(most(3) > 0.5 && most(3) < 4.0, "{}", most(3));
    }

    #[test]
    fn what_hangs_on_too_few_neighbours_is_told() {
        let places = [[0.0; 3], [1.0, 0.0, 0.0], [2.0, 0.0, 0.0]];
        let (_, loose) = Links::<5>::new(&places, 3, [1.0; 3]);
        assert_eq!(loose, [0, 1, 2]);
    }
}
