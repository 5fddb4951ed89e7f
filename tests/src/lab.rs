//! Runs tools the way a user does and hands back what they wrote.

use std::path::{Path, PathBuf};
use std::process::Command;

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
    /// A tool ended with another exit code than 0.
    #[error("{command}\nended with exit code {code:?}:\n{stderr}")]
    Tool {
        /// The command line.
        command: String,
        /// Exit code, if any.
        code: Option<i32>,
        /// What it said on stderr.
        stderr: String,
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
}

impl Finished {
    /// Wall time of the run as its record tells \[s\].
    ///
    /// # Errors
    /// When the record has no `wall_s`.
    pub fn wall_s(&self) -> Result<f64, LabError> {
        self.record["wall_s"]
            .as_f64()
            .ok_or_else(|| LabError::Content {
                path: self.artefact.clone(),
                what: "its run record has no wall_s".to_owned(),
            })
    }
}

impl Lab {
    /// Runs `tool` on `pipelines/verify/<case>/<scene>` with `patch` applied; `label` names the
    /// artefact `<out>/<case>/<label>.mcap`.
    ///
    /// # Errors
    /// When the tool cannot be started or does not end with exit code 0.
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
    /// When the tool cannot be started or does not end with exit code 0.
    pub fn run_with(
        &self,
        tool: &str,
        case: &str,
        label: &str,
        patch: &Value,
        inputs: &[(&str, &Path)],
    ) -> Result<Finished, LabError> {
        let folder = self.out.join(case);
        std::fs::create_dir_all(&folder).map_err(|source| LabError::Io {
            path: folder.clone(),
            source,
        })?;
        let patch_file = folder.join(format!("{label}.patch.json"));
        write(&patch_file, &patch.to_string())?;
        let scene = self
            .root
            .join("pipelines/verify")
            .join(case)
            .join("scene.json");
        let artefact = folder.join(format!("{label}.mcap"));
        discard_unfinished(&artefact);
        let mut command = Command::new(self.programs.join(tool));
        command
            .current_dir(&self.root)
            .arg("run")
            .arg(&scene)
            .arg("--patch")
            .arg(&patch_file);
        if let Some(user) = &self.patch {
            command.arg("--patch").arg(user);
        }
        for (name, path) in inputs {
            command
                .arg("--input")
                .arg(format!("{name}={}", path.display()));
        }
        command.arg("--out").arg(&artefact);
        command.args(["--threads", &self.threads.to_string(), "--progress", "none"]);
        finish(&mut command, artefact)
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

fn finish(command: &mut Command, artefact: PathBuf) -> Result<Finished, LabError> {
    let program = PathBuf::from(command.get_program());
    let output = command.output().map_err(|source| LabError::Io {
        path: program,
        source,
    })?;
    if !output.status.success() {
        return Err(LabError::Tool {
            command: format!("{command:?}"),
            code: output.status.code(),
            stderr: String::from_utf8_lossy(&output.stderr).into_owned(),
        });
    }
    let record = read_json(&artefact.with_extension("run.json"))?;
    let scene = record["scene"].clone();
    Ok(Finished {
        artefact,
        record,
        scene,
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
