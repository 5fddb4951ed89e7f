//! Random shifts of points.

use super::Cloud;
use super::points::Points;
use shapes::frame::Vector;

/// A number in [-1, 1) from a seed and two counters (the mixing of Steele, Lea and Flood 2014, "SplitMix").
fn random(seed: u64, point: u64, axis: u64) -> f64 {
    let mut z = seed
        .wrapping_mul(0xD6E8_FEB8_6659_FD93)
        .wrapping_add((3 * point + axis + 1).wrapping_mul(0x9E37_79B9_7F4A_7C15));
    z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    z ^= z >> 31;
    (z >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
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
