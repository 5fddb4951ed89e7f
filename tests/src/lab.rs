//! Runs tools the way a user does and hands back what they wrote.

use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Instant;

use serde_json::Value;
use thiserror::Error;

/// Why a case could not be measured.
#[derive(Debug, Error)]
pub enum LabError {
    /// A program could not be started or a file not be read or written.
    #[error("{path}: {source}")]
    Io {
        /// Program or file.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// A tool ended with another exit code than 0, and not with warnings of a run that is whole (3).
    #[error("{command}\nended with exit code {code:?}:\n{stderr}")]
    Tool {
        /// The command line.
        command: String,
        /// Exit code, if any.
        code: Option<i32>,
        /// What it said on stderr.
        stderr: String,
    },
    /// The same command wrote other bytes the second time.
    #[error("{artefact}: a repeat of the same run wrote other bytes")]
    NotRepeatable {
        /// The artefact of the first run.
        artefact: PathBuf,
    },
    /// An artefact could not be read.
    #[error(transparent)]
    Artefact(#[from] artefact::Error),
    /// A record or scene lacks what the case needs.
    #[error("{path}: {what}")]
    Content {
        /// The file.
        path: PathBuf,
        /// What is missing or wrong.
        what: String,
    },
}

impl LabError {
    /// Whether the scene is at fault, and no program: a tool refused it (exit code 2), or it has no exact solution.
    #[must_use]
    pub fn is_of_the_scene(&self) -> bool {
        match self {
            Self::Tool { code, .. } => *code == Some(2),
            Self::Content { .. } => true,
            Self::Io { .. } | Self::NotRepeatable { .. } | Self::Artefact(_) => false,
        }
    }
}

/// Where scenes are, where programs are, where results go.
#[derive(Debug, Clone)]
pub struct Lab {
    /// Repository root.
    pub root: PathBuf,
    /// Folder of the programs.
    pub programs: PathBuf,
    /// Folder for artefacts of the cases.
    pub out: PathBuf,
    /// Threads that each run may use.
    pub threads: usize,
    /// A patch of the user's, applied after the case's own.
    pub patch: Option<PathBuf>,
    /// Seconds that the repeats of one short run may take; 0 for no repeats.
    pub repeat_s: f64,
}

/// What a run left behind.
#[derive(Debug, Clone)]
pub struct Finished {
    /// The artefact.
    pub artefact: PathBuf,
    /// The run record (`.run.json`).
    pub record: Value,
    /// The scene as the tool ran it, patches applied.
    pub scene: Value,
    /// From the start of the process to its end \[s\].
    pub process_s: f64,
    /// What the case sets by level or method, and the user's patch holds fast: JSON pointers.
    pub held: Vec<String>,
    /// The program and its words, without `--out`.
    command: Vec<OsString>,
}

/// Stages of a run record that are no part of solving: reading and checking the scene, files. The plan
/// is a part: a program may put together there what it solves.
const NOT_SOLVING: [&str; 3] = ["scene", "write", "checkpoint"];

impl Finished {
    /// What a case measured itself, without a program: its time \[s\], and no artefact.
    #[must_use]
    pub fn here(seconds: f64) -> Self {
        Self {
            artefact: PathBuf::new(),
            record: serde_json::json!({ "wall_s": seconds }),
            scene: Value::Null,
            process_s: seconds,
            held: Vec::new(),
            command: Vec::new(),
        }
    }

    /// A number of the closing block of the record; not a number where there is none.
    #[must_use]
    pub fn closing(&self, name: &str) -> f64 {
        let rows = self.record["closing"].as_array().into_iter().flatten();
        let value = rows.rev().find(|row| row["name"] == name);
        let value = value.and_then(|row| row["value"].as_f64());
        value.unwrap_or(f64::NAN)
    }

    /// Whether there is a program to run again.
    pub(crate) fn repeatable(&self) -> bool {
        !self.command.is_empty()
    }

    /// Time of the solver as the run record tells \[s\]: the wall time of the run less what it spent
    /// on reading its scene and writing its files. What the record does not name counts as solving;
    /// starting the process (some milliseconds) does not.
    ///
    /// # Errors
    /// When the record has no `wall_s`.
    pub fn solver_s(&self) -> Result<f64, LabError> {
        let wall = self.record["wall_s"]
            .as_f64()
            .ok_or_else(|| LabError::Content {
                path: self.artefact.clone(),
                what: "its run record has no wall_s".to_owned(),
            })?;
        let stages = self.record["stages"].as_array();
        let outside = stages.into_iter().flatten().filter(|stage| {
            let name = stage["name"].as_str().unwrap_or_default();
            NOT_SOLVING.contains(&name)
        });
        let spent: f64 = outside.filter_map(|stage| stage["wall_s"].as_f64()).sum();
        Ok((wall - spent).max(0.0))
    }

    /// Steps or iterations as the run record counts them.
    #[must_use]
    pub fn steps(&self) -> u64 {
        self.record["steps"].as_u64().unwrap_or(0)
    }

    /// Greatest resident memory of the run \[byte\], where the system told.
    #[must_use]
    pub fn peak_memory_bytes(&self) -> Option<u64> {
        self.record["peak_memory_bytes"].as_u64()
    }
}

/// What is run.
#[derive(Debug, Clone, Copy)]
pub struct Subject<'a> {
    /// The program.
    pub tool: &'a str,
    /// The case that it is run for.
    pub case: &'a str,
    /// Its scene, in the repository.
    pub scene: &'a Path,
}

impl<'a> Subject<'a> {
    /// A program on a scene, for a case.
    #[must_use]
    pub fn new(tool: &'a str, case: &'a str, scene: &'a Path) -> Self {
        Self { tool, case, scene }
    }
}

impl Lab {
    /// Runs `tool` on `pipelines/verify/<case>/<scene>` with `patch` applied; `label` names the
    /// artefact `<out>/<case>/<label>.mcap`.
    ///
    /// # Errors
    /// When the tool cannot be started, fails or does not converge.
    pub fn run(
        &self,
        tool: &str,
        case: &str,
        label: &str,
        patch: &Value,
    ) -> Result<Finished, LabError> {
        self.run_with(tool, case, label, patch, &[])
    }

