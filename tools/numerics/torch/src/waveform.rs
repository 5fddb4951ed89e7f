//! A level over time that comes again and again: pulses, alternating currents.
//!
//! ```text
//! w(t) = w_k + (w_{k+1} - w_k) (s - s_k)/(s_{k+1} - s_k),     s = (t - t_0) mod T
//! ```
//!
//! It is straight between its corners, and jumps where two have the same time. Before the first corner of a period and after
//! the last it keeps their levels. Means over time are integrals, so that no pulse is missed by long steps.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::misfit::Misfit;

/// Instants nearer to a corner than this part of the time, or of the period, are that corner.
const NEAR: f64 = 8.0 * f64::EPSILON;

/// Levels over the time of a period, again and again.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Waveform {
    /// Length of a period \[s\].
    #[schemars(range(min = 1e-9), extend("x-unit" = "s"))]
    pub period_s: f64,
    /// Corners within the period \[s\], rising; two at the same time are a jump.
    #[schemars(extend("x-unit" = "s"), length(min = 1, max = 10000), inner(range(min = 0.0)))]
    pub times_s: Vec<f64>,
    /// Levels at the corners: factors on the quantity that has the waveform.
    #[schemars(extend("x-unit" = "1"), length(min = 1, max = 10000), inner(range(min = 0.0)))]
    pub levels: Vec<f64>,
    /// When a period begins \[s\].
    #[serde(default)]
    #[schemars(range(min = -1e6, max = 1e6), extend("x-unit" = "s"))]
    pub start_s: f64,
}

impl Waveform {
    /// What a schema cannot tell of it.
    #[must_use]
    pub fn misfit(&self) -> Option<Misfit> {
        let told = |path: &str, what| {
            let path = path.to_owned();
            Some(Misfit { path, what })
        };
        let [times, levels] = [&self.times_s, &self.levels].map(Vec::len);
        if times != levels {
            let what = format!("are {levels} for {times} times: give one level for each time");
            return told("/levels", what);
        }
        if let Some(pair) = self.times_s.windows(2).find(|pair| pair[1] < pair[0]) {
            let what = format!("must rise, but {} s comes after {} s", pair[1], pair[0]);
            return told("/times_s", what);
        }
        if let Some(late) = self.times_s.iter().find(|t| **t > self.period_s) {
            let what = format!(
                "{late} s is after the end of a period of {} s",
                self.period_s
            );
            return told("/times_s", what);
        }
        None
    }

    /// The level at a time \[s\]; at a jump that after it.
    #[must_use]
    pub fn at(&self, time: f64) -> f64 {
        let since = (time - self.start_s).rem_euclid(self.period_s);
        let next = self.times_s.partition_point(|t| *t <= since);
        match (next.checked_sub(1), self.times_s.get(next)) {
            (Some(last), Some(to)) => {
                let part = (since - self.times_s[last]) / (to - self.times_s[last]);
                self.levels[last] + part * (self.levels[next] - self.levels[last])
            }
            (Some(last), None) => self.levels[last],
            (None, _) => self.levels[0],
        }
    }

    /// The mean between two times \[s\]; the level where they are one.
    #[must_use]
    pub fn mean(&self, from: f64, to: f64) -> f64 {
        if to > from {
            (self.since_start(to) - self.since_start(from)) / (to - from)
        } else {
            self.at(from)
        }
    }

    /// Integral from the start of the waveform to a time \[s\].
    fn since_start(&self, time: f64) -> f64 {
        let periods = ((time - self.start_s) / self.period_s).floor();
        let since = time - self.start_s - periods * self.period_s;
        periods * self.within(self.period_s) + self.within(since)
    }

    /// Integral over the first part of a period, of the length `until` \[s\].
    fn within(&self, until: f64) -> f64 {
        let mut last = [0.0, self.levels[0]];
        let mut sum = 0.0;
        let corners = self.times_s.iter().zip(&self.levels);
        for (time, level) in corners.map(|(t, w)| (*t, *w)) {
            if until <= last[0] {
                return sum;
            }
            if time >= until {
                let part = (until - last[0]) / (time - last[0]);
                let end = last[1] + part * (level - last[1]);
                return sum + 0.5 * (until - last[0]) * (last[1] + end);
            }
            sum += 0.5 * (time - last[0]) * (last[1] + level);
            last = [time, level];
        }
        sum + (until - last[0]) * last[1]
    }

    /// Greatest level.
    #[must_use]
    pub fn most(&self) -> f64 {
        self.levels.iter().copied().fold(0.0, f64::max)
    }

