//! Sets of particles with declared columns.
//!
//! A stage declares what it needs of a particle as a [`Column`]: name, unit, default, whether a checkpoint keeps it and
//! whether frames show it. A [`Set`] holds the columns that were declared, and nothing else; checkpoint, frames and the
//! plan of memory follow from the declarations. Adding a column is one line in the stage that needs it.
//!
//! - [`mod@column`] declares, [`store`] holds values of one kind;
//! - [`set`] is a set of particles of one matter: rows appended, taken away, moved to another set, with ids for life;
//! - [`rows`] finds the neighbours within a set and of one set in another;
//! - [`sweep`] fills and sums columns in gather form, with the same bits on any thread count.
//!
//! ```
//! use particles::{Column, Ids, Matter, POSITION, Set};
//! const PRESSURE: Column<f64> = Column::new("pressure", "Pa", 0.0).shown();
//! let mut water = Set::new("water", Matter { density: 1000.0, spacing: 1e-3, smoothing_length: 1.5e-3 });
//! water.declare(&PRESSURE);
//! let mut ids = Ids::default();
//! let row = water.push(&mut ids);
//! water.column_mut(&POSITION)[row] = [0.0, 0.0, 1e-3];
//! assert_eq!(water.column(&PRESSURE).len(), 1);
//! ```

pub mod column;
mod held;
pub mod rows;
pub mod set;
pub mod store;
pub mod sweep;

pub use column::Column;
pub use rows::Rows;
pub use set::{Declared, ID, Ids, Matter, POSITION, Set};
pub use store::{Store, Value};
