//! How many points a body takes at least, before any is made.

use shapes::Body;

/// Samples along an axis of the box that holds the body.
const SAMPLES: usize = 24;
/// Part of the counted volume that is certainly in the body, where it is no box.
const SURE: f64 = 0.5;
/// Links of a point within twice the spacing, in a plane and in space.
const LINKS: [f64; 2] = [12.0, 32.0];
/// Bytes of a link: its weight and its other end.
const LINK: f64 = 12.0;
/// Bytes of a point: its place, spacing, share, temperature, capacity and heat.
const POINT: f64 = 64.0;

/// Points of a body at a spacing, never more than there will be.
#[must_use]
pub fn least_points(body: &Body, spacing: f64, dimensions: usize) -> f64 {
    let [low, high] = body.bounds();
    let cells = (0..dimensions).map(|k| ((high[k] - low[k]) / spacing).max(1.0));
    let all: f64 = cells.product();
    let along = |k: usize, n: usize| {
        if k < dimensions {
            low[k] + (high[k] - low[k]) * (n as f64 + 0.5) / SAMPLES as f64
        } else {
            0.0
        }
    };
    let deep = if dimensions == 3 { SAMPLES } else { 1 };
    let samples = (0..SAMPLES * SAMPLES * deep).filter(|n| {
        let at = [n % SAMPLES, n / SAMPLES % SAMPLES, n / (SAMPLES * SAMPLES)];
        body.holds(std::array::from_fn(|k| along(k, at[k])))
    });
    let part = samples.count() as f64 / (SAMPLES * SAMPLES * deep) as f64;
    if part < 1.0 { SURE * part * all } else { all }
}

/// Memory that so many points take at least \[byte\].
#[must_use]
pub fn bytes(points: f64, dimensions: usize) -> f64 {
    points * (POINT + LINK * LINKS[dimensions - 2])
}
