//! Instants that a file can tell apart: its times are whole nanoseconds.

use serde_json::Value;

use super::walk;
use crate::fault::Fault;

/// The least time between two messages of a channel \[s\].
const APART: f64 = 1e-9;
/// Endings of keys that say how often something is written.
const OFTEN: [&str; 2] = ["interval_s", "every_s"];
/// Key of the instants at which something is written.
const INSTANTS: &str = "at_s";
/// Ends of the keys that say when a run ends.
const ENDS: [&str; 3] = ["/time/end_s", "/transient/end_s", "/liquid/march/end_s"];

/// Outputs that would share one time in the file.
pub(super) fn faults(scene: &Value) -> Vec<Fault> {
    let mut found = Vec::new();
    walk::keys(scene, &mut |path, key, value| {
        let ends = ENDS.iter().any(|end| path.ends_with(end));
        let often = OFTEN.iter().any(|ending| key.ends_with(ending));
        if often || ends {
            found.extend(value.as_f64().and_then(|time| short(path, time)));
        } else if key == INSTANTS {
            found.extend(close(path, value));
        }
    });
    found
}

/// A time below that of two messages; the schema judges what is not above 0.
fn short(path: &str, time: f64) -> Option<Fault> {
    let is_short = time > 0.0 && time < APART;
    let what = || {
        format!(
            "{time:e} s is out of range: at least {APART:e} s, for times in files are whole nanoseconds and two outputs would have the same"
        )
    };
    is_short.then(|| Fault::at(path, what()))
}

/// Two instants of a list that are one in a file.
fn close(path: &str, list: &Value) -> Option<Fault> {
    let numbers = list.as_array()?.iter().enumerate();
    let mut times: Vec<(usize, f64)> = numbers
        .filter_map(|(i, time)| Some((i, time.as_f64()?)))
        .collect();
    times.sort_by(|a, b| a.1.total_cmp(&b.1));
    let pair = times.windows(2).find(|pair| {
        let apart = pair[1].1 - pair[0].1;
        // What differs by rounding is one instant.
        apart > 1e-12 * pair[1].1 && apart < APART
    })?;
    let [(_, before), (i, after)] = [pair[0], pair[1]];
    Some(Fault::at(
        &format!("{path}/{i}"),
        format!(
            "{after} s is less than {APART:e} s after {before} s, for times in files are whole nanoseconds: leave one out"
        ),
    ))
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn outputs_that_would_share_a_time_are_found_wherever_they_stand() {
        let scene = json!({
            "time": {"end_s": 1e-10, "step_s": 1e-12},
            "torches": [{"end_s": 1e-10}],
            "output": {"every_s": 9e-10, "at_s": [2e-3, 1e-3, 1.000_000_4e-3], "pool": {"interval_s": 1e-9}}
        });
        let found = faults(&scene);
        let mut paths: Vec<&str> = found.iter().map(Fault::path).collect();
        paths.sort_unstable();
        assert_eq!(paths, ["/output/at_s/2", "/output/every_s", "/time/end_s"]);
        let text = found.iter().find(|f| f.path() == "/output/every_s");
        let text = text.map(ToString::to_string).unwrap_or_default();
        assert!(
            text.contains("9e-10 s is out of range: at least 1e-9 s"),
            "{text}"
        );
    }
}
