//! `emfield`: electric and magnetic fields on points.

use std::process::ExitCode;

fn main() -> ExitCode {
    run::main::<emfield::program::EmField>()
}
