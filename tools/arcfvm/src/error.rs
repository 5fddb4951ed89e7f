//! Why a run can fail.

use thiserror::Error;

use crate::case::Case;
use crate::equation::Unsolved;

/// Everything that stops `arcfvm`, with the values and units on both sides.
#[derive(Debug, Error)]
pub enum Error {
    /// A number left the reals.
    #[error("iteration {iteration}: {equation} diverged at {place}: {what}")]
    Diverged {
        /// Equation.
        equation: &'static str,
        /// Cell with its position.
        place: String,
        /// Outer iteration.
        iteration: usize,
        /// What was found.
        what: String,
    },
    /// A temperature beyond a table, where the scene does not ask for more.
    #[error(
        "{place}: temperature {found:.0} K is outside of {table}, {from:.0} K to {to:.0} K; {advice}"
    )]
    BeyondTable {
        /// Cell with its position.
        place: String,
        /// Temperature found \[K\].
        found: f64,
        /// The table and its column, or its path in the scene.
        table: String,
        /// First temperature of the table \[K\].
        from: f64,
        /// Last temperature of the table \[K\].
        to: f64,
        /// What the scene can ask for.
        advice: String,
    },
    /// A formula of a property that is no property.
    #[error(
        "{place}: {property} is {value} at {temperature:.0} K; it must be a number, 0 or more: \
         bound the formula, for example by max(0, ...)"
    )]
    Unlawful {
        /// Cell with its position.
        place: String,
        /// Temperature found \[K\].
        temperature: f64,
        /// JSON path of the formula.
        property: String,
        /// What it gives there.
        value: f64,
    },
    /// A gas table that cannot be used.
    #[error("gas table: {0}")]
    GasTable(String),
    /// A scene that contradicts itself.
    #[error("{path}: {what}")]
    Scene {
        /// JSON path.
        path: String,
        /// What is wrong, with the allowed range.
        what: String,
    },
}

impl From<Error> for run::Failure {
    fn from(error: Error) -> Self {
        match error {
            Error::Diverged {
                equation,
                place,
                iteration,
                what,
            } => Self::Diverged {
                step: iteration as u64,
                time_s: 0.0,
                place,
                quantity: equation.to_owned(),
                what,
            },
            other => Self::Other(other.to_string()),
        }
    }
}

impl Error {
    /// A field that diverged.
    pub fn diverged(equation: &'static str, iteration: usize, place: String, what: String) -> Self {
        Self::Diverged {
            equation,
            place,
            iteration,
            what,
        }
    }

    /// A solver's error, with the cell's position.
    pub fn solver(equation: &'static str, iteration: usize, case: &Case, error: &Unsolved) -> Self {
        let (column, row) = (error.column, error.row);
        // Staggered cells reach one beyond the grid.
        let cell = case
            .grid
            .cell(column.min(case.grid.nr - 1), row.min(case.grid.nz - 1));
        Self::diverged(equation, iteration, case.place(cell), error.what.clone())
    }

    /// A scene error at `path`.
    pub fn scene(path: impl Into<String>, what: impl Into<String>) -> Self {
        Self::Scene {
            path: path.into(),
            what: what.into(),
        }
    }
}
