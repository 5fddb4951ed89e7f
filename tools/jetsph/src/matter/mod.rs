//! What there is: water and solids, how they meet, and how bodies are filled with particles; sums over pairs go `four` by four.

mod four;
pub mod lattice;
pub mod meeting;
pub mod shares;
pub mod solid;
pub mod water;
