//! `avg`: averages of particle frames.

use std::process::ExitCode;

fn main() -> ExitCode {
    run::main::<avg::program::Avg>()
}
