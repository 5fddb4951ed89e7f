//! Forces of the surface in equilibrium.

use nalgebra::{DMatrix, DVector};

use crate::body::frame::{Vector, along, cross, difference, dot};
use crate::cloud::Cloud;

/// Area times normal of each patch, changed so little that their sum and their moment about any place are zero.
#[must_use]
pub fn close(cloud: &Cloud) -> Vec<Vector> {
    let mut vectors: Vec<Vector> = cloud
        .patches
        .iter()
        .map(|p| p.normal.map(|n| p.area * n))
        .collect();
    let area: f64 = cloud.patches.iter().map(|p| p.area).sum();
    let place = |p: u32| cloud.position[p as usize];
    let middle = cloud
        .patches
        .iter()
        .fold([0.0; 3], |s, p| along(s, p.area / area, place(p.point)));
    // Unknown: a shift and a turn that the area of each patch carries.
    let turns: &[usize] = if cloud.dimensions == 2 {
        &[2]
    } else {
        &[0, 1, 2]
    };
    let size = cloud.dimensions + turns.len();
    let motion = |k: usize, x: Vector| -> Vector {
        let mut unit = [0.0; 3];
        if k < cloud.dimensions {
            unit[k] = 1.0;
            unit
        } else {
            unit[turns[k - cloud.dimensions]] = 1.0;
            cross(unit, difference(x, middle))
        }
    };
    let mut matrix = DMatrix::<f64>::zeros(size, size);
    let mut right = DVector::<f64>::zeros(size);
    for (patch, vector) in cloud.patches.iter().zip(&vectors) {
        let x = place(patch.point);
        for a in 0..size {
            right[a] -= dot(motion(a, x), *vector);
            for b in 0..size {
                matrix[(a, b)] += patch.area * dot(motion(a, x), motion(b, x));
            }
        }
    }
    if let Some(factors) = matrix.cholesky() {
        let motions = factors.solve(&right);
        for (patch, vector) in cloud.patches.iter().zip(&mut vectors) {
            for k in 0..size {
                let move_k = motion(k, place(patch.point));
                *vector = along(*vector, patch.area * motions[k], move_k);
            }
        }
    }
    vectors
}
