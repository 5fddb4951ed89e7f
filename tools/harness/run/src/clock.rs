//! Wall time per stage.

use std::time::{Duration, Instant};

/// Wall time of the run and of each of its stages.
#[derive(Debug)]
pub(crate) struct Clock {
    start: Instant,
    stages: Vec<(String, Duration)>,
}

impl Clock {
    /// A clock that has run since `start`.
    pub(crate) fn since(start: Instant) -> Self {
        Self {
            start,
            stages: Vec::new(),
        }
    }

    /// Wall time of this process \[s\].
    pub(crate) fn elapsed_s(&self) -> f64 {
        self.start.elapsed().as_secs_f64()
    }

    pub(crate) fn add(&mut self, name: &str, spent: Duration) {
        match self.stages.iter_mut().find(|(known, _)| known == name) {
            Some((_, total)) => *total += spent,
            None => self.stages.push((name.to_owned(), spent)),
        }
    }

    /// Takes up the times of earlier processes.
    pub(crate) fn take_up(&mut self, earlier: &[(String, f64)]) {
        for (name, seconds) in earlier {
            self.add(
                name,
                Duration::try_from_secs_f64(*seconds).unwrap_or_default(),
            );
        }
    }

    /// Seconds of each stage in order of first use.
    pub(crate) fn stages(&self) -> Vec<(String, f64)> {
        self.stages
            .iter()
            .map(|(name, spent)| (name.clone(), spent.as_secs_f64()))
            .collect()
    }
}