    /// Corners between two times \[s\], each with the last instant before it and the first after it.
    pub fn corners(&self, from: f64, to: f64) -> impl Iterator<Item = [f64; 2]> {
        let count = |time: f64| ((time - self.start_s) / self.period_s).floor() as i64;
        let begins = (count(from)..=count(to)).map(|n| self.start_s + n as f64 * self.period_s);
        let first = self.times_s.first().copied().unwrap_or(0.0);
        // A period that begins with another level than the last ended with has a jump there.
        let wraps = (first > 0.0).then_some(0.0);
        let own = move |begin: f64| {
            let within = wraps.into_iter().chain(self.times_s.iter().copied());
            within.map(move |t| begin + t)
        };
        let near = move |t: f64| NEAR * t.abs().max(self.period_s);
        let inside = begins.flat_map(own).filter(move |t| *t > from && *t < to);
        inside.map(move |t| [t - near(t), t + near(t)])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pulses() -> Waveform {
        Waveform {
            period_s: 0.01,
            times_s: vec![0.0, 0.002, 0.004, 0.004, 0.006],
            levels: vec![0.2, 1.0, 1.0, 0.5, 0.2],
            start_s: 0.003,
        }
    }

    #[test]
    fn levels_are_straight_between_corners_and_come_again() {
        let wave = pulses();
        for (since, level) in [
            (0.0, 0.2),
            (0.001, 0.6),
            (0.003, 1.0),
            (0.005, 0.35),
            (0.008, 0.2),
        ] {
            for period in [-3.0, 0.0, 7.0] {
                let found = wave.at(0.003 + period * 0.01 + since);
                assert!((found - level).abs() < 1e-9, "{since} {period}: {found}");
            }
        }
        assert!((wave.at(0.003 + 0.004 + 1e-12) - 0.5).abs() < 1e-9);
        assert!((wave.at(0.003 + 0.004 - 1e-12) - 1.0).abs() < 1e-9);
    }

    #[test]
    fn a_constant_level_is_its_mean_and_whole_periods_have_that_of_one() {
        let constant = Waveform {
            levels: vec![0.7; 5],
            ..pulses()
        };
        assert!((constant.mean(-0.123, 0.456) - 0.7).abs() < 1e-13);
        // (0.6 x 2 + 1 x 2 + 0.35 x 2 + 0.2 x 4)/10 = 0.47.
        for (from, periods) in [(0.0, 1.0), (0.0123, 40.0), (-0.4, 3.0), (11.1, 1000.0)] {
            let found = pulses().mean(from, from + 0.01 * periods);
            assert!((found - 0.47).abs() < 1e-12, "{found}");
        }
    }

    #[test]
    fn steps_of_any_length_add_up_to_the_whole() {
        let (wave, end) = (pulses(), 0.1);
        let whole = wave.mean(0.0, end) * end;
        for steps in [1, 7, 100, 9973] {
            let step = end / f64::from(steps);
            let sum: f64 = (0..steps)
                .map(|k| wave.mean(f64::from(k) * step, f64::from(k + 1) * step) * step)
                .sum();
            assert!((sum / whole - 1.0).abs() < 1e-12, "{steps}: {sum}");
        }
        // By the rectangle rule on its values, apart from the integral.
        let fine = 1_000_000;
        let values = (0..fine).map(|k| wave.at((f64::from(k) + 0.5) * end / f64::from(fine)));
        let rule = values.sum::<f64>() * end / f64::from(fine);
        assert!((rule / whole - 1.0).abs() < 1e-6, "{rule} {whole}");
    }

    #[test]
    fn corners_part_what_lies_before_from_what_lies_after() {
        let wave = pulses();
        let corners: Vec<[f64; 2]> = wave.corners(0.0, 0.033).collect();
        // 7, 7 and 9 ms, then each of the five of the periods that begin at 3, 13 and 23 ms.
        assert_eq!(corners.len(), 15, "{corners:?}");
        for [before, after] in corners {
            assert!(before < after);
            let jump = wave.at(after) - wave.at(before);
            let since = (after - 0.003).rem_euclid(0.01);
            let asked = if (since - 0.004).abs() < 1e-9 {
                -0.5
            } else {
                0.0
            };
            assert!((jump - asked).abs() < 1e-9, "{before}: {jump}");
        }
    }

    #[test]
    fn means_are_exact_after_many_periods() {
        let short = Waveform {
            period_s: 1e-9,
            times_s: vec![0.0],
            levels: vec![0.7],
            start_s: 0.0,
        };
        for from in [0.0, 3.0, 1e4] {
            let mean = short.mean(from, from + 0.1);
            assert!((mean - 0.7).abs() < 1e-6, "{from}: {mean}");
        }
    }

    #[test]
    fn what_is_wrong_is_told_at_its_key() {
        let found = |change: &dyn Fn(&mut Waveform)| {
            let mut wave = pulses();
            change(&mut wave);
            wave.misfit().map(|misfit| misfit.path)
        };
        assert_eq!(found(&|_| ()), None);
        for (path, wrong) in [
            ("/levels", found(&|w| w.levels.truncate(2))),
            ("/times_s", found(&|w| w.times_s[1] = 0.005)),
            ("/times_s", found(&|w| w.times_s[4] = 0.011)),
        ] {
            assert_eq!(wrong.as_deref(), Some(path));
        }
    }
}
