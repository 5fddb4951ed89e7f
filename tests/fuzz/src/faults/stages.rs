//! A run of each stage, and of studies, that lasts about a second.

use std::path::{Path, PathBuf};
use std::process::Command;

use super::Trials;
use crate::seeds::elsewhere;

/// A run that can be started again and again.
#[derive(Debug, Clone)]
pub(super) struct Job {
    pub(super) name: &'static str,
    pub(super) program: PathBuf,
    /// Files that it reads: the scene, patches, inputs.
    pub(super) reads: Vec<PathBuf>,
    arguments: Vec<String>,
    /// A folder of its own.
    pub(super) folder: PathBuf,
}

/// Name, tool, scene, patch, inputs by the names of other jobs.
type Recipe = (
    &'static str,
    &'static str,
    &'static str,
    &'static str,
    &'static [(&'static str, &'static str)],
);

/// Stages first, in the order in which one reads what another wrote; then studies, shortened.
const RECIPES: [Recipe; 10] = [
    (
        "gasprop",
        "gasprop",
        "pipelines/gases/argon.json",
        r#"{"temperatures": {"chosen": {"count": 60}}}"#,
        &[],
    ),
    (
        "arcfvm",
        "arcfvm",
        "pipelines/verify/arc-surface/scene.json",
        r#"{"iterate": {"most": 400}}"#,
        &[("gas", "gasprop")],
    ),
    (
        "poolsph",
        "poolsph",
        "tests/resume/weld.json",
        r#"{"time": {"end_s": 0.02}, "output": {"pool": {"from_s": 0.002, "interval_s": 0.0001}}}"#,
        &[("arc", "arcfvm")],
    ),
    (
        "avg",
        "avg",
        "pipelines/gmaw-300a/avg.json",
        r#"{"time": null, "phases": null, "landed": null, "sections": [{"name": "x0",
            "cut": {"plane": {"normal": "x", "half_thickness_m": 1e-3}}, "first_m": [-0.004, 0.004],
            "second_m": [-0.002, 0.002]}]}"#,
        &[("frames", "poolsph")],
    ),
    ("heatsph", "heatsph", "tests/resume/rod.json", "{}", &[]),
    ("emfield", "emfield", "tests/resume/field.json", "{}", &[]),
    (
        "jetsph",
        "jetsph",
        "pipelines/verify/solid-turn/scene.json",
        r#"{"time": {"end_s": 0.03}}"#,
        &[],
    ),
    (
        "gmaw-quick",
        "poolsph",
        "pipelines/gmaw-300a/pool.json",
        r#"{"time": {"end_s": 0.004}, "output": {"particles_interval_s": 0.001}}"#,
        &[("arc", "arcfvm")],
    ),
    (
        "fgm-shock",
        "heatsph",
        "pipelines/fgm-shock/disc-1023.json",
        r#"{"time": {"end_s": 0.02}}"#,
        &[],
    ),
    (
        "dielectric-sphere",
        "emfield",
        "pipelines/dielectric-sphere/scene.json",
        "{}",
        &[],
    ),
];

/// Jobs that keep no checkpoint: they begin again.
const WITHOUT: [&str; 3] = ["gasprop", "emfield", "dielectric-sphere"];

/// All jobs, each run once: what it wrote undisturbed is `straight.mcap` in its folder.
pub(super) fn jobs(trials: &Trials) -> Result<Vec<Job>, String> {
    let mut jobs: Vec<Job> = Vec::new();
    for (name, tool, scene, patch, inputs) in RECIPES {
        let folder = trials.out.join(name);
        let told = |e: std::io::Error| format!("{}: {e}", folder.display());
        if folder.exists() {
            std::fs::remove_dir_all(&folder).map_err(told)?;
        }
        std::fs::create_dir_all(&folder).map_err(told)?;
        let own = folder.join("scene.json");
        let scene = trials.root.join(scene);
        let whole = std::fs::read_to_string(&scene).map_err(told)?;
        let whole = elsewhere(&whole, scene.parent().unwrap_or(&trials.root));
        std::fs::write(&own, whole).map_err(told)?;
        let patched = folder.join("patch.json");
        std::fs::write(&patched, patch).map_err(told)?;
        let mut arguments = words(&["run", &text(&own), "--patch", &text(&patched)]);
        let mut reads = vec![own, patched];
        for (input, made) in inputs {
            let made = trials.out.join(made).join("straight.mcap");
            arguments.extend(words(&["--input", &format!("{input}={}", text(&made))]));
            reads.push(made);
        }
        let job = Job {
            name,
            program: trials.programs.join(tool),
            reads,
            arguments,
            folder,
        };
        let output = job.command("straight.mcap").output();
        let output = output.map_err(|e| format!("{}: {e}", job.program.display()))?;
        if !matches!(output.status.code(), Some(0 | 3)) {
            let said = String::from_utf8_lossy(&output.stderr).into_owned();
            return Err(format!(
                "{name} ended with {:?}: {said}",
                output.status.code()
            ));
        }
        jobs.push(job);
    }
    Ok(jobs)
}

impl Job {
    /// The run with its output in its folder, a checkpoint as often as that is cheap.
    pub(super) fn command(&self, out: &str) -> Command {
        let mut command = Command::new(&self.program);
        command
            .args(&self.arguments)
            .arg("--out")
            .arg(self.folder.join(out))
            .args(["--threads", "2", "--progress", "none", "-q"])
            .args(["--checkpoint-s", "0.01"]);
        command
    }

    /// Whether it writes checkpoints.
    pub(super) fn keeps(&self) -> bool {
        !WITHOUT.contains(&self.name)
    }

    /// A file of its folder.
    pub(super) fn path(&self, name: &str) -> PathBuf {
        self.folder.join(name)
    }

    /// Removes an output with all that stands beside it.
    pub(super) fn clear(&self, out: &str) -> Result<(), String> {
        let told = |e: std::io::Error| format!("{}: {e}", self.folder.display());
        let stem = out.trim_end_matches(".mcap");
        for entry in std::fs::read_dir(&self.folder).map_err(told)?.flatten() {
            if entry.file_name().to_string_lossy().starts_with(stem) {
                std::fs::remove_file(entry.path()).map_err(told)?;
            }
        }
        Ok(())
    }
}

pub(super) fn text(path: &Path) -> String {
    path.display().to_string()
}

fn words(of: &[&str]) -> Vec<String> {
    of.iter().map(|word| (*word).to_owned()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scenes_find_what_they_name_from_elsewhere() {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
        let mut named = 0;
        for (name, _, scene, ..) in RECIPES {
            let path = root.join(scene);
            let whole = std::fs::read_to_string(&path).unwrap();
            let whole = elsewhere(&whole, path.parent().unwrap());
            for file in whole.split("\"file\": \"").skip(1) {
                let file = Path::new(file.split('"').next().unwrap());
                assert!(file.is_absolute() && file.exists(), "{name}: {file:?}");
                named += 1;
            }
        }
        assert!(named > 0);
    }
}
