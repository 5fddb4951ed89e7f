//! The equation of the pressure, by conjugate gradients with the diagonal.
//!
//! ```text
//! V_a (sum_b w_ab (p_a - p_b) + k_a p_a) = V_a r_a
//! ```
//!
//! Since w_ab holds V_b the rows are symmetric. Rows of water that a nozzle leads are p = 0.

use krylov::{Inverse, Operator, Rule, Scratch, conjugate_gradient};
use particles::sweep;
use rayon::prelude::*;

use super::operators::Couplings;
use super::yielding::Yielding;

/// Rows per chunk.
pub(super) const ROWS: usize = 256;
/// Most sweeps.
const SWEEPS: usize = 3000;

/// The rows with their scratch.
#[derive(Debug, Clone, Default)]
pub(super) struct Poisson {
    /// Couplings of [`ROWS`] rows each.
    pub(super) chunks: Vec<Couplings>,
    /// Diagonal w + k \[1/m2\], and V \[m3\], of each row; both 1 of led water.
    pub(super) diagonal: Vec<[f64; 2]>,
    /// V r \[Pa m\].
    pub(super) right: Vec<f64>,
    /// What solids add to the rows.
    pub(super) yielding: Yielding,
    scratch: Scratch<f64>,
}

impl Operator<f64> for Poisson {
    fn len(&self) -> usize {
        self.diagonal.len()
    }

    fn apply(&self, p: &[[f64; 1]], out: &mut [[f64; 1]]) {
        let (p, out) = (p.as_flattened(), out.as_flattened_mut());
        let chunks = out.par_chunks_mut(ROWS).zip(&self.chunks);
        chunks.enumerate().for_each(|(chunk, (out, rows))| {
            let mut from = 0;
            for (k, (out, end)) in out.iter_mut().zip(&rows.ends).enumerate() {
                let [diagonal, volume] = self.diagonal[chunk * ROWS + k];
                let mut sum = 0.0;
                for (b, w) in &rows.with[from..*end as usize] {
                    sum += w * p[*b as usize];
                }
                *out = volume * (diagonal * p[chunk * ROWS + k] - sum);
                from = *end as usize;
            }
        });
        self.yielding.apply(p, out);
    }
}

/// The inverse of the diagonal.
struct Diagonal<'a>(&'a [[f64; 2]], &'a Yielding);

impl Inverse<f64> for Diagonal<'_> {
    fn invert(&mut self, rhs: &[[f64; 1]], out: &mut [[f64; 1]]) {
        let (rhs, out) = (rhs.as_flattened(), out.as_flattened_mut());
        sweep::fill(out, |a| {
            rhs[a] / (self.0[a][0] * self.0[a][1] + self.1.diagonal(a))
        });
    }
}

impl Poisson {
    /// Improves `p` until the norm of the residual is at most `floor`; sweeps that this took, or what was left.
    pub(super) fn solve(&mut self, p: &mut [f64], floor: f64) -> Result<usize, String> {
        let mut scratch = std::mem::take(&mut self.scratch);
        let rule = Rule {
            floor,
            ..Rule::to(0.0, 1 + SWEEPS)
        };
        let mut diagonal = Diagonal(&self.diagonal, &self.yielding);
        let solved = conjugate_gradient(self, &self.right, p, &mut diagonal, rule, &mut scratch);
        self.scratch = scratch;
        let solved = solved.sound().map_err(|e| e.to_string())?;
        if solved.last > floor {
            let left = solved.last / floor;
            return Err(format!(
                "is off by {left:.1e} tolerances after {SWEEPS} sweeps"
            ));
        }
        Ok(solved.steps)
    }

    /// Bytes held.
    pub(super) fn bytes(&self) -> usize {
        let with: usize = self.chunks.iter().map(|chunk| chunk.with.capacity()).sum();
        16 * with + (24 + 4 * 8) * self.diagonal.len()
    }
}
