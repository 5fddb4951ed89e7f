//! `artefact`: looks into artefacts, checks, compares, exports and saves them.

use std::process::ExitCode;

mod program;

fn main() -> ExitCode {
    program::main()
}
