//! The quality of a group of rows.

use super::view::View;
use crate::grouping::NONE;

/// Most rows of a group.
pub(crate) const MOST: usize = 8;

/// Rows of a group to be judged, filled up with [`NONE`].
#[derive(Debug, Clone, Copy)]
pub(crate) struct Candidate {
    nodes: [u32; MOST],
    len: usize,
}

impl Candidate {
    pub(crate) fn new(nodes: impl Iterator<Item = u32>) -> Self {
        let mut new = Self {
            nodes: [NONE; MOST],
            len: 0,
        };
        for (place, node) in new.nodes.iter_mut().zip(nodes) {
            *place = node;
            new.len += 1;
        }
        new
    }

    /// Is the quality of the group at most `limit`? With `A` the couplings within the group and
    /// the excess, and `D` the diagonal, the matrix `limit A - 2 D (I - 1 (1^T D 1)^-1 1^T D)` must
    /// have no negative eigenvalue (Napov and Notay 2012, eq. 3.7): elimination decides. `inside`
    /// tells the columns of the group.
    pub(crate) fn within(&self, view: View<'_>, inside: impl Fn(u32) -> bool, limit: f64) -> bool {
        let mut a = [[0.0; MOST]; MOST];
        let mut diagonal = [0.0; MOST];
        let m = self.len.min(MOST);
        for k in 0..m {
            let i = self.nodes[k] as usize;
            diagonal[k] = view.diagonal(i);
            a[k][k] += limit * view.excess(i) - 2.0 * diagonal[k];
            for (j, w) in view.row(i).filter(|(j, _)| inside(*j)) {
                let mut l = 0;
                for (place, node) in self.nodes.iter().enumerate() {
                    l += if *node == j { place } else { 0 };
                }
                a[k][l] -= limit * w;
                a[k][k] += limit * w;
            }
        }
        let total: f64 = diagonal.iter().sum();
        for k in 0..m {
            let share = 2.0 * diagonal[k] / total;
            for l in 0..m {
                a[k][l] += share * diagonal[l];
            }
        }
        positive(&mut a, m, 1e-9 * total)
    }
}

/// Eliminates; a pivot may be zero if its row is.
fn positive(a: &mut [[f64; MOST]; MOST], m: usize, tolerance: f64) -> bool {
    for k in 0..m {
        let row = a[k];
        if row[k] <= tolerance {
            let rest = row[k + 1..m].iter().all(|v| v.abs() <= tolerance);
            if row[k] < -tolerance || !rest {
                return false;
            }
            continue;
        }
        let inverse = 1.0 / row[k];
        for other in &mut a[k + 1..m] {
            let factor = other[k] * inverse;
            for (v, u) in other.iter_mut().zip(&row) {
                *v -= factor * u;
            }
        }
    }
    true
}

#[cfg(test)]
mod tests {
    use super::super::rows::{Balance, Rows};
    use super::*;

    /// A group of all rows of `couplings`, each row with `outside` beside them.
    fn quality(couplings: &[Vec<f64>], outside: f64) -> f64 {
        let (mut rows, mut balance) = (Rows::default(), Balance::default());
        rows.clear();
        for row in couplings {
            let links = row.iter().enumerate().filter(|(_, w)| **w > 0.0);
            let sum = rows.push(links.map(|(j, w)| (j as u32, *w)));
            rows.close(sum + outside);
            balance.push(sum + outside, 0.0, 0);
        }
        let all = Candidate::new(0..couplings.len() as u32);
        let (mut low, mut high) = (1e-3, 1e9_f64);
        while high > low * (1.0 + 1e-9) {
            let middle = (low * high).sqrt();
            if all.within(View::Rows(&rows, &balance), |_| true, middle) {
                high = middle;
            } else {
                low = middle;
            }
        }
        high
    }

    #[test]
    fn quality_of_known_groups() {
        // Of 2 D (I - mean) v = quality A v with the same D everywhere: 2 D over the smallest
        // eigenvalue of the graph but zero.
        let box_of_four = vec![
            vec![0.0, 1.0, 1.0, 0.0],
            vec![1.0, 0.0, 0.0, 1.0],
            vec![1.0, 0.0, 0.0, 1.0],
            vec![0.0, 1.0, 1.0, 0.0],
        ];
        assert!((quality(&box_of_four, 2.0) - 2.0 * 4.0 / 2.0).abs() < 1e-5);
        let pair = vec![vec![0.0, 3.0], vec![3.0, 0.0]];
        assert!((quality(&pair, 5.0) - 2.0 * 8.0 / 6.0).abs() < 1e-5);
        let cube: Vec<Vec<f64>> = (0..8_u32)
            .map(|i| {
                (0..8_u32)
                    .map(|j| f64::from((i ^ j).count_ones() == 1))
                    .collect()
            })
            .collect();
        assert!((quality(&cube, 3.0) - 2.0 * 6.0 / 2.0).abs() < 1e-5);
    }
}
