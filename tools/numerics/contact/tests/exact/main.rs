//! Contacts against their exact solutions.

#![allow(clippy::unwrap_used, reason = "a test may fail")]

mod heat;
mod impact;
mod motion;
mod plane;
mod symmetry;
