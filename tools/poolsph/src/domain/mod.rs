//! What fills the domain: bodies at the start, droplets during the run.

pub mod bodies;
pub mod bounds;
pub mod container;
pub mod droplet;
pub mod fitting;
pub mod pitch;
pub mod round;
mod row;
pub mod shape;
