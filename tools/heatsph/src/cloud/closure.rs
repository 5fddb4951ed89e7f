//! Areas of patches that close the surface.
//!
//! The forces of a pressure on a closed surface balance: `sum A_e n_e = 0`, and so do their moments,
//! `sum x_e x A_e n_e = 0` with the points that bear them. On curved and cut surfaces the patches do so but for a
//! small part. The areas are changed by what mends it,
//!
//! ```text
//! A'_e = A_e (1 + c . n_e + w . (x_e x n_e))
//! ```
//!
//! with the least c and w; normals stay, so that fluxes given along them stay right.

use nalgebra::{DMatrix, DVector};

use super::Cloud;
use shapes::frame::{Vector, along, cross, difference, length};

/// Part of the mean of the diagonal that keeps directions out in which nothing can be changed.
const LEAST: f64 = 1e-10;
/// Rounds: what rounding leaves of one is mended by the next.
const ROUNDS: usize = 3;

/// Changes the areas of a cloud's patches so that its surface is closed.
pub(super) fn close(cloud: &mut Cloud) {
    for _ in 0..ROUNDS {
        mend(cloud);
    }
}

fn mend(cloud: &mut Cloud) {
    let area: f64 = cloud.patches.iter().map(|p| p.area).sum();
    let middle = cloud.patches.iter().fold([0.0; 3], |s, p| {
        along(s, p.area / area, cloud.position[p.point as usize])
    });
    let reach = |x: &Vector| length(difference(*x, middle));
    let size = cloud
        .position
        .iter()
        .map(reach)
        .fold(f64::MIN_POSITIVE, f64::max);
    // What a patch of unit area contributes to force and moment, in units of the body's size.
    let share = |normal: Vector, x: Vector| -> Vec<f64> {
        let arm = difference(x, middle).map(|d| d / size);
        let moment = cross(arm, normal);
        if cloud.dimensions == 2 {
            vec![normal[0], normal[1], moment[2]]
        } else {
            normal.into_iter().chain(moment).collect()
        }
    };
    let unknowns = if cloud.dimensions == 2 { 3 } else { 6 };
    let mut matrix = DMatrix::<f64>::zeros(unknowns, unknowns);
    let mut right = DVector::<f64>::zeros(unknowns);
    let shares: Vec<Vec<f64>> = cloud
        .patches
        .iter()
        .map(|p| share(p.normal, cloud.position[p.point as usize]))
        .collect();
    for (patch, share) in cloud.patches.iter().zip(&shares) {
        let share = DVector::from_column_slice(share);
        right -= patch.area * &share;
        matrix += patch.area * &share * share.transpose();
    }
    let least = LEAST * matrix.trace() / unknowns as f64;
    for k in 0..unknowns {
        matrix[(k, k)] += least;
    }
    let Some(factors) = matrix.cholesky() else {
        return;
    };
    let change = factors.solve(&right);
    for (patch, share) in cloud.patches.iter_mut().zip(&shares) {
        patch.area *= 1.0 + DVector::from_column_slice(share).dot(&change);
    }
}
