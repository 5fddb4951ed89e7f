//! Incomplete factorisation of the five-point equation, used as a preconditioner.
//!
//! `L D^-1 U` with the equation's own neighbour coefficients in L and U; only the diagonal D is
//! worked out, so that the product has the central coefficients of the equation. What the product
//! has beside them is subtracted from D in the part `MODIFIED` (Gustafsson 1978), which keeps row
//! sums and lowers the number of iterations from order n to order n^1/2 on n cells per side.

use crate::{Error, FivePoint, Precondition};

/// Part of the neglected entries that the diagonal takes up.
const MODIFIED: f64 = 0.97;
/// Smallest part of the central coefficient that is left on the diagonal.
const LEAST: f64 = 1e-3;

/// The factors of an equation.
#[derive(Debug, Clone, Default)]
pub struct Incomplete {
    columns: usize,
    inverse: Vec<f64>,
    east: Vec<f64>,
    west: Vec<f64>,
    north: Vec<f64>,
    south: Vec<f64>,
}

impl Incomplete {
    /// Factorises `equation`, keeping the memory where sizes are as before.
    ///
    /// # Errors
    /// When the equation is not usable.
    pub fn rebuild(&mut self, equation: &FivePoint) -> Result<(), Error> {
        equation.check()?;
        self.columns = equation.columns;
        self.east.clone_from(&equation.east);
        self.west.clone_from(&equation.west);
        self.north.clone_from(&equation.north);
        self.south.clone_from(&equation.south);
        self.inverse.resize(equation.len(), 0.0);
        let n = self.columns;
        for k in 0..equation.len() {
            let mut diagonal = equation.centre[k];
            if self.west[k] != 0.0 {
                let factor = self.west[k] * self.inverse[k - 1];
                diagonal -= factor * (self.east[k - 1] + MODIFIED * self.north[k - 1]);
            }
            if self.south[k] != 0.0 {
                let factor = self.south[k] * self.inverse[k - n];
                diagonal -= factor * (self.north[k - n] + MODIFIED * self.east[k - n]);
            }
            self.inverse[k] = 1.0 / diagonal.max(LEAST * equation.centre[k]);
        }
        Ok(())
    }
}

impl Precondition for Incomplete {
    fn precondition(&mut self, rhs: &[f64], out: &mut [f64]) {
        let n = self.columns;
        for k in 0..out.len() {
            let mut sum = rhs[k];
            if k >= 1 {
                sum += self.west[k] * out[k - 1];
            }
            if k >= n {
                sum += self.south[k] * out[k - n];
            }
            out[k] = sum * self.inverse[k];
        }
        for k in (0..out.len()).rev() {
            let mut sum = 0.0;
            if k + 1 < out.len() {
                sum += self.east[k] * out[k + 1];
            }
            if k + n < out.len() {
                sum += self.north[k] * out[k + n];
            }
            out[k] += sum * self.inverse[k];
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_is_factorised_exactly() {
        // Without a second row nothing is neglected: one application solves the equation.
        let mut a = FivePoint::new(6, 1);
        for k in 0..6 {
            a.centre[k] = 3.0 + k as f64;
            a.east[k] = if k < 5 { 1.0 } else { 0.0 };
            a.west[k] = if k > 0 { 1.5 } else { 0.0 };
        }
        let x = [1.0, -2.0, 0.5, 4.0, 3.0, -1.0];
        let (mut b, mut found) = ([0.0; 6], [0.0; 6]);
        a.apply(&x, &mut b);
        let mut factors = Incomplete::default();
        factors.rebuild(&a).unwrap();
        factors.precondition(&b, &mut found);
        assert!(
            x.iter().zip(&found).all(|(x, f)| (x - f).abs() < 1e-13),
            "{found:?}"
        );
    }
}
