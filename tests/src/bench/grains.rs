//! LAMMPS beside `poolsph` on a settled bed of grains: `pipelines/bench/dem`.
//!
//! `poolsph` settles the bed. Both then take steps of the same length from the same places, by the same law, in the same box, on
//! one thread, in turns. What is timed are steps alone; figures are grains times steps per second.

use std::path::{Path, PathBuf};
use std::process::Command;

use artefact::Reader;
use serde_json::{Value, json};

use super::io;
use super::others::output;
use super::record::Record;
use crate::grains::{Swing, mass};
use crate::lab::{LabError, discard_unfinished, read_json};
use crate::speed::Row;

/// Where the scenes and the script are.
const FOLDER: &str = "pipelines/bench/dem";
/// Steps of theirs before those that are timed.
const WARM: u64 = 100;
/// The least that is asked of us on a core: grains times steps per second, and times theirs.
const LEAST: [f64; 2] = [9e6, 1.5];

/// Skin of the lists of both over the radius of a grain: that of `poolsph`.
const SKIN: f64 = 0.4;

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
    /// Threads on which the bed settles.
    pub threads: usize,
}

impl Beside<'_> {
    /// Settles the bed, times both in turns and gives the record, and whether all that is asked for holds.
    ///
    /// # Errors
    /// When a program cannot be started or fails, or what it wrote cannot be read.
    pub fn time(&self) -> Result<(Record, bool), LabError> {
        let bed = self.out.join("bed.mcap");
        if !bed.is_file() {
            self.ours(&[], &bed, self.threads)?;
        }
        let (mut own, mut theirs, mut ratios, mut contacts) =
            (Vec::new(), Vec::new(), Vec::new(), Vec::new());
        for _ in 0..self.runs.max(1) {
            let told = self.ours(&[&bed], &self.out.join("timed.mcap"), 1)?;
            let ours = Timed::of(&told)?;
            contacts.push(ours.contacts);
            own.push(ours.rate());
            if let Some(python) = self.python {
                let their = self.theirs(python, &bed, &told, &ours)?;
                ratios.push(ours.rate() / their);
                theirs.push(their);
            }
        }
        let rows = [
            ("poolsph", "grains steps/s", own),
            ("LAMMPS", "grains steps/s", theirs),
            ("poolsph over LAMMPS", "1", ratios),
            ("contacts of a grain", "1", contacts),
        ];
        let rows = rows.into_iter().filter(|(.., values)| !values.is_empty());
        let rows: Vec<Row> = rows
            .map(|(name, unit, values)| Row::of(name, unit, 1, values))
            .collect();
        let holds = rows.iter().all(|row| match row.name.as_str() {
            "poolsph" => row.value >= LEAST[0],
            "poolsph over LAMMPS" => row.value >= LEAST[1],
            _ => true,
        });
        Ok((Record::of_rows("dem", rows), holds))
    }

    /// A run of ours: of the scene that settles the bed, or from the bed.
    fn ours(&self, bed: &[&Path], out: &Path, threads: usize) -> Result<Value, LabError> {
        discard_unfinished(out);
        let mut command = Command::new(self.programs.join("poolsph"));
        command.arg("run").arg(Path::new(FOLDER).join("bed.json"));
        for bed in bed {
            let patch = Path::new(FOLDER).join("timed.json");
            command.arg("--patch").arg(patch).arg("--input");
            command.arg(format!("bed={}", bed.display()));
        }
        command.arg("--out").arg(out);
        command.args(["--threads", &threads.to_string(), "--progress", "none"]);
        output(&mut command)?;
        read_json(&out.with_extension("run.json"))
    }

    /// Steps of theirs per second, times the grains.
    fn theirs(
        &self,
        python: &Path,
        bed: &Path,
        told: &Value,
        ours: &Timed,
    ) -> Result<f64, LabError> {
        let path = self.out.join("bed.json");
        let text = written(bed, told, ours)?.to_string();
        std::fs::write(&path, text).map_err(io(&path))?;
        let script = Path::new(FOLDER).join("beside.py");
        let mut command = Command::new(python);
        // Its library of messages lies beside it.
        let library = python
            .parent()
            .and_then(Path::parent)
            .map(|p| p.join("lib"));
        command.env("LD_LIBRARY_PATH", library.unwrap_or_default());
        command.env("OMP_NUM_THREADS", "1");
        let said = output(command.arg(&script).arg(&path))?;
        let told: Value = serde_json::from_str(said.trim()).map_err(|e| LabError::Content {
            path: script.clone(),
            what: format!("it printed no JSON: {e}"),
        })?;
        let number = |key: &str| number(&told, &format!("/{key}"), &script);
        Ok(number("grains")? * number("steps")? / number("run_time_s")?)
    }
}

