//! Steps in time, as every march takes them: limits and who sets them, instants that are met, and lengths between them.
//!
//! Four ways to choose a step, one for each kind of march:
//!
//! | way | the march |
//! |---|---|
//! | [`even`] | equal parts of the way to the next instant, each within all limits |
//! | [`Legs`] | the same, all known before the first step |
//! | [`Strides`] | 1, 2, 4, 8 ... steps of one length, for what is due at multiples of it |
//! | [`control`] | as long as the error of a step allows |
//!
//! What is due, and when, is in [`instants`].

pub mod control;
pub mod even;
mod figure;
pub mod instants;
mod legs;
mod limit;
mod strides;

pub use figure::Figure;
pub use legs::Legs;
pub use limit::{Beyond, Limit};
pub use strides::Strides;
