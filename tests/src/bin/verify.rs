//! `verify`: runs exact cases and writes error against run time.

#![allow(
    clippy::print_stdout,
    clippy::print_stderr,
    reason = "a program talks to its user"
)]

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::Parser;
use verification::{
    cases,
    keep::{apart, keep},
    lab::Lab,
    study,
};

/// Runs exact cases over several resolutions and writes one record each.
///
/// Example: verify --case arc-poiseuille --levels 1,2,3 --out build/verify
#[derive(Parser)]
struct Arguments {
    /// Cases to run; all when none is named.
    #[arg(long, value_delimiter = ',')]
    case: Vec<String>,
    /// Resolutions, 1 is the coarsest.
    #[arg(long, value_delimiter = ',', default_value = "1,2,3", value_parser = clap::value_parser!(u32).range(1..))]
    levels: Vec<u32>,
    /// Where records and artefacts go.
    #[arg(long, default_value = "build/verify")]
    out: PathBuf,
    /// A merge patch on every scene, to run other parameter values.
    #[arg(long)]
    patch: Option<PathBuf>,
    /// Threads per run.
    #[arg(long, default_value_t = 2)]
    threads: usize,
    /// Seconds that the repeats of one short run may take, for the median of its time; 0 for none.
    #[arg(long, default_value_t = 3.0)]
    repeat_s: f64,
    /// Names the cases and ends.
    #[arg(long)]
    list: bool,
}

fn main() -> ExitCode {
    let arguments = Arguments::parse();
    let known = cases::all();
    if arguments.list {
        for case in &known {
            println!(
                "{:<24} {:<10} {}",
                case.name(),
                case.tool(),
                case.reference()
            );
        }
        return ExitCode::SUCCESS;
    }
    if let Some(stranger) = arguments
        .case
        .iter()
        .find(|c| known.iter().all(|k| k.name() != **c))
    {
        eprintln!("verify: there is no case '{stranger}'; `verify --list` names them");
        return ExitCode::from(2);
    }
    match run(&arguments) {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::FAILURE,
        Err(message) => {
            eprintln!("verify: {message}");
            ExitCode::FAILURE
        }
    }
}

/// Runs the chosen cases one after the other; true when every target holds.
fn run(arguments: &Arguments) -> Result<bool, String> {
    let programs = std::env::current_exe().map_err(|e| e.to_string())?;
    let lab = Lab {
        root: std::env::current_dir().map_err(|e| e.to_string())?,
        programs: programs.parent().map(PathBuf::from).unwrap_or_default(),
        out: arguments.out.clone(),
        threads: arguments.threads,
        patch: arguments.patch.clone(),
        repeat_s: arguments.repeat_s,
    };
    apart(&arguments.out, Path::new("pipelines"))?;
    std::fs::create_dir_all(&lab.out).map_err(|e| format!("{}: {e}", lab.out.display()))?;
    let mut good = true;
    for case in cases::all() {
        if !arguments.case.is_empty() && !arguments.case.iter().any(|c| c == case.name()) {
            continue;
        }
        eprintln!("{}", case.name());
        let tell = |line: &str| eprintln!("{line}");
        match study::study(case.as_ref(), &lab, &arguments.levels, tell) {
            Ok(study) => {
                print!("{}", study.table());
                good &= study.holds;
                let path = lab.out.join(format!("{}.json", case.name()));
                keep(&path, &study)?;
            }
            Err(error) => {
                good = false;
                eprintln!("{}: {error}", case.name());
            }
        }
    }
    Ok(good)
}
