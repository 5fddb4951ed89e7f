//! Links between the particles of a solid in its reference state: weights that give first and second derivatives.
//!
//! Around each particle a quadratic is fitted to the places of its neighbours, through its own place (weighted least
//! squares). The derivatives of the fit are weighted sums of differences,
//!
//! ```text
//! d^m x / dX^m (i) = sum_j w_ij^m (x_j - x_i)
//! ```
//!
//! exact for every quadratic on any cloud, at free faces too. Where a surface cuts cells, first derivatives are those in the middle
//! of what the body has of a cell. Weights are those of the reference state and never change
//! while the particle has its neighbours.

use std::collections::BTreeMap;

use neighbours::Grid;
use particles::Rows;
use rayon::prelude::*;

use super::fit::{Fit, Fitted, SUPPORT, fit, moved};
use super::sides::{in_order, of_pair, seen};
use super::stencils::Stencils;

/// Links with `T` terms: 5 in the plane, 9 in space.
#[derive(Debug, Clone, Default)]
pub struct Links<const T: usize> {
    start: Vec<usize>,
    other: Vec<u32>,
    /// Kind of the weights of each particle.
    kind: Vec<u32>,
    stencils: Stencils<T>,
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

impl<const T: usize> Links<T> {
    /// Links of the first `particles` of `places` to each other and to the others, the anchors; `cell` is the size of
    /// the lattice's cells \[m\], and derivatives are those at `middles`, seen from the particles \[cells\], or at the particles if none.
    /// Gives the particles that too few neighbours hold, too.
    #[must_use]
    pub fn new(
        places: &[[f64; 3]],
        particles: usize,
        cell: [f64; 3],
        middles: &[[f64; 3]],
    ) -> (Self, Vec<usize>) {
        // In cells, where the lattice is cubic.
        let scaled: Vec<[f64; 3]> = places
            .iter()
            .map(|x| std::array::from_fn(|k| x[k] / cell[k]))
            .collect();
        let (mut grid, mut rows) = (Grid::new(SUPPORT), Rows::new());
        grid.bin(&scaled);
        rows.within(&scaled[..particles], &grid, SUPPORT);
        let fitted: Vec<Fit<T>> = (0..particles)
            .into_par_iter()
            .map(|a| {
                let mut fit = fit(&scaled, particles, a, rows.row(a));
                if let Some(to) = middles.get(a) {
                    moved(&mut fit.weights, *to);
                }
                fit
            })
            .collect();
        let loose = fitted.iter().enumerate().filter(|(_, fit)| !fit.held);
        let loose = loose.map(|(a, _)| a).collect();
        let each = fitted.into_iter().enumerate();
        let own: Vec<Fitted<T>> = each
            .map(|(a, fit)| (rows.row(a).to_vec(), fit.weights))
            .map(|fitted| in_order(&fitted, cell))
            .collect();
        let mut from: Vec<Vec<u32>> = vec![Vec::new(); particles];
        for (a, (others, _)) in own.iter().enumerate() {
            let particles = others.iter().filter(|b| (**b as usize) < particles);
            particles.for_each(|b| from[*b as usize].push(a as u32));
        }
        let weight = |a: usize, b: u32| of_pair(&own[a].0, &own[a].1, b);
        let mut links = Self {
            start: vec![0],
            ..Self::default()
        };
        for (a, from) in from.into_iter().enumerate() {
            let near = [&own[a].0[..], &from].concat();
            let seen = seen(a, near, particles, &weight);
            let kind = links.stencils.kind(&seen.weight, &seen.back);
            links.push(&seen.other, kind);
        }
        (links, loose)
    }

    /// Replaces the links of some particles: their neighbours and the weights in cells.
    pub(super) fn replace(&mut self, new: &BTreeMap<usize, Fitted<T>>, cell: [f64; 3]) {
        let particles = self.kind.len();
        let new: BTreeMap<usize, Fitted<T>> = new
            .iter()
            .map(|(a, fitted)| (*a, in_order(fitted, cell)))
            .collect();
        // Those that are seen anew, with all that they might see.
        let mut near: BTreeMap<usize, Vec<u32>> = BTreeMap::new();
        for (a, (others, _)) in &new {
            near.entry(*a).or_default().extend(others);
            for b in others.iter().chain(self.row(*a).other) {
                if (*b as usize) < particles {
                    near.entry(*b as usize).or_default().push(*a as u32);
                }
            }
        }
        for (a, near) in &mut near {
            near.extend(self.row(*a).other);
        }
        let mut stencils = std::mem::take(&mut self.stencils);
        let mut changed = BTreeMap::new();
        for (a, near) in near {
            let weight = |a: usize, b: u32| match new.get(&a) {
                Some((others, weights)) => of_pair(others, weights, b),
                None => {
                    let weights = stencils.stencil(self.kind[a]).weight;
                    of_pair(&self.other[self.start[a]..self.start[a + 1]], weights, b)
                }
            };
            let seen = seen(a, near, particles, &weight);
            let kind = stencils.kind(&seen.weight, &seen.back);
            changed.insert(a, (seen.other, kind));
        }
        let mut links = Self {
            start: vec![0],
            stencils,
            ..Self::default()
        };
        for a in 0..particles {
            match changed.get(&a) {
                Some((other, kind)) => links.push(other, *kind),
                None => {
                    let range = self.start[a]..self.start[a + 1];
                    links.push(&self.other[range], self.kind[a]);
                }
            }
        }
        links.stencils.tidy(&mut links.kind);
        *self = links;
    }

