//! Weighted least squares meshfree electrostatic and eddy-current fields.
//!
//! After Matsuzawa (2017), chapters 2.1, 2.3 and 3.2, with the errata. The way of a scene through the crate:
//!
//! - [`scene`] is what a person writes; [`cloud`] fills the domain with points, on which [`stencils`] stand;
//! - [`electric`] and [`magnetic`] hold the equations of fields, [`liquid`] those of a liquid that they move;
//! - [`assemble`] leads a scene there and back, [`march`] in time;
//! - [`frames`] writes.

pub mod assemble;
pub mod cloud;
pub mod electric;
pub mod frames;
pub mod geometry;
pub mod liquid;
pub mod magnetic;
pub mod march;
pub mod program;
pub mod scene;
pub mod solve;
pub mod stencils;
pub mod surface;
mod trial;
