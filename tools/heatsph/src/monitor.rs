//! Temperature at a place between points: moving least squares, exact for linear fields.

use kernels::CubicSpline;
use nalgebra::{DMatrix, DVector};

use crate::cloud::Cloud;
use shapes::frame::{Vector, difference, length};

/// Smoothing length over spacing.
const SMOOTHING: f64 = 1.2;

/// A place whose temperature is written.
#[derive(Debug, Clone, PartialEq)]
pub struct Monitor {
    /// Its name.
    pub name: String,
    weights: Vec<(u32, f64)>,
}

impl Monitor {
    /// The monitor of a cloud at a place; where points lie on one line or plane it takes the nearest.
    #[must_use]
    pub fn new(name: &str, place: &[f64], cloud: &Cloud) -> Self {
        let x: Vector = std::array::from_fn(|k| place.get(k).copied().unwrap_or(0.0));
        let nearest = (0..cloud.position.len())
            .map(|i| (length(difference(cloud.position[i], x)), i as u32))
            .min_by(|a, b| a.0.total_cmp(&b.0));
        let weights = match nearest {
            Some((away, i)) if away > 1e-9 * cloud.spacing[i as usize] => {
                fit(x, cloud, cloud.spacing[i as usize]).unwrap_or_else(|| vec![(i, 1.0)])
            }
            Some((_, i)) => vec![(i, 1.0)],
            None => Vec::new(),
        };
        Self {
            name: name.to_owned(),
            weights,
        }
    }

    /// Temperature there \[K\].
    #[must_use]
    pub fn temperature(&self, temperature: &[f64]) -> f64 {
        self.weights
            .iter()
            .map(|(i, w)| w * temperature[*i as usize])
            .sum()
    }
}

/// Weights of the points about `x`; none where they lie on one line or plane.
fn fit(x: Vector, cloud: &Cloud, spacing: f64) -> Option<Vec<(u32, f64)>> {
    let kernel = CubicSpline::<3>::new(SMOOTHING * spacing);
    let size = cloud.dimensions + 1;
    let terms = |d: Vector| -> Vec<f64> {
        let linear = d[..cloud.dimensions].iter().map(|c| c / spacing);
        std::iter::once(1.0).chain(linear).collect()
    };
    let mut near = Vec::new();
    let mut matrix = DMatrix::<f64>::zeros(size, size);
    for (i, position) in cloud.position.iter().enumerate() {
        let d = difference(*position, x);
        let weight = kernel.value(length(d)) / kernel.value(0.0);
        if weight > 0.0 {
            let p = DVector::from_vec(terms(d));
            matrix += weight * &p * p.transpose();
            near.push((i as u32, weight, p));
        }
    }
    let inverse = matrix.try_inverse()?;
    let first = inverse.row(0).transpose();
    let weights: Vec<_> = near
        .into_iter()
        .map(|(i, w, p)| (i, w * first.dot(&p)))
        .collect();
    weights
        .iter()
        .all(|(_, w)| w.is_finite())
        .then_some(weights)
}

#[cfg(test)]
mod tests {
    use super::*;
    use shapes::Body;

    #[test]
    fn a_monitor_is_exact_for_linear_fields() {
        let body = Body::new(
            &serde_json::from_str(r#"{"box": {"min_m": [0, 0], "max_m": [1, 1]}}"#).unwrap(),
            2,
        );
        let points = serde_json::from_str(r#"{"spacing_m": 0.1, "jitter": 0.3}"#).unwrap();
        let cloud = Cloud::fill(&body, &points, 2).unwrap();
        let field: Vec<f64> = cloud
            .position
            .iter()
            .map(|x| 3.0 + x[0] - 2.0 * x[1])
            .collect();
        for place in [[0.43, 0.57], [0.0, 0.0], [1.0, 0.33], [0.97, 0.99]] {
            let found = Monitor::new("a", &place, &cloud).temperature(&field);
            assert!(
                (found - (3.0 + place[0] - 2.0 * place[1])).abs() < 1e-11,
                "{place:?}"
            );
        }
    }
}
