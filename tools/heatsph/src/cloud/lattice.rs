//! The lattice of a box, with points on its faces.

use super::points::Points;
use super::{Cloud, Patch, gaps, graded, widths};

/// Fills a box of the given half extents about the origin.
pub(super) fn fill(half: [f64; 3], points: &Points, dimensions: usize) -> Cloud {
    let ratios = [points.grading.x, points.grading.y, points.grading.z];
    let nodes: [Vec<f64>; 3] = std::array::from_fn(|k| {
        if k >= dimensions {
            return vec![0.0];
        }
        let steps = ((2.0 * half[k] / points.spacing_m).round() as usize).max(1);
        let offsets = graded(steps, ratios[k]);
        offsets.iter().map(|t| half[k] * (2.0 * t - 1.0)).collect()
    });
    let width: [Vec<f64>; 3] = std::array::from_fn(|k| {
        if k < dimensions {
            widths(&nodes[k])
        } else {
            vec![1.0]
        }
    });
    let gap: [Vec<f64>; 3] = std::array::from_fn(|k| {
        if k < dimensions {
            gaps(&nodes[k])
        } else {
            vec![0.0]
        }
    });
    let first = [0, 1, 2].map(|k| gap[k][0]);
    let even = (0..dimensions).all(|k| {
        gap[k]
            .iter()
            .all(|g| (g - first[0]).abs() < 1e-9 * first[0])
    });
    let mut cloud = Cloud {
        dimensions,
        lattice: even,
        ..Cloud::default()
    };
    for k in 0..nodes[2].len() {
        for j in 0..nodes[1].len() {
            for i in 0..nodes[0].len() {
                let at = [i, j, k];
                let x = [0, 1, 2].map(|a| nodes[a][at[a]]);
                let w = [0, 1, 2].map(|a| width[a][at[a]]);
                let spacing = (0..dimensions).map(|a| gap[a][at[a]]).fold(0.0, f64::max);
                let point = cloud.push(x, spacing, w[0] * w[1] * w[2]);
                own(&mut cloud, point, &nodes, at, w);
            }
        }
    }
    cloud
}

/// Gives a point its parts of the faces on which it lies.
fn own(cloud: &mut Cloud, point: u32, nodes: &[Vec<f64>; 3], at: [usize; 3], width: [f64; 3]) {
    for axis in 0..cloud.dimensions {
        let last = nodes[axis].len() - 1;
        let area = width[0] * width[1] * width[2] / width[axis];
        for (side, face) in [(0, 2 * axis), (last, 2 * axis + 1)] {
            if at[axis] == side {
                let mut normal = [0.0; 3];
                normal[axis] = if side == 0 { -1.0 } else { 1.0 };
                cloud.patches.push(Patch {
                    point,
                    face: face as u32,
                    area,
                    normal,
                    place: middle(nodes, at, axis, cloud.dimensions),
                });
            }
        }
    }
}

/// Middle of the part of a face that a node stands for: it lies aside of the node at the face's edges.
fn middle(nodes: &[Vec<f64>; 3], at: [usize; 3], axis: usize, dimensions: usize) -> [f64; 3] {
    std::array::from_fn(|k| {
        let x = nodes[k][at[k]];
        if k == axis || k >= dimensions {
            return x;
        }
        let last = nodes[k].len() - 1;
        let low = 0.5 * (x + nodes[k][at[k].saturating_sub(1)]);
        let high = 0.5 * (x + nodes[k][(at[k] + 1).min(last)]);
        0.5 * (low + high)
    })
}
