//! References for heat conduction that share nothing with a solver.
//!
//! - [`formula`] and [`property`] read what a scene says.
//! - [`plate`]: steady, Rong and Kisu (2010), eqs 6 and 7.
//! - [`bar`]: transient in one dimension, fine finite volumes, extrapolated.

pub mod bar;
pub mod cylinder;
pub mod disc;
pub mod formula;
pub mod plate;
pub mod property;
pub mod robin;
pub mod sdirk;
pub mod slabs;
pub mod square;
