//! Verification across the tools: exact cases, run through scenes and measured from what is written.
//!
//! Every case drives a tool as its users do (a scene, a patch, a command line), opens the artefact
//! and compares it with an exact solution coded here. Nothing in this crate is shared with a solver:
//! the only common ground is the file format. ([`speed`] times the numerical cores and checks
//! nothing.)
//!
//! - [`case`] says what a case is, [`lab`] runs tools, [`norms`] measures, [`study`] turns three
//!   resolutions into a record of error against run time.
//! - [`certify`] tells the error of a study against its run time.
//! - [`keep`] writes records whole or not at all.
//! - [`cases`] holds one file per exact solution; [`heat`] holds the references for conduction,
//!   [`em`] those for electric and magnetic fields, [`mod@drop`] those for drops, [`operators`] the clouds of weighted least squares.

pub mod bell;
pub mod bench;
pub mod case;
pub mod cases;
pub mod certify;
pub mod drop;
pub mod em;
pub mod extreme;
mod flow;
mod grains;
mod heap;
pub mod heat;
pub mod keep;
pub mod lab;
mod meniscus;
mod neumann;
pub mod norms;
pub mod operators;
mod particles;
pub mod plasma;
pub mod skipped;
mod solid;
pub mod special;
pub mod speed;
mod spot;
mod spot_pool;
pub mod study;
