//! What the frames of a run must keep: bounds, and rise or fall along an axis.
//!
//! A bound that is broken is named with its place and time. What finds nothing to look at is broken
//! too: a check that cannot fail would be worth nothing.

use std::collections::BTreeMap;
use std::path::Path;

use artefact::{Frame, Reader};
use serde::Deserialize;

use super::told::Told;
use crate::lab::LabError;

/// Coordinates closer than this part of the extent are the same.
const SAME: f64 = 1e-6;
/// Slack where none is given, as a part of the range: round-off of long sums.
const SLACK: f64 = 1e-9;

/// Least and greatest value of a column in every frame.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Bounds {
    /// Channel of the frames; the first of `/points`, `/particles` that is there.
    pub channel: Option<String>,
    /// The column.
    pub column: String,
    /// Least value, in the unit of the column.
    pub min: f64,
    /// Greatest value.
    pub max: f64,
    /// How far beyond it may be; 1e-9 of the range where it is not given.
    pub slack: Option<f64>,
    /// The axis of the grid whose value multiplies all three.
    pub times: Option<Name>,
}

/// An axis of a grid.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Name {
    /// Across.
    X,
    /// Upward.
    Y,
}

/// A column that only rises or only falls along an axis, in every frame.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Monotone {
    /// Channel of the frames; the first of `/points`, `/particles` that is there.
    pub channel: Option<String>,
    /// The column.
    pub column: String,
    /// `x`, `y` or `z`.
    pub along: Along,
    /// Which way.
    pub sense: Sense,
    /// How far it may go the other way; 1e-9 of the range of the frame where it is not given.
    pub slack: Option<f64>,
    /// All points make one row; otherwise those that share both other coordinates do.
    #[serde(default)]
    pub whole: bool,
}

/// A direction of space.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Along {
    /// First coordinate.
    X,
    /// Second.
    Y,
    /// Third.
    Z,
}

/// Which way a column goes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Sense {
    /// Never falls.
    Rising,
    /// Never rises.
    Falling,
}

impl Bounds {
    /// The same of a problem that is `factor` times as large.
    pub(super) fn scaled(&self, factor: f64) -> Self {
        Self {
            min: self.min * factor,
            max: self.max * factor,
            slack: self.slack.map(|s| s * factor),
            ..self.clone()
        }
    }

    fn broken(&self, frame: &Frame) -> Result<Option<String>, LabError> {
        let values = frame.f64(&self.column)?;
        let slack = self.slack.unwrap_or(SLACK * (self.max - self.min).abs());
        let beyond = |v: f64| (self.min - v).max(v - self.max);
        let worst =
            (0..values.len()).max_by(|a, b| beyond(values[*a]).total_cmp(&beyond(values[*b])));
        let Some(worst) = worst.filter(|i| beyond(values[*i]) > slack) else {
            return Ok(None);
        };
        Ok(Some(format!(
            "{} is {:.9e} at {} m, {:.4e} s: not within {:e} to {:e}",
            self.column,
            values[worst],
            place(frame, worst)?,
            frame.time_s,
            self.min,
            self.max
        )))
    }
}

fn place(frame: &Frame, index: usize) -> Result<String, LabError> {
    let [x, y, z] = frame.position_vectors()?[index];
    Ok(format!("({x:.4e}, {y:.4e}, {z:.4e})"))
}

impl Monotone {
    fn broken(&self, frame: &Frame) -> Result<Option<String>, LabError> {
        let sign = if self.sense == Sense::Rising {
            1.0
        } else {
            -1.0
        };
        let values: Vec<f64> = frame.f64(&self.column)?.iter().map(|v| sign * v).collect();
        let positions = frame.position_vectors()?;
        let low = values.iter().copied().fold(f64::INFINITY, f64::min);
        let high = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let slack = self.slack.unwrap_or(SLACK * (high - low));
        let mut compared = false;
        for row in self.rows(&positions) {
            // The greatest value of all places before this one.
            let mut before = f64::NEG_INFINITY;
            for place_of in row {
                compared |= before.is_finite();
                let lowest = place_of
                    .iter()
                    .min_by(|a, b| values[**a].total_cmp(&values[**b]));
                if let Some(&i) = lowest.filter(|i| values[**i] < before - slack) {
                    let word = if sign > 0.0 { "falls" } else { "rises" };
                    return Ok(Some(format!(
                        "{} {word} by {:.3e} along {:?} before {} m, {:.4e} s",
                        self.column,
                        before - values[i],
                        self.along,
                        place(frame, i)?,
                        frame.time_s
                    )));
                }
                before = place_of.iter().fold(before, |b, i| b.max(values[*i]));
            }
        }
        let nothing = || format!("there is no row of points along {:?}", self.along);
        Ok((!compared).then(nothing))
    }

    /// Rows of places, each place with the points that share it.
    fn rows(&self, positions: &[[f64; 3]]) -> Vec<Vec<Vec<usize>>> {
        let axis = self.along as usize;
        let extent = |k: usize| {
            let of = positions.iter().map(|p| p[k]);
            of.clone().fold(f64::NEG_INFINITY, f64::max) - of.fold(f64::INFINITY, f64::min)
        };
        let same = SAME * (0..3).map(extent).fold(0.0, f64::max);
        let shared = |k: usize| shelves(positions.iter().map(|p| p[k]), same);
        let (along, first, second) = (shared(axis), shared((axis + 1) % 3), shared((axis + 2) % 3));
        let mut rows: BTreeMap<(usize, usize), BTreeMap<usize, Vec<usize>>> = BTreeMap::new();
        for i in 0..positions.len() {
            let row = if self.whole {
                (0, 0)
            } else {
                (first[i], second[i])
            };
            rows.entry(row)
                .or_default()
                .entry(along[i])
                .or_default()
                .push(i);
        }
        let rows = rows.into_values();
        rows.map(|row| row.into_values().collect()).collect()
    }
}

