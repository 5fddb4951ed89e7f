//! How the runs of a case are made and judged.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use serde_json::Value;

use super::check::Checks;
use super::grid::{Grid, Node};
use super::{Extreme, Outcome, Row, Variant};
use crate::lab::{LabError, discard_unfinished, gave_up, read_json};

/// Where a case is run.
pub(super) struct Stand<'a> {
    pub(super) inputs: Vec<String>,
    pub(super) programs: &'a Path,
    pub(super) folder: &'a Path,
    pub(super) threads: usize,
}

/// One run to be made.
struct Trial<'a> {
    name: &'a str,
    scene: &'a Path,
    patch: Option<&'a Path>,
    parameters: &'a Value,
    expect: &'a [Outcome],
    checks: &'a Checks,
    at: Option<[usize; 2]>,
}

impl Stand<'_> {
    pub(super) fn variant(&self, case: &Extreme, variant: &Variant) -> Result<Row, LabError> {
        let patch = self.folder.join(format!("{}.patch.json", variant.name));
        write(&patch, &variant.patch)?;
        let checks = Checks {
            bounds: variant.bounds.clone().or_else(|| case.bounds.clone()),
            monotone: variant.monotone.clone().or_else(|| case.monotone.clone()),
            told: case.told.and(&variant.told),
        };
        let trial = Trial {
            name: &variant.name,
            scene: &case.scene,
            patch: Some(&patch),
            parameters: &variant.patch,
            expect: &variant.expect,
            checks: &checks,
            at: None,
        };
        self.row(&case.tool, &trial)
    }

    pub(super) fn grid(&self, case: &Extreme, grid: &Grid) -> Result<Vec<Row>, LabError> {
        let base = read_json(&case.scene)?;
        let checks = Checks {
            bounds: case.bounds.clone(),
            monotone: case.monotone.clone(),
            told: case.told.clone(),
        };
        let limit = |row: usize, name: &str, scene: &Value| {
            let path = self.folder.join(format!("limit-y{row}.scene.json"));
            write(&path, scene)?;
            let artefact = self.folder.join(format!("limit-y{row}.mcap"));
            let (output, record) = self.start(&case.tool, &path, None, &artefact)?;
            let limits = record["limits"].as_array().into_iter().flatten();
            let mut values = limits.filter(|l| l["name"] == name);
            let value = values.next().and_then(|l| l["value"].as_f64());
            value.ok_or_else(|| LabError::Content {
                path,
                what: format!(
                    "its run does not tell the limit {name}: {}",
                    String::from_utf8_lossy(&output.stderr)
                ),
            })
        };
        let nodes = grid.nodes(&base, &checks, limit)?;
        nodes.iter().map(|node| self.node(case, node)).collect()
    }

    fn node(&self, case: &Extreme, node: &Node) -> Result<Row, LabError> {
        let scene = self.folder.join(format!("{}.scene.json", node.name));
        write(&scene, &node.scene)?;
        let trial = Trial {
            name: &node.name,
            scene: &scene,
            patch: None,
            parameters: &node.parameters,
            expect: &node.expect,
            checks: &node.checks,
            at: Some(node.at),
        };
        self.row(&case.tool, &trial)
    }

    /// Runs a scene; what the program said and its record, null where it wrote none.
    fn start(
        &self,
        tool: &str,
        scene: &Path,
        patch: Option<&Path>,
        artefact: &Path,
    ) -> Result<(Output, Value), LabError> {
        let record = artefact.with_extension("run.json");
        for old in [artefact, &record] {
            // A leftover of an earlier run must not be taken for the result of this one.
            let _ = std::fs::remove_file(old);
        }
        discard_unfinished(artefact);
        let mut command = Command::new(self.programs.join(tool));
        command.arg("run").arg(scene);
        if let Some(patch) = patch {
            command.arg("--patch").arg(patch);
        }
        command.arg("--out").arg(artefact);
        for input in &self.inputs {
            command.arg("--input").arg(input);
        }
        command.args(["--threads", &self.threads.to_string(), "--progress", "none"]);
        let output = start(&mut command, tool)?;
        Ok((output, read_json(&record).unwrap_or(Value::Null)))
    }

    fn row(&self, tool: &str, trial: &Trial) -> Result<Row, LabError> {
        let artefact = self.folder.join(format!("{}.mcap", trial.name));
        let (output, record) = self.start(tool, trial.scene, trial.patch, &artefact)?;
        let message = String::from_utf8_lossy(&output.stderr);
        let outcome = match output.status.code() {
            Some(0 | 3) if !numbers_only(self.programs, &artefact)? => Outcome::Failed,
            Some(3) if gave_up(&record) => Outcome::DivergedDetected,
            Some(0 | 3) if record["steps_divided"].as_u64() > Some(0) => Outcome::Substepped,
            Some(0 | 3) => Outcome::Stable,
            Some(2) => Outcome::Refused,
            Some(1) if record["outcome"].as_str() == Some("diverged") => Outcome::DivergedDetected,
            _ => Outcome::Failed,
        };
        let finished = matches!(outcome, Outcome::Stable | Outcome::Substepped);
        let mut broken = trial.checks.told.broken(&message, &record, finished);
        if finished {
            broken.extend(lost(&record["closing"]));
            broken.extend(trial.checks.broken(&artefact)?);
        }
        let mut said: Vec<&str> = message.lines().rev().take(6).collect();
        said.reverse();
        Ok(Row {
            name: trial.name.to_owned(),
            at: trial.at,
            parameters: trial.parameters.clone(),
            outcome,
            expected: trial.expect.to_vec(),
            step_s: step(&record["scene"]["time"]),
            limits: record["limits"].clone(),
            conservation: record["closing"].clone(),
            message: said.join("\n"),
            holds: trial.expect.contains(&outcome) && broken.is_empty(),
            broken,
        })
    }
}

