//! Points as the equations have them, and the stencils on them: what electric and magnetic fields share.
//!
//! 1. [`region`]: places, metrics and which media meet where, in as many coordinates as the equations have;
//! 2. [`sides`]: stencils that keep to one side of an interface, mirrored about an axis of symmetry by `mirror`;
//! 3. [`quadrature`]: integrals over bodies as one weight a point.
//!
//! `setup` makes the points from the cloud of a scene, `unfit` says of which no stencil can be made.

pub(crate) mod mirror;
pub mod quadrature;
pub mod region;
pub(crate) mod setup;
pub mod sides;
pub(crate) mod unfit;

#[cfg(test)]
pub(crate) mod tests;
