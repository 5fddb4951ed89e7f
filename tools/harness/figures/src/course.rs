//! What the course of a value in time says: its mean, when it falls below a limit, its period.

use std::ops::RangeInclusive;

use artefact::Reader;

/// A value over time.
#[derive(Debug, Clone, PartialEq)]
pub struct Course {
    /// Times \[s\].
    pub time: Vec<f64>,
    /// Values.
    pub value: Vec<f64>,
    /// Their unit; empty without a value.
    pub unit: String,
}

impl Course {
    /// A value of the records of a channel.
    ///
    /// # Errors
    /// When the artefact does not hold it.
    pub fn of(reader: &Reader, channel: &str, value: &str) -> artefact::Result<Self> {
        let records = reader.records(channel)?;
        let values = records.iter().map(|(_, record)| record.get(value));
        let entries = records.iter().flat_map(|(_, record)| &record.values);
        let unit = entries.filter(|entry| entry.name == value);
        Ok(Self {
            value: values.collect::<Result<_, _>>()?,
            time: records.iter().map(|(time, _)| *time).collect(),
            unit: unit
                .map(|entry| entry.unit.clone())
                .next()
                .unwrap_or_default(),
        })
    }

    /// The mean over the records of a time; not a number where there are none.
    #[must_use]
    pub fn mean(&self, during_s: &RangeInclusive<f64>) -> f64 {
        let all = self.time.iter().zip(&self.value);
        let own: Vec<f64> = all
            .filter(|(t, _)| during_s.contains(t))
            .map(|(_, v)| *v)
            .collect();
        own.iter().sum::<f64>() / own.len() as f64
    }

    /// When the value falls below a limit for the first time, between two records by a straight line; none where it never does.
    #[must_use]
    pub fn falls_below(&self, limit: f64) -> Option<f64> {
        let first = self.value.iter().position(|v| *v < limit)?;
        let before = first.checked_sub(1)?;
        let [t0, t1] = [self.time[before], self.time[first]];
        let [v0, v1] = [self.value[before], self.value[first]];
        Some(t0 + (t1 - t0) * (v0 - limit) / (v0 - v1))
    }

    /// Twice the mean time between turning points, each that of the parabola through three records; none with fewer than two.
    #[must_use]
    pub fn period(&self) -> Option<f64> {
        let (t, v) = (&self.time, &self.value);
        let turns: Vec<f64> = (1..v.len().saturating_sub(1))
            .filter(|k| (v[k - 1] < v[*k]) != (v[*k] < v[k + 1]))
            .map(|k| {
                // Slopes in the middles of both intervals; between them the slope is straight.
                let before = (v[k] - v[k - 1]) / (t[k] - t[k - 1]);
                let after = (v[k + 1] - v[k]) / (t[k + 1] - t[k]);
                let [from, to] = [0.5 * (t[k - 1] + t[k]), 0.5 * (t[k] + t[k + 1])];
                from + (to - from) * before / (before - after)
            })
            .collect();
        let between = turns.len().checked_sub(1).filter(|n| *n > 0)?;
        Some(2.0 * (turns[between] - turns[0]) / between as f64)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn course(of: impl Fn(f64) -> f64) -> Course {
        let time: Vec<f64> = (0..=100).map(|k| 0.01 * f64::from(k)).collect();
        let value = time.iter().map(|t| of(*t)).collect();
        Course {
            time,
            value,
            unit: "1".to_owned(),
        }
    }

    #[test]
    fn a_swing_has_its_period() {
        let swing = course(|t| 3.0 + (2.0 * std::f64::consts::PI * t / 0.27 + 0.4).cos());
        assert!((swing.period().unwrap() / 0.27 - 1.0).abs() < 1e-3);
        assert_eq!(course(|t| t).period(), None);
    }

    #[test]
    fn a_limit_is_met_between_two_records() {
        let falling = course(|t| 1.0 - t);
        assert!((falling.falls_below(0.755).unwrap() - 0.245).abs() < 1e-12);
        assert_eq!(falling.falls_below(-1.0), None);
    }

    #[test]
    fn a_mean_leaves_out_other_times() {
        assert!((course(|t| t).mean(&(0.895..=0.985)) - 0.94).abs() < 1e-12);
        assert!(course(|t| t).mean(&(2.0..=3.0)).is_nan());
    }
}
