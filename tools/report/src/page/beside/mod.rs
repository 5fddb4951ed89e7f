//! Runs beside each other: their numbers, their curves on one plot, their pictures.

pub(super) mod curves;
pub(super) mod numbers;
pub(super) mod pictures;

use std::path::{Path, PathBuf};

use artefact::Reader;
use run::Failure;

use super::Named;
use crate::html::note;
use crate::records::RunRecord;
use crate::weld::{PARTICLES, Stretch, Weld};

/// One of the runs.
pub(super) struct Member {
    /// What the page calls it.
    pub(super) name: String,
    /// What its stages left.
    pub(super) stages: Vec<Stage>,
}

/// What a stage left.
pub(super) struct Stage {
    pub(super) name: String,
    pub(super) reader: Reader,
    pub(super) record: Option<RunRecord>,
    /// The weld at its end, of frames that hold one.
    pub(super) weld: Option<Weld>,
    /// Its bead.
    pub(super) stretch: Option<Stretch>,
}

impl Member {
    /// Opens the artefacts of a run, each with the name of its stage.
    ///
    /// # Errors
    /// When one cannot be read.
    pub(super) fn open(name: &str, files: &[(String, PathBuf)]) -> Result<Self, Failure> {
        let stages = files.iter().map(|(stage, path)| Stage::open(stage, path));
        Ok(Self {
            name: name.to_owned(),
            stages: stages.collect::<Result<_, _>>()?,
        })
    }

    /// A run of one stage that is not whole yet.
    ///
    /// # Errors
    /// When nothing of it can be read.
    pub(super) fn part(stage: &str, path: &PathBuf) -> Result<Self, Failure> {
        Ok(Self {
            name: stage.to_owned(),
            stages: vec![Stage::of(stage, path, Reader::recover(path)?)?],
        })
    }

    /// A stage by its name.
    pub(super) fn stage(&self, name: &str) -> Option<&Stage> {
        self.stages.iter().find(|stage| stage.name == name)
    }
}

impl Stage {
    fn open(name: &str, path: &PathBuf) -> Result<Self, Failure> {
        Self::of(name, path, Reader::open(path)?)
    }

    fn of(name: &str, path: &Path, reader: Reader) -> Result<Self, Failure> {
        reader.must_be_known()?;
        let welds = reader.header().kind == "particle-frames"
            && reader.has("/plate")
            && reader.count(PARTICLES) > 0;
        let weld = match welds {
            true => Weld::last(&reader)?,
            false => None,
        };
        Ok(Self {
            name: name.to_owned(),
            record: RunRecord::beside(path),
            stretch: weld.as_ref().and_then(Weld::bead),
            weld,
            reader,
        })
    }

    /// Whether its artefact is of a kind.
    fn is(&self, kind: &str) -> bool {
        self.reader.header().kind == kind
    }
}

/// Names of all stages, each once, in the order in which they are met.
pub(super) fn stages(members: &[Member]) -> Vec<&str> {
    let mut all: Vec<&str> = Vec::new();
    for stage in members.iter().flat_map(|member| &member.stages) {
        if !all.contains(&stage.name.as_str()) {
            all.push(&stage.name);
        }
    }
    all
}

/// Where the beads of a stage are of two kinds, medians of what has frozen and greatest values so far, which are not comparable.
pub(super) fn unlike(members: &[Member]) -> Vec<String> {
    let mut told = Vec::new();
    for stage in stages(members) {
        let beads = || {
            members
                .iter()
                .filter_map(|m| Some((&m.name, m.stage(stage)?.stretch.as_ref()?)))
        };
        let young: Vec<&str> = beads()
            .filter(|(_, s)| !s.frozen)
            .map(|(name, _)| name.as_str())
            .collect();
        if !young.is_empty() && beads().any(|(_, s)| s.frozen) {
            told.push(format!(
                "Nothing of these welds has frozen beyond its run-in: {}. Measures of their beads ('{stage}') are the greatest ones so \
                 far, those of the others are medians of a frozen stretch: they are not to be compared.",
                young.join("; ")
            ));
        }
    }
    told
}

/// Statements of plain text as notes.
pub(super) fn notes(told: &[String]) -> String {
    told.iter().map(|words| note(words)).collect()
}

/// The record of every stage under the name of its run and its own.
pub(super) fn records(members: &[Member]) -> Vec<Named> {
    let mut all = Vec::new();
    for member in members {
        for stage in &member.stages {
            let name = format!("{}: {}", member.name, stage.name);
            all.extend(stage.record.clone().map(|record| (name, record)));
        }
    }
    all
}
