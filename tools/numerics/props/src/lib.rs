//! Property tables: piecewise linear interpolation, its exact integral, and the inverse of that.
//!
//! A [`Table`] holds `y(x)` on strictly increasing nodes. Values beyond the ends are refused by
//! [`Table::at`] and held at the end value by [`Table::held`]; the caller decides which it means.
//! [`Integral`] is `F(x)`, the exact (piecewise quadratic) integral of a positive table from its
//! first node, continued beyond the ends with the end value; [`Integral::inverse`] undoes it, so
//! that an enthalpy `h(T)` made from a specific heat gives back `T` to rounding. A [`Surface`] is a row of
//! tables, linear in a second variable between them. [`Odd`] is a rising function that is smooth between its nodes.
//!
//! ```
//! let cp = props::Table::new(vec![300.0, 1300.0], vec![500.0, 600.0]).unwrap();
//! let h = props::Integral::new(&cp).unwrap();
//! assert_eq!(h.value(1300.0), 550.0 * 1000.0);
//! assert!((h.inverse(h.value(777.0)) - 777.0).abs() < 1e-9);
//! ```

mod integral;
mod monotone;
mod surface;
mod table;

pub use integral::Integral;
pub use monotone::{Local, Odd};
pub use surface::Surface;
pub use table::{Outside, Table};

use thiserror::Error;

/// Why a table cannot be used.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum Error {
    /// Fewer than two nodes, or columns of different length.
    #[error("a table needs two columns of equal length, two nodes or more; it has {x} and {y}")]
    Length {
        /// Nodes.
        x: usize,
        /// Values.
        y: usize,
    },
    /// A node or value is not a number.
    #[error("row {row}: {value} is not a finite number")]
    NotFinite {
        /// Row, from 0.
        row: usize,
        /// The value.
        value: f64,
    },
    /// The nodes do not increase.
    #[error("row {row}: {value} does not exceed {before}, the row before")]
    NotIncreasing {
        /// Row, from 0.
        row: usize,
        /// Node of this row.
        value: f64,
        /// Node of the row before.
        before: f64,
    },
    /// A value that must be positive is not.
    #[error("row {row}: {value} is not positive")]
    NotPositive {
        /// Row, from 0.
        row: usize,
        /// The value.
        value: f64,
    },
}
