//! How far a figure is from what it tends to as a knob is refined.
//!
//! With sizes h_i of the knob (a spacing, a step) and values f_i, the model is
//!
//! ```text
//! f(h) = f_0 + c h^p
//! ```
//!
//! fitted by least squares with weights 1/h_i over p between 1/2 and the formal order (Eca and Hoekstra 2014). The band about
//! f(h) is the grid convergence index (Roache 1994): 1.25 |f(h) - f_0| where three or more sizes approach one value, and three
//! times where the order is assumed, or the values swing or barely approach (then the order is assumed too); twice the standard deviation of the fit is added.
//! It is never below what the values cannot be told apart by. Equal values of two sizes may be so by chance and have no band; of three or
//! more they have one of rounding, and where they are whole numbers, as counts are, one of a half.

use serde::Serialize;

/// Least order that a fit may have: below, values barely approach anything.
const LEAST_ORDER: f64 = 0.5;
/// Factor of safety of a fit that can be trusted, and of one that cannot (Roache 1994).
const SAFETY: [f64; 2] = [1.25, 3.0];

/// What solvers leave of a figure and no series can see, over its size.
const UNSEEN: f64 = 1e-10;

/// Half of the step between counts.
const COUNTED: f64 = 0.5;

/// What a series of a knob tells of a figure at the base size.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Band {
    /// Observed order; none where it was assumed.
    pub order: Option<f64>,
    /// What the figure tends to.
    pub extrapolated: f64,
    /// Half the width of the band about the base value.
    pub half_width: f64,
    /// Whether the series approaches its limit as its order says: else the band is wide.
    pub trusted: bool,
}

impl Band {
    /// Of a figure that a knob cannot change.
    pub(super) fn none_about(value: f64) -> Self {
        Self {
            order: None,
            extrapolated: value,
            half_width: UNSEEN * value.abs(),
            trusted: true,
        }
    }
}

/// A fit of f_0 + c h^p for a given p: f_0, c, and the standard deviation of what is left.
fn fitted(sizes: &[f64], values: &[f64], p: f64) -> [f64; 3] {
    let weights: Vec<f64> = sizes.iter().map(|h| 1.0 / h).collect();
    let total: f64 = weights.iter().sum();
    let mean = |of: &dyn Fn(usize) -> f64| {
        weights
            .iter()
            .enumerate()
            .map(|(i, w)| w * of(i))
            .sum::<f64>()
            / total
    };
    let power: Vec<f64> = sizes.iter().map(|h| h.powf(p)).collect();
    let (x, y) = (mean(&|i| power[i]), mean(&|i| values[i]));
    let spread = mean(&|i| (power[i] - x).powi(2));
    let slope = mean(&|i| (power[i] - x) * (values[i] - y)) / spread;
    let f0 = y - slope * x;
    let left = mean(&|i| (values[i] - f0 - slope * power[i]).powi(2));
    let free = sizes.len().saturating_sub(2).max(1);
    [f0, slope, (left * sizes.len() as f64 / free as f64).sqrt()]
}

/// The order between 1/2 and `formal` whose fit leaves least, by golden section on a scan.
fn order(sizes: &[f64], values: &[f64], formal: f64) -> f64 {
    let left = |p: f64| fitted(sizes, values, p)[2];
    let parts = 200;
    let at = |k: usize| LEAST_ORDER + (formal - LEAST_ORDER) * k as f64 / f64::from(parts);
    let best = (0..=parts as usize).min_by(|a, b| left(at(*a)).total_cmp(&left(at(*b))));
    let best = best.unwrap_or(0);
    let (mut low, mut high) = (
        at(best.saturating_sub(1)),
        at((best + 1).min(parts as usize)),
    );
    for _ in 0..60 {
        let third = (high - low) / 3.0;
        if left(low + third) < left(high - third) {
            high -= third;
        } else {
            low += third;
        }
    }
    0.5 * (low + high)
}

