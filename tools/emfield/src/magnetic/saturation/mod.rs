//! Media whose permeability depends on the field.
//!
//! 1. [`places`]: which points and faces have such media, and what sources give there;
//! 2. [`equations`]: what the media put on the right of the rows, `conducting` where currents flow in them;
//! 3. [`stage`]: the field that goes with them, by a fixed point, or by `newton` where currents flow;
//! 4. `bodies`: whether there are such bodies, and what is told of the iterations.

pub(crate) mod bodies;
pub(crate) mod conducting;
pub mod equations;
pub(crate) mod newton;
pub mod places;
pub mod stage;

#[cfg(test)]
mod tests;
