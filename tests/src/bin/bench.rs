//! `bench`: times the numerical cores and whole scenes.

#![allow(
    clippy::print_stdout,
    clippy::print_stderr,
    reason = "a program talks to its user"
)]

use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};

use clap::Parser;
use serde_json::{Value, json};
use verification::speed::{self, Row};

/// Times the numerical cores and the scenes of pipelines/bench; one record each.
///
/// Example: bench --threads 2 --repeats 5 --out build/bench
#[derive(Parser)]
struct Arguments {
    /// Where records and artefacts go.
    #[arg(long, default_value = "build/bench")]
    out: PathBuf,
    /// Threads; every figure is taken on one thread too.
    #[arg(long, default_value_t = 2)]
    threads: usize,
    /// Times that each core is measured.
    #[arg(long, default_value_t = 11)]
    repeats: usize,
    /// Times that each scene is run.
    #[arg(long, default_value_t = 3)]
    runs: usize,
}

/// Stages of a run that are no part of its steps.
const OUTSIDE: [&str; 4] = ["plan", "write", "checkpoint", "other"];

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
    let rows = speed::cores(&threads, arguments.repeats.max(1)).map_err(|e| e.to_string())?;
    write(&arguments.out, "cores", &rows)?;
    for scene in scenes(Path::new("pipelines/bench"))? {
        let rows = time(&scene, arguments, &threads)?;
        write(&arguments.out, &name(&scene), &rows)?;
    }
    Ok(())
}

/// Folders with a scene, in the order of their names.
fn scenes(folder: &Path) -> Result<Vec<PathBuf>, String> {
    let entries = std::fs::read_dir(folder).map_err(|e| at(folder, e))?;
    let mut found: Vec<PathBuf> = entries
        .filter_map(|entry| entry.ok().map(|e| e.path()))
        .filter(|path| path.join("scene.json").is_file())
        .collect();
    found.sort();
    Ok(found)
}

/// Time per step of the scene on each number of threads, taken in turn, and the stages of the
/// last run.
fn time(scene: &Path, arguments: &Arguments, threads: &[usize]) -> Result<Vec<Row>, String> {
    let mut times = vec![Vec::new(); threads.len()];
    let mut last = Value::Null;
    for _ in 0..arguments.runs.max(1) {
        for (&count, times) in threads.iter().zip(&mut times) {
            last = once(scene, &arguments.out, count)?;
            let stages = last["stages"].as_array().into_iter().flatten();
            let inside = stages.filter(|stage| !OUTSIDE.iter().any(|name| stage["name"] == *name));
            let wall: f64 = inside.filter_map(|stage| stage["wall_s"].as_f64()).sum();
            let steps = last["steps"].as_f64().unwrap_or(0.0);
            times.push(1e3 * wall / steps);
        }
    }
    let mut rows: Vec<Row> = threads
        .iter()
        .zip(times)
        .map(|(&count, times)| Row::of("step", "ms", count, times))
        .collect();
    let steps = last["steps"].as_f64().unwrap_or(0.0);
    for stage in last["stages"].as_array().into_iter().flatten() {
        if let (Some(stage_name), Some(wall)) = (stage["name"].as_str(), stage["wall_s"].as_f64()) {
            let count = threads.last().copied().unwrap_or(1);
            rows.push(Row::of(stage_name, "ms", count, vec![1e3 * wall / steps]));
        }
    }
    Ok(rows)
}

/// Runs the scene once; its run record.
fn once(scene: &Path, out: &Path, threads: usize) -> Result<Value, String> {
    let program = std::env::current_exe().map_err(|e| e.to_string())?;
    let program = program.with_file_name("poolsph");
    let artefact = out.join(format!("{}.mcap", name(scene)));
    let output = Command::new(&program)
        .arg("run")
        .arg(scene.join("scene.json"))
        .arg("--out")
        .arg(&artefact)
        .args(["--threads", &threads.to_string(), "--progress", "none"])
        .output()
        .map_err(|e| at(&program, e))?;
    if !output.status.success() {
        return Err(format!(
            "{}: {}",
            scene.display(),
            String::from_utf8_lossy(&output.stderr)
        ));
    }
    let record = artefact.with_extension("run.json");
    let text = std::fs::read_to_string(&record).map_err(|e| at(&record, e))?;
    serde_json::from_str(&text).map_err(|e| at(&record, e))
}

/// Writes a record and shows it.
fn write(out: &Path, name: &str, rows: &[Row]) -> Result<(), String> {
    println!("{name}");
    for row in rows {
        println!(
            "  {:24} {:2} threads  median {:10.3} {}  least {:10.3}",
            row.name, row.threads, row.value, row.unit, row.least
        );
    }
    let record = json!({"name": name, "load_average": load(), "rows": rows});
    let path = out.join(format!("{name}.json"));
    let text = serde_json::to_string_pretty(&record).map_err(|e| at(&path, e))?;
    std::fs::write(&path, text + "\n").map_err(|e| at(&path, e))
}

/// Load of the machine over the last minute, where the system tells.
fn load() -> Option<f64> {
    let text = std::fs::read_to_string("/proc/loadavg").ok()?;
    text.split_whitespace().next()?.parse().ok()
}

fn name(scene: &Path) -> String {
    let name = scene.file_name().unwrap_or_default();
    name.to_string_lossy().into_owned()
}

fn at(path: &Path, error: impl std::fmt::Display) -> String {
    format!("{}: {error}", path.display())
}
