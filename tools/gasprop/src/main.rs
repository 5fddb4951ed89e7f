//! `gasprop`: properties of plasmas of argon, carbon, oxygen and iron.

use std::process::ExitCode;

fn main() -> ExitCode {
    run::main::<gasprop::program::GasProp>()
}