    fn push(&mut self, other: &[u32], kind: u32) {
        self.other.extend_from_slice(other);
        self.start.push(self.other.len());
        self.kind.push(kind);
    }

    /// The links of particle `a`.
    #[inline(always)]
    #[must_use]
    pub fn row(&self, a: usize) -> Row<'_, T> {
        let stencil = self.stencils.stencil(self.kind[a]);
        Row {
            other: &self.other[self.start[a]..self.start[a + 1]],
            weight: stencil.weight,
            back: stencil.back,
            total: stencil.total,
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
        4 * self.other.len() + 12 * self.kind.len() + self.stencils.bytes()
    }
}

#[cfg(test)]
mod tests {
    use super::super::quadratic::terms;
    use super::*;

    fn cloud(shake: f64, dimensions: usize, n: usize, cell: [f64; 3]) -> Vec<[f64; 3]> {
        let depth = if dimensions == 3 { n } else { 1 };
        let shaken = |i: usize| shake * ((i as f64 * 12.9898).sin() * 43758.5453).fract();
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

    /// Part of the particles whose fits are not exact for quadratics.
    fn inexact<const T: usize>(shake: f64, dimensions: usize) -> f64 {
        let cell = [0.01, 0.012, 0.009];
        let places = cloud(shake, dimensions, 5, cell);
        let (links, loose) = Links::<T>::new(&places, places.len(), cell, &[]);
        assert!(loose.is_empty());
        let exact: [f64; T] = std::array::from_fn(|m| 1.0 + m as f64);
        let field = |x: [f64; 3], y: [f64; 3]| -> f64 {
            let p: [f64; T] = terms(std::array::from_fn(|k| y[k] - x[k]));
            p.iter().zip(exact).map(|(p, c)| p * c).sum()
        };
        let is_exact = |a: &usize| {
            let row = links.row(*a);
            (0..T).all(|m| {
                let others = row.other.iter().zip(row.weight);
                let found: f64 = others
                    .map(|(b, w)| w[m] * field(places[*a], places[*b as usize]))
                    .sum();
                (found - exact[m]).abs() < 1e-8
            })
        };
        let exact = (0..places.len()).filter(is_exact).count();
        1.0 - exact as f64 / places.len() as f64
    }

    #[test]
    fn derivatives_of_quadratics_are_exact_on_shaken_clouds() {
        for shake in [0.05, 0.1, 0.15] {
            assert!(inexact::<5>(shake, 2) <= 0.0 && inexact::<9>(shake, 3) <= 0.0);
        }
        // One corner may do without a curvature.
        assert!(inexact::<5>(0.2, 2) <= 0.0 && inexact::<9>(0.2, 3) < 0.01);
    }

    #[test]
    fn slopes_are_those_of_quadratics_in_the_middles() {
        let places = cloud(0.1, 2, 5, [1.0; 3]);
        let middles: Vec<[f64; 3]> = (0..places.len())
            .map(|a| [0.3 * (a as f64).sin(), 0.4 * (a as f64).cos(), 0.0])
            .collect();
        let (links, _) = Links::<5>::new(&places, places.len(), [1.0; 3], &middles);
        let field = |[x, y, _]: [f64; 3]| 2.0 * x - y + 0.5 * x * x - x * y + 0.7 * y * y;
        for (a, to) in middles.iter().enumerate() {
            let [x, y] = [0, 1].map(|k| places[a][k] + to[k]);
            let exact = [2.0 + x - y, -1.0 - x + 1.4 * y];
            let row = links.row(a);
            for (k, exact) in exact.into_iter().enumerate() {
                let others = row.other.iter().zip(row.weight);
                let rise = |b: &u32| field(places[*b as usize]) - field(places[a]);
                let found: f64 = others.map(|(b, w)| w[k] * rise(b)).sum();
                assert!((found - exact).abs() < 1e-9, "{a} {k}: {found} {exact}");
            }
        }
    }

    #[test]
    fn linear_fields_are_exact_in_two_rows() {
        let places: Vec<[f64; 3]> = (0..12)
            .map(|i| [f64::from(i % 6), f64::from(i / 6), 0.0])
            .collect();
        let (links, loose) = Links::<5>::new(&places, places.len(), [1.0; 3], &[]);
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
            let (links, loose) = Links::<5>::new(&places, places.len(), [1.0; 3], &[]);
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
        let (_, loose) = Links::<5>::new(&places, 3, [1.0; 3], &[]);
        assert_eq!(loose, [0, 1, 2]);
    }
}
