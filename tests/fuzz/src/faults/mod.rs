//! Machines that fail: kills at any moment, disks that fill, two writers, outputs that are inputs, places that belong
//! to others. Every stage must lose nothing that was whole, say what happened, and go on to the same bytes.

mod kills;
mod places;
mod stages;

use std::path::PathBuf;

use serde::Serialize;

use crate::chance::Chance;

/// What is tried.
#[derive(Debug, Clone)]
pub struct Trials {
    /// Kills in all, shared out over stages and studies.
    pub kills: usize,
    /// Fixes the moments.
    pub seed: u64,
    /// Where the programs are.
    pub programs: PathBuf,
    /// The root of the repository.
    pub root: PathBuf,
    /// Where it works.
    pub out: PathBuf,
}

/// A fault, who met it, and what came of it.
#[derive(Debug, Clone, Serialize)]
pub struct Row {
    /// What goes wrong.
    pub fault: String,
    /// The stage or study.
    pub who: String,
    /// How often it was tried.
    pub times: usize,
    /// What must be.
    pub expected: String,
    /// What came; the first that was otherwise where one was.
    pub found: String,
    /// Whether all was as it must be; `null` where it could not be tried here.
    pub holds: Option<bool>,
}

/// The table.
#[derive(Debug, Serialize)]
pub struct Table {
    kind: &'static str,
    version: &'static str,
    /// Fixes the moments.
    pub seed: u64,
    /// All that was tried.
    pub rows: Vec<Row>,
    /// Whether nothing was otherwise.
    pub holds: bool,
}

/// Tries everything.
///
/// # Errors
/// Where nothing can be tried: a stage does not run, the disk refuses.
pub fn run(trials: &Trials) -> Result<Table, String> {
    let told = |e: std::io::Error| format!("{}: {e}", trials.out.display());
    std::fs::create_dir_all(&trials.out).map_err(told)?;
    let jobs = stages::jobs(trials)?;
    let mut rows = Vec::new();
    let share = trials.kills.div_ceil(jobs.len());
    for (i, job) in jobs.iter().enumerate() {
        let mut chance = Chance::of(trials.seed, i as u64);
        rows.push(kills::row(job, share, &mut chance)?);
        rows.extend(places::rows(job)?);
    }
    let holds = rows.iter().all(|row| row.holds != Some(false));
    Ok(Table {
        kind: "faults",
        version: "1.0",
        seed: trials.seed,
        rows,
        holds,
    })
}

impl Table {
    /// The table for people.
    #[must_use]
    pub fn text(&self) -> String {
        let mut text = String::new();
        for row in &self.rows {
            let word = match row.holds {
                Some(true) => "good",
                Some(false) => "BAD",
                None => "not judged",
            };
            text += &format!(
                "{word:<10} {:<12} {:<44} {:>4} x  {}\n",
                row.who, row.fault, row.times, row.found
            );
        }
        text
    }
}
