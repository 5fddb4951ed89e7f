//! Droplet-phase and time averages of particle frames on a grid that moves with the source.

pub mod cloud;
pub mod ensemble;
pub mod grid;
pub mod mean;
pub mod phase;
