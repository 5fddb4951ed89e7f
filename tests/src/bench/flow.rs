//! LAMMPS beside the weakly compressible water of `jetsph` on a cube of it: `pipelines/bench/solid/flow.json`.
//!
//! Both take steps of the same length from the same places, with the same reach and skin, on one thread, in turns. What is
//! timed are steps alone; figures are particles times steps per second.

use std::path::{Path, PathBuf};
use std::process::Command;

use serde_json::Value;

use super::others::output;
use super::record::Record;
use crate::lab::{LabError, discard_unfinished, read_json};
use crate::speed::Row;

/// Where the scene and the script are.
const FOLDER: &str = "pipelines/bench/solid";
/// The least that is asked of us on a core, times theirs.
const LEAST: f64 = 1.0;

/// Where and how often both are run.
#[derive(Debug, Clone)]
pub struct Beside<'a> {
    /// Folder of the programs.
    pub programs: &'a Path,
    /// A Python with LAMMPS, if there is one.
    pub python: Option<&'a Path>,
    /// Folder of what is written.
    pub out: &'a Path,
    /// Turns.
    pub runs: usize,
}

impl Beside<'_> {
    /// Times both in turns and gives the record, and whether what is asked for holds.
    ///
    /// # Errors
    /// When a program cannot be started or fails, or what it wrote cannot be read.
    pub fn time(&self) -> Result<(Record, bool), LabError> {
        let (mut own, mut theirs, mut ratios) = (Vec::new(), Vec::new(), Vec::new());
        for _ in 0..self.runs.max(1) {
            let ours = self.ours()?;
            if let Some(python) = self.python {
                let their = self.theirs(python)?;
                ratios.push(ours / their);
                theirs.push(their);
            }
            own.push(ours);
        }
        let rows = [
            ("jetsph", "particles steps/s", own),
            ("LAMMPS SPH", "particles steps/s", theirs),
            ("jetsph over LAMMPS SPH", "1", ratios),
        ];
        let rows = rows.into_iter().filter(|(.., values)| !values.is_empty());
        let rows: Vec<Row> = rows
            .map(|(name, unit, values)| Row::of(name, unit, 1, values))
            .collect();
        let ratio = rows.iter().find(|row| row.unit == "1");
        let holds = ratio.is_none_or(|row| row.value >= LEAST);
        Ok((Record::of_rows("flow", rows), holds))
    }

    /// Particles times steps per second of ours: without what reads, writes and fills.
    fn ours(&self) -> Result<f64, LabError> {
        let out = self.out.join("flow.mcap");
        discard_unfinished(&out);
        let mut command = Command::new(self.programs.join("jetsph"));
        command.arg("run").arg(Path::new(FOLDER).join("flow.json"));
        command.arg("--out").arg(&out);
        command.args(["--threads", "1", "--progress", "none"]);
        output(&mut command)?;
        let path = out.with_extension("run.json");
        let told = read_json(&path)?;
        let stages = told["stages"].as_array().into_iter().flatten();
        let marching = stages.filter(|stage| stage["name"] == "water" || stage["name"] == "motion");
        let seconds: f64 = marching.filter_map(|stage| stage["wall_s"].as_f64()).sum();
        let steps = number(&told, "/steps", &path)?;
        let mass = told["closing"].as_array().into_iter().flatten();
        let mass = mass
            .filter(|total| total["name"] == "mass_kg")
            .find_map(|total| total["value"].as_f64());
        let water = &told["scene"]["water"];
        let spacing = number(water, "/spacing_m", &path)?;
        let density = number(water, "/density_kg_m3", &path)?;
        let particles = mass.unwrap_or(f64::NAN) / (density * spacing.powi(3));
        Ok(particles.round() * steps / seconds)
    }

    /// The same of theirs.
    fn theirs(&self, python: &Path) -> Result<f64, LabError> {
        let script = Path::new(FOLDER).join("flow_lammps.py");
        let mut command = Command::new(python);
        // Its library of messages lies beside it.
        let library = python.parent().and_then(Path::parent);
        let library: PathBuf = library.map(|p| p.join("lib")).unwrap_or_default();
        command.env("LD_LIBRARY_PATH", library);
        command.env("OMP_NUM_THREADS", "1");
        command
            .arg(&script)
            .arg(Path::new(FOLDER).join("flow.json"));
        let said = output(&mut command)?;
        let told: Value = serde_json::from_str(said.trim()).map_err(|e| LabError::Content {
            path: script.clone(),
            what: format!("it printed no JSON: {e}"),
        })?;
        let number = |key: &str| number(&told, &format!("/{key}"), &script);
        Ok(number("particles")? * number("steps")? / number("run_time_s")?)
    }
}

fn number(told: &Value, at: &str, path: &Path) -> Result<f64, LabError> {
    let found = told.pointer(at).and_then(Value::as_f64);
    found.ok_or_else(|| LabError::Content {
        path: path.to_owned(),
        what: format!("has no number at {at}"),
    })
}
