//! Weighted least squares meshfree electrostatic and eddy-current fields.
//!
//! After Matsuzawa (2017), chapters 2.1, 2.3 and 3.2, with the errata. The way of a scene through the crate:
//!
//! - [`scene`] is what a person writes; [`cloud`] fills the domain with points;
//! - [`source`] knows the exact fields of coils;
//! - [`solve`] makes the equations of the points and solves them, [`assemble`] leads a scene there and back;
//! - [`output`] writes.

pub mod assemble;
pub mod cloud;
pub mod liquid;
pub mod output;
pub mod scene;
mod solution;
pub mod solve;
pub mod source;
pub mod stage;
pub mod surface;
mod trial;
