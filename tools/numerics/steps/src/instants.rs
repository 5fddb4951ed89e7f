//! Instants at which something is due: typed ones, and multiples of an interval, by time or by steps of one length.

use crate::even::ROUNDING;

/// Instants that are nearer to each other than this part of the whole time are one.
const SAME: f64 = 1e-9;

/// An instant at which something is due.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Instant {
    /// When \[s\].
    pub time: f64,
    /// Whether all is due, and not only what is small.
    pub whole: bool,
}

impl Instant {
    /// An instant at which all is due.
    #[must_use]
    pub fn whole(time: f64) -> Self {
        Self { time, whole: true }
    }
}

/// The multiples of `interval` \[s\] up to `end` \[s\], without zero.
pub fn every(interval: f64, end: f64) -> impl Iterator<Item = f64> {
    let count = (end / interval * (1.0 + 1e-12)).floor() as u64;
    (1..=count).map(move |n| n as f64 * interval)
}

/// All in rising order, each once, with the start and the `end` \[s\], at which all is due. Those that are `one` to a file are one.
#[must_use]
pub fn merged(mut all: Vec<Instant>, end: f64, one: impl Fn(f64, f64) -> bool) -> Vec<Instant> {
    all.splice(0..0, [Instant::whole(0.0), Instant::whole(end)]);
    all.sort_by(|a, b| a.time.total_cmp(&b.time));
    let near = |a: f64, b: f64| (a - b).abs() <= SAME * end || one(a, b);
    let mut merged: Vec<Instant> = Vec::new();
    for instant in all {
        match merged.last_mut() {
            Some(last) if near(last.time, instant.time) => {
                last.whole |= instant.whole;
                // The end is the end, whatever a multiple of the interval rounds to.
                if near(end, instant.time) {
                    last.time = end;
                }
            }
            _ => merged.push(instant),
        }
    }
    merged
}

/// The first multiple of `interval` \[s\] after `time` \[s\], or `end` \[s\] where that comes before it. Times that are nearer to a
/// multiple than a millionth of the interval are at it.
#[must_use]
pub fn after(time: f64, interval: f64, end: f64) -> f64 {
    let next = interval * ((time / interval + ROUNDING).floor() + 1.0);
    if next < end - ROUNDING * interval {
        next
    } else {
        end
    }
}

/// Whether `time` \[s\] is a multiple of `interval` \[s\].
#[must_use]
pub fn is_at(time: f64, interval: f64) -> bool {
    let turn = time / interval;
    (turn - turn.round()).abs() < ROUNDING
}

/// Multiples of `interval` \[s\] from 0 to `end` \[s\].
#[must_use]
pub fn count(end: f64, interval: f64) -> u64 {
    (end / interval + ROUNDING).floor() as u64 + 1
}

/// Whether something that is due every `interval` \[s\] is due at `step` of length `dt` \[s\]: at
/// the step nearest to each of its times.
#[must_use]
pub fn due(step: u64, dt: f64, interval: f64) -> bool {
    let turn = (step as f64 * dt / interval).round();
    nearest(turn, dt, interval) == step
}

/// The first step after `step` at which it is due.
#[must_use]
pub fn next_due(step: u64, dt: f64, interval: f64) -> u64 {
    if interval <= dt {
        return step + 1;
    }
    let mut turn = (step as f64 * dt / interval).floor();
    loop {
        let next = nearest(turn, dt, interval);
        if next > step {
            return next;
        }
        turn += 1.0;
    }
}

/// The step nearest to the time of a turn.
fn nearest(turn: f64, dt: f64, interval: f64) -> u64 {
    // Half a step rounds up, whatever the rounding of the quotient.
    (turn * interval / dt + 0.5 + 1e-6).floor() as u64
}

#[cfg(test)]
#[allow(clippy::float_cmp, reason = "instants are met exactly")]
mod tests {
    use super::*;

    #[test]
    fn instants_rise_and_each_comes_once() {
        let frames = every(0.3, 1.0).map(Instant::whole);
        let small = every(0.1, 1.0).map(|time| Instant { time, whole: false });
        let all = merged(frames.chain(small).collect(), 1.0, |_, _| false);
        assert_eq!(all.len(), 11);
        assert!(all.windows(2).all(|pair| pair[0].time < pair[1].time));
        let whole: Vec<usize> = (0..11).filter(|n| all[*n].whole).collect();
        assert_eq!(whole, [0, 3, 6, 9, 10]);
        assert_eq!(all[10].time, 1.0);
    }

    #[test]
    fn what_is_typed_at_start_and_end_is_no_instant_more() {
        let typed = [0.0, 0.5, 0.6, 1.0 + 1e-13].map(Instant::whole);
        let times = |one: fn(f64, f64) -> bool| -> Vec<f64> {
            let all = merged(typed.to_vec(), 1.0, one);
            all.iter().map(|i| i.time).collect()
        };
        assert_eq!(times(|_, _| false), [0.0, 0.5, 0.6, 1.0]);
        assert_eq!(times(|a, b| (a - b).abs() < 0.2), [0.0, 0.5, 1.0]);
    }

    #[test]
    fn the_end_comes_once_whatever_a_multiple_rounds_to() {
        // 3 times 0.7 is less than 2.1, and 3 times 0.1 is more than 0.3.
        assert_eq!(after(1.4, 0.7, 2.1), 2.1);
        assert_eq!(after(0.2, 0.1, 0.3), 0.3);
        assert_eq!(after(0.0, 0.5, 0.3), 0.3);
        assert_eq!(after(0.5, 0.5, 2.0), 1.0);
    }

    #[test]
    fn eight_frames_in_each_hundred_steps() {
        let steps: Vec<u64> = (0..200).filter(|s| due(*s, 1e-4, 1.25e-3)).collect();
        assert_eq!(steps[..8], [0, 13, 25, 38, 50, 63, 75, 88]);
        assert_eq!(steps[8..], [100, 113, 125, 138, 150, 163, 175, 188]);
        assert_eq!((0..=100_000).filter(|s| due(*s, 1e-4, 0.1)).count(), 101);
        assert_eq!((0..10).filter(|s| due(*s, 1e-4, 1e-5)).count(), 10);
    }

    #[test]
    fn the_next_one_is_the_first_that_is_due() {
        for interval in [1.25e-3, 1e-4, 3.7e-5, 1e-20, 0.02, 1.0 / 3.0] {
            let mut next = next_due(0, 1e-4, interval);
            for step in 1..20_000 {
                // Of intervals shorter than a step, turns between two steps are passed over.
                if due(step, 1e-4, interval) {
                    assert_eq!(step, next, "{interval}");
                    next = next_due(step, 1e-4, interval);
                }
            }
        }
    }
}
