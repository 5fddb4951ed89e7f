//! The simplest preconditioners.

use crate::{Error, Inverse, Sparse};

/// The diagonal.
#[derive(Debug, Clone, Default)]
pub struct Jacobi {
    inverse: Vec<f64>,
}

impl Jacobi {
    /// Takes the diagonal of `a`.
    ///
    /// # Errors
    /// When it is not positive everywhere.
    pub fn new(a: &Sparse) -> Result<Self, Error> {
        let mut jacobi = Self::default();
        jacobi.renew(a)?;
        Ok(jacobi)
    }

    /// Takes the diagonal of `a`, keeping the memory.
    ///
    /// # Errors
    /// When it is not positive everywhere.
    pub fn renew(&mut self, a: &Sparse) -> Result<(), Error> {
        positive(a.diagonal())?;
        self.inverse.clear();
        self.inverse.extend(a.diagonal().iter().map(|d| 1.0 / d));
        Ok(())
    }
}

impl Inverse<f64> for Jacobi {
    fn invert(&mut self, rhs: &[[f64; 1]], out: &mut [[f64; 1]]) {
        for (([out], [r]), inverse) in out.iter_mut().zip(rhs).zip(&self.inverse) {
            *out = r * inverse;
        }
    }
}

/// Refuses a diagonal that is not positive and finite.
pub(crate) fn positive(diagonal: &[f64]) -> Result<(), Error> {
    match diagonal.iter().position(|d| !(d.is_finite() && *d > 0.0)) {
        None => Ok(()),
        Some(index) if diagonal[index].is_finite() => Err(Error::NotPositive {
            index,
            value: diagonal[index],
        }),
        Some(index) => Err(Error::NotFinite {
            index,
            what: "the diagonal",
        }),
    }
}

/// A preconditioner of `A diag(k)` from one of `A`: the Jacobian of conduction whose conductivity
/// depends on the temperature is the symmetric matrix times the conductivities, and
/// `(A diag(k))^-1 = diag(1 / k) A^-1`.
#[derive(Debug)]
pub struct Scaled<'a, P> {
    /// Preconditioner of `A`.
    pub inner: &'a mut P,
    /// Factors of the columns.
    pub columns: &'a [f64],
}

impl<P: Inverse<f64>> Inverse<f64> for Scaled<'_, P> {
    fn invert(&mut self, rhs: &[[f64; 1]], out: &mut [[f64; 1]]) {
        self.inner.invert(rhs, out);
        for ([out], k) in out.iter_mut().zip(self.columns) {
            *out /= k;
        }
    }
}
