//! The arithmetic mean over periods of equal phase, its standard error, and the mean over all time.

use crate::mean::Sample;
use crate::parts::Estimate;

/// Mean and spread of a quantity, updated one value at a time (Welford 1962).
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Moments {
    /// Number of values.
    pub count: u32,
    /// Their mean; 0 without values.
    pub mean: f64,
    pub(crate) squares: f64,
}

impl Moments {
    /// Takes in a value.
    pub fn add(&mut self, value: f64) {
        self.count += 1;
        let off = value - self.mean;
        self.mean += off / f64::from(self.count);
        self.squares += off * (value - self.mean);
    }

    /// Standard deviation of the values; 0 with fewer than two.
    #[must_use]
    pub fn deviation(&self) -> f64 {
        if self.count < 2 {
            return 0.0;
        }
        (self.squares / (f64::from(self.count) - 1.0)).sqrt()
    }
}

/// Means at one grid point.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Point {
    /// Velocity relative to the source \[m/s\], over frames with liquid here.
    pub velocity: [Estimate; 3],
    /// Temperature \[K\], over frames with metal here.
    pub temperature: Estimate,
    /// Height of the averaged particles \[m\], over frames with metal here.
    pub height: Moments,
    /// Share of liquid, over frames with metal here.
    pub share: Moments,
}

impl Point {
    /// Its means with errors, in the order of a checkpoint.
    pub(crate) fn estimates(&self) -> [Estimate; 4] {
        let [x, y, z] = self.velocity;
        [x, y, z, self.temperature]
    }

    /// The same, to be replaced.
    pub(crate) fn estimates_mut(&mut self) -> [&mut Estimate; 4] {
        let [x, y, z] = &mut self.velocity;
        [x, y, z, &mut self.temperature]
    }

    /// Its means without errors, in the order of a checkpoint.
    pub(crate) fn moments(&self) -> [Moments; 2] {
        [self.height, self.share]
    }

    /// The same, to be replaced.
    pub(crate) fn moments_mut(&mut self) -> [&mut Moments; 2] {
        [&mut self.height, &mut self.share]
    }

    fn add(&mut self, part: u32, sample: &Sample) {
        if sample.metal {
            self.temperature.add(part, sample.temperature);
            self.height.add(sample.height);
            self.share.add(sample.share);
        }
        if sample.liquid {
            for (mean, u) in self.velocity.iter_mut().zip(sample.velocity) {
                mean.add(part, u);
            }
        }
    }
}

/// Means of one section: per phase, and over all time.
#[derive(Debug, Clone)]
pub struct Ensemble {
    /// `[phase][grid point]`.
    pub phases: Vec<Vec<Point>>,
    /// `[grid point]`.
    pub time: Vec<Point>,
    /// Frames in each phase.
    pub frames: Vec<u32>,
}

impl Ensemble {
    /// Whether no frame had metal at any grid point.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.time.iter().all(|point| point.share.count == 0)
    }

    /// An empty ensemble of `phases` phases over `points` grid points.
    #[must_use]
    pub fn new(phases: usize, points: usize) -> Self {
        Self {
            phases: vec![vec![Point::default(); points]; phases],
            time: vec![Point::default(); points],
            frames: vec![0; phases],
        }
    }

    /// All points, those of the phases before those of the mean over all time.
    pub(crate) fn points(&self) -> impl Iterator<Item = &Point> {
        self.phases.iter().flatten().chain(&self.time)
    }

    /// The same, to be replaced.
    pub(crate) fn points_mut(&mut self) -> impl Iterator<Item = &mut Point> {
        self.phases.iter_mut().flatten().chain(&mut self.time)
    }

    /// Takes in the samples of a frame of the given phase and independent part. Frames come in the order of time,
    /// so that the sums are the same on every run.
    pub fn add(&mut self, phase: usize, part: u32, samples: &[Sample]) {
        self.frames[phase] += 1;
        for (i, sample) in samples.iter().enumerate() {
            self.phases[phase][i].add(part, sample);
            self.time[i].add(part, sample);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn liquid(u: f64, t: f64) -> Sample {
        let velocity = [u, 0.0, 0.0];
        Sample {
            metal: true,
            liquid: true,
            velocity,
            temperature: t,
            height: 0.0,
            share: 1.0,
        }
    }

    #[test]
    fn moments_are_mean_and_deviation() {
        let mut m = Moments::default();
        for v in [2.0, 4.0, 4.0, 4.0, 5.0, 5.0, 7.0, 9.0] {
            m.add(v);
        }
        assert!((m.mean - 5.0).abs() < 1e-14);
        assert!((m.deviation() - (32.0_f64 / 7.0).sqrt()).abs() < 1e-14);
    }

    #[test]
    fn phases_are_kept_apart_and_time_takes_all() {
        let mut e = Ensemble::new(2, 1);
        for n in 0..4 {
            let part = (n / 2) as u32;
            e.add(
                n % 2,
                part,
                &[liquid(if n % 2 == 0 { 1.0 } else { 3.0 }, 2000.0)],
            );
        }
        assert!((e.phases[0][0].velocity[0].mean - 1.0).abs() < 1e-15);
        assert!((e.phases[1][0].velocity[0].mean - 3.0).abs() < 1e-15);
        assert!((e.time[0].velocity[0].mean - 2.0).abs() < 1e-15);
        assert_eq!(e.frames, [2, 2]);
    }

    #[test]
    fn where_nothing_is_the_count_is_zero_and_no_value_is_not_a_number() {
        let mut e = Ensemble::new(1, 1);
        e.add(0, 0, &[Sample::default()]);
        let p = e.phases[0][0];
        assert_eq!((p.temperature.count, p.velocity[0].count), (0, 0));
        assert!(p.temperature.mean == 0.0 && p.temperature.standard_error() == 0.0);
    }
}
