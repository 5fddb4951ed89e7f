//! Closed surfaces around bodies, over which forces are found another way.
//!
//! 1. `setup`: those of a scene; `halfway`: one about all bodies, halfway to the walls;
//! 2. [`fits`]: the fields there; [`enclosing`]: what acts on all within;
//! 3. `ways`: what to say where several ways of finding a force disagree.

pub mod enclosing;
pub mod fits;
pub(crate) mod halfway;
pub(crate) mod setup;
pub(crate) mod ways;
