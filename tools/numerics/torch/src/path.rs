//! Where a torch goes: a polyline at a constant speed, from the start of the arc to its end, with a weave across it.
//!
//! ```text
//! x(t) = polyline(v (t - t_0)) + A sin(2 pi f (t - t_0)) across,      t_0 <= t < t_1
//! ```
//!
//! The torch stands at the end of its path for as long as the arc burns on there.

use std::f64::consts::TAU;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use shapes::frame::{Vector, along, length, unit};

/// A sine across the path.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Weave {
    /// Greatest distance from the path \[m\]: half of the width of the weave.
    #[schemars(extend("x-unit" = "m", "exclusiveMinimum" = 0.0))]
    pub amplitude_m: f64,
    /// Periods of the weave per second.
    #[schemars(range(max = 1e5), extend("x-unit" = "Hz", "exclusiveMinimum" = 0.0))]
    pub frequency_hz: f64,
}

/// The path of a torch.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "TorchPath")]
pub struct Path {
    /// Corners of the path \[m\]; with a single one the torch stands still there.
    #[schemars(extend("x-unit" = "m"), length(min = 1))]
    pub points_m: Vec<[f64; 3]>,
    /// Speed along it \[m/s\]; needed where there is more than one corner.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-unit" = "m/s", "exclusiveMinimum" = 0.0))]
    pub speed_m_s: Option<f64>,
    /// Start of the arc \[s\].
    #[serde(default)]
    #[schemars(range(min = 0.0), extend("x-unit" = "s"))]
    pub start_s: f64,
    /// End of the arc \[s\]. Absent: when the torch reaches the end of its path; never for a torch that stands still.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-unit" = "s", "exclusiveMinimum" = 0.0))]
    pub end_s: Option<f64>,
    /// Weave across it; none if absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub weave: Option<Weave>,
}

impl Path {
    /// Whole length \[m\].
    #[must_use]
    pub fn length(&self) -> f64 {
        self.legs()
            .map(|(from, to)| length(along(to, -1.0, from)))
            .sum()
    }

    fn legs(&self) -> impl Iterator<Item = (Vector, Vector)> {
        self.points_m.windows(2).map(|pair| (pair[0], pair[1]))
    }

    /// Speed along the path \[m/s\]; 0 where it stands.
    fn speed(&self) -> f64 {
        match self.points_m.len() {
            0 | 1 => 0.0,
            _ => self.speed_m_s.unwrap_or(0.0),
        }
    }

    /// Direction of the whole path: from its first corner to the last; of one that comes back, along its first leg. None where it stands.
    #[must_use]
    pub fn heading(&self) -> Option<Vector> {
        let first = self.points_m.first()?;
        let from = |to: &Vector| unit(along(*to, -1.0, *first));
        let last = self.points_m.last().and_then(from);
        last.or_else(|| self.points_m.iter().find_map(from))
    }

    /// When the arc burns: from, and to \[s\].
    #[must_use]
    pub fn burns(&self) -> [f64; 2] {
        let speed = self.speed();
        let passed = if speed > 0.0 {
            self.start_s + self.length() / speed
        } else {
            f64::INFINITY
        };
        [self.start_s, self.end_s.unwrap_or(passed)]
    }

    /// Times at which it starts, turns a corner, comes to its end and goes out \[s\], rising.
    #[must_use]
    pub fn times(&self) -> Vec<f64> {
        let [from, to] = self.burns();
        let mut times = vec![from];
        let (speed, mut passed) = (self.speed(), 0.0);
        if speed > 0.0 {
            for (a, b) in self.legs() {
                passed += length(along(b, -1.0, a));
                times.push(from + passed / speed);
            }
        }
        times.retain(|t| *t < to);
        times.extend(Some(to).filter(|t| t.is_finite()));
        times
    }

    /// Fastest that it moves \[m/s\].
    #[must_use]
    pub fn fastest(&self) -> f64 {
        let weave = self
            .weave
            .map_or(0.0, |w| TAU * w.frequency_hz * w.amplitude_m);
        self.speed().hypot(weave)
    }

    /// Place on the polyline at a time \[m\], and the direction of its leg; none where it has no leg of any length.
    #[must_use]
    pub fn on(&self, time: f64) -> (Vector, Option<Vector>) {
        let mut left = (self.speed() * (time - self.start_s)).max(0.0);
        let first = self.points_m.first().copied().unwrap_or_default();
        let mut last = (first, None);
        for (from, to) in self.legs() {
            let way = along(to, -1.0, from);
            let Some(direction) = unit(way) else {
                continue;
            };
            if left < length(way) {
                return (along(from, left, direction), Some(direction));
            }
            left -= length(way);
            last = (to, Some(direction));
        }
        last
    }

    /// How far the weave is from the polyline at a time \[m\].
    #[must_use]
    pub fn aside(&self, time: f64) -> f64 {
        let of = |w: Weave| w.amplitude_m * (TAU * w.frequency_hz * (time - self.start_s)).sin();
        self.weave.map_or(0.0, of)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn corner() -> Path {
        serde_json::from_str(
            r#"{"points_m": [[0, 0, 0], [0, 3, 0], [4, 3, 0]], "speed_m_s": 2, "start_s": 1,
            "weave": {"amplitude_m": 0.5, "frequency_hz": 1}}"#,
        )
        .unwrap()
    }

    #[test]
    fn a_path_is_followed_at_its_speed() {
        let path = corner();
        assert!((path.length() - 7.0).abs() < 1e-15);
        assert_eq!(path.burns().to_vec(), [1.0, 4.5]);
        assert_eq!(path.times(), [1.0, 2.5, 4.5]);
        for (time, place, direction) in [
            (0.0, [0.0, 0.0, 0.0], [0.0, 1.0, 0.0]),
            (2.0, [0.0, 2.0, 0.0], [0.0, 1.0, 0.0]),
            (3.0, [1.0, 3.0, 0.0], [1.0, 0.0, 0.0]),
            (9.0, [4.0, 3.0, 0.0], [1.0, 0.0, 0.0]),
        ] {
            let found = path.on(time);
            assert!(length(along(found.0, -1.0, place)) < 1e-12, "{time}");
            assert_eq!(found.1, Some(direction));
        }
        assert!((path.aside(1.25) - 0.5).abs() < 1e-12 && path.aside(1.0).abs() < 1e-15);
        assert!((path.fastest() - 2.0_f64.hypot(TAU * 0.5)).abs() < 1e-12);
    }

    #[test]
    fn a_path_heads_for_its_end() {
        let mut path = corner();
        assert_eq!(path.heading(), Some([0.8, 0.6, 0.0]));
        path.points_m.push([0.0; 3]);
        assert_eq!(path.heading(), Some([0.0, 1.0, 0.0]));
        path.points_m.truncate(1);
        assert_eq!(path.heading(), None);
    }

    #[test]
    fn an_arc_burns_on_at_the_end_of_its_path() {
        let mut path = corner();
        path.end_s = Some(6.0);
        assert_eq!(path.times(), [1.0, 2.5, 4.5, 6.0]);
        assert_eq!(path.burns().to_vec(), [1.0, 6.0]);
        path.end_s = Some(2.0);
        assert_eq!(path.times(), [1.0, 2.0]);
        path.points_m.truncate(1);
        path.end_s = None;
        assert_eq!(path.burns().to_vec(), [1.0, f64::INFINITY]);
        assert_eq!(path.on(5.0), ([0.0; 3], None));
    }
}
