//! What a solution may not exceed.

use crate::case::{Case, GAS};
use crate::error::Error;
use crate::solver::Arc;

impl Arc {
    /// Gas cells above the end of the gas table: an error, or told where the scene lets the table
    /// go on.
    ///
    /// # Errors
    /// [`Error::AboveTable`].
    pub fn beyond_table(&self) -> Result<Option<String>, Error> {
        let gas = &self.case.materials[GAS];
        let Some(end) = gas.end_k.filter(|_| self.heating.is_some()) else {
            return Ok(None);
        };
        let t = self.temperature();
        let above = |k: &usize| self.case.material[*k] == GAS && t[*k] > end;
        let cells: Vec<usize> = (0..t.len()).filter(above).collect();
        let Some(hottest) = cells.iter().copied().max_by(|a, b| t[*a].total_cmp(&t[*b])) else {
            return Ok(None);
        };
        if gas.end_is_error {
            return Err(Error::AboveTable {
                place: self.case.place(hottest),
                found: t[hottest],
                end,
                material: "gas".to_owned(),
            });
        }
        Ok(Some(format!(
            "{} of {} cells are hotter than the end of the gas table, {end:.0} K: up to {:.0} K at {}",
            cells.len(),
            t.len(),
            t[hottest],
            self.case.place(hottest)
        )))
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
