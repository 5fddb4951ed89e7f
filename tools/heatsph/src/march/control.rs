//! The length of steps: given, or after their error (Hairer and Wanner 1996, section IV.2).

/// Part of the step that would just do.
const SAFETY: f64 = 0.8;
/// Most that a step shrinks and grows at once.
const LEAST: f64 = 0.2;
const MOST: f64 = 2.0;
/// Power of the step that the error of a step of second order follows.
const POWER: f64 = 3.0;

/// Part of a temperature below which differences are none.
const NOTHING: f64 = 1e-10;

/// The difference of temperature below which there is none, where temperatures lie between `low` and `high` \[K\]:
/// errors over the range of temperature say nothing of a body of one temperature.
#[must_use]
pub fn floor(low: f64, high: f64) -> f64 {
    NOTHING * low.abs().max(high.abs())
}

/// The step that suits an error of `error` times the tolerated one.
#[must_use]
pub fn suited(step: f64, error: f64) -> f64 {
    let factor = SAFETY * error.max(1e-9).powf(-1.0 / POWER);
    step * factor.clamp(LEAST, MOST)
}

/// The step that leads toward `end` from `time` in steps of about `step`, without a small one at the end.
#[must_use]
pub fn toward(time: f64, end: f64, step: f64) -> f64 {
    let left = end - time;
    if left <= step * (1.0 + 1e-9) {
        left
    } else if left < 2.0 * step {
        0.5 * left
    } else {
        step
    }
}

/// As [`toward`] in equal steps.
#[must_use]
pub fn even(time: f64, end: f64, step: f64) -> f64 {
    let left = end - time;
    left / (left / step * (1.0 - 1e-9)).ceil().max(1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_meet_the_end() {
        for step in [0.3, 0.25, 0.07, 2.0] {
            for rule in [toward, even] {
                let (mut t, mut n) = (0.0, 0);
                while t < 1.0 {
                    let d = rule(t, 1.0, step);
                    assert!(d <= step * (1.0 + 1e-6) && d > 0.3 * step.min(1.0));
                    t = if (1.0 - t - d).abs() < 1e-12 {
                        1.0
                    } else {
                        t + d
                    };
                    n += 1;
                }
                assert!(n <= (1.0 / step).ceil() as usize + 1);
            }
        }
    }

    #[test]
    fn a_good_step_grows_and_a_bad_one_shrinks() {
        assert!(suited(1.0, 1e-3) > 1.9 && suited(1.0, 10.0) < 0.5);
        assert!((suited(1.0, 1e9) - LEAST).abs() < 1e-12);
    }
}
