//! A liquid with a free surface on moving points, by weighted least squares.
//!
//! After Matsuzawa (2017), chapter 2.2, with the errata.

pub mod air;
pub mod balance;
pub mod borne;
mod cell;
mod chart;
pub mod drift;
pub mod effort;
pub mod electric;
pub mod equilibrium;
pub mod fill;
pub mod follow;
pub mod friction;
pub mod groups;
pub mod heat;
pub mod magnetic;
pub mod matter;
pub mod operators;
pub mod outline;
pub mod parts;
pub mod passing;
pub mod points;
mod polyhedron;
pub mod pressure;
pub mod renew;
pub mod room;
mod rounds;
pub mod sessile;
mod settle;
mod spheroidal;
pub mod step;
pub mod stirred;
pub mod surface;
pub mod told;
pub mod vector;
