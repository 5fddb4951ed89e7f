//! `exact`: writes the exact fields along the lines of a scene of `emfield`, where they are known.

#![allow(clippy::print_stderr, reason = "a program talks to its user")]

use std::path::PathBuf;
use std::process::ExitCode;

use clap::Parser;
use verification::em::exact::Known;
use verification::keep::keep;
use verification::lab::read_json;

/// Writes the exact fields along the lines of a scene, for the report to draw beside those found.
///
/// Known are a dielectric sphere whose dipole is imposed on the walls, and a conducting sphere among coaxial loops.
///
/// Example: exact pipelines/levitation-field/scene.json --out build/levitation-field/exact.json
#[derive(Parser)]
struct Arguments {
    /// Scene of emfield.
    scene: PathBuf,
    /// The file to write.
    #[arg(long)]
    out: PathBuf,
}

fn main() -> ExitCode {
    match run(&Arguments::parse()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(message) => {
            eprintln!("exact: {message}");
            ExitCode::FAILURE
        }
    }
}

fn run(arguments: &Arguments) -> Result<(), String> {
    let scene = read_json(&arguments.scene).map_err(|e| e.to_string())?;
    let at = |path: &std::path::Path, what: &dyn std::fmt::Display| {
        format!("{}: {what}", path.display())
    };
    let known = Known::of(&scene).and_then(|known| known.file(&scene));
    let file = known.map_err(|e| at(&arguments.scene, &e))?;
    if let Some(folder) = arguments.out.parent() {
        std::fs::create_dir_all(folder).map_err(|e| at(folder, &e))?;
    }
    keep(&arguments.out, &file)
}
