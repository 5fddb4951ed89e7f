//! What steps of a march miss, told by modes that decay at all rates a conductor can have.
//!
//! A conductor without motion is a sum of modes, each of which follows the wave of the sources at a rate of its own:
//!
//! ```text
//! du/dt = -lambda (u - wave)      lambda >= 1/(mu sigma D^2)
//! ```
//!
//! with the greatest extent D of all conductors: what is larger decays more slowly (Rayleigh's quotient), and a ball of that
//! diameter decays 39 times as fast. The scheme takes each mode as it takes the field, step by step, beside its exact course. What it misses of the
//! worst mode, over the greatest value of the wave, bounds the error of the potential in the norm of the heat, whatever the shape.

use artefact::Checkpoint;
use run::{Failure, Session};

use super::scheme::GAMMA;
use super::wave::Wave;

/// Modes over a decade of rates.
const DECADE: f64 = 8.0;
/// Rates times the first step from which on steps make no error: the scheme damps what is stiff.
const STIFF: f64 = 1e3;
/// Part of the greatest value of the wave by which fields that are written may miss.
const MISSED: f64 = 0.03;

/// Modes of a march, beside their exact course.
pub(crate) struct Modes {
    /// Their rates \[1/s\].
    rates: Vec<f64>,
    /// What the scheme has reached.
    stepped: Vec<f64>,
    /// What they would be.
    exact: Vec<f64>,
    /// Greatest value of the wave so far.
    greatest: f64,
    /// What is worst of all instants that are written, its time \[s\], and how many are as bad as to be told.
    worst: [f64; 3],
}

impl Modes {
    /// Modes at rest, from the slowest rate \[1/s\] on, of a march of `length` \[s\] a step until `end` \[s\].
    pub(crate) fn new(slowest: f64, length: f64, end: f64) -> Self {
        let first = slowest.max(1e-2 / end).log10();
        let last = (STIFF / length).log10();
        let count = (DECADE * (last - first)).ceil().max(0.0) as usize;
        let rates: Vec<f64> = (0..count)
            .map(|k| 10_f64.powf(first + k as f64 / DECADE))
            .collect();
        Self {
            stepped: vec![0.0; count],
            exact: vec![0.0; count],
            greatest: 0.0,
            worst: [0.0; 3],
            rates,
        }
    }

    /// Takes a step of `length` \[s\] that begins at `from` \[s\].
    ///
    /// # Errors
    /// Where the wave has no value.
    pub(crate) fn step(&mut self, from: f64, length: f64, wave: &Wave) -> Result<(), Failure> {
        let [early, late] = [wave.at(from + GAMMA * length)?, wave.at(from + length)?];
        for (u, rate) in self.stepped.iter_mut().zip(&self.rates) {
            let damped = 1.0 / (1.0 + GAMMA * rate * length);
            let first = -rate * (*u - early) * damped;
            let second = -rate * (*u + (1.0 - GAMMA) * length * first - late) * damped;
            *u += length * ((1.0 - GAMMA) * first + GAMMA * second);
        }
        let parts = wave.lines(from, length)?;
        let part = length / (parts.len() - 1) as f64;
        for ends in parts.windows(2) {
            let (start, end) = (ends[0], ends[1]);
            self.greatest = self.greatest.max(start.abs()).max(end.abs());
            for (u, rate) in self.exact.iter_mut().zip(&self.rates) {
                *u = along(*u, [start, end], rate * part);
            }
        }
        Ok(())
    }

    /// Takes in that fields are written at an instant \[s\].
    pub(crate) fn written(&mut self, time: f64) {
        if self.greatest == 0.0 {
            return;
        }
        let pairs = self.stepped.iter().zip(&self.exact);
        let off = pairs.fold(0.0_f64, |most, (u, exact)| most.max((u - exact).abs()));
        let off = off / self.greatest;
        if off > self.worst[0] {
            (self.worst[0], self.worst[1]) = (off, time);
        }
        self.worst[2] += f64::from(u8::from(off > MISSED));
    }

    /// Tells what the steps missed.
    pub(crate) fn tell(&self, longest: f64, session: &mut Session) {
        let [worst, time, count] = self.worst;
        session.closing("error_steps", "1", worst);
        if count > 0.0 {
            session.warn(format!(
                "unresolved: at {count} instants that are written, fields follow what drives them in too few steps of up to \
                 {longest:.3e} s since it changed: they may be off by {:.1} % of their greatest value, at {time:.4e} s; take a \
                 smaller 'step_s', or write later",
                100.0 * worst
            ));
        }
    }

