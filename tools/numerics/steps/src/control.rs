//! The length of steps after their error (Hairer and Wanner 1996, section IV.2).

/// Part of the step that would just do.
const SAFETY: f64 = 0.8;
/// Most that a step shrinks and grows at once.
const LEAST: f64 = 0.2;
const MOST: f64 = 2.0;
/// Power of the step that the error of a step of second order follows.
const POWER: f64 = 3.0;

/// The step that suits an error of `error` times the tolerated one.
#[must_use]
pub fn suited(step: f64, error: f64) -> f64 {
    let factor = SAFETY * error.max(1e-9).powf(-1.0 / POWER);
    step * factor.clamp(LEAST, MOST)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_good_step_grows_and_a_bad_one_shrinks() {
        assert!(suited(1.0, 1e-3) > 1.9 && suited(1.0, 10.0) < 0.5);
        assert!((suited(1.0, 1e9) - LEAST).abs() < 1e-12);
    }
}
