//! Media with curves of magnetisation on clouds made by hand.

mod conducting;
mod newton;
