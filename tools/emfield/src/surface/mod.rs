//! What fields do to surfaces.

pub mod traction;
