//! Equal steps on the way to an instant, none longer than asked for.

/// Part of a step that counts as rounding: six digits of a step's length are no reason for one step more.
pub(crate) const ROUNDING: f64 = 1e-6;

/// Number of equal steps of at most `longest` \[s\] over a way of `left` \[s\]; at least one.
#[must_use]
pub fn parts(left: f64, longest: f64) -> f64 {
    (left / longest * (1.0 - ROUNDING)).ceil().max(1.0)
}

/// The step \[s\] that leads from `time` to `end` \[s\] in equal steps of at most `longest` \[s\].
#[must_use]
pub fn step(time: f64, end: f64, longest: f64) -> f64 {
    let left = end - time;
    left / parts(left, longest)
}

/// The step \[s\] that leads from `time` toward `end` \[s\] in steps of about `step` \[s\], without a small one at the end.
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_meet_the_end() {
        for length in [0.3, 0.25, 0.07, 2.0] {
            for rule in [toward, step] {
                let (mut t, mut n) = (0.0, 0);
                while t < 1.0 {
                    let d = rule(t, 1.0, length);
                    assert!(d <= length * (1.0 + 1e-5) && d > 0.3 * length.min(1.0));
                    t = if (1.0 - t - d).abs() < 1e-12 {
                        1.0
                    } else {
                        t + d
                    };
                    n += 1;
                }
                assert!(n <= (1.0 / length).ceil() as usize + 1);
            }
        }
    }

    #[test]
    fn rounding_asks_for_no_step_more() {
        for [left, longest, wanted] in [
            [1.0, 0.1, 10.0],
            [0.3, 0.1, 3.0],
            [1.0, 0.333_333_3, 3.0],
            [1.0, 0.33, 4.0],
            [1.0, 5.0, 1.0],
        ] {
            assert!(
                (parts(left, longest) - wanted).abs() < 0.5,
                "{left} {longest}"
            );
        }
    }
}
