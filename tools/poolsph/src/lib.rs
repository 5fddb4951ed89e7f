//! Incompressible SPH weld pool and bead under a moving arc source.

pub mod assemble;
pub mod balance;
pub mod columns;
pub mod domain;
pub mod faces;
pub mod forces;
pub mod frames;
pub mod grains;
pub mod heat;
pub mod march;
pub mod motion;
pub mod pace;
pub mod patch;
pub mod probes;
pub mod rest;
pub mod resume;
pub mod scene;
pub mod simulate;
pub mod source;
pub mod stage;
pub mod state;

pub mod surface;
mod sweep;
pub mod tool;
mod trial;
pub mod vector;
mod watch;

pub use state::near;
pub use tool::PoolSph;
