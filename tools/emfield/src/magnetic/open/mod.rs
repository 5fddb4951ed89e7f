//! Walls as if there were none: what bodies add there is that of their multipoles.
//!
//! 1. [`multipoles`]: of currents, in any geometry;
//! 2. `bound`: of the bound currents of magnetised bodies in space;
//! 3. `moments`: both in the rows of walls, where A and the potential of charges are sought together.

pub(crate) mod bound;
pub(crate) mod moments;
pub mod multipoles;
