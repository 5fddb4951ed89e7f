//! The quality of a group of rows.

use super::groups::View;

/// Scratch of the test.
#[derive(Debug, Default)]
pub(crate) struct Quality {
    pub(crate) nodes: Vec<u32>,
    matrix: Vec<f64>,
}

impl Quality {
    /// Is the quality of the group of `nodes` at most `limit`? With `A` the couplings within the
    /// group and the excess, and `D` the diagonal, the matrix
    /// `limit A - 2 D (I - 1 (1^T D 1)^-1 1^T D)` must have no negative eigenvalue (Napov and Notay
    /// 2012, eq. 3.7): a Cholesky factorisation decides. `inside` tells the columns of the group.
    pub(crate) fn within(
        &mut self,
        view: View<'_>,
        inside: impl Fn(u32) -> bool,
        limit: f64,
    ) -> bool {
        let m = self.nodes.len();
        self.matrix.clear();
        self.matrix.resize(m * m, 0.0);
        let mut total = 0.0;
        for (k, &i) in self.nodes.iter().enumerate() {
            total += view.diagonal(i as usize);
            self.matrix[k * m + k] += limit * view.excess(i as usize);
            for (j, w) in view.row(i as usize) {
                if !inside(j) {
                    continue;
                }
                if let Some(l) = self.nodes.iter().position(|node| *node == j) {
                    self.matrix[k * m + l] -= limit * w;
                    self.matrix[k * m + k] += limit * w;
                }
            }
        }
        for k in 0..m {
            let d = view.diagonal(self.nodes[k] as usize);
            self.matrix[k * m + k] -= 2.0 * d;
            for l in 0..m {
                let other = view.diagonal(self.nodes[l] as usize);
                self.matrix[k * m + l] += 2.0 * d * other / total;
            }
        }
        self.positive(m, 1e-9 * total)
    }

    /// Eliminates; a pivot may be zero if its row is.
    fn positive(&mut self, m: usize, tolerance: f64) -> bool {
        let a = &mut self.matrix;
        for k in 0..m {
            let pivot = a[k * m + k];
            if pivot <= tolerance {
                let rest = (k + 1..m).all(|l| a[k * m + l].abs() <= tolerance);
                if pivot < -tolerance || !rest {
                    return false;
                }
                continue;
            }
            for i in k + 1..m {
                let factor = a[i * m + k] / pivot;
                for l in k + 1..m {
                    a[i * m + l] -= factor * a[k * m + l];
                }
            }
        }
        true
    }
}
