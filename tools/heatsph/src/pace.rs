//! What of a march changes from step to step, beside its state; both are kept in checkpoints.

use artefact::Checkpoint;
use run::{Failure, Session};

use crate::march::choice::Steps;
use crate::march::{Method, State};
use crate::system::System;

/// Error of a step, over the range of temperature, from which on what it ends at is told to be off.
const ROUGH: f64 = 0.01;

/// Errors of steps in a row, over that of one.
const MANY: f64 = 10.0;

/// What of the march changes from step to step.
#[derive(Debug, Clone, PartialEq)]
pub struct Pace {
    /// Steps taken.
    pub steps: u64,
    /// Steps refused by their error.
    pub rejected: u64,
    /// The next step \[s\].
    pub step: f64,
    /// Range of temperature so far \[K\].
    pub range: f64,
    /// Number of the next output.
    pub next: usize,
    /// Least explicit limit met \[s\].
    pub limit: f64,
    /// Greatest and least step \[s\].
    pub taken: [f64; 2],
    /// Whether steps had to be divided.
    pub substepped: bool,
    /// Estimated error of the last step \[K\].
    pub error: f64,
    /// Instants that were written after a rough step, the greatest error of these over the range of temperature, and its instant \[s\].
    rough: [f64; 3],
}

impl Default for Pace {
    fn default() -> Self {
        Self {
            steps: 0,
            rejected: 0,
            step: 0.0,
            range: 0.0,
            next: 0,
            limit: f64::INFINITY,
            taken: [0.0, f64::INFINITY],
            substepped: false,
            error: 0.0,
            rough: [0.0; 3],
        }
    }
}

impl Pace {
    /// Takes the estimated error of a step; what is below `nothing` is none \[K\].
    pub fn erred(&mut self, error: f64, nothing: f64) {
        self.error = if error > nothing { error } else { 0.0 };
    }

    /// By how much temperatures may be off after many steps, as far as they are told \[K\].
    #[must_use]
    pub fn strays(&self, steps: Steps) -> f64 {
        let part = match steps {
            Steps::Controlled { tolerance, .. } => (MANY * tolerance).max(ROUGH),
            _ => ROUGH,
        };
        part * self.range
    }

    /// Marks an instant \[s\] that is written, and its least temperature \[K\]: what is below 0 K is an error too.
    pub fn mark(&mut self, time: f64, low: f64) {
        let share = self.error.max(-low) / self.range.max(f64::MIN_POSITIVE);
        if share > ROUGH {
            let [count, worst, at] = self.rough;
            let [worst, at] = if share > worst {
                [share, time]
            } else {
                [worst, at]
            };
            self.rough = [count + 1.0, worst, at];
        }
    }

    /// Tells instants that were written after steps which err.
    pub fn tell(&self, session: &mut Session) {
        let [count, _, at] = self.rough;
        if count > 0.0 {
            session.warn(format!(
                "what is written at {count} instants follows steps that err by more than {:.0} % of the range of temperature as \
                 estimated, most at {at:.4e} s: take a shorter \"step_s\", or none, so that the error chooses the steps, or a \
                 smaller \"tolerance\"",
                100.0 * ROUGH
            ));
        }
    }

    /// Puts all that the rest of a march depends on into a checkpoint.
    ///
    /// # Errors
    /// None: the signature is that of [`run::Session::keep`].
    pub fn save(
        &self,
        state: &State,
        method: &dyn Method,
        checkpoint: &mut Checkpoint,
    ) -> artefact::Result<()> {
        checkpoint.put_f64("time", &[state.time, state.source]);
        checkpoint.put_f64("temperature", &state.temperature);
        if !state.heat.is_empty() {
            checkpoint.put_f64("heat", &state.heat);
        }
        checkpoint.put_f64("entries", &state.entries);
        let [most, least] = self.taken;
        checkpoint.put_f64("pace", &[self.step, self.range, self.limit, most, least]);
        let [count, worst, at] = self.rough;
        checkpoint.put_f64("errors", &[self.error, count, worst, at]);
        let done: Vec<f64> = method.report().iter().map(|(_, n)| *n).collect();
        checkpoint.put_f64("method", &done);
        let flag = u64::from(self.substepped);
        checkpoint.put_u64(
            "count",
            &[self.steps, self.rejected, self.next as u64, flag],
        );
        Ok(())
    }

    /// Takes back what [`Pace::save`] put.
    ///
    /// # Errors
    /// When the checkpoint lacks a part.
    pub fn restore(
        checkpoint: &mut Checkpoint,
        system: &System,
        method: &mut dyn Method,
    ) -> Result<(Self, State), Failure> {
        let (time, pace, count) = (
            checkpoint.f64("time")?,
            checkpoint.f64("pace")?,
            checkpoint.u64("count")?,
        );
        let temperature = checkpoint.f64("temperature")?;
        let heat = match system.storage.varies() {
            Some(_) => checkpoint.f64("heat")?,
            None => Vec::new(),
        };
        let (entries, errors) = (checkpoint.f64("entries")?, checkpoint.f64("errors")?);
        method.count_from(&checkpoint.f64("method")?);
        let (
            &[time, source],
            &[step, range, limit, most, least],
            &[steps, rejected, next, substepped],
            &[error, instants, worst, at],
        ) = (&time[..], &pace[..], &count[..], &errors[..])
        else {
            return Err(Failure::Other("the checkpoint lacks a part".to_owned()));
        };
        let pace = Self {
            steps,
            rejected,
            step,
            range,
            next: next as usize,
            limit,
            taken: [most, least],
            substepped: substepped > 0,
            error,
            rough: [instants, worst, at],
        };
        let state = State {
            time,
            temperature,
            heat,
            entries,
            source,
        };
        Ok((pace, state))
    }
}
