//! Iterations of small arcs: how they are led to rest, and what they find there.
#![allow(clippy::unwrap_used, reason = "a test may fail")]

mod beyond;
mod clear_slag;
mod conduction;
mod lit_wall;
mod recombination;
mod setup;
