//! A temperature between points: by least squares, exact where it is linear.
//!
//! ```text
//! min over a of sum_j w_j (a_0 + a . (x_j - x) - T_j)^2,   w = (1 - r/R)^2
//! ```
//!
//! It stays between the least and the greatest of the points around. Where few points are, or all in a plane, it is their mean.

use neighbours::Tree;

/// Reach of a point, in spacings.
const REACH: f64 = 2.0;
/// A place farther from all points than this many spacings is outside.
const OUTSIDE: f64 = 1.5;
/// Least pivot over the greatest entry, below which a system has no solution.
const FLAT: f64 = 1e-9;

/// Temperatures of points.
pub(super) struct Field<'a> {
    tree: Tree,
    places: &'a [[f64; 3]],
    values: &'a [f64],
    spacing: f64,
}

impl<'a> Field<'a> {
    /// Values at places of about this spacing \[m\].
    pub(super) fn new(places: &'a [[f64; 3]], values: &'a [f64], spacing: f64) -> Self {
        Self {
            tree: Tree::new(places),
            places,
            values,
            spacing,
        }
    }

    /// The value at a place; nothing where no point is near.
    pub(super) fn at(&self, x: [f64; 3]) -> Option<f64> {
        let reach = REACH * self.spacing;
        let (mut nearest, mut range) = (f64::INFINITY, [f64::INFINITY, f64::NEG_INFINITY]);
        let (mut system, mut sums) = ([[0.0; 5]; 4], [0.0; 2]);
        self.tree.within(x, reach, |j, square| {
            let r = square.sqrt();
            nearest = nearest.min(r);
            let weight = (1.0 - r / reach).powi(2);
            let value = self.values[j];
            range = [range[0].min(value), range[1].max(value)];
            let step = |k: usize| (self.places[j][k] - x[k]) / self.spacing;
            let row = [1.0, step(0), step(1), step(2), value];
            for (line, own) in system.iter_mut().zip(row) {
                for (entry, other) in line.iter_mut().zip(row) {
                    *entry += weight * own * other;
                }
            }
            sums = [sums[0] + weight, sums[1] + weight * value];
        });
        if nearest > OUTSIDE * self.spacing {
            return None;
        }
        let mean = sums[1] / sums[0];
        let found = first(system).unwrap_or(mean);
        Some(found.clamp(range[0], range[1]))
    }
}

/// The first unknown of four equations with their right sides; nothing where they have no single solution.
fn first(mut system: [[f64; 5]; 4]) -> Option<f64> {
    let scale = system[0][0].abs();
    // From the last unknown on, so that the first is found without going back.
    for k in (1..4).rev() {
        let pivot = (1..=k).max_by(|a, b| system[*a][k].abs().total_cmp(&system[*b][k].abs()))?;
        system.swap(k, pivot);
        if system[k][k].abs() <= FLAT * scale {
            return None;
        }
        let line = system[k];
        for (number, other) in system.iter_mut().enumerate() {
            if number < k {
                let part = other[k] / line[k];
                other.iter_mut().zip(line).for_each(|(x, y)| *x -= part * y);
            }
        }
    }
    let [a, .., b] = system[0];
    (a.abs() > FLAT * scale).then(|| b / a)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cloud() -> Vec<[f64; 3]> {
        let mut places = Vec::new();
        for i in 0..512 {
            let cell = [i % 8, (i / 8) % 8, i / 64];
            // Shaken, and the same each time.
            let off = |k: i32| 0.3 * (f64::from(i * (7 + 4 * k)) * 1.7).sin();
            places.push([0, 1, 2].map(|k| 1e-3 * (f64::from(cell[k]) + off(k as i32))));
        }
        places
    }

    #[test]
    fn a_linear_temperature_is_exact_in_disorder() {
        let places = cloud();
        let linear = |x: [f64; 3]| 400.0 + 2e4 * x[0] - 3e4 * x[1] + 1e4 * x[2];
        let values: Vec<f64> = places.iter().map(|x| linear(*x)).collect();
        let field = Field::new(&places, &values, 1e-3);
        for x in [
            [3.1e-3, 2.2e-3, 4.9e-3],
            [2.5e-3; 3],
            [5e-3, 4.4e-3, 3.3e-3],
        ] {
            let found = field.at(x).unwrap();
            assert!((found - linear(x)).abs() < 1e-8, "{found} {}", linear(x));
        }
    }

    #[test]
    fn a_place_without_points_is_outside_and_a_plane_of_points_gives_its_mean() {
        let places = cloud();
        let values = vec![300.0; places.len()];
        let field = Field::new(&places, &values, 1e-3);
        assert_eq!(field.at([0.02, 0.0, 0.0]), None);
        let flat: Vec<[f64; 3]> = (0..9)
            .map(|i| [f64::from(i % 3), f64::from(i / 3), 0.0])
            .collect();
        let values: Vec<f64> = flat.iter().map(|x| 10.0 * x[0]).collect();
        let field = Field::new(&flat, &values, 1.0);
        assert!((field.at([1.0, 1.0, 0.0]).unwrap() - 10.0).abs() < 1e-9);
    }
}
