//! Random shifts of points.

use super::Cloud;
use super::points::Points;
use shapes::frame::Vector;
use shapes::jitter::signed;

/// A number from -1 to 1 from a seed and two counters.
fn random(seed: u64, point: u64, axis: u64) -> f64 {
    signed(seed.wrapping_mul(0xD6E8_FEB8_6659_FD93), 3 * point + axis)
}

/// The place of point `number` after its shift.
pub(super) fn shifted(
    x: Vector,
    number: u64,
    points: &Points,
    spacing: f64,
    dimensions: usize,
) -> Vector {
    if points.jitter <= 0.0 {
        return x;
    }
    std::array::from_fn(|k| {
        if k < dimensions {
            x[k] + points.jitter * spacing * random(points.seed, number, k as u64)
        } else {
            x[k]
        }
    })
}

/// Shifts every point that owns no surface.
pub(super) fn inner_points(cloud: &mut Cloud, points: &Points) {
    if points.jitter <= 0.0 {
        return;
    }
    let mut outer = vec![false; cloud.position.len()];
    for patch in &cloud.patches {
        outer[patch.point as usize] = true;
    }
    for (number, x) in cloud.position.iter_mut().enumerate() {
        if !outer[number] {
            let spacing = cloud.spacing[number];
            *x = shifted(*x, number as u64, points, spacing, cloud.dimensions);
        }
    }
    cloud.lattice = false;
}
