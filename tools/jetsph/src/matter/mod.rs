//! What there is: water and solids, and how bodies are filled with particles.

pub mod lattice;
pub mod solid;
pub mod water;
