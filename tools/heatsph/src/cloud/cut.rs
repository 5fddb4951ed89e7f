//! A lattice along the axes, cut by a body: points well inside, none on the surface.

use super::points::Points;
use super::{Cloud, CloudError, shift};
use shapes::Body;
use shapes::surface;

/// Points nearer to the surface than this part of the spacing are left out.
const NEAREST: f64 = 0.25;

/// Fills any body. Along each axis the lattice lies evenly between the ends of the body.
pub(super) fn fill(body: &Body, points: &Points, dimensions: usize) -> Result<Cloud, CloudError> {
    let spacing = points.spacing_m;
    let [low, high] = body.bounds();
    let counts = [0, 1, 2].map(|k| {
        if k < dimensions {
            (((high[k] - low[k]) / spacing).round() as usize).max(1)
        } else {
            1
        }
    });
    let start = [0, 1, 2].map(|k| {
        if k < dimensions {
            0.5 * (low[k] + high[k]) - 0.5 * spacing * (counts[k] - 1) as f64
        } else {
            0.0
        }
    });
    let mut cloud = Cloud {
        dimensions,
        faces: surface::names(body, dimensions),
        ..Cloud::default()
    };
    let share = spacing.powi(dimensions as i32);
    let mut number = 0;
    for k in 0..counts[2] {
        for j in 0..counts[1] {
            for i in 0..counts[0] {
                let at = [i, j, k];
                let plain = std::array::from_fn(|a| start[a] + spacing * at[a] as f64);
                let x = shift::shifted(plain, number, points, spacing, dimensions);
                number += 1;
                if body.distance(x) < -NEAREST * spacing {
                    cloud.push(x, spacing, share);
                }
            }
        }
    }
    if cloud.position.is_empty() {
        return Err(CloudError::Empty(spacing));
    }
    let pieces = surface::pieces(body, dimensions, spacing);
    cloud.own(&pieces, spacing);
    Ok(cloud)
}