/// The step that a scene asks for, wherever its method keeps it.
fn step(time: &Value) -> Option<f64> {
    let own = time["step_s"].as_f64();
    let methods = time.as_object().into_iter().flatten();
    own.or_else(|| methods.filter_map(|(_, m)| m["step_s"].as_f64()).next())
}

fn write(path: &Path, value: &Value) -> Result<(), LabError> {
    std::fs::write(path, value.to_string()).map_err(|source| LabError::Io {
        path: path.to_owned(),
        source,
    })
}

/// What a run that finished may lose, as parts of the whole.
const CONSERVED: [(&str, f64); 6] = [
    ("mass_error", 1e-12),
    ("momentum_error", 1e-8),
    ("energy_balance", 5e-3),
    // Of water and solids, whose pressure and stress are no heat.
    ("energy_error", 2e-2),
    ("element_error", 1e-10),
    ("charge_error", 1e-10),
];

/// A conserved total that was not conserved.
fn lost(closing: &Value) -> Option<String> {
    let totals = closing.as_array()?;
    CONSERVED.iter().find_map(|(name, most)| {
        let total = totals.iter().find(|total| total["name"] == *name)?;
        // null is a number that is not finite.
        let error = total["value"].as_f64().unwrap_or(f64::INFINITY);
        (error.abs() > *most).then(|| format!("{name} is {error:e}, at most {most:e}"))
    })
}

/// Whether `artefact validate` finds the file whole and free of values that are not numbers.
fn numbers_only(programs: &Path, artefact: &Path) -> Result<bool, LabError> {
    let mut command = Command::new(programs.join("artefact"));
    command.arg("validate").arg(artefact);
    Ok(start(&mut command, "artefact")?.status.success())
}

fn start(command: &mut Command, name: &str) -> Result<Output, LabError> {
    command.output().map_err(|source| LabError::Io {
        path: PathBuf::from(name),
        source,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn what_is_lost_is_told() {
        let closing = |mass: Value, energy: f64| {
            json!([{"name": "mass_error", "value": mass, "unit": "1"},
                   {"name": "energy_balance", "value": energy, "unit": "1"}])
        };
        assert_eq!(lost(&closing(json!(1e-15), 1e-4)), None);
        assert_eq!(lost(&json!([])), None);
        assert!(
            lost(&closing(json!(1e-11), 1e-4))
                .unwrap()
                .contains("mass_error")
        );
        assert!(
            lost(&closing(json!(0.0), -0.01))
                .unwrap()
                .contains("energy_balance")
        );
        assert!(lost(&closing(Value::Null, 0.0)).is_some());
        let jet = |energy: f64| json!([{"name": "energy_error", "value": energy, "unit": "1"}]);
        assert!(lost(&jet(0.03)).is_some() && lost(&jet(0.01)).is_none());
    }

    #[test]
    fn an_iteration_that_gave_up_is_told_from_one_that_warns() {
        let record = |warning: &str| json!({"warnings": ["little is known here", warning]});
        assert!(gave_up(&record("not converged after 1501 iterations")));
        assert!(!gave_up(&record("the surface is coarse")));
        assert!(!gave_up(&json!({})));
    }
}
