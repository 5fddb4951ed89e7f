//! Walls as if there were none: what bodies add to an applied potential decays beyond them.
//!
//! 1. `walls`: what is applied, and the surface about all bodies over which their moments are counted;
//! 2. [`rows`]: the rows of walls, by the `harmonics` of what lies within.

pub(crate) mod harmonics;
pub mod rows;
pub(crate) mod walls;
