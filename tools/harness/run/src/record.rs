//! The run record: everything that varies from run to run, and how it ended.

use std::path::{Path, PathBuf};

use artefact::{Header, write_atomically};
use serde::Serialize;
use serde_json::{Value, json};

use crate::failure::Failure;
use crate::ledger::{Bytes, History, Ledger, LeftOut, Limit};
use crate::machine::{self, Machine};

/// Wall time of a stage.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(crate) struct Spent {
    pub(crate) name: String,
    pub(crate) wall_s: f64,
    pub(crate) share: f64,
}

/// The run record.
#[derive(Debug, Serialize)]
pub(crate) struct RunRecord {
    kind: &'static str,
    version: &'static str,
    tool: String,
    tool_version: String,
    artefact: PathBuf,
    pub(crate) outcome: String,
    /// Why there is no result; absent when there is one.
    #[serde(skip_serializing_if = "Option::is_none")]
    message: Option<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    divergence: Option<Value>,
    exit_code: u8,
    start: String,
    pub(crate) wall_s: f64,
    /// Time that processors spent on it, which other work on the machine hardly changes; none of a run that was resumed.
    processor_s: Option<f64>,
    resumed: u32,
    pub(crate) stages: Vec<Spent>,
    memory: Vec<Bytes>,
    peak_memory_bytes: Option<u64>,
    machine: Machine,
    threads: usize,
    load_average: Option<[f64; 3]>,
    steps: u64,
    substepped: bool,
    steps_divided: u64,
    pub(crate) warnings: Vec<String>,
    notes: Vec<String>,
    left_out: Vec<LeftOut>,
    limits: Vec<Limit>,
    pub(crate) closing: Vec<Limit>,
    scene_hash: String,
    inputs: Value,
    scene: Value,
    /// Last, for it is long.
    history: Vec<History>,
}

impl RunRecord {
    /// The record of a run that began at `start` and ended as `ended` says.
    pub(crate) fn new(
        out: &Path,
        header: &Header,
        start: String,
        ledger: Ledger,
        ended: Result<(), &Failure>,
    ) -> Self {
        let warned = !ledger.warnings.is_empty();
        let (outcome, exit_code) = match ended {
            Ok(()) if warned => ("warned", 3),
            Ok(()) => ("done", 0),
            Err(failure) => (failure.outcome(), failure.exit_code()),
        };
        let wall_s = ledger.earlier_s;
        Self {
            kind: "run-record",
            version: "1.3",
            tool: header.tool.clone(),
            tool_version: header.tool_version.clone(),
            artefact: out.to_owned(),
            outcome: outcome.to_owned(),
            message: ended.err().map(ToString::to_string),
            divergence: ended.err().and_then(place_of),
            exit_code,
            start,
            wall_s,
            processor_s: machine::work_s().filter(|_| ledger.resumed == 0),
            resumed: ledger.resumed,
            stages: shares(&ledger.stages, wall_s),
            memory: ledger.memory,
            peak_memory_bytes: machine::peak_memory_bytes(),
            machine: Machine::here(),
            threads: rayon::current_num_threads(),
            load_average: machine::load_average(),
            steps: ledger.steps,
            substepped: ledger.divided > 0,
            steps_divided: ledger.divided,
            warnings: ledger.warnings,
            notes: ledger.notes,
            left_out: ledger.left_out,
            limits: ledger.limits,
            closing: ledger.closing,
            history: ledger.history,
            scene_hash: header.scene_sha256(),
            inputs: json!(header.inputs),
            scene: header.scene.clone(),
        }
    }

    pub(crate) fn exit_code(&self) -> u8 {
        self.exit_code
    }

    /// Writes the record beside the artefact: `arc.mcap` has `arc.run.json`.
    pub(crate) fn write(&self) -> Result<(), Failure> {
        let path = path_of(&self.artefact);
        let text = serde_json::to_string_pretty(self).map_err(|e| {
            Failure::Other(format!(
                "{}: the record cannot be written: {e}",
                path.display()
            ))
        })?;
        Ok(write_atomically(&path, format!("{text}\n").as_bytes())?)
    }
}

