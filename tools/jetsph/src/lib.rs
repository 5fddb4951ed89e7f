//! A water jet cuts a solid.
//!
//! After Shinohara, Okabe and Nakayama (2004), with their errata. The way of a scene through the crate:
//!
//! - [`scene`] is what a person writes, [`assemble`] the only file that asks what it contains;
//! - [`matter`] fills bodies with particles and knows water and solids, [`motion`] what acts on both;
//! - [`stage`] is what a physical effect promises, [`mod@march`] takes all of them through a step;
//! - [`simulate`] leads the run: steps, outputs, checkpoints ([`resume`]); [`frames`] writes, [`balance`]
//!   checks mass, momentum and energy.
//!
//! Water is weakly compressible, or has no sound where a scene says so: see [`matter::water`]. A solid is total Lagrangian with quadratics fitted at rest: see [`matter::solid`].

pub mod assemble;
pub mod balance;
pub mod frames;
pub mod march;
pub mod matter;
pub mod memory;
pub mod motion;
mod plan;
pub mod program;
pub mod resume;
pub mod scene;
pub mod simulate;
pub mod stage;
pub mod state;
mod trial;

pub use program::JetSph;
