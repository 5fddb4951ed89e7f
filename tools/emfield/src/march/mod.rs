//! Steps in time: the loops over them, what they keep and what is written.
//!
//! - [`scheme`]: two stages of an implicit Runge-Kutta method;
//! - `currents`: eddy currents from rest to the end; `adaptive`: steps as long as their error allows; `growth`: what of them grows though nothing drives it;
//!   `wave`: what drives them, and whether steps follow it; `modes`: what steps miss of it;
//! - `liquid`: a liquid in a room or between faces, with the fields that act on it and its heat.

pub(crate) mod adaptive;
pub(crate) mod currents;
mod growth;
pub(crate) mod liquid;
mod modes;
pub mod scheme;
mod wave;
