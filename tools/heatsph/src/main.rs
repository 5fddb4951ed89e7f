//! `heatsph`: heat conduction by smoothed particles.

use std::process::ExitCode;

fn main() -> ExitCode {
    run::main::<heatsph::program::HeatSph>()
}
