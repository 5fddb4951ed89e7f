//! A in space together with the potential of charges on conductors, whatever the rate of change.
//!
//! 1. [`potential`]: the rows of the potential within conductors (Matsuzawa 2017, eqs 2.65, 2.66, 2.69);
//! 2. [`equations`]: it and A, made of [`parts`], with what both have on a [`surface`]; `operator` applies them at a
//!    [`rate`], and in [`balance`] none is large with it;
//! 3. [`solution`]: a Krylov method over all rows, preconditioned by `factors`, [`block`] after block;
//! 4. [`stage`]: the same as a stage of a march; `fields`: what charges add to the fields.

pub mod balance;
pub mod block;
pub mod equations;
pub(crate) mod factors;
pub(crate) mod fields;
pub(crate) mod operator;
pub mod parts;
pub mod potential;
pub mod rate;
pub mod solution;
pub mod stage;
pub mod surface;

#[cfg(test)]
mod tests;
