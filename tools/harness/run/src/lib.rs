//! How every stage is run: command line, scene, clock, progress, record, checkpoint.
//!
//! A stage implements [`Tool`]; its program is one line:
//!
//! ```ignore
//! fn main() -> std::process::ExitCode {
//!     run::main::<arcfvm::ArcFvm>()
//! }
//! ```
//!
//! What it gets for that: `TOOL run`, `TOOL check`, `TOOL schema`; scenes that are patched,
//! validated and located to the line ([`scene`]); properties as numbers, tables or expressions
//! ([`property`]); an artefact with its header set, a clock per stage, progress, checkpoints and a
//! run record ([`Session`]); one exit code per kind of failure ([`Failure`]).

mod clock;
mod command;
mod console;
mod failure;
mod inputs;
mod interrupt;
mod launch;
mod ledger;
mod machine;
mod plan;
mod progress;
pub mod property;
mod record;
pub mod scene;
mod session;
mod tool;

pub use failure::Failure;
pub use inputs::Inputs;
pub use launch::{main, report_failure};
pub use plan::Plan;
pub use scene::Fault;
pub use session::Session;
pub use tool::{Input, Tool};
