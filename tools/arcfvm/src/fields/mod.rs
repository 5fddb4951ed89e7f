//! The fields: each owns its columns, its equation and its solver.

mod clear_bed;
pub mod edge_shear;
pub mod electrons;
pub mod energy;
mod energy_conduct;
pub mod energy_edges;
mod energy_electrons;
mod energy_film;
mod energy_integral;
mod energy_skin;
mod faces;
pub mod flow;
pub mod linear;
pub mod magnetic;
mod mixing;
pub mod momentum_axial;
pub mod momentum_radial;
mod momentum_side;
pub mod multigrid;
pub mod potential;
pub mod pressure;
pub mod sheath;
pub mod vapour;

pub use linear::{Method, Solver, Unsolved};
