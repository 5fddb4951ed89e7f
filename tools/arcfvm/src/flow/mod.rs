//! The flow of the gas (Komen 2019, eqs 3.3 to 3.5).

pub mod balance;
pub mod edge_shear;
pub mod field;
pub(crate) mod figures;
pub mod momentum_axial;
pub mod momentum_radial;
mod momentum_side;
pub mod pressure;
pub mod setup;
mod step;
