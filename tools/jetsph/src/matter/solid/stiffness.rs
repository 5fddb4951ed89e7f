//! How stiff a cell is for its neighbours.

use nalgebra::DMatrix;

use super::quadratic::second;

/// Stiffness of a cell for its neighbours \[1/m2\]: the greatest eigenvalue of `S W W^T S`, W its weights and S the roots of its
/// moments. A fit beside a crack, from one side, can be stiffer than any at rest, and the step follows.
pub(super) fn stiffness<const T: usize>(weights: &[[f64; T]], moment: [f64; 3]) -> f64 {
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
    let total: [f64; T] = std::array::from_fn(|m| weights.iter().map(|w| w[m]).sum());
    let product = DMatrix::from_fn(T, T, |m, n| {
        let pairs = weights.iter().map(|w| w[m] * w[n]).sum::<f64>();
        scale[m] * scale[n] * (pairs + total[m] * total[n])
    });
    // Without finite numbers there are no eigenvalues.
    if product.iter().any(|x| !x.is_finite()) {
        return f64::INFINITY;
    }
    let values = product.symmetric_eigenvalues();
    values.iter().fold(0.0, |most, value| most.max(*value))
}
