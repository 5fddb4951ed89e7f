//! Columns of grains that have heat.

use particles::Column;

pub use crate::state::{ENTHALPY, TEMPERATURE};

/// [`POWDER`], [`SLAG`] or [`FROZEN`].
pub const STATE: Column<u8> = Column::new("state", "1", POWDER).saved().shown();
/// Number of the body that keeps its temperature, plus one; 0 for a free grain.
pub const HELD: Column<u8> = Column::new("held", "1", 0).saved();

/// A grain that has not melted yet.
pub const POWDER: u8 = 0;
/// A grain that is molten.
pub const SLAG: u8 = 1;
/// A grain that has set again.
pub const FROZEN: u8 = 2;
