//! What of a march changes from step to step, beside its state; both are kept in checkpoints.

use artefact::Checkpoint;
use run::Failure;

use crate::march::{Method, State};
use crate::system::System;

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
        }
    }
}

impl Pace {
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
        let entries = checkpoint.f64("entries")?;
        method.count_from(&checkpoint.f64("method")?);
        let (
            &[time, source],
            &[step, range, limit, most, least],
            &[steps, rejected, next, substepped],
        ) = (&time[..], &pace[..], &count[..])
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
