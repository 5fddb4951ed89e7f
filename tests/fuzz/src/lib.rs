//! Scenes and artefacts as nobody wrote them: what every program does with thousands of changed files.
//!
//! A trial takes a seed (a scene of a study or a case, an artefact of each kind), changes one to four things in it
//! with its structure in mind, and gives it to the programs that read such files, as a user does. Nothing may panic,
//! abort, hang, take memory without end, say nothing when it fails, send control characters to a terminal, or read
//! changed data as good. A seed number fixes every trial.

mod chance;
pub mod faults;
mod file;
mod grow;
mod json;
mod judge;
mod records;
mod seeds;
mod trials;
mod watch;

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Duration;

use serde::Serialize;

pub use seeds::Breadth;
use seeds::Seeds;
use trials::Trial;

/// What a campaign does.
#[derive(Debug, Clone)]
pub struct Campaign {
    /// Fixes every change.
    pub seed: u64,
    /// Changed scenes that are checked.
    pub scenes: u64,
    /// Changed scenes that are run for a moment.
    pub runs: u64,
    /// Changed artefacts that are read.
    pub files: u64,
    /// Only this trial of each sort.
    pub only: Option<u64>,
    /// Which scenes are changed.
    pub breadth: Breadth,
    /// Where the programs are.
    pub programs: PathBuf,
    /// The root of the repository.
    pub root: PathBuf,
    /// Where it works, and where what failed is kept.
    pub out: PathBuf,
    /// Trials at a time.
    pub threads: usize,
}

/// Processor time that no program may need for a changed file.
pub(crate) const LONGEST: Duration = Duration::from_secs(10);
/// Resident memory that no program may need for it \[byte\].
pub(crate) const MOST: u64 = 2 << 30;

/// Something that must not be.
#[derive(Debug, Clone, Serialize, PartialEq, Eq, PartialOrd, Ord)]
pub struct Finding {
    /// What happened, in a word.
    pub kind: String,
    /// Sort and number of the trial: `fuzz --seed N --only TRIAL` does it again.
    pub trial: String,
    /// The command.
    pub command: String,
    /// What it said.
    pub said: String,
}

/// What came of a campaign.
#[derive(Debug, Clone, Serialize)]
pub struct Outcome {
    /// The seed.
    pub seed: u64,
    /// Trials by sort.
    pub trials: BTreeMap<String, u64>,
    /// Programs that were started.
    pub programs: u64,
    /// How they ended: exit code and how often, by sort of trial.
    pub ended: BTreeMap<String, BTreeMap<String, u64>>,
    /// What must not be.
    pub findings: Vec<Finding>,
}

/// Makes the seeds and does all trials.
///
/// # Errors
/// Where seeds cannot be made or nothing can be written.
pub fn run(campaign: &Campaign) -> Result<Outcome, String> {
    let seeds = Seeds::make(campaign)?;
    let sorts = [
        ("scene", campaign.scenes),
        ("run", campaign.runs),
        ("file", campaign.files),
    ];
    let mut outcome = Outcome {
        seed: campaign.seed,
        trials: BTreeMap::new(),
        programs: 0,
        ended: BTreeMap::new(),
        findings: Vec::new(),
    };
    for (sort, count) in sorts {
        let numbers = match campaign.only {
            Some(only) if count > 0 => only..only + 1,
            _ => 0..count,
        };
        outcome
            .trials
            .insert(sort.to_owned(), numbers.end - numbers.start);
        let next = AtomicU64::new(numbers.start);
        let results = Mutex::new(Vec::new());
        let work = |worker: usize| -> Result<(), String> {
            let trials = Trial::new(campaign, &seeds, worker)?;
            loop {
                let number = next.fetch_add(1, Ordering::Relaxed);
                if number >= numbers.end {
                    return Ok(());
                }
                let done = trials.one(sort, number)?;
                lock(&results).push((number, done));
            }
        };
        std::thread::scope(|scope| {
            let workers: Vec<_> = (0..campaign.threads.max(1))
                .map(|worker| scope.spawn(move || work(worker)))
                .collect();
            workers
                .into_iter()
                .try_for_each(|worker| worker.join().map_err(|_| "a worker panicked".to_owned())?)
        })?;
        let mut results = lock(&results);
        results.sort_by_key(|(number, _)| *number);
        for (_, done) in results.drain(..) {
            for code in done.codes {
                outcome.programs += 1;
                *outcome
                    .ended
                    .entry(sort.to_owned())
                    .or_default()
                    .entry(code)
                    .or_default() += 1;
            }
            outcome.findings.extend(done.findings);
        }
    }
    Ok(outcome)
}

fn lock<T>(shared: &Mutex<T>) -> std::sync::MutexGuard<'_, T> {
    shared
        .lock()
        .unwrap_or_else(std::sync::PoisonError::into_inner)
}

impl Outcome {
    /// What came of it, for people.
    #[must_use]
    pub fn table(&self) -> String {
        use std::fmt::Write;
        let mut text = format!("seed {}: {} programs started\n", self.seed, self.programs);
        for (sort, n) in &self.trials {
            let ended = self.ended.get(sort).into_iter().flatten();
            let ended: Vec<String> = ended.map(|(code, n)| format!("{code}: {n}")).collect();
            let _ = writeln!(text, "  {sort:<6} {n:>6} trials   {}", ended.join(", "));
        }
        let mut kinds: BTreeMap<&str, Vec<&Finding>> = BTreeMap::new();
        for finding in &self.findings {
            kinds.entry(&finding.kind).or_default().push(finding);
        }
        for (kind, found) in kinds {
            let _ = writeln!(text, "{kind}: {}", found.len());
            for finding in found.iter().take(SHOWN) {
                let said = finding.said.lines().next().unwrap_or_default();
                let _ = writeln!(text, "  {}: {}\n    {said}", finding.trial, finding.command);
            }
        }
        text
    }
}

/// Findings of a kind that are shown.
const SHOWN: usize = 6;
