//! StencilFactors factorisation of the five-point equation, used as a preconditioner.
//!
//! `L D^-1 U` with the equation's own neighbour coefficients in L and U; only the diagonal D is
//! worked out, so that the product has the central coefficients of the equation. What the product
//! has beside them is subtracted from D in the part `MODIFIED` (Gustafsson 1978), which keeps row
//! sums and lowers the number of iterations from order n to order n^1/2 on n cells per side.

use krylov::{Error, Inverse};

use crate::FivePoint;

/// Part of the neglected entries that the diagonal takes up.
const MODIFIED: f64 = 0.97;
/// Smallest part of the central coefficient that is left on the diagonal.
const LEAST: f64 = 1e-3;

/// The factors of an equation.
#[derive(Debug, Clone, Default)]
pub struct StencilFactors {
    columns: usize,
    inverse: Vec<f64>,
    east: Vec<f64>,
    west: Vec<f64>,
    north: Vec<f64>,
    south: Vec<f64>,
}

impl StencilFactors {
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

impl Inverse<f64> for StencilFactors {
    fn invert(&mut self, rhs: &[[f64; 1]], out: &mut [[f64; 1]]) {
        let (rhs, out) = (rhs.as_flattened(), out.as_flattened_mut());
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
    use krylov::{Rule, Scratch, bicgstab, conjugate_gradient};

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
        a.product(&x, &mut b);
        let mut factors = StencilFactors::default();
        factors.rebuild(&a).unwrap();
        factors.invert(b.as_chunks().0, found.as_chunks_mut().0);
        assert!(
            x.iter().zip(&found).all(|(x, f)| (x - f).abs() < 1e-13),
            "{found:?}"
        );
    }

    /// A layered conductor: conductivity `ratio` in the lower half, 1 above; insulated sides, a
    /// current through the top, ground below. Convection `flow` upward makes it unsymmetric.
    fn layers(n: usize, ratio: f64, flow: f64) -> FivePoint {
        let mut a = FivePoint::new(n, n);
        let sigma = |j: usize| if j < n / 2 { ratio } else { 1.0 };
        let face = |j: usize| 2.0 / (1.0 / sigma(j) + 1.0 / sigma(j + 1));
        for j in 0..n {
            for i in 0..n {
                let k = j * n + i;
                a.east[k] = if i + 1 < n { sigma(j) } else { 0.0 };
                a.west[k] = if i > 0 { sigma(j) } else { 0.0 };
                a.north[k] = if j + 1 < n { face(j) } else { 0.0 };
                a.south[k] = if j > 0 { face(j - 1) + flow } else { 0.0 };
                a.centre[k] = a.east[k] + a.west[k] + a.north[k] + a.south[k];
                if j == 0 {
                    a.centre[k] += 2.0 * sigma(0) + flow;
                }
                if j + 1 == n {
                    a.source[k] = 1.0;
                }
            }
        }
        a
    }

    #[test]
    fn they_serve_conjugate_gradients_whatever_the_jump() {
        for ratio in [1.0, 1e12, 1e-7] {
            let (a, n) = (layers(97, ratio, 0.0), 97);
            let mut factors = StencilFactors::default();
            factors.rebuild(&a).unwrap();
            let mut scratch = Scratch::default();
            let (rule, mut x) = (Rule::to(1e-10, 201), vec![0.0; n * n]);
            let o = conjugate_gradient(&a, &a.source, &mut x, &mut factors, rule, &mut scratch);
            assert!(o.converged(), "ratio {ratio}: {o:?}");
        }
    }

    #[test]
    fn they_serve_stabilised_gradients_where_a_stream_passes() {
        let a = layers(64, 10.0, 30.0);
        let mut factors = StencilFactors::default();
        factors.rebuild(&a).unwrap();
        let mut x = vec![0.0; 64 * 64];
        let mut scratch = Scratch::default();
        let mut solve = |rule| bicgstab(&a, &a.source, &mut x, &mut factors, rule, &mut scratch);
        let first = solve(Rule::to(1e-10, 161));
        assert!(first.last <= 1e-10 * first.first, "{first:?}");
        // A second solve of the same equation costs nothing.
        assert_eq!(solve(Rule::to(1e-8, 161)).steps, 0);
    }
}
