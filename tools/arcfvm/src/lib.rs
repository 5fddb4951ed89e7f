//! A steady, axisymmetric, laminar arc plasma in local thermodynamic equilibrium between a wire and
//! a base metal (Komen 2019, sections 3.2 and 5.2).
//!
//! One folder per effect: [`flow`], [`heat`], [`current`], [`vapour`], [`bed`]. Each holds what is set up (`setup`), its field and
//! [`equation`], its step within an iteration (`step`), its `balance` and what is told of it (`figures`); in [`scene`] and
//! [`assemble`] each has a file of its own. The [`case`] owns all that is set up, and what follows from the materials of the
//! cells; fields borrow it. The [`solver`] iterates.

pub mod assemble;
pub mod bed;
pub mod beyond;
pub mod case;
pub mod current;
pub mod curve;
pub mod diffusion;
pub mod edges;
pub mod equation;
pub mod error;
pub mod flow;
pub mod frames;
pub mod grid;
pub mod heat;
mod laws;
mod layers;
mod limits;
pub mod march;
pub mod material;
pub mod mixture;
mod plan;
pub mod program;
pub mod properties;
pub mod residual;
pub mod resume;
pub mod sample;
pub mod scene;
pub mod settings;
pub mod solver;
pub mod start;
pub mod surface;
pub mod vapour;
