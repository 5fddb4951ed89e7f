//! Measures over a stretch of a weld.

use crate::measure::bead::{Bead, measure_of};

/// Sections measured one after another along the weld.
#[derive(Debug, Clone)]
pub(crate) struct Stretch {
    /// Whether all of it has frozen and lies beyond the run-in: the bead that an experiment shows.
    pub(crate) frozen: bool,
    /// Place \[m\] and measures of each section, in the order in which they were welded.
    pub(crate) beads: Vec<(f64, Bead)>,
}

/// A measure over a stretch.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Measure {
    /// Median over a frozen stretch; greatest value while nothing has frozen.
    pub(crate) value: f64,
    /// Least and greatest value.
    pub(crate) range: [f64; 2],
}

impl Stretch {
    /// A measure by its name in the targets; `None` for an unknown name.
    pub(crate) fn get(&self, name: &str) -> Option<Measure> {
        let mut values: Vec<f64> = self
            .beads
            .iter()
            .map(|(_, bead)| Some(measure_of(name)?.of(bead)))
            .collect::<Option<_>>()?;
        values.sort_by(f64::total_cmp);
        let (low, high) = (*values.first()?, *values.last()?);
        let half = values.len() / 2;
        let median = if values.len() % 2 == 1 {
            values[half]
        } else {
            0.5 * (values[half - 1] + values[half])
        };
        Some(Measure {
            value: if self.frozen { median } else { high },
            range: [low, high],
        })
    }

    /// Whether the plate is fused through anywhere.
    pub(crate) fn through(&self) -> bool {
        self.beads.iter().any(|(_, bead)| bead.through)
    }

    /// Length measured \[m\].
    pub(crate) fn length(&self) -> f64 {
        match (self.beads.first(), self.beads.last()) {
            (Some(a), Some(b)) => b.0 - a.0,
            _ => 0.0,
        }
    }

    /// The section to show: the middle of a frozen stretch, else the deepest.
    pub(crate) fn place(&self) -> Option<f64> {
        if self.frozen {
            return self.beads.get(self.beads.len() / 2).map(|b| b.0);
        }
        let deepest =
            |a: &&(f64, Bead), b: &&(f64, Bead)| a.1.penetration.total_cmp(&b.1.penetration);
        self.beads.iter().max_by(deepest).map(|b| b.0)
    }
}
