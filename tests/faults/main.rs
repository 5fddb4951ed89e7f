//! What goes wrong is told clearly, with place and remedy, and loses nothing: damaged, truncated,
//! foreign and newer files, disks that are full or cannot be written, and scenes with faults.

#![allow(
    clippy::unwrap_used,
    clippy::print_stderr,
    reason = "a test may fail, and says what it skips"
)]

mod artefacts;
mod disk;
mod extremes;
mod gases;
mod owners;
mod places;
mod scenes;
mod sizes;
mod workplace;
