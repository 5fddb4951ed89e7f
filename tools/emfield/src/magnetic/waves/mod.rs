//! What conductors carry in a sinusoidal steady state in a plane, where a spacing is not small against the skin depth.
//!
//! 1. [`weights`]: of stencils that are exact for it;
//! 2. [`rows`]: the rows of them.

pub mod rows;
pub mod weights;
