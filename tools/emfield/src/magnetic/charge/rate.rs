//! What stands for `d/dt` where A and V are sought together.

use krylov::{Error, Inverse, Options, Rows, Scalar};
use num_complex::Complex;

use crate::magnetic::charge::block::Block;

/// A rate of change: `j w` in a sinusoidal steady state, `1 / (gamma h)` in a stage of a march.
pub trait Rate: Scalar {
    /// Factors of real rows with a diagonal of such numbers beside them.
    type Block: Inverse<Self, 3>;

    /// The square root whose real part is not negative.
    #[must_use]
    fn root(self) -> Self;

    /// Factors of `rows + diag(shift)`, fluxes by the given sizes.
    ///
    /// # Errors
    /// Where a coefficient is no number, or the rows are singular.
    fn block(
        rows: &Rows<f64>,
        sizes: &[f64],
        shift: &[Self],
        options: &Options,
    ) -> Result<Self::Block, Error>;

    /// Applies real factors.
    fn invert(block: &mut Block<f64>, given: &[[Self; 1]], found: &mut [[Self; 1]]);
}

impl Rate for f64 {
    type Block = Block<Self>;

    fn root(self) -> Self {
        self.sqrt()
    }

    fn block(
        rows: &Rows<f64>,
        sizes: &[f64],
        shift: &[Self],
        options: &Options,
    ) -> Result<Self::Block, Error> {
        Block::new(rows, sizes, shift, options)
    }

    fn invert(block: &mut Block<f64>, given: &[[Self; 1]], found: &mut [[Self; 1]]) {
        block.invert(given, found);
    }
}

impl Rate for Complex<f64> {
    type Block = Block<Self>;

    fn root(self) -> Self {
        self.sqrt()
    }

    fn block(
        rows: &Rows<f64>,
        sizes: &[f64],
        shift: &[Self],
        options: &Options,
    ) -> Result<Self::Block, Error> {
        Block::new(rows, sizes, shift, options)
    }

    /// Real and imaginary part are two columns.
    fn invert(block: &mut Block<f64>, given: &[[Self; 1]], found: &mut [[Self; 1]]) {
        let parts: Vec<[f64; 2]> = given.iter().map(|[g]| [g.re, g.im]).collect();
        let mut out = vec![[0.0; 2]; parts.len()];
        block.invert(&parts, &mut out);
        for (found, [re, im]) in found.iter_mut().zip(out) {
            *found = [Self::new(re, im)];
        }
    }
}