    /// As [`Lab::run`], with named inputs.
    ///
    /// # Errors
    /// When the tool cannot be started, fails or does not converge.
    pub fn run_with(
        &self,
        tool: &str,
        case: &str,
        label: &str,
        patch: &Value,
        inputs: &[(&str, &Path)],
    ) -> Result<Finished, LabError> {
        let scene = Path::new("pipelines/verify").join(case).join("scene.json");
        self.run_scene(Subject::new(tool, case, &scene), label, patch, inputs)
    }

    /// As [`Lab::run_with`], of another scene in the repository, for `case`.
    ///
    /// # Errors
    /// When the tool cannot be started, fails or does not converge.
    pub fn run_scene(
        &self,
        of: Subject<'_>,
        label: &str,
        patch: &Value,
        inputs: &[(&str, &Path)],
    ) -> Result<Finished, LabError> {
        let Subject { tool, case, scene } = of;
        let folder = self.out.join(case);
        std::fs::create_dir_all(&folder).map_err(|source| LabError::Io {
            path: folder.clone(),
            source,
        })?;
        let patch_file = folder.join(format!("{label}.patch.json"));
        write(&patch_file, &patch.to_string())?;
        let artefact = folder.join(format!("{label}.mcap"));
        let mut command: Vec<OsString> = vec![self.programs.join(tool).into(), "run".into()];
        command.push(self.root.join(scene).into());
        let patches = std::iter::once(&patch_file).chain(&self.patch);
        for patch in patches {
            command.extend(["--patch".into(), patch.into()]);
        }
        for (name, path) in inputs {
            let input = format!("{name}={}", path.display());
            command.extend(["--input".into(), input.into()]);
        }
        let threads = self.threads.to_string();
        command.extend(["--threads", &threads, "--progress", "none"].map(OsString::from));
        let held = match &self.patch {
            Some(path) => common(patch, &read_json(path)?, ""),
            None => Vec::new(),
        };
        let finished = self.execute(command, artefact)?;
        Ok(Finished { held, ..finished })
    }

    /// The run `first` with `patch` over all others, the user's included: for a patch that is made from
    /// the scene which ran.
    ///
    /// # Errors
    /// When the tool cannot be started, fails or does not converge.
    pub fn varied(
        &self,
        first: &Finished,
        label: &str,
        patch: &Value,
    ) -> Result<Finished, LabError> {
        let artefact = first.artefact.with_file_name(format!("{label}.mcap"));
        let patch_file = artefact.with_extension("patch.json");
        write(&patch_file, &patch.to_string())?;
        let mut command = first.command.clone();
        command.extend(["--patch".into(), patch_file.into()]);
        self.execute(command, artefact)
    }

