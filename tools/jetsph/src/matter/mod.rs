//! What there is: solids, and how bodies are filled with particles.

pub mod lattice;
pub mod solid;
