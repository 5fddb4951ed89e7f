//! Steps that are all known before the first: even ones between the instants that are asked for.

use crate::even::{ROUNDING, parts};

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

/// Steps of at most a given length, even from each instant to the next.
#[derive(Debug, Clone, PartialEq)]
pub struct Legs {
    legs: Vec<Leg>,
}

impl Legs {
    /// Steps of at most `longest` \[s\] from 0 to each of the instants \[s\], which rise.
    #[must_use]
    pub fn new(longest: f64, instants: impl IntoIterator<Item = f64>) -> Self {
        let mut legs: Vec<Leg> = Vec::new();
        for to in instants {
            let last = legs.last();
            let from = last.map_or(0.0, |l| l.to);
            let count = parts(to - from, longest);
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
    #[must_use]
    pub fn count(&self) -> u64 {
        self.legs.last().map_or(0, |l| l.before + l.count)
    }

    /// Instants that are met.
    #[must_use]
    pub fn instants(&self) -> u64 {
        self.legs.len() as u64
    }

    fn leg(&self, step: u64) -> &Leg {
        let after = self.legs.partition_point(|l| l.before <= step);
        &self.legs[after - 1]
    }

    /// Start and length of the step after so many \[s\].
    #[must_use]
    pub fn step(&self, taken: u64) -> (f64, f64) {
        let leg = self.leg(taken);
        let part = (taken - leg.before) as f64 / leg.count as f64;
        (leg.from + part * (leg.to - leg.from), leg.length)
    }

    /// The end of the last of so many steps, at least one \[s\], and whether that is one of the instants.
    #[must_use]
    pub fn end(&self, taken: u64) -> (f64, bool) {
        let leg = self.leg(taken - 1);
        if taken == leg.before + leg.count {
            (leg.to, true)
        } else {
            (self.step(taken).0, false)
        }
    }

    /// Steps after so many until the next instant.
    #[must_use]
    pub fn left(&self, taken: u64) -> u64 {
        let leg = self.leg(taken);
        leg.before + leg.count - taken
    }

    /// The longest step \[s\].
    #[must_use]
    pub fn longest(&self) -> f64 {
        self.legs.iter().map(|l| l.length).fold(0.0, f64::max)
    }
}

#[cfg(test)]
#[allow(clippy::float_cmp, reason = "instants are met exactly")]
mod tests {
    use super::*;

    #[test]
    fn steps_are_even_where_instants_fit_them() {
        let all = Legs::new(0.1, [0.3, 0.6, 0.9, 1.0]);
        assert_eq!(all.count(), 10);
        let lengths: Vec<f64> = (0..10).map(|n| all.step(n).1).collect();
        assert!(lengths.iter().all(|l| *l == lengths[0]));
        let met: Vec<u64> = (1..=10).filter(|n| all.end(*n).1).collect();
        assert_eq!(met, [3, 6, 9, 10]);
        assert_eq!([all.left(0), all.left(4), all.left(9)], [3, 2, 1]);
        assert_eq!(all.end(10).0, 1.0);
    }

    #[test]
    fn the_very_instants_are_met() {
        let all = Legs::new(0.1, [0.05, 0.33, 1.0]);
        let met: Vec<f64> = (1..=all.count())
            .map(|n| all.end(n))
            .filter(|e| e.1)
            .map(|e| e.0)
            .collect();
        assert_eq!(met, [0.05, 0.33, 1.0]);
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
