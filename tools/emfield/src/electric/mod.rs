//! Electrostatics: `div(eps grad V) = 0` (Matsuzawa 2017, eq. 2.60).
//!
//! 1. `setup`: from a scene to what is given;
//! 2. [`equations`]: a row for each point; [`open`]: walls that truncate nothing;
//! 3. `solution`: the potential;
//! 4. `columns`: the field of it, [`traction`] on surfaces and forces on bodies; `enclosed` on what surfaces enclose;
//! 5. `doubts`: where several ways of finding a force disagree.

mod columns;
mod doubts;
mod enclosed;
pub mod equations;
pub mod open;
pub(crate) mod setup;
mod solution;
pub mod traction;

#[cfg(test)]
mod tests;
