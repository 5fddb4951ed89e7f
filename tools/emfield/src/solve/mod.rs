//! Equations at the points: one row for each unknown, their solution, and the fields of it.
//!
//! - [`region`]: what a point is; [`sides`]: stencils that keep to one side of an interface, mirrored about an axis
//!   of symmetry.
//! - [`electrostatic`]: potentials, [`open`] walls of theirs that truncate nothing, by `harmonics`. [`unknown`] of eddy currents, [`diffusion`]: their operator, [`drive`] what drives
//!   them, [`eddy`] the fields of a solution, [`multipole`] walls that truncate nothing, [`quadrature`]
//!   integrals over conductors, [`totals`] forces and heat, [`enclosed`] fields on surfaces around bodies.
//! - [`waves`]: weights that are exact for what conductors carry in a sinusoidal steady state in a plane, [`waving`] the rows
//!   of them.
//! - [`winding`]: coils that are regions of points. [`permeable`]: media of different permeability, [`magnetised`] in space, `bound` what walls
//!   know of these there; [`magnetisation`]: how fields follow flux densities, [`saturation`] what that puts into the rows
//!   of points that are [`curved`],
//!   [`saturated`] the iterations, `flow` and `newton` what they are where currents flow.
//! - [`bars`]: net currents along z in a plane.
//! - [`charge`]: the potential of charges on conductors, [`coupled`] it and A together, made of [`parts`] and with [`skin`],
//!   [`at_rate`] their solution at a [`rate`] of change as a `whole`, by [`block`]s, `factors` and in [`balance`],
//!   `moments` what walls know of the currents.
//! - [`march`]: the same in time, each stage of A [`alone`] or [`charged`].

pub mod alone;
pub mod at_rate;
pub mod balance;
pub mod bars;
pub mod block;
mod bound;
pub mod charge;
pub mod charged;
mod coils;
pub mod coupled;
pub mod curved;
pub mod diffusion;
pub mod drive;
pub mod eddy;
pub mod electrostatic;
pub mod enclosed;
mod factors;
mod flow;
mod harmonics;
pub mod holes;
pub mod magnetisation;
pub mod magnetised;
pub mod march;
mod mirror;
mod moments;
pub mod multipole;
mod newton;
pub mod open;
pub mod parts;
pub mod permeable;
pub mod quadrature;
pub mod rate;
pub mod region;
pub mod saturated;
pub mod saturation;
pub mod sides;
pub mod skin;
pub mod totals;
pub mod unknown;
pub mod waves;
pub mod waving;
mod whole;
pub mod winding;

#[cfg(test)]
mod tests;
