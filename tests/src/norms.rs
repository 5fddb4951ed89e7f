//! Error norms and observed orders.

/// The greatest of errors, which are 0 or more.
pub trait Worst: Iterator<Item = f64> + Sized {
    /// The greatest; not a number where there is none, or where one is none: `max` would forget it, and 0 would pass.
    fn worst(self) -> f64 {
        let greater = |a: f64, b: f64| {
            if a.is_nan() || b.is_nan() {
                f64::NAN
            } else {
                a.max(b)
            }
        };
        self.reduce(greater).unwrap_or(f64::NAN)
    }
}

impl<I: Iterator<Item = f64>> Worst for I {}

/// Relative L2 and L-infinity errors of `found` against `exact`, both scaled by the largest
/// magnitude of `exact` (or by 1 where that is zero). Not numbers where there is nothing, or less than is exact.
#[must_use]
pub fn relative(found: &[f64], exact: &[f64]) -> (f64, f64) {
    if found.len() != exact.len() {
        return (f64::NAN, f64::NAN);
    }
    let scale = exact.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
    let scale = if scale > 0.0 { scale } else { 1.0 };
    let apart = || found.iter().zip(exact).map(|(f, e)| (f - e).abs() / scale);
    let sum: f64 = apart().map(|d| d * d).sum();
    ((sum / found.len() as f64).sqrt(), apart().worst())
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
    fn nothing_has_no_error() {
        let none = |(mean, worst): (f64, f64)| mean.is_nan() && worst.is_nan();
        assert!(none(relative(&[], &[])) && none(relative(&[1.0], &[1.0, 2.0])));
        assert!(
            [0.0; 0].into_iter().worst().is_nan()
                && [1.0, f64::NAN, 2.0].into_iter().worst().is_nan()
        );
        assert!(([1.0, 3.0, 2.0].into_iter().worst() - 3.0).abs() < 1e-15);
    }

    #[test]
    fn a_value_that_is_not_a_number_stays_in_the_norm() {
        let (_, worst) = relative(&[f64::NAN, 1.0], &[1.0, 1.0]);
        assert!(worst.is_nan());
    }
}
