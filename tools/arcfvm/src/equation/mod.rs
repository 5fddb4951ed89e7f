//! The one equation that all transported values obey: its faces, its coefficients, and how it is solved.

pub mod aggregated;
pub(crate) mod faces;
pub mod linear;
pub mod transport;

pub use linear::{Method, Solver, Unsolved};
