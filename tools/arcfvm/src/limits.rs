//! What a solution may not exceed.

use crate::case::{Case, GAS};
use crate::error::Error;
use crate::solver::Arc;

impl Arc {
    /// The first gas cell above the end of the gas table, if that is an error.
    ///
    /// # Errors
    /// [`Error::AboveTable`].
    pub fn within_table(&self) -> Result<(), Error> {
        let Some(end) = self.case.materials[GAS]
            .end_k
            .filter(|_| self.heating.is_some())
        else {
            return Ok(());
        };
        let cells = self.temperature().iter().enumerate();
        match cells
            .into_iter()
            .find(|(k, t)| self.case.material[*k] == GAS && **t > end)
        {
            Some((k, t)) => Err(Error::AboveTable {
                place: self.case.place(k),
                found: *t,
                end,
                material: "gas".to_owned(),
            }),
            None => Ok(()),
        }
    }
}

/// Stops at the first value beyond `most`.
pub(crate) fn check(
    case: &Case,
    quantity: &'static str,
    unit: &str,
    iteration: usize,
    values: &[f64],
    most: f64,
) -> Result<(), Error> {
    match values.iter().position(|v| v.abs() > most) {
        Some(k) => {
            let what = format!("{quantity} {:.3e} {unit}", values[k]);
            Err(Error::diverged(
                quantity,
                iteration,
                case.place(k.min(case.grid.len() - 1)),
                what,
            ))
        }
        None => Ok(()),
    }
}
