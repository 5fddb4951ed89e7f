//! What fields do to surfaces: of bodies, and around them.

pub mod enclosing;
pub mod traction;
