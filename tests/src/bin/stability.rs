//! `stability`: runs stiff and extreme scenes and says how each ended.

#![allow(
    clippy::print_stdout,
    clippy::print_stderr,
    reason = "a program talks to its user"
)]

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::Parser;
use verification::{
    extreme,
    keep::{apart, keep},
};

/// Runs the stiff and extreme cases of pipelines/stability and writes one record each.
///
/// Example: stability --case pool-steps --out build/stability
#[derive(Parser)]
struct Arguments {
    /// Cases to run; all when none is named.
    #[arg(long, value_delimiter = ',')]
    case: Vec<String>,
    /// Where records and artefacts go.
    #[arg(long, default_value = "build/stability")]
    out: PathBuf,
    /// Threads per run.
    #[arg(long, default_value_t = 2)]
    threads: usize,
}

fn main() -> ExitCode {
    match run(&Arguments::parse()) {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::FAILURE,
        Err(message) => {
            eprintln!("stability: {message}");
            ExitCode::FAILURE
        }
    }
}

/// Runs the chosen cases; true when none ended in a failure.
fn run(arguments: &Arguments) -> Result<bool, String> {
    let programs = std::env::current_exe().map_err(|e| e.to_string())?;
    let programs = programs.parent().map(PathBuf::from).unwrap_or_default();
    apart(&arguments.out, Path::new("pipelines"))?;
    std::fs::create_dir_all(&arguments.out)
        .map_err(|e| format!("{}: {e}", arguments.out.display()))?;
    let mut good = true;
    let cases = extreme::cases(Path::new("pipelines/stability")).map_err(|e| e.to_string())?;
    let strange = |name: &&String| cases.iter().all(|case| case.case != **name);
    if let Some(stranger) = arguments.case.iter().find(strange) {
        let names: Vec<&str> = cases.iter().map(|case| case.case.as_str()).collect();
        return Err(format!(
            "there is no case '{stranger}'; there are {}",
            names.join(", ")
        ));
    }
    for case in cases {
        if !arguments.case.is_empty() && !arguments.case.contains(&case.case) {
            continue;
        }
        let record = extreme::run(&case, &programs, &arguments.out, arguments.threads)
            .map_err(|e| e.to_string())?;
        print!("{}", record.table());
        good &= record.holds;
        let path = arguments.out.join(format!("{}.json", case.case));
        keep(&path, &record)?;
    }
    Ok(good)
}
