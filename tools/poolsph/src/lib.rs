//! Incompressible SPH weld pool and bead under a moving arc source, with grains of flux (Komen 2019, sections 3.3, 4 and 5.3).
//!
//! The way of a scene through the crate:
//!
//! - [`scene`] is what a person writes, [`assemble`] the only place that asks what it contains;
//! - [`domain`] fills bodies and adds droplets, [`source`] moves the arc and reads files of other runs;
//! - [`state`] holds the columns of the metal, [`surface`] finds its free surface, [`faces`] continues it as images;
//! - [`forces`], [`heat`] and [`motion`] act on the metal, [`grains`] are discrete elements beside it;
//! - [`stage`] is what a physical effect promises, [`mod@march`] takes all of them through a step;
//! - [`simulate`] leads the run: steps, outputs, checkpoints ([`resume`]); [`frames`] writes, [`balance`] checks mass, momentum
//!   and energy.

pub mod assemble;
pub mod balance;
pub mod domain;
pub mod faces;
pub mod forces;
pub mod frames;
pub mod grains;
pub mod heat;
pub mod march;
pub mod mean;
pub mod memory;
pub mod motion;
pub mod patch;
mod plan;
pub mod probes;
pub mod rest;
pub mod resume;
pub mod scene;
pub mod simulate;
pub mod source;
pub mod stage;
pub mod state;

pub mod program;
pub mod surface;
mod sweep;
mod trial;
mod watch;

pub use program::PoolSph;
pub use state::near;
