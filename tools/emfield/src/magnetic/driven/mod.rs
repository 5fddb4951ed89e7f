//! What drives currents, and what pulls back at it.
//!
//! `setup` finds bars and coils in a scene.
//!
//! 1. [`right`]: what sources put on the right of the rows, and walls that know of the currents;
//! 2. [`winding`]: coils that are regions of points; [`bar`]: net currents along z in a plane;
//! 3. `given`: what all of these give, at points and in rows;
//! 4. `force`: the force on coils in the field of the currents found.

pub mod bar;
pub(crate) mod force;
mod given;
pub mod right;
pub(crate) mod setup;
pub mod winding;
