//! Steps in time.
//!
//! [`scheme`]: two stages of an implicit Runge-Kutta method.

pub mod scheme;
