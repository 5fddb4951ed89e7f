//! Motion of the liquid: viscosity and forces predict, a pressure corrects.

pub mod around;
pub mod divergence_free;
pub mod homogenising;
pub mod integration;
pub mod lattice;
pub mod law;
pub mod noise;
pub mod parameters;
pub mod projection;
pub mod push;
mod settled;
pub mod slag;
pub mod step;
pub mod viscosity;

pub use integration::Motion;
pub use law::Law;
pub use parameters::{Method, OnColdMetal, Parameters};

#[cfg(test)]
mod tests;
