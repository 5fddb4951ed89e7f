//! Steps of a march of currents that are as long as their error allows.
//!
//! A step holds 1, 2, 4, 8 ... of the scene's. Its error is told from three rates, those at its start and of its two stages:
//! the parabola through them has an integral of third order, which the step misses by
//!
//! ```text
//! q = h (w0 k(0) + (w1 - 1 + gamma) k(gamma) + (w2 - gamma) k(1))
//! w0 = (gamma/2 - 1/6)/gamma    w1 = 1/(6 gamma (1 - gamma))    w2 = (1/3 - gamma/2)/(1 - gamma)
//! ```
//!
//! The rates of stages err themselves, which q does not see. Where fields decay freely, `du/dt = lambda u`, the error of a step is
//! `c h^3 d3u/dt3` and q is a fixed share of that; the error is told as q over this share:
//!
//! ```text
//! c = 1/6 - 4 gamma^3 - 3 gamma^2 (1 - 2 gamma)    share = ((w1 - 1 + gamma) gamma^2 + (w2 - gamma)/2)/c
//! ```
//!
//! Where sources alone drive the rates, that is up to seven times too much.
//!
//! A step whose error is too large is taken again, shorter; one of the scene's own length always stands.

use artefact::Checkpoint;
use run::Failure;
use steps::Strides;
use steps::control::suited;

use super::scheme::{GAMMA, March, State};
use crate::scene::currents::Adaptive as Wanted;

/// Chooses steps, in numbers of those of the scene.
pub(crate) struct Adaptive {
    strides: Strides,
    /// Error of a step over the greatest field.
    tolerance: f64,
    /// Conductivity times volume by point, up to a factor.
    weights: Vec<f64>,
    /// Unknowns of a point.
    components: usize,
    /// Longest step that the error of the last one allows \[s\].
    longest: f64,
    /// Greatest field so far, in the norm of errors.
    greatest: f64,
    /// Steps that were taken again.
    rejected: u64,
    /// The state before the step.
    before: State,
}

impl Adaptive {
    /// Steps of a march whose own are of `length` \[s\]; `weights` are those of the points in the heat, each with so many
    /// `components`.
    pub(crate) fn new(
        wanted: &Wanted,
        length: f64,
        weights: Vec<f64>,
        components: usize,
        start: &State,
    ) -> Self {
        let most = wanted.greatest_s.unwrap_or(f64::INFINITY) / length * (1.0 + 1e-9);
        let greatest = 1 << (most.clamp(1.0, f64::from(u32::MAX)) as u64).ilog2();
        let mut strides = Strides::even(1.0);
        strides.greatest = greatest;
        Self {
            strides,
            tolerance: wanted.tolerance,
            weights,
            components,
            longest: length,
            greatest: 0.0,
            rejected: 0,
            before: start.clone(),
        }
    }

    /// How many of the scene's steps of `length` \[s\] the next one holds, with `left` until the next instant. A longer one is
    /// taken only where the sources can be followed.
    ///
    /// # Errors
    /// Those of `follows`.
    pub(crate) fn stride(
        &mut self,
        left: u64,
        length: f64,
        follows: impl Fn(f64) -> Result<bool, Failure>,
    ) -> Result<u64, Failure> {
        (self.strides).choose(0, left, f64::INFINITY, self.longest / length);
        while self.strides.stride > 1 && !follows(self.strides.stride as f64 * length)? {
            self.strides.stride /= 2;
        }
        Ok(self.strides.stride)
    }

    /// Keeps what has been reached.
    pub(crate) fn keep(&mut self, march: &March<'_>) {
        self.before.clone_from(march.state());
    }

    /// Whether a step of `length` \[s\] stands; if not, the march is where it was before it.
    pub(crate) fn stands(&mut self, march: &mut March<'_>, length: f64) -> bool {
        let after = march.state();
        self.greatest = self.greatest.max(self.norm(|k| after.total[k]));
        let error = self.norm(|k| missed(&self.before, after, length, k));
        // Where there is no field yet, there is no error.
        let error = error / (self.tolerance * self.greatest).max(f64::MIN_POSITIVE);
        self.longest = suited(length, error);
        if error <= 1.0 || self.strides.stride == 1 {
            self.strides.taken += 1;
            return true;
        }
        self.rejected += 1;
        march.set_back(&self.before);
        false
    }