/// Where the record of an artefact stands.
pub(crate) fn path_of(out: &Path) -> PathBuf {
    out.with_extension("run.json")
}

fn place_of(failure: &Failure) -> Option<Value> {
    match failure {
        Failure::Diverged {
            step,
            time_s,
            place,
            quantity,
            what,
        } => Some(json!({
            "step": step, "time_s": time_s, "place": place, "quantity": quantity, "what": what,
        })),
        Failure::Artefact(artefact::Error::NotFinite {
            channel,
            column,
            index,
            value,
            ..
        }) => Some(json!({
            "place": format!("channel '{channel}', entry {index}"), "quantity": column, "what": value.to_string(),
        })),
        _ => None,
    }
}

/// Time and share of each stage, the rest as "other".
fn shares(stages: &[(String, f64)], wall_s: f64) -> Vec<Spent> {
    let spent: f64 = stages.iter().map(|(_, seconds)| seconds).sum();
    let rest = ("other".to_owned(), (wall_s - spent).max(0.0));
    let share = |seconds: f64| if wall_s > 0.0 { seconds / wall_s } else { 0.0 };
    stages
        .iter()
        .chain([&rest])
        .map(|(name, seconds)| Spent {
            name: name.clone(),
            wall_s: *seconds,
            share: share(*seconds),
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use artefact::{Error, Version};

    fn header() -> Header {
        Header {
            kind: "particle-frames".to_owned(),
            version: Version::new(1, 0),
            tool: "poolsph".to_owned(),
            tool_version: "0.1.0".to_owned(),
            scene: json!({"kind": "poolsph.scene", "version": 2}),
            inputs: std::collections::BTreeMap::new(),
        }
    }

    fn ended(failure: &Failure) -> RunRecord {
        RunRecord::new(
            Path::new("a.mcap"),
            &header(),
            machine::now(),
            Ledger::default(),
            Err(failure),
        )
    }

    #[test]
    fn a_value_that_is_not_finite_counts_as_divergence() {
        let failure = Failure::Artefact(Error::NotFinite {
            path: "a.mcap".into(),
            channel: "/particles".to_owned(),
            column: "temperature".to_owned(),
            index: 7,
            value: f64::NAN,
        });
        let record = ended(&failure);
        assert_eq!((record.outcome.as_str(), record.exit_code), ("diverged", 1));
        let divergence = record.divergence.expect("a place");
        assert_eq!(divergence["place"], "channel '/particles', entry 7");
        assert_eq!(divergence["quantity"], "temperature");
    }

    #[test]
    fn every_failure_has_its_outcome_and_exit_code() {
        let refused = || std::io::Error::other("disk full");
        let cases = [
            (Failure::Other("x".to_owned()), "failed", 1),
            (
                Failure::Io {
                    path: "a".into(),
                    action: "write",
                    source: refused(),
                },
                "failed",
                1,
            ),
            (Failure::Interrupted { resumable: true }, "interrupted", 130),
            (Failure::Usage("x".to_owned()), "failed", 2),
            (
                Failure::Scene(vec![crate::Fault::at("/a", "x")]),
                "failed",
                2,
            ),
        ];
        for (failure, outcome, code) in cases {
            let record = ended(&failure);
            assert_eq!(
                (record.outcome.as_str(), record.exit_code),
                (outcome, code),
                "{failure}"
            );
            assert_eq!(record.message, Some(failure.to_string()));
        }
    }

    #[test]
    fn shares_add_to_the_whole() {
        let spent = shares(&[("heat".to_owned(), 3.0), ("write".to_owned(), 1.0)], 5.0);
        assert_eq!(
            spent.iter().map(|s| s.name.as_str()).collect::<Vec<_>>(),
            ["heat", "write", "other"]
        );
        assert!((spent.iter().map(|s| s.share).sum::<f64>() - 1.0).abs() < 1e-12);
        assert!((spent[2].wall_s - 1.0).abs() < 1e-12);
    }
}
