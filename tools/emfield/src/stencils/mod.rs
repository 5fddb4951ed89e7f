//! Points as the equations have them, and the stencils on them: what electric and magnetic fields share.
//!
//! 1. [`region`]: places, metrics and which media meet where, in as many coordinates as the equations have;
//! 2. [`sides`]: stencils that keep to one side of an interface, mirrored about an axis of symmetry by `mirror`;
//! 3. [`quadrature`]: integrals over bodies as one weight a point.

pub(crate) mod mirror;
pub mod quadrature;
pub mod region;
pub mod sides;

#[cfg(test)]
pub(crate) mod tests;
