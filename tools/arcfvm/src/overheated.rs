//! Gas that is hotter than its table goes.

use crate::error::Error;
use crate::material::GAS;
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
