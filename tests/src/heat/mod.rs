//! References for heat conduction that share nothing with a solver.
//!
//! - [`formula`] and [`property`] read what a scene says, [`frames`] what a run wrote; [`methods`]
//!   names the methods that compete.
//! - [`plate`]: steady, Rong and Kisu (2010), eqs 6 and 7.
//! - [`bar`]: transient in one dimension, fine finite volumes, extrapolated; [`sdirk`] marches.
//! - [`square`]: steady in two dimensions, spectral elements.
//! - [`robin`]: a square that cools by convection, eqs 8 to 10.
//! - [`cylinder`]: a cylinder heated on its side, eq. 11.
//! - [`slabs`]: two half spaces brought together.
//! - [`stefan`]: a half space that melts.
//! - [`disc`]: a layered disc cooled from above, finite volumes in r and z.

pub mod bar;
pub mod cylinder;
pub mod disc;
pub mod formula;
pub mod frames;
pub mod methods;
pub mod plate;
pub mod property;
pub mod robin;
pub mod sdirk;
pub mod slabs;
pub mod square;
pub mod stefan;
