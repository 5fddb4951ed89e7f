//! Eddy currents on clouds made by hand.

mod axis;
mod fields;
mod holes;
mod stage;