    /// Puts all that the next steps depend on into a checkpoint.
    pub(crate) fn save(&self, checkpoint: &mut Checkpoint) {
        checkpoint.put_f64("modes", &[&self.stepped[..], &self.exact[..]].concat());
        let [worst, time, count] = self.worst;
        checkpoint.put_f64("missed", &[self.greatest, worst, time, count]);
    }

    /// Takes back what [`Modes::save`] put.
    ///
    /// # Errors
    /// Where the checkpoint lacks it.
    pub(crate) fn restore(&mut self, checkpoint: &mut Checkpoint) -> Result<(), Failure> {
        let (modes, missed) = (checkpoint.f64("modes")?, checkpoint.f64("missed")?);
        let &[greatest, worst, time, count] = &missed[..] else {
            return Err(lacks());
        };
        if modes.len() != 2 * self.rates.len() {
            return Err(lacks());
        }
        let (stepped, exact) = modes.split_at(self.rates.len());
        (self.stepped, self.exact) = (stepped.to_vec(), exact.to_vec());
        (self.greatest, self.worst) = (greatest, [worst, time, count]);
        Ok(())
    }
}

fn lacks() -> Failure {
    Failure::Other("the checkpoint lacks a part of \"modes\"".to_owned())
}

/// `u` after a time in which the wave goes along a line, over which the mode decays by exp(-z):
///
/// ```text
/// u = w1 - s/z + (u0 - w0 + s/z) exp(-z)      s = w1 - w0
/// ```
fn along(u: f64, wave: [f64; 2], z: f64) -> f64 {
    let left = u - wave[0];
    // (1 - exp(-z))/z, without a difference of what is alike.
    let mean = if z == 0.0 { 1.0 } else { -(-z).exp_m1() / z };
    wave[1] + left * (-z).exp() - (wave[1] - wave[0]) * mean
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test may fail")]
mod tests {
    use super::*;
    use crate::scene::Output;
    use crate::scene::currents::Transient;

    /// What is missed at the end of so many steps of 1 s, of a wave of `expr`.
    fn missed(expr: &str, steps: u32) -> f64 {
        let transient = Transient {
            end_s: f64::from(steps),
            step_s: 1.0,
            wave: serde_json::from_str(&format!(r#"{{"expr": "{expr}"}}"#)).unwrap(),
            adaptive: None,
        };
        let wave = Wave::new(&transient, &transient.steps(&Output::default())).unwrap();
        let mut modes = Modes::new(0.0, 1.0, f64::from(steps));
        for step in 0..steps {
            modes.step(f64::from(step), 1.0, &wave).unwrap();
        }
        modes.written(f64::from(steps));
        modes.worst[0]
    }

    #[test]
    fn a_switch_is_missed_by_the_stability_function_less_the_exponential() {
        // R(-z) = (1 - (1 - 2 gamma) z)/(1 + gamma z)^2 of the method (Alexander 1977).
        for steps in [1, 2, 3, 5] {
            let z = |k: i32| 10_f64.powf(-3.0 + f64::from(k) / 200.0);
            let ratio = |z: f64| (1.0 - (1.0 - 2.0 * GAMMA) * z) / (1.0 + GAMMA * z).powi(2);
            let off = |z: f64| (ratio(z).powi(steps) - (-f64::from(steps) * z).exp()).abs();
            let most = (0..1200).map(|k| off(z(k))).fold(0.0, f64::max);
            let told = missed("1", steps as u32);
            assert!((told / most - 1.0).abs() < 0.02, "{steps}: {told} {most}");
        }
    }

    #[test]
    fn a_mode_follows_a_line_exactly() {
        // du/dt = -(u - t) from 1: u = t - 1 + 2 exp(-t), whatever the parts.
        let exact = |t: f64| t - 1.0 + 2.0 * (-t).exp();
        let halfway = along(1.0, [0.0, 0.5], 0.5);
        assert!((halfway - exact(0.5)).abs() < 1e-15);
        assert!((along(halfway, [0.5, 1.0], 0.5) - exact(1.0)).abs() < 1e-15);
        assert!((along(1.0, [2.0, 3.0], 0.0) - 1.0).abs() < 1e-15);
    }
}
