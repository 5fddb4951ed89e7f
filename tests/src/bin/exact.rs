//! `exact`: writes the exact fields along the lines of a scene of `emfield`, where they are known.

#![allow(clippy::print_stderr, reason = "a program talks to its user")]

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::Parser;
use run::{Form, Owned};
use verification::em::exact::Known;
use verification::keep::keep_owned;
use verification::lab::read_json;

/// Writes the exact fields along the lines of a scene, for the report to draw beside the computed ones.
///
/// It knows a dielectric sphere whose dipole is imposed on the walls, and a conducting sphere among coaxial loops.
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
    let arguments = Arguments::parse();
    let reads = [("the scene".to_owned(), arguments.scene.as_path())];
    let owned = match Owned::of(&arguments.out, Form::Record, reads) {
        Ok(owned) => owned,
        Err(failure) => return run::report_failure("exact", &failure),
    };
    match write(&arguments.scene, owned.out()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(message) => {
            eprintln!("exact: {message}");
            ExitCode::FAILURE
        }
    }
}

/// Writes the exact fields of a scene.
fn write(scene: &Path, out: &Path) -> Result<(), String> {
    let read = read_json(scene).map_err(|e| e.to_string())?;
    let known = Known::of(&read).and_then(|known| known.file(&read));
    let file = known.map_err(|e| format!("{}: {e}", scene.display()))?;
    keep_owned(out, &file)
}
