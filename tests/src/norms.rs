//! Error norms and observed orders.

/// Relative L2 and L-infinity errors of `found` against `exact`, both scaled by the largest
/// magnitude of `exact` (or by 1 where that is zero).
#[must_use]
pub fn relative(found: &[f64], exact: &[f64]) -> (f64, f64) {
    let scale = exact.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
    let scale = if scale > 0.0 { scale } else { 1.0 };
    let mut sum = 0.0;
    let mut worst = 0.0_f64;
    for (f, e) in found.iter().zip(exact) {
        let d = (f - e).abs() / scale;
        sum += d * d;
        // `max` forgets a NaN; an error that is not a number must stay one.
        worst = if d.is_nan() || worst.is_nan() {
            f64::NAN
        } else {
            worst.max(d)
        };
    }
    ((sum / found.len().max(1) as f64).sqrt(), worst)
}

/// Observed order of convergence: slope of log(error) over log(spacing) by least squares.
/// `None` with fewer than two levels or an error that is zero or not finite.
#[must_use]
pub fn observed_order(spacing: &[f64], error: &[f64]) -> Option<f64> {
    if spacing.len() < 2 || error.iter().any(|e| !e.is_finite() || *e <= 0.0) {
        return None;
    }
    let n = spacing.len() as f64;
    let x: Vec<f64> = spacing.iter().map(|h| h.ln()).collect();
    let y: Vec<f64> = error.iter().map(|e| e.ln()).collect();
    let mean_x = x.iter().sum::<f64>() / n;
    let mean_y = y.iter().sum::<f64>() / n;
    let covariance: f64 = x
        .iter()
        .zip(&y)
        .map(|(a, b)| (a - mean_x) * (b - mean_y))
        .sum();
    let variance: f64 = x.iter().map(|a| (a - mean_x).powi(2)).sum();
    (variance > 0.0).then(|| covariance / variance)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_quadratic_error_has_order_two() {
        let order = observed_order(&[0.4, 0.2, 0.1], &[0.16, 0.04, 0.01]).unwrap();
        assert!((order - 2.0).abs() < 1e-12);
    }

    #[test]
    fn an_exact_result_has_no_order() {
        assert!(observed_order(&[0.4, 0.2], &[0.0, 0.0]).is_none());
    }

    #[test]
    fn a_value_that_is_not_a_number_stays_in_the_norm() {
        let (_, worst) = relative(&[f64::NAN, 1.0], &[1.0, 1.0]);
        assert!(worst.is_nan());
    }
}
