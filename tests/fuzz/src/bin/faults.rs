//! `faults`: kills, full disks, second writers, outputs over inputs and places of others, over all stages.

#![allow(
    clippy::print_stdout,
    clippy::print_stderr,
    reason = "a program talks to its user"
)]

use std::path::PathBuf;
use std::process::ExitCode;

use clap::Parser;
use fuzz::faults::{self, Trials};

/// Tries on every stage, and on three studies, what machines do to runs, and writes one table.
///
/// Example: faults --kills 300 --out build/faults
#[derive(Parser)]
struct Arguments {
    /// Kills at random moments, shared out over stages and studies.
    #[arg(long, default_value_t = 300)]
    kills: usize,
    /// Fixes the moments.
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Where the table goes, and where the stages work.
    #[arg(long, default_value = "build/faults")]
    out: PathBuf,
}

fn main() -> ExitCode {
    match run(&Arguments::parse()) {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::FAILURE,
        Err(message) => {
            eprintln!("faults: {message}");
            ExitCode::FAILURE
        }
    }
}

fn run(arguments: &Arguments) -> Result<bool, String> {
    let own = std::env::current_exe().map_err(|e| e.to_string())?;
    let root = std::env::current_dir().map_err(|e| e.to_string())?;
    let out = root.join(&arguments.out);
    let table = faults::run(&Trials {
        kills: arguments.kills,
        seed: arguments.seed,
        programs: own.parent().map(PathBuf::from).unwrap_or_default(),
        root,
        out: out.join("work"),
    })?;
    print!("{}", table.text());
    let text = serde_json::to_string_pretty(&table).map_err(|e| e.to_string())?;
    artefact::write_atomically(&out.join("faults.json"), (text + "\n").as_bytes())
        .map_err(|e| e.to_string())?;
    Ok(table.holds)
}