/// What a run of ours says of itself.
struct Timed {
    grains: f64,
    steps: f64,
    contacts: f64,
    seconds: f64,
    end: f64,
}

impl Timed {
    fn of(told: &Value) -> Result<Self, LabError> {
        let missing = |what: &str| LabError::Content {
            path: PathBuf::from("timed.run.json"),
            what: format!("has no {what}"),
        };
        let listed = |list: &str, name: &str, key: &str| {
            let rows = told[list].as_array().into_iter().flatten();
            let mut named = rows.filter(|row| row["name"] == name);
            named
                .find_map(|row| row[key].as_f64())
                .ok_or_else(|| missing(name))
        };
        Ok(Self {
            grains: listed("closing", "grains", "value")?,
            steps: listed("closing", "grain_steps", "value")?,
            contacts: listed("closing", "grain_contacts", "value")?,
            seconds: listed("stages", "grains", "wall_s")?,
            end: number(told, "/scene/time/end_s", Path::new("timed.run.json"))?,
        })
    }

    fn rate(&self) -> f64 {
        self.grains * self.steps / self.seconds
    }
}

fn number(told: &Value, at: &str, path: &Path) -> Result<f64, LabError> {
    let found = told.pointer(at).and_then(Value::as_f64);
    found.ok_or_else(|| LabError::Content {
        path: path.to_owned(),
        what: format!("has no number at {at}"),
    })
}

/// The bed and its law for the script.
fn written(bed: &Path, told: &Value, ours: &Timed) -> Result<Value, LabError> {
    let reader = Reader::open_kind(bed, "particle-frames", 1)?;
    let last = reader.count("/grains").saturating_sub(1);
    let frame = reader.frame("/grains", last)?;
    let (places, radii) = (frame.position_vectors()?, frame.f64("radius")?);
    let grains = places.iter().zip(radii.iter());
    let grains: Vec<[f64; 4]> = grains.map(|([x, y, z], r)| [*x, *y, *z, *r]).collect();
    let scene = &told["scene"]["grains"];
    let at = |key: &str| number(scene, key, Path::new("bed.json"));
    let side = &scene["walls"][0]["shape"]["box"];
    let density = at("/density_kg_m3")?;
    let radius = grains.first().map_or(0.0, |grain| grain[3]);
    Ok(json!({
        "box_m": [side["min_m"], side["max_m"]],
        "stiffness_n_m": at("/contact/law/linear/stiffness_n_m")?,
        "tangential_ratio": at("/contact/law/linear/tangential_ratio").unwrap_or(1.0),
        "damping_ratio": Swing::of(at("/contact/restitution")?, true).damping_ratio(),
        "friction": at("/contact/friction")?,
        "mass_kg": mass(density, radius),
        "density_kg_m3": density,
        "gravity_m_s2": scene["gravity_m_s2"],
        "skin_m": SKIN * radius,
        "step_s": ours.end / ours.steps,
        "warm_steps": WARM,
        "steps": ours.steps as u64,
        "grains": grains,
    }))
}
