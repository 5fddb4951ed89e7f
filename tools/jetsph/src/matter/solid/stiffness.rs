//! How stiff a cell is for its neighbours.

use nalgebra::DMatrix;

use super::links::{Row, second};

/// Stiffness of a cell for its neighbours \[1/m2\]: the greatest eigenvalue of `S W W^T S`, W its weights and S the roots of its
/// moments. A fit beside a crack, from one side, can be stiffer than any at rest, and the step follows.
pub(super) fn stiffness<const T: usize>(row: &Row<'_, T>, moment: [f64; 3]) -> f64 {
    let dimensions = if T == 5 { 2 } else { 3 };
    let mut scale = [1.0; T];
    for k in 0..dimensions {
        for l in k..dimensions {
            let both = if k == l {
                moment[k]
            } else {
                moment[k] + moment[l]
            };
            scale[second(dimensions, k, l)] = both.sqrt();
        }
    }
    let product = DMatrix::from_fn(T, T, |m, n| {
        let pairs = row.weight.iter().map(|w| w[m] * w[n]).sum::<f64>();
        scale[m] * scale[n] * (pairs + row.total[m] * row.total[n])
    });
    let values = product.symmetric_eigenvalues();
    values.iter().fold(0.0, |most, value| most.max(*value))
}
