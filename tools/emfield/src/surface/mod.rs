//! Closed surfaces around bodies: [`enclosing`] what acts on all within, [`fits`] the fields there.

pub mod enclosing;
pub mod fits;