/// The rank of each value, where values less than `same` above the one before share its rank.
fn shelves(values: impl Iterator<Item = f64>, same: f64) -> Vec<usize> {
    let values: Vec<f64> = values.collect();
    let mut order: Vec<usize> = (0..values.len()).collect();
    order.sort_by(|a, b| values[*a].total_cmp(&values[*b]));
    let mut ranks = vec![0; values.len()];
    let mut rank = 0;
    for pair in order.windows(2) {
        rank += usize::from(values[pair[1]] - values[pair[0]] > same);
        ranks[pair[1]] = rank;
    }
    ranks
}

/// All checks of a run.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct Checks {
    pub(super) bounds: Option<Bounds>,
    pub(super) monotone: Option<Monotone>,
    pub(super) told: Told,
}

impl Checks {
    /// What the frames of an artefact break, the first of each kind.
    ///
    /// # Errors
    /// When the artefact cannot be read or lacks the column.
    pub(super) fn broken(&self, artefact: &Path) -> Result<Vec<String>, LabError> {
        let mut found = Vec::new();
        if let Some(bounds) = &self.bounds {
            found.extend(first(artefact, bounds.channel.as_deref(), |f| {
                bounds.broken(f)
            })?);
        }
        if let Some(row) = &self.monotone {
            found.extend(first(artefact, row.channel.as_deref(), |f| row.broken(f))?);
        }
        Ok(found)
    }
}

/// What is first found in the frames of a channel.
fn first(
    artefact: &Path,
    channel: Option<&str>,
    broken: impl Fn(&Frame) -> Result<Option<String>, LabError>,
) -> Result<Option<String>, LabError> {
    let reader = Reader::open(artefact)?;
    let usual = ["/points", "/particles"];
    let there = usual.into_iter().find(|name| reader.has(name));
    let channel = channel.or(there).unwrap_or(usual[0]);
    let mut empty = true;
    for frame in reader.frames(channel)? {
        let frame = frame?;
        empty &= frame.is_empty();
        if let Some(what) = broken(&frame)? {
            return Ok(Some(what));
        }
    }
    Ok(empty.then(|| format!("{channel} has no points to check")))
}

#[cfg(test)]
mod tests {
    use super::*;
    use artefact::Precision;

    /// A lattice of 3 x 2 points with a column of six values, row by row.
    fn frame(values: [f64; 6]) -> Frame {
        let places = (0..6).map(|i| [f64::from(i % 3), f64::from(i / 3) + 1e-12, 0.0]);
        Frame::new(Precision::F64)
            .positions(places)
            .scalar("temperature", "K", values)
    }

    fn monotone(along: Along, sense: Sense, whole: bool) -> Monotone {
        Monotone {
            channel: None,
            column: "temperature".to_owned(),
            along,
            sense,
            slack: None,
            whole,
        }
    }

    #[test]
    fn a_value_beyond_its_bounds_is_named_with_its_place() {
        let bounds = Bounds {
            channel: None,
            column: "temperature".to_owned(),
            min: 0.0,
            max: 1.0,
            slack: None,
            times: None,
        };
        let broken = |values| bounds.broken(&frame(values)).unwrap();
        assert_eq!(broken([0.0, 0.5, 1.0, 1.0 + 5e-10, -5e-10, 0.0]), None);
        let said = broken([0.0, 0.5, 1.0, 1.0, 1.1, -0.05]).unwrap();
        assert!(
            said.contains("1.1") && said.contains("(1.0000e0, 1.0000e0"),
            "{said}"
        );
        assert!(
            broken([0.0, 0.5, 1.0, 1.0, 1.0, -0.05])
                .unwrap()
                .contains("-5.0")
        );
        let large = bounds.scaled(100.0);
        assert_eq!(large.broken(&frame([99.0; 6])).unwrap(), None);
    }

    #[test]
    fn a_row_that_turns_is_found() {
        let rising = monotone(Along::X, Sense::Rising, false);
        // Each row rises, though the middle of the first lies below the start of the second.
        let two = frame([0.0, 1.0, 2.0, 1.5, 1.5, 3.0]);
        assert_eq!(rising.broken(&two).unwrap(), None);
        let whole = monotone(Along::X, Sense::Rising, true);
        assert!(whole.broken(&two).unwrap().is_some());
        let turned = frame([0.0, 1.0, 2.0, 0.5, 0.4, 3.0]);
        let said = rising.broken(&turned).unwrap().unwrap();
        assert!(said.contains("falls by 1.000e-1"), "{said}");
        let falling = monotone(Along::Y, Sense::Falling, false);
        assert!(falling.broken(&two).unwrap().is_some());
        assert_eq!(
            falling
                .broken(&frame([3.0, 2.0, 1.0, 0.0, 2.0, 0.5]))
                .unwrap(),
            None
        );
    }

    #[test]
    fn a_check_without_points_to_compare_is_broken() {
        let upward = monotone(Along::Z, Sense::Rising, false);
        let said = upward.broken(&frame([0.0; 6])).unwrap().unwrap();
        assert!(said.contains("no row"), "{said}");
    }
}
