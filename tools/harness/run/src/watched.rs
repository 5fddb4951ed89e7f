//! What the stages of a trial keep of memory.

use crate::machine;

/// Growth of the resident memory over each stage, and its greatest size between them.
#[derive(Debug, Clone, Default)]
pub(crate) struct Watched {
    stages: Vec<(&'static str, i64)>,
    pub(crate) most: u64,
}

impl Watched {
    /// Resident memory where a stage begins, if it is watched \[byte\].
    pub(crate) fn before(watched: Option<&Self>) -> Option<u64> {
        watched.and_then(|_| machine::memory_bytes())
    }

    /// Adds what a stage has kept since there were so many bytes.
    pub(crate) fn add(&mut self, name: &'static str, before: u64) {
        let Some(now) = machine::memory_bytes() else {
            return;
        };
        self.most = self.most.max(now);
        let more = now.cast_signed() - before.cast_signed();
        match self.stages.iter_mut().find(|(known, _)| *known == name) {
            Some((_, total)) => *total += more,
            None => self.stages.push((name, more)),
        }
    }

    /// What a stage has kept \[byte\].
    pub(crate) fn of(&self, name: &str) -> u64 {
        let found = self.stages.iter().find(|(known, _)| *known == name);
        found.map_or(0, |(_, bytes)| (*bytes).max(0).cast_unsigned())
    }
}
