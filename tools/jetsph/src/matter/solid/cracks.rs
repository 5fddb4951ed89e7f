//! Links that cracks cut: who is left to whom, and the fits that are left.

use std::collections::BTreeSet;

use neighbours::Grid;
use particles::Rows;
use rayon::prelude::*;

use super::fit::{SUPPORT, fit, moved};
use super::fracture::crossed;
use super::links::Links;

/// What may stand between two linked places is nearer than this to either \[cells\].
pub(super) const AROUND: f64 = SUPPORT + 0.5;

/// The neighbours that there were at rest.
#[derive(Debug, Clone)]
pub struct Cracks {
    /// Places at rest in cells, anchors behind the particles.
    places: Vec<[f64; 3]>,
    /// Middles of their cells, in cells: what breaks are cells, wherever in them particles stand.
    middles: Vec<[f64; 3]>,
    /// Middles of what the body has of their cells, seen from the particles, in cells; none where all are whole.
    own: Vec<[f64; 3]>,
    rows: Rows,
    around: Rows,
}

impl Cracks {
    /// Of places at rest \[m\], particles before anchors, and the middles of the cells that may break \[m\]; `own` are
    /// those of what the body has of them, seen from the particles \[cells\].
    #[must_use]
    pub fn new(rest: &[[f64; 3]], middles: &[[f64; 3]], cell: [f64; 3], own: &[[f64; 3]]) -> Self {
        let particles = middles.len();
        let scaled = |x: &[f64; 3]| [0, 1, 2].map(|k| x[k] / cell[k]);
        let places: Vec<[f64; 3]> = rest.iter().map(scaled).collect();
        let within = |radius: f64| {
            let (mut grid, mut rows) = (Grid::new(SUPPORT), Rows::new());
            grid.bin(&places);
            rows.within(&places[..particles], &grid, radius);
            rows
        };
        Self {
            own: own.to_vec(),
            rows: within(SUPPORT),
            around: within(AROUND),
            middles: middles
                .iter()
                .map(scaled)
                .chain(places[particles..].iter().copied())
                .collect(),
            places,
        }
    }

    /// Those whose links the fresh cracks may cut, in order.
    #[must_use]
    pub fn touched(&self, fresh: &[usize], broken: &[bool]) -> Vec<usize> {
        let mut touched: Vec<usize> = fresh
            .iter()
            .flat_map(|a| self.around.row(*a))
            .map(|b| *b as usize)
            .filter(|b| broken.get(*b) == Some(&false))
            .collect();
        touched.sort_unstable();
        touched.dedup();
        touched
    }

    /// Distance at rest \[cells\].
    #[must_use]
    pub fn distance(&self, a: usize, b: usize) -> f64 {
        let [x, y] = [self.places[a], self.places[b]];
        (0..3).map(|k| (x[k] - y[k]).powi(2)).sum::<f64>().sqrt()
    }

    /// The neighbours that particle `a` had at rest.
    pub(super) fn row(&self, a: usize) -> &[u32] {
        self.rows.row(a)
    }

    /// The particles nearer than a radius \[cells\] at rest, in order.
    pub(super) fn near(&self, a: usize, radius: f64) -> Vec<u32> {
        let (mut found, mut open) = (BTreeSet::from([a as u32]), vec![a as u32]);
        while let Some(b) = open.pop() {
            for c in self.rows.row(b as usize) {
                let is_one =
                    (*c as usize) < self.rows.len() && self.distance(a, *c as usize) < radius;
                if is_one && found.insert(*c) {
                    open.push(*c);
                }
            }
        }
        found.into_iter().collect()
    }

    /// The neighbours that particle `a` still has.
    pub(super) fn left(&self, a: usize, broken: &[bool]) -> Vec<u32> {
        let is_broken = |b: &u32| broken.get(*b as usize).is_some_and(|b| *b);
        let between: Vec<[f64; 3]> = self
            .around
            .row(a)
            .iter()
            .filter(|b| is_broken(b))
            .map(|b| self.middles[*b as usize])
            .collect();
        let is_left = |b: &&u32| {
            let to = self.middles[**b as usize];
            !is_broken(b) && !crossed(self.middles[a], to, between.iter().copied())
        };
        self.rows.row(a).iter().filter(is_left).copied().collect()
    }

