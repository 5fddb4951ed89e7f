//! Which frames stand for one independent part of the run, and the error of a mean over such parts.
//!
//! Frames that follow one another closely show the same metal: they are not independent, and the spread of single
//! frames over the root of their number tells an error that is too small, the more so the more frames are
//! written. So frames are gathered in G parts, of n_g frames with the mean m_g, and with N = sum n_g and
//! m = sum n_g m_g / N
//!
//! ```text
//! s^2 = G / (G - 1) * sum_g n_g^2 (m_g - m)^2 / N^2
//! ```
//!
//! is the square of the standard error (Cochran 1977, eq. 6.13: the ratio of two sums over clusters). The true mean
//! lies within `t s` in 95 of 100 cases, t by Student's distribution of G - 1 degrees of freedom.
//!
//! A part is a period of the droplets, or as many in a row as make [`DROPLET_PARTS`] of them: what several droplets
//! in a row share is then not taken for chance. Where no droplets are told, the frames are cut into [`SPANS`] parts of equal
//! numbers (batch means, Law and Kelton 2000, section 9.5.3); they have to be longer than what the metal remembers.

use std::collections::BTreeMap;

/// Most parts of droplets.
pub const DROPLET_PARTS: usize = 20;
/// Parts of frames without droplets.
pub const SPANS: usize = 10;

/// Half of the interval that holds 95 of 100 values of Student's t, by degrees of freedom from 1 on (Fisher and Yates).
const STUDENT: [f64; DROPLET_PARTS - 1] = [
    12.706, 4.303, 3.182, 2.776, 2.571, 2.447, 2.365, 2.306, 2.262, 2.228, 2.201, 2.179, 2.160,
    2.145, 2.131, 2.120, 2.110, 2.101, 2.093,
];

/// Part of each frame that counts, in the order of time.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Parts {
    of: Vec<u32>,
    /// Number of parts.
    pub count: usize,
}

impl Parts {
    /// Parts of frames that show the given droplets, in the order of time.
    #[must_use]
    pub fn by_droplets(droplets: &[i64]) -> Self {
        let mut ranks: BTreeMap<i64, usize> = droplets.iter().map(|d| (*d, 0)).collect();
        for (rank, of) in ranks.values_mut().enumerate() {
            *of = rank;
        }
        let count = ranks.len().min(DROPLET_PARTS);
        let each = |d: &i64| (ranks[d] * count / ranks.len()) as u32;
        let of = droplets.iter().map(each).collect();
        Self { of, count }
    }

    /// Parts of equal numbers of `frames`.
    #[must_use]
    pub fn by_spans(frames: usize) -> Self {
        let count = frames.min(SPANS);
        let of = (0..frames).map(|i| (i * count / frames) as u32).collect();
        Self { of, count }
    }

    /// The part of the frame with an index among those that count.
    #[must_use]
    pub fn of(&self, frame: usize) -> u32 {
        self.of.get(frame).copied().unwrap_or(0)
    }
}

/// A mean over frames and its error by parts, updated one frame at a time.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Estimate {
    /// Number of frames.
    pub count: u32,
    /// Their mean; 0 without frames.
    pub mean: f64,
    /// The part that is not complete yet, with its frames and their mean.
    pub(crate) part: u32,
    pub(crate) part_count: u32,
    pub(crate) part_mean: f64,
    /// The complete parts: their number, and sum, mean and squares about it with the weights n_g^2.
    pub(crate) closed: u32,
    pub(crate) weight: f64,
    pub(crate) centre: f64,
    pub(crate) squares: f64,
}

impl Estimate {
    /// Takes in the value of a frame of a part. Parts come in a row.
    pub fn add(&mut self, part: u32, value: f64) {
        if part != self.part {
            *self = self.complete();
            self.part = part;
        }
        self.count += 1;
        self.mean += (value - self.mean) / f64::from(self.count);
        self.part_count += 1;
        self.part_mean += (value - self.part_mean) / f64::from(self.part_count);
    }

    /// The same with its open part among the complete ones (West 1979, for weighted squares).
    fn complete(mut self) -> Self {
        if self.part_count > 0 {
            let weight = f64::from(self.part_count).powi(2);
            let off = self.part_mean - self.centre;
            self.weight += weight;
            self.centre += off * weight / self.weight;
            self.squares += weight * off * (self.part_mean - self.centre);
            self.closed += 1;
        }
        (self.part_count, self.part_mean) = (0, 0.0);
        self
    }

    /// Number of independent parts behind the mean.
    #[must_use]
    pub fn parts(&self) -> u32 {
        self.complete().closed
    }

    /// Standard error of the mean; 0 with fewer than two parts, which tell none.
    #[must_use]
    pub fn standard_error(&self) -> f64 {
        let all = self.complete();
        if all.closed < 2 {
            return 0.0;
        }
        let (parts, frames) = (f64::from(all.closed), f64::from(all.count));
        let about_mean = all.squares + all.weight * (all.centre - all.mean).powi(2);
        if about_mean < 0.0 {
            // Of values that differ by rounding alone.
            return 0.0;
        }
        (parts / (parts - 1.0) * about_mean).sqrt() / frames
    }

    /// Half of the interval about the mean that holds the true one in 95 of 100 cases; 0 with fewer than two parts.
    #[must_use]
    pub fn half_interval(&self) -> f64 {
        student(self.parts()) * self.standard_error()
    }
}

/// Student's t of 95 % for a mean over `parts`; 0 with fewer than two.
#[must_use]
pub fn student(parts: u32) -> f64 {
    let freedom = (parts as usize).saturating_sub(1).min(STUDENT.len());
    freedom.checked_sub(1).map_or(0.0, |row| STUDENT[row])
}

#[cfg(test)]
mod tests;
