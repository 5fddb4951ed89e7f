//! Methods of `heatsph` as series of a case: patches on a scene that names none of them.
//!
//! A name is an operator (`pair`, `corrected`), then a march in time where there is one (`explicit`,
//! `stabilised`, `implicit`), then the jitter of the points in hundredths (`jitter-30`).

use serde_json::{Value, json};

use crate::case::{Bound, Case, Target};
use crate::lab::{Finished, Lab, LabError};

/// Points shifted at random may be this many times as wrong as regular ones.
const TIMES_REGULAR: f64 = 3.0;
/// What counts as exact, of the range of temperature.
const ROUND_OFF: f64 = 1e-10;

/// Competing methods of a transient case.
pub const TRANSIENT: &[&str] = &[
    "corrected-implicit",
    "pair-explicit",
    "corrected-explicit",
    "corrected-stabilised",
    "pair-implicit",
    "corrected-implicit-jitter-10",
    "corrected-implicit-jitter-30",
    "pair-implicit-jitter-30",
];

/// Competing methods of a steady case.
pub const STEADY: &[&str] = &[
    "corrected",
    "pair",
    "corrected-jitter-10",
    "corrected-jitter-30",
    "pair-jitter-30",
];

/// The patch of a method. An implicit or stabilised march takes its tolerance from the scene.
#[must_use]
pub fn patch(method: &str) -> Value {
    let mut patch = json!({});
    let mut words = method.split('-').peekable();
    while let Some(word) = words.next() {
        match word {
            "pair" => patch["operator"] = json!({"pair": {}}),
            "explicit" => patch["time"] = json!({"implicit": null, "explicit": {}}),
            "stabilised" => patch["time"] = json!({"implicit": null, "stabilised": {}}),
            "jitter" => {
                let hundredths = words.next().and_then(|w| w.parse::<f64>().ok());
                patch["points"] = json!({"jitter": hundredths.unwrap_or(0.0) / 100.0});
            }
            // `corrected` and `implicit` are what a scene has without a patch.
            _ => {}
        }
    }
    patch
}

/// The run of a case at a level: its scene with this spacing and method.
///
/// # Errors
/// When the tool fails.
pub fn run(
    case: &impl Case,
    lab: &Lab,
    level: u32,
    method: &str,
    spacing: f64,
) -> Result<Finished, LabError> {
    let points = json!({"points": {"spacing_m": spacing}});
    let label = format!("level{level}-{method}");
    lab.run(
        case.tool(),
        case.name(),
        &label,
        &over(points, &patch(method)),
    )
}

/// Lays `upper` over `lower` (RFC 7386, without the removal that `null` asks for: it stays).
#[must_use]
pub fn over(lower: Value, upper: &Value) -> Value {
    let (Value::Object(mut below), Value::Object(above)) = (lower.clone(), upper) else {
        return upper.clone();
    };
    for (key, value) in above {
        let merged = match below.get(key) {
            Some(old) if value.is_object() => over(old.clone(), value),
            _ => value.clone(),
        };
        below.insert(key.clone(), merged);
    }
    Value::Object(below)
}

/// Whether a method is the corrected operator on points shifted at random. The pair form is run on such points to
/// show what the correction is worth, and nothing is asked of it there.
#[must_use]
pub fn is_jittered(method: &str) -> bool {
    method.contains("jitter") && !method.starts_with("pair")
}

/// The targets, and those on points shifted at random: each error within three times the regular
/// one, wherever the regular one is judged.
#[must_use]
pub fn also_jittered(mut targets: Vec<Target>, methods: &[&str]) -> Vec<Target> {
    let errors = |t: &&Target| matches!(t.bound, Bound::Error { .. }) && t.method.is_none();
    let regular: Vec<Target> = targets.iter().filter(errors).cloned().collect();
    for method in methods.iter().filter(|m| is_jittered(m)) {
        targets.extend(regular.iter().map(|target| Target {
            level: target.level,
            ..Target::multiple(&target.quantity, TIMES_REGULAR, ROUND_OFF).of(*method)
        }));
    }
    targets
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_name_says_what_is_patched() {
        assert_eq!(patch("corrected-implicit"), json!({}));
        assert_eq!(
            patch("pair-explicit"),
            json!({"operator": {"pair": {}}, "time": {"implicit": null, "explicit": {}}})
        );
        assert_eq!(
            patch("corrected-stabilised-jitter-30"),
            json!({"time": {"implicit": null, "stabilised": {}}, "points": {"jitter": 0.3}})
        );
    }

    #[test]
    fn jittered_points_are_held_against_the_regular_ones() {
        let regular = vec![
            Target::error("a", 1e-3).at_level(2),
            Target::error("a", 1e-2).of("pair"),
            Target::order("a", 1.8),
        ];
        let all = also_jittered(regular.clone(), STEADY);
        assert_eq!(all[..3], regular);
        let names: Vec<String> = all[3..].iter().map(Target::name).collect();
        assert_eq!(
            names,
            [
                "a_at_level_2_of_corrected-jitter-10",
                "a_at_level_2_of_corrected-jitter-30"
            ]
        );
    }

    #[test]
    fn patches_are_laid_over_each_other() {
        let lower = json!({"points": {"spacing_m": 0.1}, "time": {"end_s": 1, "implicit": {}}});
        let found = over(lower, &patch("pair-explicit-jitter-10"));
        assert_eq!(
            found,
            json!({"points": {"spacing_m": 0.1, "jitter": 0.1},
                   "time": {"end_s": 1, "implicit": null, "explicit": {}},
                   "operator": {"pair": {}}})
        );
    }
}
