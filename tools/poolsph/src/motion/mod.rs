//! Motion of the liquid: viscosity and forces predict, a pressure corrects.

pub mod integration;
pub mod lattice;
pub mod projection;
pub mod viscosity;

pub use integration::{Motion, Parameters};
