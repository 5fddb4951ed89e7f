//! Incompressible SPH weld pool and bead under a moving arc source.

pub mod march;
pub mod near;
pub mod stage;
pub mod state;
