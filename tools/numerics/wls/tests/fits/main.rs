//! Weights of whole clouds against exact answers.

#![allow(
    clippy::unwrap_used,
    clippy::float_cmp,
    reason = "a test may fail, and some answers are exact"
)]

mod bent;
mod clouds;
mod conditions;
mod exact;
mod folded;
mod invariant;
mod linear;
mod moved;
mod orders;
mod positive;
mod room;
mod singular;
mod wedge;
