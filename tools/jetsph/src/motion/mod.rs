//! Forces on all that there is.

pub mod gravity;
pub mod repulsion;