    /// Root of the weighted sum of squares over all unknowns of conductors.
    fn norm(&self, value: impl Fn(usize) -> f64) -> f64 {
        let squares = |(i, weight): (usize, &f64)| -> f64 {
            let own = self.components * i..self.components * (i + 1);
            weight * own.map(|k| value(k).powi(2)).sum::<f64>()
        };
        self.weights
            .iter()
            .enumerate()
            .map(squares)
            .sum::<f64>()
            .sqrt()
    }

    /// Steps taken and taken again.
    pub(crate) fn counts(&self) -> [u64; 2] {
        [self.strides.taken, self.rejected]
    }

    /// Puts all that the next steps depend on into a checkpoint.
    pub(crate) fn save(&self, rates: &[f64], checkpoint: &mut Checkpoint) {
        let Strides { stride, taken, .. } = self.strides;
        checkpoint.put_u64("strides", &[stride, taken, self.rejected]);
        checkpoint.put_f64("pace", &[self.longest, self.greatest]);
        checkpoint.put_f64("rates", rates);
    }

    /// Takes back what [`Adaptive::save`] put; gives the rates at the end of the last step.
    pub(crate) fn restore(&mut self, checkpoint: &mut Checkpoint) -> Result<Vec<f64>, Failure> {
        let (strides, pace) = (checkpoint.u64("strides")?, checkpoint.f64("pace")?);
        let (&[stride, taken, rejected], &[longest, greatest]) = (&strides[..], &pace[..]) else {
            return Err(Failure::Other("the checkpoint lacks a part".to_owned()));
        };
        (self.strides.stride, self.strides.taken) = (stride, taken);
        (self.rejected, self.longest, self.greatest) = (rejected, longest, greatest);
        Ok(checkpoint.f64("rates")?)
    }
}

/// What a step of `length` \[s\] misses of unknown `k`.
fn missed(before: &State, after: &State, length: f64, k: usize) -> f64 {
    const START: f64 = (0.5 * GAMMA - 1.0 / 6.0) / GAMMA;
    const EARLY: f64 = 1.0 / (6.0 * GAMMA * (1.0 - GAMMA)) - (1.0 - GAMMA);
    const LATE: f64 = (1.0 / 3.0 - 0.5 * GAMMA) / (1.0 - GAMMA) - GAMMA;
    const FREE: f64 =
        1.0 / 6.0 - 4.0 * GAMMA * GAMMA * GAMMA - 3.0 * GAMMA * GAMMA * (1.0 - 2.0 * GAMMA);
    const SHARE: f64 = (EARLY * GAMMA * GAMMA + 0.5 * LATE) / FREE;
    let late = length * after.change[k];
    let early = (after.total[k] - before.total[k] - GAMMA * late) / (1.0 - GAMMA);
    (START * length * before.change[k] + EARLY * early + LATE * late) / SHARE
}

#[cfg(test)]
mod tests {
    use super::*;

    fn state(total: f64, change: f64) -> State {
        State {
            unknown: vec![total],
            total: vec![total],
            change: vec![change],
            following: Vec::new(),
        }
    }

    /// What a step of `h` from 1 misses of `exp(-t)`, as it is told and as it is.
    fn decay(h: f64) -> [f64; 2] {
        let early = 1.0 / (1.0 + GAMMA * h);
        let middle = 1.0 - (1.0 - GAMMA) * h * early;
        let late = middle / (1.0 + GAMMA * h);
        let told = missed(&state(1.0, -1.0), &state(late, -late), h, 0);
        [told, (-h).exp() - late]
    }

    #[test]
    fn what_is_told_is_the_error_of_a_free_decay() {
        for [h, close] in [[0.1, 0.1], [0.01, 0.01], [0.001, 0.001]] {
            let [told, error] = decay(h);
            assert!((told / error - 1.0).abs() < close, "{h}: {told} {error}");
        }
    }

    #[test]
    fn a_parabola_misses_nothing() {
        // total = t^2 with its own rates: the step is exact where its weights are.
        let h = 0.3;
        let [start, early, late] = [0.0, 2.0 * GAMMA * h, 2.0 * h];
        let end = h * ((1.0 - GAMMA) * early + GAMMA * late);
        let told = missed(&state(0.0, start), &state(end, late), h, 0);
        assert!(told.abs() < 1e-15, "{told}");
    }
}
