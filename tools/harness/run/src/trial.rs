//! Work in a session that is thrown away, to tell what a run will take.

use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Duration;

use artefact::{Header, beside};

use crate::ballast::Ballast;
use crate::failure::Failure;
use crate::machine;
use crate::session::Session;
use crate::watched::Watched;

/// What a stage of a trial took.
#[derive(Debug, Clone, PartialEq)]
pub struct Part {
    /// Name of the stage.
    pub name: String,
    /// Wall time \[s\].
    pub seconds: f64,
    /// Resident memory that it kept \[byte\].
    pub bytes: u64,
}

/// What a trial took.
#[derive(Debug, Clone, PartialEq)]
pub struct Taken {
    /// Its stages.
    pub parts: Vec<Part>,
    /// Resident memory before it \[byte\]; zero where the system does not say.
    pub before: u64,
    /// How much more there was at most \[byte\]. Where the process had held more before the trial: at most between stages.
    pub most: u64,
}

impl Taken {
    /// Seconds and bytes of a stage; nothing where there was none.
    #[must_use]
    pub fn of(&self, name: &str) -> (f64, u64) {
        let found = self.parts.iter().find(|p| p.name == name);
        found.map_or((0.0, 0), |p| (p.seconds, p.bytes))
    }
}

/// Does work in a session whose artefact is thrown away, and which says nothing.
///
/// # Errors
/// Those of the work, and where no temporary file can be written.
pub fn trial(
    header: Header,
    work: impl FnOnce(&mut Session) -> Result<(), Failure>,
) -> Result<Taken, Failure> {
    let ballast = Ballast::new();
    let before = machine::memory_bytes().unwrap_or_default();
    let highest = machine::peak_memory_bytes();
    let mut session = silent(header)?;
    session.watched = Some(Watched::default());
    let done = work(&mut session);
    let higher = machine::peak_memory_bytes().filter(|now| Some(*now) > highest);
    let ledger = session.ledger();
    let watched = session.watched.take().unwrap_or_default();
    drop(session);
    done?;
    let part = |(name, seconds): (String, f64)| Part {
        bytes: watched.of(&name),
        name,
        seconds,
    };
    Ok(Taken {
        parts: ledger.stages.into_iter().map(part).collect(),
        before: ballast.without(before),
        most: higher.unwrap_or(watched.most).saturating_sub(before),
    })
}

/// A session that says nothing, and whose artefact is thrown away.
///
/// # Errors
/// Where no temporary file can be written.
pub(crate) fn silent(header: Header) -> Result<Session, Failure> {
    static NUMBER: AtomicUsize = AtomicUsize::new(0);
    let number = NUMBER.fetch_add(1, Ordering::Relaxed);
    let name = format!("{}-trial-{}-{number}.mcap", header.tool, std::process::id());
    let out = std::env::temp_dir().join(name);
    let mut session = Session::quiet(&out, header)?;
    session.every = Duration::MAX;
    // The open file lasts without its name: however the process ends, nothing is left. What cannot be removed is in nobody's way.
    let _ = std::fs::remove_file(beside(&out, ".part"));
    Ok(session)
}

impl Session {
    /// Does work in a silent session beside this one, and adds its time to a stage. What it writes and says is thrown away; it
    /// stops where this one does.
    ///
    /// # Errors
    /// Those of the work, and where no temporary file can be written.
    pub fn beside<R>(
        &mut self,
        name: &'static str,
        work: impl FnOnce(&mut Self) -> Result<R, Failure>,
    ) -> Result<R, Failure> {
        let mut other = silent(self.header.clone())?;
        other.interrupt = self.interrupt.clone();
        self.timed(name, || work(&mut other))
    }
}