/// The band of a figure about its value at the size `base`, which is one of `sizes`.
///
/// `formal` is the order that the method promises in this knob, and the greatest that is believed. None with fewer than two sizes, or
/// where two have the same value, or all the value 0.
#[must_use]
pub fn band(sizes: &[f64], values: &[f64], base: f64, formal: f64) -> Option<Band> {
    let at = sizes.iter().position(|h| (h - base).abs() <= 1e-9 * base)?;
    let value = values[at];
    let apart = values
        .iter()
        .fold(0.0_f64, |m, v| m.max((v - values[0]).abs()));
    let noise = UNSEEN * values.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
    if sizes.len() < 2 || values.iter().any(|v| !v.is_finite()) {
        return None;
    }
    if apart <= noise {
        return (sizes.len() > 2 && noise > 0.0).then(|| Band {
            order: None,
            extrapolated: value,
            half_width: if value.fract().abs() <= 0.0 {
                COUNTED
            } else {
                noise
            },
            trusted: true,
        });
    }
    if sizes.len() == 2 {
        let [f0, ..] = fitted(sizes, values, formal);
        return Some(Band {
            order: None,
            extrapolated: f0,
            half_width: SAFETY[1] * (value - f0).abs(),
            trusted: false,
        });
    }
    let p = order(sizes, values, formal);
    let found = p > LEAST_ORDER + 1e-3;
    let approaches = monotone(sizes, values) && found;
    // Values that barely approach anything lead a fit of their own order far away: it takes that of the method, or 1.
    let p = if found {
        p
    } else {
        let left = |p: &f64| fitted(sizes, values, *p)[2];
        let known = [formal, formal.min(1.0)];
        (known.into_iter().min_by(|a, b| left(a).total_cmp(&left(b)))).unwrap_or(formal)
    };
    let [f0, _, left] = fitted(sizes, values, p);
    // A fit of every order passes through no noise: where more is left than a twentieth of the difference, it is no law.
    let trusted = approaches && left < 0.05 * apart;
    let error = (value - f0).abs();
    // At the top of its range the order is that of the method, and the series may converge faster for a while by chance.
    let half_width = if trusted {
        SAFETY[0] * error + 2.0 * left
    } else {
        (SAFETY[1] * error).min(SAFETY[1] * apart).max(apart) + 2.0 * left
    };
    Some(Band {
        order: found.then_some(p),
        extrapolated: f0,
        half_width: half_width.max(noise),
        trusted,
    })
}

/// Whether the values go one way as the sizes fall, by steps that shrink.
fn monotone(sizes: &[f64], values: &[f64]) -> bool {
    let mut order: Vec<usize> = (0..sizes.len()).collect();
    order.sort_by(|a, b| sizes[*b].total_cmp(&sizes[*a]));
    let steps: Vec<f64> = order
        .windows(2)
        .map(|w| values[w[1]] - values[w[0]])
        .collect();
    steps.iter().all(|s| *s > 0.0) || steps.iter().all(|s| *s < 0.0)
}

/// Mean and half width of the 95 % interval of a sample of independent runs; no interval of fewer than two.
#[must_use]
pub fn scatter(values: &[f64]) -> (f64, Option<f64>) {
    let n = values.len() as f64;
    let mean = values.iter().sum::<f64>() / n;
    if values.len() < 2 {
        return (mean, None);
    }
    let variance = values.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / (n - 1.0);
    (
        mean,
        Some(student(values.len() - 1) * (variance / n).sqrt()),
    )
}

