//! Times of short runs: repeated in turns until the median can be trusted.
//!
//! The first run of each method is the one whose errors are measured; its repeats must write the
//! same bytes, which proves on the way that the program is deterministic.

use crate::lab::{Finished, Lab, LabError};

/// Runs shorter than this are repeated \[s\].
const SHORT_S: f64 = 2.0;
/// Fewest and most runs of what is repeated; odd, so that the median is one of them.
const REPEATS: [usize; 2] = [3, 9];

/// The runs of one measurement and their times so far.
#[derive(Debug)]
pub(crate) struct Repeated {
    runs: Vec<Finished>,
    solver_s: Vec<f64>,
    process_s: Vec<f64>,
}

/// The middle and the ends of a list of times \[s\].
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Spread {
    pub(crate) median: f64,
    pub(crate) least: f64,
    pub(crate) greatest: f64,
}

impl Spread {
    /// Of an odd number of times; of an even number the upper middle.
    pub(crate) fn of(times: &[f64]) -> Self {
        let mut sorted = times.to_vec();
        sorted.sort_by(f64::total_cmp);
        let at = |i: usize| sorted.get(i).copied().unwrap_or(f64::NAN);
        Self {
            median: at(sorted.len() / 2),
            least: at(0),
            greatest: at(sorted.len().saturating_sub(1)),
        }
    }
}

impl Repeated {
    /// What has been run once.
    ///
    /// # Errors
    /// When a run record tells no time.
    pub(crate) fn first(runs: Vec<Finished>) -> Result<Self, LabError> {
        let mut all = Self {
            solver_s: Vec::new(),
            process_s: Vec::new(),
            runs,
        };
        all.add(&all.runs.clone())?;
        Ok(all)
    }

    fn add(&mut self, runs: &[Finished]) -> Result<(), LabError> {
        let mut solver = 0.0;
        for run in runs {
            solver += run.solver_s()?;
        }
        self.solver_s.push(solver);
        self.process_s.push(runs.iter().map(|r| r.process_s).sum());
        Ok(())
    }

    /// Runs everything once more.
    ///
    /// # Errors
    /// When a run fails or writes other bytes than the first time.
    pub(crate) fn again(&mut self, lab: &Lab) -> Result<(), LabError> {
        let runs = self.runs.iter().map(|run| lab.again(run));
        let runs = runs.collect::<Result<Vec<_>, _>>()?;
        self.add(&runs)
    }

    /// How often this should be run within `budget_s` seconds.
    fn wanted(&self, budget_s: f64) -> usize {
        if !self.runs.iter().all(Finished::repeatable) {
            return 1;
        }
        repeats(self.process_s.first().copied().unwrap_or(0.0), budget_s)
    }

    pub(crate) fn solver(&self) -> Spread {
        Spread::of(&self.solver_s)
    }

    pub(crate) fn process(&self) -> Spread {
        Spread::of(&self.process_s)
    }

    pub(crate) fn count(&self) -> usize {
        self.solver_s.len()
    }

    pub(crate) fn runs(&self) -> &[Finished] {
        &self.runs
    }
}

/// An odd number of runs of `once_s` seconds each: once where it is long or no budget is given.
fn repeats(once_s: f64, budget_s: f64) -> usize {
    let [least, most] = REPEATS;
    if once_s >= SHORT_S || budget_s <= 0.0 {
        return 1;
    }
    // A saturating cast: a run of no time at all fits any number of times.
    let fits = (budget_s / once_s) as usize;
    let fits = fits.clamp(least, most);
    fits - usize::from(fits.is_multiple_of(2))
}

/// Repeats all of `batch` within the budget of `lab`, in turns: a machine that slows down slows all
/// of them alike.
///
/// # Errors
/// When a run fails or writes other bytes than the first time.
pub(crate) fn in_turns(lab: &Lab, batch: &mut [Repeated]) -> Result<(), LabError> {
    for turn in 1..REPEATS[1] {
        for one in batch.iter_mut() {
            if turn < one.wanted(lab.repeat_s) {
                one.again(lab)?;
            }
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn short_runs_are_repeated_an_odd_number_of_times() {
        assert_eq!(repeats(0.0, 3.0), 9);
        assert_eq!(repeats(0.01, 3.0), 9);
        assert_eq!(repeats(0.5, 3.0), 5);
        assert_eq!(repeats(1.9, 3.0), 3);
        assert_eq!(repeats(2.0, 3.0), 1);
        assert_eq!(repeats(0.01, 0.0), 1);
    }

    #[test]
    fn the_median_is_one_of_the_times() {
        let spread = Spread::of(&[3.0, 1.0, 9.0, 2.0, 2.5]);
        let expected = Spread {
            median: 2.5,
            least: 1.0,
            greatest: 9.0,
        };
        assert_eq!(spread, expected);
    }
}
