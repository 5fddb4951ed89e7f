//! The current within an iteration.

use crate::error::Error;
use crate::residual::{Unbalanced, part};
use crate::solver::{Arc, Electric};

impl Arc {
    /// Potential, currents and their field; returns the residual and the worst cell.
    ///
    /// # Errors
    /// When the potential leaves the numbers.
    pub(crate) fn solve_current(&mut self) -> Result<(f64, Unbalanced), Error> {
        let Self {
            case,
            properties,
            electric,
            iteration,
            ..
        } = self;
        let Some((setup, electric)) = case.potential.as_ref().zip(electric.as_mut()) else {
            return Ok((0.0, Unbalanced::default()));
        };
        let Electric {
            potential,
            magnetic,
        } = electric;
        potential
            .solve(case, setup, &properties.electric)
            .map_err(|e| Error::solver("potential", *iteration, case, &e))?;
        magnetic.update(&case.grid, potential);
        let found = potential.unbalanced;
        Ok((part(found.amount, potential.throughput(&case.grid)), found))
    }
}
