//! What varies in time: where steps have to end, how long they may be, and what heat is prescribed.
//!
//! A march that looks at a property only where its steps end can step over a pulse and never know. The course of
//! every property that depends on time is known before the march: `pieces` divides the time until the trapezoidal
//! rule is good in each piece, led by bounds of the property over whole pieces, from which no pulse hides, however
//! short. Where it jumps, time is cut between two neighbouring numbers: a step ends at the first, and the next
//! begins at the second. [`prescribed`] integrates prescribed heat, apart from the march.

mod pieces;
pub mod prescribed;
mod signal;

use crate::system::System;
use pieces::{Pieces, divide};
use signal::signals;

/// Jumps nearer than this part of the whole time are one.
const ONE: f64 = 1e-14;

/// The course of all that varies in time.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Course {
    /// Last instant before and first instant after each jump \[s\], rising.
    jumps: Vec<[f64; 2]>,
    /// Begin and length of the pieces of each property \[s\]; those that bound no step are infinitely long.
    pieces: Vec<Vec<[f64; 2]>>,
    /// Greatest difference of temperature that what varies makes between neighbouring points, about \[K\].
    pub range: f64,
    /// Whether every property was resolved.
    pub resolved: bool,
}

impl Course {
    /// The course until `end` \[s\] of what a system is under, which begins with the given temperatures.
    #[must_use]
    pub fn new(system: &System, temperature: &[f64], end: f64) -> Self {
        let mut course = Self {
            resolved: true,
            ..Self::default()
        };
        for signal in signals(system, temperature) {
            let pieces = divide(&signal, end);
            course.range = course.range.max(signal.range(&pieces));
            course.add(pieces);
        }
        if let Some(torches) = &system.torches {
            let conductivity = temperature.first().map(|t| system.conductivity(0, *t));
            let range = conductivity.map_or(0.0, |k| torches.range(&system.cloud, k));
            course.range = course.range.max(range);
            course.jumps.extend(torches.jumps(end));
            course.pieces.extend(torches.pieces(end));
        }
        course.jumps.sort_by(|a, b| a[0].total_cmp(&b[0]));
        course.jumps.dedup_by(|next, kept| {
            let near = next[0] <= kept[1] + ONE * end;
            if near {
                kept[1] = kept[1].max(next[1]);
            }
            near
        });
        course
    }

    fn add(&mut self, pieces: Pieces) {
        self.resolved &= pieces.resolved;
        self.jumps.extend(pieces.jumps);
        self.pieces.push(pieces.lengths);
    }

    /// Whether nothing varies.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.pieces.is_empty()
    }

    /// Number of jumps.
    #[must_use]
    pub fn jumps(&self) -> usize {
        self.jumps.len()
    }

    /// The first instant after a jump right after `time` \[s\], if there is one.
    #[must_use]
    pub fn jump(&self, time: f64) -> Option<f64> {
        let next = self.jumps.partition_point(|jump| jump[1] <= time);
        let [before, after] = *self.jumps.get(next)?;
        (time >= before).then_some(after)
    }

    /// Where a step from `time` has to end at the latest, if not at `end`: before the next jump \[s\].
    #[must_use]
    pub fn until(&self, time: f64, end: f64) -> f64 {
        let next = self.jumps.partition_point(|jump| jump[0] <= time);
        self.jumps.get(next).map_or(end, |jump| jump[0].min(end))
    }

    /// The longest step from `time` that follows what varies \[s\].
    #[must_use]
    pub fn longest(&self, time: f64) -> f64 {
        let mut longest = f64::INFINITY;
        for pieces in &self.pieces {
            let own = pieces.partition_point(|piece| piece[0] <= time).max(1) - 1;
            for [begin, length] in &pieces[own.min(pieces.len())..] {
                let before = (begin - time).max(0.0);
                if before >= longest {
                    break;
                }
                // A long step ends where a short piece begins.
                longest = longest.min(before.max(*length));
            }
        }
        longest
    }
}

#[cfg(test)]
mod tests;
