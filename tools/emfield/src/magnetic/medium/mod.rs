//! Media of different permeability. `setup` looks whether coils of a scene lie where their field is known.
//!
//! 1. [`law`]: how the field follows the flux density, `H(B)`, and what pulls at a face between two media;
//! 2. [`interface`]: rows of interfaces in a plane and about an axis, and what sources and walls put there;
//! 3. [`mixing`]: rows in space, where components of A mix.

pub mod interface;
pub mod law;
pub mod mixing;
pub(crate) mod setup;