/// The 97.5 % point of Student's t (Fisher and Yates; beyond 30 by Cornish and Fisher's expansion).
fn student(freedom: usize) -> f64 {
    const TABLE: [f64; 30] = [
        12.706, 4.303, 3.182, 2.776, 2.571, 2.447, 2.365, 2.306, 2.262, 2.228, 2.201, 2.179, 2.160,
        2.145, 2.131, 2.120, 2.110, 2.101, 2.093, 2.086, 2.080, 2.074, 2.069, 2.064, 2.060, 2.056,
        2.052, 2.048, 2.045, 2.042,
    ];
    match TABLE.get(freedom.wrapping_sub(1)) {
        Some(t) => *t,
        None => {
            let (z, n) = (1.959_964_f64, freedom as f64);
            z + (z.powi(3) + z) / (4.0 * n)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_clean_series_gives_its_order_and_its_limit() {
        for p in [0.8, 1.0, 1.7, 2.0] {
            let sizes = [0.4, 0.2, 0.1];
            let values = sizes.map(|h: f64| 3.0 + 0.5 * h.powf(p));
            let band = band(&sizes, &values, 0.1, 2.0).unwrap();
            assert!((band.order.unwrap() - p).abs() < 1e-3, "{band:?}");
            assert!((band.extrapolated - 3.0).abs() < 1e-5 && band.trusted);
            let error: f64 = values[2] - 3.0;
            assert!((band.half_width / (1.25 * error) - 1.0).abs() < 0.01);
        }
    }

    #[test]
    fn the_base_need_not_be_the_finest() {
        let sizes = [0.4, 0.2, 0.1, 0.05];
        let values = sizes.map(|h: f64| 3.0 - h * h);
        let band = band(&sizes, &values, 0.2, 2.0).unwrap();
        assert!((band.half_width - 1.25 * 0.04).abs() < 1e-4);
    }

    #[test]
    fn values_that_swing_get_a_wide_band() {
        let band = band(&[0.4, 0.2, 0.1], &[1.0, 1.4, 1.1], 0.1, 2.0).unwrap();
        assert!(!band.trusted && band.half_width >= 0.4, "{band:?}");
    }

    #[test]
    fn values_that_barely_approach_are_not_led_far_away() {
        let band = band(&[2.0, 1.33, 1.0, 0.8], &[115.0, 95.0, 90.0, 78.0], 1.0, 1.0).unwrap();
        assert!(!band.trusted && band.order.is_none(), "{band:?}");
        assert!((40.0..70.0).contains(&band.extrapolated), "{band:?}");
        assert!(band.half_width > 37.0);
    }

    #[test]
    fn two_sizes_take_the_order_of_the_method() {
        let band = band(&[0.2, 0.1], &[3.04, 3.01], 0.1, 2.0).unwrap();
        assert!((band.extrapolated - 3.0).abs() < 1e-12);
        assert!((band.half_width - 0.03).abs() < 1e-12 && !band.trusted);
    }

    #[test]
    fn what_a_knob_does_not_change_has_no_band() {
        let band = band(&[0.2, 0.1, 0.05], &[3.1; 3], 0.1, 2.0).unwrap();
        assert!(band.half_width < 1e-9);
        assert!(super::band(&[0.1], &[3.0], 0.1, 2.0).is_none());
    }

    #[test]
    fn equal_values_are_not_trusted_farther_than_they_tell() {
        // Seven drops at both spacings, or at three.
        assert!(band(&[0.2, 0.1], &[7.0; 2], 0.1, 2.0).is_none());
        let counted = band(&[0.2, 0.1, 0.05], &[7.0; 3], 0.1, 2.0).unwrap();
        assert!((counted.half_width - 0.5).abs() < 1e-15);
        assert!(band(&[0.2, 0.1, 0.05], &[0.0; 3], 0.1, 2.0).is_none());
    }

    #[test]
    fn three_runs_scatter_by_students_t() {
        let (mean, half) = scatter(&[1.0, 2.0, 3.0]);
        assert!((mean - 2.0).abs() < 1e-15);
        assert!((half.unwrap() - 4.303 / 3.0_f64.sqrt()).abs() < 1e-12);
        assert_eq!(scatter(&[1.0]).1, None);
        assert!((student(1000) - 1.9623).abs() < 1e-3 && student(30) > student(31));
    }
}
