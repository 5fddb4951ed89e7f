//! The steps of a march: even ones between the instants that are asked for.

use crate::scene::Output;
use crate::scene::currents::Transient;

/// Part of a step, or of an instant, that counts as rounding.
const ROUNDING: f64 = 1e-6;

/// Even steps from one instant to the next.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Leg {
    from: f64,
    to: f64,
    /// Steps before it.
    before: u64,
    count: u64,
    /// Of a step; that of the leg before where the two are the same but for rounding.
    length: f64,
}

/// Steps of at most the length that the scene asks for, even from each instant of a frame to the next.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Steps {
    legs: Vec<Leg>,
}

impl Steps {
    pub(crate) fn new(transient: &Transient, output: &Output) -> Self {
        let mut legs: Vec<Leg> = Vec::new();
        for to in instants(transient.end_s, output) {
            let last = legs.last();
            let from = last.map_or(0.0, |l| l.to);
            let wanted = (to - from) / transient.step_s;
            let count = (wanted * (1.0 - ROUNDING)).ceil().max(1.0);
            let own = (to - from) / count;
            let even = last.filter(|l| (l.length - own).abs() <= ROUNDING * own);
            legs.push(Leg {
                from,
                to,
                before: last.map_or(0, |l| l.before + l.count),
                count: count as u64,
                length: even.map_or(own, |l| l.length),
            });
        }
        Self { legs }
    }

    /// Steps in all.
    pub(crate) fn count(&self) -> u64 {
        self.legs.last().map_or(0, |l| l.before + l.count)
    }

    /// Frames after the start.
    pub(crate) fn frames(&self) -> u64 {
        self.legs.len() as u64
    }

    fn leg(&self, step: u64) -> &Leg {
        let after = self.legs.partition_point(|l| l.before <= step);
        &self.legs[after - 1]
    }

    /// Start and length of the step after so many \[s\].
    pub(crate) fn step(&self, taken: u64) -> (f64, f64) {
        let leg = self.leg(taken);
        let part = (taken - leg.before) as f64 / leg.count as f64;
        (leg.from + part * (leg.to - leg.from), leg.length)
    }

    /// The instant after so many steps, at least one \[s\], and whether fields are written there.
    pub(crate) fn end(&self, taken: u64) -> (f64, bool) {
        let leg = self.leg(taken - 1);
        if taken == leg.before + leg.count {
            (leg.to, true)
        } else {
            (self.step(taken).0, false)
        }
    }

    /// The longest step \[s\].
    pub(crate) fn longest(&self) -> f64 {
        self.legs.iter().map(|l| l.length).fold(0.0, f64::max)
    }
}

/// Instants of frames after the start, rising, the end last.
fn instants(end: f64, output: &Output) -> Vec<f64> {
    let near = |a: f64, b: f64| (a - b).abs() <= 1e-9 * end;
    let mut all = output.at_s.clone();
    if let Some(every) = output.every_s {
        let count = (end / every * (1.0 + 1e-12)).floor() as u64;
        all.extend((1..=count).map(|n| n as f64 * every));
    }
    all.retain(|t| !near(*t, 0.0) && !near(*t, end));
    all.push(end);
    all.sort_by(f64::total_cmp);
    all.dedup_by(|later, kept| near(*later, *kept));
    all
}

#[cfg(test)]
#[allow(clippy::float_cmp, reason = "instants are met exactly")]
mod tests {
    use super::*;

    fn steps(step_s: f64, every_s: Option<f64>, at_s: &[f64]) -> Steps {
        let transient = Transient {
            end_s: 1.0,
            step_s,
            wave: None,
        };
        let output = Output {
            every_s,
            at_s: at_s.to_vec(),
            ..Output::default()
        };
        Steps::new(&transient, &output)
    }

    #[test]
    fn steps_are_even_where_frames_fit_them() {
        let all = steps(0.1, Some(0.3), &[]);
        assert_eq!(all.count(), 10);
        let lengths: Vec<f64> = (0..10).map(|n| all.step(n).1).collect();
        assert!(lengths.iter().all(|l| *l == lengths[0]));
        let written: Vec<u64> = (1..=10).filter(|n| all.end(*n).1).collect();
        assert_eq!(written, [3, 6, 9, 10]);
        assert_eq!(all.end(10).0, 1.0);
    }

    #[test]
    fn frames_come_at_the_very_instants() {
        let all = steps(0.1, None, &[0.0, 0.05, 0.33, 1.0]);
        let written: Vec<f64> = (1..=all.count())
            .map(|n| all.end(n))
            .filter(|e| e.1)
            .map(|e| e.0)
            .collect();
        assert_eq!(written, [0.05, 0.33, 1.0]);
        assert!(all.longest() <= 0.1);
        let mut now = 0.0;
        for n in 0..all.count() {
            let (from, length) = all.step(n);
            assert!((from - now).abs() < 1e-12);
            now = from + length;
            assert!((all.end(n + 1).0 - now).abs() < 1e-12);
        }
    }
}
