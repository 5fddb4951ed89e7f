//! `fuzz`: thousands of changed scenes and artefacts, and what the programs do with them.

#![allow(
    clippy::print_stdout,
    clippy::print_stderr,
    reason = "a program talks to its user"
)]

use std::path::PathBuf;
use std::process::ExitCode;

use clap::Parser;
use fuzz::{Breadth, Campaign};

/// Gives changed scenes and artefacts to every program, and tells what must not be: panics, aborts, hangs, memory
/// without end, changed data that is read as good. What failed is kept in OUT/found.
///
/// Example: fuzz --number 1000 --seed 1
#[derive(Parser)]
struct Arguments {
    /// Changed scenes, and as many changed artefacts; a tenth as many scenes are run for a moment.
    #[arg(long, default_value_t = 1000)]
    number: u64,
    /// Fixes every change.
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Only these sorts of trials.
    #[arg(long, value_delimiter = ',', default_value = "scene,run,file")]
    sort: Vec<String>,
    /// Only the trial of this number.
    #[arg(long)]
    only: Option<u64>,
    /// Only scenes that are checked in a moment.
    #[arg(long)]
    quick: bool,
    /// Where it works, and where what failed is kept.
    #[arg(long, default_value = "build/fuzz")]
    out: PathBuf,
    /// Trials at a time.
    #[arg(long, default_value_t = 2)]
    threads: usize,
}

fn main() -> ExitCode {
    match run(&Arguments::parse()) {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::FAILURE,
        Err(message) => {
            eprintln!("fuzz: {message}");
            ExitCode::FAILURE
        }
    }
}

/// Sorts of trials.
const SORTS: [&str; 3] = ["scene", "run", "file"];

/// Refuses what would try nothing and find nothing.
fn must_try(arguments: &Arguments) -> Result<(), String> {
    let unknown = |sort: &&String| !SORTS.contains(&sort.as_str());
    if let Some(sort) = arguments.sort.iter().find(unknown) {
        return Err(format!("there is no sort '{sort}': {}", SORTS.join(", ")));
    }
    match arguments.number {
        0 => Err("--number 0 tries nothing".to_owned()),
        _ => Ok(()),
    }
}

fn run(arguments: &Arguments) -> Result<bool, String> {
    must_try(arguments)?;
    let programs = std::env::current_exe().map_err(|e| e.to_string())?;
    let of = |sort: &str, n: u64| {
        if arguments.sort.iter().any(|s| s == sort) {
            n
        } else {
            0
        }
    };
    let root = std::env::current_dir().map_err(|e| e.to_string())?;
    let campaign = Campaign {
        seed: arguments.seed,
        scenes: of("scene", arguments.number),
        runs: of("run", arguments.number.div_ceil(10)),
        files: of("file", arguments.number),
        only: arguments.only,
        breadth: if arguments.quick {
            Breadth::Quick
        } else {
            Breadth::All
        },
        programs: programs.parent().map(PathBuf::from).unwrap_or_default(),
        out: root.join(&arguments.out),
        root,
        threads: arguments.threads,
    };
    let outcome = fuzz::run(&campaign)?;
    print!("{}", outcome.table());
    let text = serde_json::to_string_pretty(&outcome).map_err(|e| e.to_string())?;
    artefact::write_atomically(&campaign.out.join("fuzz.json"), (text + "\n").as_bytes())
        .map_err(|e| e.to_string())?;
    Ok(outcome.findings.is_empty())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_would_try_nothing_is_refused() {
        let of = |words: &[&str]| {
            let words = ["fuzz"].iter().chain(words);
            must_try(&Arguments::try_parse_from(words).map_err(|e| e.to_string())?)
        };
        assert!(of(&[]).is_ok() && of(&["--sort", "scene,file"]).is_ok());
        assert!(
            of(&["--sort", "typo"]).is_err_and(|told| told.contains("'typo': scene, run, file"))
        );
        assert!(of(&["--number", "0"]).is_err());
    }
}