    /// The same run once more. Its artefact is compared with the first and removed.
    ///
    /// # Errors
    /// When the run fails or its artefact differs from the first by a byte.
    pub fn again(&self, first: &Finished) -> Result<Finished, LabError> {
        let artefact = first.artefact.with_extension("again.mcap");
        let again = self.execute(first.command.clone(), artefact.clone())?;
        let same = bytes(&first.artefact)? == bytes(&artefact)?;
        for old in [&artefact, &artefact.with_extension("run.json")] {
            let _ = std::fs::remove_file(old);
        }
        if same {
            return Ok(again);
        }
        Err(LabError::NotRepeatable {
            artefact: first.artefact.clone(),
        })
    }

    fn execute(&self, words: Vec<OsString>, artefact: PathBuf) -> Result<Finished, LabError> {
        discard_unfinished(&artefact);
        let mut command = Command::new(&words[0]);
        command.current_dir(&self.root).args(&words[1..]);
        command.arg("--out").arg(&artefact);
        finish(&mut command, words, artefact)
    }
}

/// Pointers to what both patches set.
fn common(one: &Value, other: &Value, at: &str) -> Vec<String> {
    match (one, other) {
        (Value::Object(one), Value::Object(other)) => {
            let both = one
                .iter()
                .filter_map(|(key, a)| Some((key, a, other.get(key)?)));
            both.flat_map(|(key, a, b)| common(a, b, &format!("{at}/{key}")))
                .collect()
        }
        _ => vec![at.to_owned()],
    }
}

/// Removes what a run that was killed left: a measurement begins at the start.
pub(crate) fn discard_unfinished(artefact: &Path) {
    for ending in ["checkpoint", "part"] {
        let mut name = artefact.as_os_str().to_owned();
        name.push(".");
        name.push(ending);
        // What is not there need not be removed; what cannot be is told by the tool.
        let _ = std::fs::remove_file(name);
    }
}

/// Whether an iteration gave up, and said so in its run `record`: every tool begins such a warning alike.
#[must_use]
pub fn gave_up(record: &Value) -> bool {
    let warnings = record["warnings"].as_array().into_iter().flatten();
    let mut told = warnings.filter_map(Value::as_str);
    told.any(|warning| warning.starts_with("not converged"))
}

fn finish(
    command: &mut Command,
    words: Vec<OsString>,
    artefact: PathBuf,
) -> Result<Finished, LabError> {
    let program = PathBuf::from(command.get_program());
    let start = Instant::now();
    let output = command.output().map_err(|source| LabError::Io {
        path: program,
        source,
    })?;
    let process_s = start.elapsed().as_secs_f64();
    let record = artefact.with_extension("run.json");
    // A run with warnings is judged by its errors, but for one that gave up.
    let warned = output.status.code() == Some(3) && !gave_up(&read_json(&record)?);
    if !output.status.success() && !warned {
        return Err(LabError::Tool {
            command: format!("{command:?}"),
            code: output.status.code(),
            stderr: String::from_utf8_lossy(&output.stderr).into_owned(),
        });
    }
    let record = read_json(&record)?;
    let scene = record["scene"].clone();
    Ok(Finished {
        artefact,
        record,
        scene,
        process_s,
        held: Vec::new(),
        command: words,
    })
}

fn bytes(path: &Path) -> Result<Vec<u8>, LabError> {
    std::fs::read(path).map_err(|source| LabError::Io {
        path: path.to_owned(),
        source,
    })
}

fn write(path: &Path, text: &str) -> Result<(), LabError> {
    std::fs::write(path, text).map_err(|source| LabError::Io {
        path: path.to_owned(),
        source,
    })
}

/// Reads a JSON file.
///
/// # Errors
/// When it cannot be read or is not JSON.
pub fn read_json(path: &Path) -> Result<Value, LabError> {
    let text = std::fs::read_to_string(path).map_err(|source| LabError::Io {
        path: path.to_owned(),
        source,
    })?;
    serde_json::from_str(&text).map_err(|e| LabError::Content {
        path: path.to_owned(),
        what: e.to_string(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn what_two_patches_set_is_told_by_its_place() {
        let level = json!({"points": {"spacing_m": 1, "layers": {"first_m": 0.5}}, "bodies": [1]});
        let user = json!({"points": {"spacing_m": 2, "jitter": 0.1}, "bodies": [2], "gas": {}});
        assert_eq!(common(&level, &user, ""), ["/points/spacing_m", "/bodies"]);
        assert!(common(&level, &json!({"gas": {"pressure_pa": 1}}), "").is_empty());
        // A whole object may be taken away.
        assert_eq!(common(&level, &json!({"points": null}), ""), ["/points"]);
    }
}
