//! Clouds for the tests.

use wls::{Cloud, Metric, Search};

/// Numbers between -1 and 1 that are the same on every machine.
pub(crate) struct Random(u64);

impl Random {
    pub(crate) fn new(seed: u64) -> Self {
        Self(seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) ^ 0x5DEE_CE66)
    }

    pub(crate) fn next(&mut self) -> f64 {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        ((self.0 >> 33) as f64) / f64::from(1_u32 << 30) - 1.0
    }
}

/// Points with their spacings.
#[derive(Debug, Clone)]
pub(crate) struct Points<const D: usize> {
    pub(crate) places: Vec<[f64; D]>,
    pub(crate) metrics: Vec<Metric<D>>,
}

impl<const D: usize> Points<D> {
    pub(crate) fn search(&self) -> Search<'_, D> {
        Search::new(Cloud {
            points: &self.places,
            metrics: &self.metrics,
        })
        .unwrap()
    }

    pub(crate) fn field(&self, f: impl Fn([f64; D]) -> f64) -> Vec<f64> {
        self.places.iter().map(|p| f(*p)).collect()
    }

    /// Points farther than `margin` from the faces of the unit cube.
    pub(crate) fn inside(&self, margin: f64) -> Vec<usize> {
        let within = |p: &[f64; D]| p.iter().all(|x| *x > margin && *x < 1.0 - margin);
        (0..self.places.len())
            .filter(|&i| within(&self.places[i]))
            .collect()
    }
}

/// A lattice of `n` cells per side in the unit cube, cell-centred, with `jitter` parts of the
/// spacing.
pub(crate) fn lattice<const D: usize>(n: usize, jitter: f64) -> Points<D> {
    let spacing = 1.0 / n as f64;
    let mut random = Random::new(n as u64);
    let places = (0..n.pow(D as u32))
        .map(|k| {
            std::array::from_fn(|a| {
                let cell = k / n.pow(a as u32) % n;
                spacing * (cell as f64 + 0.5 + jitter * random.next())
            })
        })
        .collect::<Vec<_>>();
    let metrics = vec![Metric::round(spacing); places.len()];
    Points { places, metrics }
}

/// A lattice whose spacing grows three times along x, from 0 to 1, jittered.
pub(crate) fn graded<const D: usize>(n: usize, jitter: f64) -> Points<D> {
    let mut points = lattice::<D>(n, jitter);
    for (place, metric) in points.places.iter_mut().zip(&mut points.metrics) {
        let x = place[0];
        // x -> (x + x^2) / 2 has slopes from 1/2 to 3/2.
        place[0] = 0.5 * (x + x * x);
        *metric = Metric::round((0.5 + x).max(1.0) / n as f64);
    }
    points
}
