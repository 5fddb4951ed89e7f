//! The coarsest matrix, factorised.

use super::rows::{Balance, Rows};
use crate::Error;

/// Triangular factors of a small matrix. Each pivot is the sum of the excess and the couplings that
/// are left in its row, never a difference (Grassmann, Taksar and Heyman 1985, Oper. Res. 33,
/// 1107), so an M-matrix is solved to rounding of each number however nearly singular it is.
#[derive(Debug, Clone, Default)]
pub(crate) struct Dense {
    n: usize,
    /// Below the diagonal the multipliers, on it the inverse pivots, above it the couplings.
    factors: Vec<f64>,
    /// What is left of the excess of each row while factorising.
    excess: Vec<f64>,
}

impl Dense {
    pub(crate) fn bytes(&self) -> usize {
        8 * self.factors.capacity()
    }

    pub(crate) fn factorise(&mut self, rows: &Rows, balance: &Balance) -> Result<(), Error> {
        let n = rows.len();
        self.n = n;
        self.factors.clear();
        self.factors.resize(n * n, 0.0);
        for i in 0..n {
            for &(j, w) in rows.row(i) {
                self.factors[i * n + j as usize] += f64::from(w);
            }
        }
        let Self {
            factors, excess, ..
        } = self;
        excess.clone_from(&balance.excess);
        for k in 0..n {
            let (upper, lower) = factors.split_at_mut((k + 1) * n);
            let row = &mut upper[k * n..];
            let pivot = excess[k] + row[k + 1..].iter().sum::<f64>();
            if pivot.is_nan() || pivot <= 0.0 {
                let index = balance.leader[k] as usize;
                return Err(Error::Singular { index });
            }
            let inverse = 1.0 / pivot;
            row[k] = inverse;
            for (i, other) in (k + 1..n).zip(lower.chunks_mut(n)) {
                let factor = other[k] * inverse;
                other[k] = factor;
                if factor == 0.0 {
                    continue;
                }
                excess[i] += factor * excess[k];
                for (w, u) in other[k + 1..].iter_mut().zip(&row[k + 1..]) {
                    *w += factor * u;
                }
                // A coupling of the row with itself is none.
                other[i] = 0.0;
            }
        }
        Ok(())
    }

    pub(crate) fn solve(&self, rhs: &[f64], out: &mut [f64]) {
        let n = self.n;
        for i in 0..n {
            let row = &self.factors[i * n..i * n + i];
            let sum: f64 = row.iter().zip(&*out).map(|(f, x)| f * x).sum();
            out[i] = rhs[i] + sum;
        }
        for i in (0..n).rev() {
            let row = &self.factors[i * n..(i + 1) * n];
            let after = row[i + 1..].iter().zip(&out[i + 1..]);
            let sum: f64 = after.map(|(w, x)| w * x).sum();
            out[i] = (out[i] + sum) * row[i];
        }
    }
}
