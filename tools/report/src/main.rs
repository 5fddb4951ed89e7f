//! `report`: pages from artefacts and records.

use std::process::ExitCode;

fn main() -> ExitCode {
    report::command::main()
}
