//! The mean of a property over a stretch of time, however short its pulses are.
//!
//! Gauss' rule of three points, halved until bounds of the property over each part leave nothing hidden between its
//! points and two halves agree with the whole. A part that holds many pulses can pass both by chance: two values make few
//! different sums. So a part counts only where the property varies less in each of its eighths than in the whole.

use quadrature::THREE;
use run::property::{Arguments, Curve, OutOfRange};

/// Error of the mean, over that of the magnitude.
const TOLERANCE: f64 = 1e-4;
/// Part of the greatest magnitude within the stretch that is nothing.
const NOTHING: f64 = 1e-12;
/// Bounds wider than this many times what the points span are not trusted.
const TRUST: f64 = 3.0;
/// Shorter parts within which the property has to vary less, and how much of its variation one of them may have: an eighth of a
/// line, 0.44 of a parabola about its vertex.
const WITHIN: u32 = 8;
const LESS: f64 = 0.6;
/// Most parts of a stretch, and most rounds of halving.
const MOST: usize = 4096;
const ROUNDS: usize = 64;

/// A part of the stretch: its begin and length as parts of it, its mean times its length, and the error of that.
#[derive(Clone, Copy)]
struct Part {
    begin: f64,
    length: f64,
    sum: f64,
    gross: f64,
    error: f64,
}

/// The mean of `curve` over `length` \[s\] from the time of `at` on, and whether all of it was found.
///
/// # Errors
/// As [`Curve::value`].
///
/// ```
/// # use run::property::{Arguments, Property};
/// let pulse: Property = serde_json::from_str(r#"{"expr": "1e9*exp(-((t - 0.123)/1e-7)^2)"}"#).unwrap();
/// let curve = pulse.compile("/flux", &["t"]).unwrap();
/// let (mean, found) = poolsph::mean::in_time(&curve, &Arguments::default(), 1.0).unwrap();
/// assert!(found && (mean / (100.0 * std::f64::consts::PI.sqrt()) - 1.0).abs() < 1e-3);
/// ```
pub fn in_time(curve: &Curve, at: &Arguments, length: f64) -> Result<(f64, bool), OutOfRange> {
    if !curve.depends_on("t") {
        return Ok((curve.value(at)?, true));
    }
    let mut parts = vec![Part::new(curve, at, length, 0.0, 1.0)?];
    let ends = [0.0, 1.0].map(|s| moved(at, s * length));
    let most = curve.bounds(&ends[0], &ends[1]).most();
    let nothing = if most.is_finite() {
        NOTHING * most
    } else {
        0.0
    };
    let mut found = false;
    for _ in 0..ROUNDS {
        let gross: f64 = parts.iter().map(|p| p.gross).sum();
        let error: f64 = parts.iter().map(|p| p.error).sum();
        let wanted = TOLERANCE * gross + nothing;
        found = error <= wanted;
        if found || parts.len() > MOST {
            break;
        }
        let least = 0.5 * wanted / parts.len() as f64;
        let mut next = Vec::with_capacity(2 * parts.len());
        for part in parts {
            if part.error <= least {
                next.push(part);
                continue;
            }
            let half = 0.5 * part.length;
            next.push(Part::new(curve, at, length, part.begin, half)?);
            next.push(Part::new(curve, at, length, part.begin + half, half)?);
        }
        parts = next;
    }
    Ok((parts.iter().map(|p| p.sum).sum(), found))
}

impl Part {
    fn new(
        curve: &Curve,
        at: &Arguments,
        whole: f64,
        begin: f64,
        length: f64,
    ) -> Result<Self, OutOfRange> {
        let value = |s: f64| curve.value(&moved(at, whole * (begin + s * length)));
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        let mut gauss = |from: f64, to: f64| -> Result<(f64, f64), OutOfRange> {
            let mut sum = (0.0, 0.0);
            for (s, weight) in THREE {
                let v = value(from + s * (to - from))?;
                (low, high) = (low.min(v), high.max(v));
                sum = (sum.0 + weight * v, sum.1 + weight * v.abs());
            }
            Ok((sum.0 * (to - from), sum.1 * (to - from)))
        };
        let once = gauss(0.0, 1.0)?;
        let halves = [gauss(0.0, 0.5)?, gauss(0.5, 1.0)?];
        let sum = halves[0].0 + halves[1].0;
        let between = |from: f64, to: f64| {
            let [from, to] = [from, to].map(|s| moved(at, whole * (begin + s * length)));
            curve.bounds(&from, &to)
        };
        let bounds = between(0.0, 1.0);
        let nothing = 1e-12 * bounds.most();
        let even = (0..WITHIN).all(|k| {
            let [from, to] = [k, k + 1].map(|k| f64::from(k) / f64::from(WITHIN));
            between(from, to).width() <= LESS * bounds.width() + nothing
        });
        let trusted = even && bounds.width() <= TRUST * (high - low) + nothing;
        let error = if trusted {
            (sum - once.0).abs()
        } else {
            bounds.width().min(f64::MAX)
        };
        Ok(Self {
            begin,
            length,
            sum: length * sum,
            gross: length * (halves[0].1 + halves[1].1),
            error: length * error,
        })
    }
}

/// The same place, some time later.
fn moved(at: &Arguments, by: f64) -> Arguments {
    Arguments {
        time: at.time + by,
        ..*at
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use run::property::Property;

    #[test]
    fn many_square_pulses_have_their_mean() {
        // Half on, a tenth on, 0.3 on, in steps that hold whole numbers of periods and others.
        for (periods, on) in [
            (20.0, 0.5),
            (100.0, 0.5),
            (20.0, 0.1),
            (2.0, 0.3),
            (3.7, 0.3),
            (7.3, 0.3),
        ] {
            let period = 1e-3 / periods;
            let text = format!(
                "1e8*if({} - mod(t + {}, {period}), 1, 0)",
                on * period,
                0.1 * period
            );
            let property: Property =
                serde_json::from_str(&format!(r#"{{"expr": "{text}"}}"#)).unwrap();
            let curve = property.compile("/q", &["t"]).unwrap();
            let (mut sum, mut all) = (0.0, true);
            for step in 0..10 {
                let from = Arguments {
                    time: 1e-3 * f64::from(step),
                    ..Arguments::default()
                };
                let (mean, found) = in_time(&curve, &from, 1e-3).unwrap();
                sum += 0.1 * mean;
                all &= found;
            }
            assert!(
                all && (sum / (1e8 * on) - 1.0).abs() < 1e-3,
                "{text}: {sum} {all}"
            );
        }
    }

    #[test]
    fn pulses_and_jumps_have_their_means() {
        let from = Arguments {
            time: 2.0,
            ..Arguments::default()
        };
        for (text, exact) in [
            ("3", 3.0),
            ("t", 2.25),
            ("if(t - 2.1, if(2.1001 - t, 1e6, 0), 0)", 200.0),
            ("5 + sin(40*pi*t)", 5.0),
            ("1e8*max(0, 1 - abs(t - 2.3)/1e-6)", 200.0),
            ("if(t - 7, 1e6, 0)", 0.0),
        ] {
            let property: Property =
                serde_json::from_str(&format!(r#"{{"expr": "{text}"}}"#)).unwrap();
            let curve = property.compile("/q", &["t"]).unwrap();
            let (mean, found) = in_time(&curve, &from, 0.5).unwrap();
            assert!(
                found && (mean - exact).abs() <= 1e-3 * exact,
                "{text}: {mean}"
            );
        }
    }
}