    /// Weights in cells of the neighbours `row` that are left to particle `a`, and whether they hold it.
    pub(super) fn refit<const T: usize>(&self, a: usize, row: &[u32]) -> (Vec<[f64; T]>, bool) {
        let fewest = if T == 5 { 4 } else { 7 };
        let mut fit = fit::<T>(&self.places, self.rows.len(), a, row);
        if let Some(to) = self.own.get(a) {
            moved(&mut fit.weights, *to);
        }
        (fit.weights, fit.held && fit.soft && row.len() >= fewest)
    }

    /// Bytes held.
    #[must_use]
    pub fn bytes(&self) -> usize {
        self.rows.bytes() + self.around.bytes() + 48 * self.places.len() + 24 * self.own.len()
    }
}

impl<const T: usize> Links<T> {
    /// Fits the links of the `touched` anew and takes those of the `fresh` away. Gives those that too few neighbours
    /// hold.
    #[must_use]
    pub fn cut(
        &mut self,
        cracks: &Cracks,
        cell: [f64; 3],
        broken: &[bool],
        fresh: &[usize],
        touched: &[usize],
    ) -> Vec<usize> {
        let mut before = broken.to_vec();
        fresh.iter().for_each(|a| before[*a] = false);
        // Rows that lose nothing keep their fits.
        let refit = |a: &usize| {
            let row = cracks.left(*a, broken);
            let is_changed = row.len() != cracks.left(*a, &before).len();
            is_changed.then(|| {
                let (weights, held) = cracks.refit::<T>(*a, &row);
                (*a, row, weights, held)
            })
        };
        let mut found: Vec<_> = touched.par_iter().filter_map(refit).collect();
        found.extend(fresh.iter().map(|a| (*a, Vec::new(), Vec::new(), true)));
        found.sort_by_key(|(a, ..)| *a);
        let loose = found
            .iter()
            .filter(|(.., held)| !held)
            .map(|(a, ..)| *a)
            .collect();
        let new = found
            .into_iter()
            .map(|(a, row, weights, _)| (a, (row, weights)));
        self.replace(&new.collect(), cell);
        loose
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_crack_parts_its_sides_and_linear_fields_stay_exact() {
        let places: Vec<[f64; 3]> = (0..81)
            .map(|i| [f64::from(i % 9), f64::from(i / 9), 0.0])
            .collect();
        let (mut links, _) = Links::<5>::new(&places, 81, [1.0; 3], &[]);
        let cracks = Cracks::new(&places, &places, [1.0; 3], &[]);
        // A column of broken particles.
        let fresh: Vec<usize> = (0..9).map(|j| 9 * j + 4).collect();
        let broken: Vec<bool> = (0..81).map(|a| fresh.contains(&a)).collect();
        let touched = cracks.touched(&fresh, &broken);
        let loose = links.cut(&cracks, [1.0; 3], &broken, &fresh, &touched);
        assert!(loose.is_empty());
        for a in (0..81).filter(|a| !broken[*a]) {
            let row = links.row(a);
            let mut slope = 0.0;
            for (b, w) in row.other.iter().zip(row.weight) {
                let b = *b as usize;
                assert_eq!(a % 9 < 4, b % 9 < 4, "{a} still holds {b}");
                assert!(
                    links.row(b).other.contains(&(a as u32)),
                    "{a} {b}: one way alone"
                );
                slope += w[0] * (3.0 * (places[b][0] - places[a][0]) + places[b][1] - places[a][1]);
            }
            assert!((slope - 3.0).abs() < 1e-10);
        }
        assert!(links.row(4).other.is_empty());
    }
}
