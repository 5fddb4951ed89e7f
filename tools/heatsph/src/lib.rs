//! SPH heat conduction in functionally graded materials.
//!
//! After Rong and Kisu (2010), with their errata: conductivity a function of place and temperature, bodies of
//! any shape, every kind of boundary. The way of a scene through the crate:
//!
//! - `shapes` composes bodies, [`cloud`] fills them with points and gives each its patches of surface;
//! - [`operator`] weighs the links between points: the pair form of the paper, or weights balanced so that linear
//!   fields are exact on any cloud while no heat is lost;
//! - [`material`] says how links conduct and cells store, [`boundary`] what passes through the surface;
//! - [`source`] spreads heat sources over cells, however narrow they are;
//! - [`system`] is the equation of every point, `C dT/dt = W`, and its Newton matrix;
//! - [`course`] finds where what varies in time jumps or peaks, and what heat is prescribed;
//! - [`mod@march`] takes it through time (explicit, stabilised or implicit), [`steady`] to its end at once, with
//!   the solves of [`solve`];
//! - [`simulate`] leads the march, [`frames`] writes.

pub mod assemble;
pub mod boundary;
pub mod cloud;
pub mod course;
pub mod frames;
pub mod march;
pub mod material;
pub mod monitor;
pub mod operator;
pub mod pace;
pub mod program;
pub mod scene;
pub mod simulate;
pub mod solve;
pub mod source;
pub mod steady;
pub mod system;
pub mod torches;
