//! `bench`: times the numerical cores and whole scenes.

#![allow(
    clippy::print_stdout,
    clippy::print_stderr,
    reason = "a program talks to its user"
)]

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::Parser;
use verification::bench::{Record, Stand, benches, in_order};
use verification::speed;

/// The record of the numerical cores.
const CORES: &str = "cores";

/// Times the numerical cores and the scenes of pipelines/bench; one record each.
///
/// Example: bench --threads 2 --case cores,flow-dam-break-52k --out build/bench
#[derive(Parser)]
struct Arguments {
    /// Folders of pipelines/bench, or `cores`; all when none is named.
    #[arg(long, value_delimiter = ',')]
    case: Vec<String>,
    /// Where records and artefacts go.
    #[arg(long, default_value = "build/bench")]
    out: PathBuf,
    /// Threads; every figure is taken on one thread too.
    #[arg(long, default_value_t = 2)]
    threads: usize,
    /// Times that each core is measured.
    #[arg(long, default_value_t = 11)]
    repeats: usize,
    /// Times that each scene is run on that many threads; on one thread it is run once.
    #[arg(long, default_value_t = 3)]
    runs: usize,
}

fn main() -> ExitCode {
    match run(&Arguments::parse()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(message) => {
            eprintln!("bench: {message}");
            ExitCode::FAILURE
        }
    }
}

fn run(arguments: &Arguments) -> Result<(), String> {
    std::fs::create_dir_all(&arguments.out).map_err(|e| at(&arguments.out, e))?;
    let mut threads = vec![1, arguments.threads.max(1)];
    threads.dedup();
    let (cores, scenes): (Vec<String>, Vec<String>) =
        arguments.case.iter().cloned().partition(|c| c == CORES);
    let everything = arguments.case.is_empty();
    if everything || !cores.is_empty() {
        let rows = speed::cores(&threads, arguments.repeats.max(1)).map_err(|e| e.to_string())?;
        write(&arguments.out, CORES, &Record::of_rows(CORES, rows))?;
    }
    if !everything && scenes.is_empty() {
        return Ok(());
    }
    let program = std::env::current_exe().map_err(|e| e.to_string())?;
    let stand = Stand {
        programs: program.parent().map(PathBuf::from).unwrap_or_default(),
        out: arguments.out.clone(),
        threads,
        runs: arguments.runs,
    };
    let all = benches(Path::new("pipelines/bench")).map_err(|e| e.to_string())?;
    for bench in in_order(&all, &scenes).map_err(|e| e.to_string())? {
        let record = stand.time(&bench).map_err(|e| e.to_string())?;
        write(&arguments.out, &bench.name, &record)?;
    }
    Ok(())
}

/// Writes a record and shows it.
fn write(out: &Path, name: &str, record: &Record) -> Result<(), String> {
    print!("{}", record.table());
    let path = out.join(format!("{name}.json"));
    let text = serde_json::to_string_pretty(record).map_err(|e| at(&path, e))?;
    std::fs::write(&path, text + "\n").map_err(|e| at(&path, e))
}

fn at(path: &Path, error: impl std::fmt::Display) -> String {
    format!("{}: {error}", path.display())
}
