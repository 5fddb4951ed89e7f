//! Electrostatics: `div(eps grad V) = 0` (Matsuzawa 2017, eq. 2.60).
//!
//! 1. [`equations`]: a row for each point, and the field of a solution;
//! 2. [`open`]: walls that truncate nothing, by the `harmonics` of what lies within;
//! 3. [`traction`]: what the field does to surfaces.

pub mod equations;
pub(crate) mod harmonics;
pub mod open;
pub mod traction;

#[cfg(test)]
mod tests;
