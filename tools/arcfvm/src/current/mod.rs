//! The electric current and its magnetic field (Komen 2019, eqs 5.10 to 5.15).

pub mod balance;
pub(crate) mod figures;
pub mod magnetic;
pub mod potential;
pub mod setup;
pub mod sheath;
mod step;
