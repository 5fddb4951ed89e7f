//! Steps in time: the loops over them, and nothing of what is stepped.
//!
//! - `steps`: even ones between the instants that are asked for;
//! - [`scheme`]: two stages of an implicit Runge-Kutta method;
//! - `currents`: eddy currents from rest to the end; `growth`: what of them grows though nothing drives it.

pub(crate) mod currents;
mod growth;
pub mod scheme;
pub(crate) mod steps;
