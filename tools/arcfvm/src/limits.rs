//! What a solution may not exceed.

use crate::case::Case;
use crate::error::Error;

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
