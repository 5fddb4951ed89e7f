//! Incompressible SPH weld pool and bead under a moving arc source.

pub mod domain;
pub mod march;
pub mod motion;
pub mod near;
pub mod rest;
pub mod scene;
pub mod stage;
pub mod state;
