//! Reads a sweep, and finds all that is wrong with it before anything runs.

use std::path::Path;

use run::scene::{Loaded, load, located, nearest, schema_of};
use run::{Failure, Fault};

use crate::plan::{Input, KIND, Sweep};
use crate::points::Points;
use crate::template::{calls, named_by, texts};
use crate::values::{self, Named};

/// More points than this are a slip of the pen.
const MOST_POINTS: usize = 10_000;

/// Reads a sweep, whole and sound; paths in it begin at `root`.
///
/// # Errors
/// With every fault, each with file, line, path and value.
pub(crate) fn read(path: &Path, root: &Path) -> Result<Sweep, Failure> {
    let Loaded { scene, merged, .. } = load::<Sweep>(path, &[], &schema_of::<Sweep>(KIND), KIND)?;
    let mut faults = faults(&scene, root);
    if faults.is_empty() {
        faults.extend(Points::of(scene.clone(), path).confused());
    }
    if faults.is_empty() {
        return Ok(scene);
    }
    Err(Failure::Scene(located(faults, &merged)))
}

fn faults(sweep: &Sweep, root: &Path) -> Vec<Fault> {
    let mut all = Vec::new();
    if !root.join("pipelines").join(&sweep.study).is_dir() || !is_name(&sweep.study, '-') {
        let what = format!("there is no study pipelines/{}", sweep.study);
        all.push(Fault::at("/study", what));
    }
    all.extend(of_parameters(sweep));
    for (i, stage) in sweep.stages.iter().enumerate() {
        all.extend(of_stage(sweep, i, root).map(|f| f.within(&format!("/stages/{i}"))));
        let earlier = sweep.stages[..i].iter();
        if earlier.filter(|other| other.name == stage.name).count() > 0 {
            all.push(twice(&format!("/stages/{i}/name"), &stage.name));
        }
    }
    let names: Vec<&str> = sweep.stages.iter().map(|s| s.name.as_str()).collect();
    for (i, figure) in sweep.figures.iter().enumerate() {
        let at = format!("/figures/{i}");
        all.extend(
            unknown(&figure.stage, &names, "stage").map(|w| Fault::at(&format!("{at}/stage"), w)),
        );
        if figure
            .factor
            .is_some_and(|f| !f.is_finite() || f.abs() < f64::MIN_POSITIVE)
        {
            all.push(Fault::at(&format!("{at}/factor"), "must not be 0"));
        }
    }
    for (i, stage) in sweep.whole.iter().enumerate() {
        all.extend(unknown(stage, &names, "stage").map(|w| Fault::at(&format!("/whole/{i}"), w)));
    }
    all
}

/// What of a list of names is not known, in words.
fn unknown(name: &str, known: &[&str], what: &str) -> Option<String> {
    if known.contains(&name) {
        return None;
    }
    let meant = nearest(name, known).map_or(String::new(), |n| format!("; did you mean '{n}'?"));
    Some(format!(
        "'{name}' is no {what} of this sweep, which has {}{meant}",
        known.join(", ")
    ))
}

fn twice(at: &str, name: &str) -> Fault {
    Fault::at(at, format!("'{name}' stands here twice"))
}

/// Small letters, digits and one more character, a letter first.
fn is_name(word: &str, also: char) -> bool {
    word.starts_with(|c: char| c.is_ascii_lowercase())
        && word
            .chars()
            .all(|c| c.is_ascii_lowercase() || c.is_ascii_digit() || c == also)
}

fn of_parameters(sweep: &Sweep) -> Vec<Fault> {
    let mut all = Vec::new();
    let mut counts: Vec<usize> = Vec::new();
    let mut points: usize = 1;
    for (i, parameter) in sweep.parameters.iter().enumerate() {
        let at = format!("/parameters/{i}");
        let earlier: Vec<&str> = sweep.parameters[..i]
            .iter()
            .map(|p| p.name.as_str())
            .collect();
        if !is_name(&parameter.name, '_') {
            let what = format!(
                "'{}' must have small letters, digits and underscores, and begin with a letter",
                parameter.name
            );
            all.push(Fault::at(&format!("{at}/name"), what));
        }
        if earlier.contains(&parameter.name.as_str()) {
            all.push(twice(&format!("{at}/name"), &parameter.name));
        }
        let count = match values::of(parameter) {
            Ok(values) => values.len(),
            Err((below, what)) => {
                all.push(Fault::at(&format!("{at}{below}"), what));
                0
            }
        };
        counts.push(count);
        match parameter.with.is_none() {
            true => points = points.saturating_mul(count.max(1)),
            false => all.extend(of_with(sweep, i, &counts).map(|f| f.within(&at))),
        }
        if !sweep
            .stages
            .iter()
            .any(|s| named_by(s).iter().any(|name| *name == parameter.name))
        {
            let what = format!(
                "no stage names ${{{}}}: nothing changes with it",
                parameter.name
            );
            all.push(Fault::at(&format!("{at}/name"), what));
        }
    }
    all.extend(repeated(sweep));
    if points > MOST_POINTS {
        let what = format!("these values make {points} points; at most {MOST_POINTS} are run");
        all.push(Fault::at("/parameters", what));
    }
    all
}

/// Values that stand twice: of a parameter alone, or together with those of all that go with it.
fn repeated(sweep: &Sweep) -> Vec<Fault> {
    let names = |p: &crate::plan::Parameter| -> Vec<String> {
        let values = values::of(p).unwrap_or_default();
        values.into_iter().map(|v| v.meant()).collect()
    };
    let mut found = Vec::new();
    for (i, first) in sweep.parameters.iter().enumerate() {
        if first.with.is_some() {
            continue;
        }
        let beside = sweep.parameters.iter();
        let beside = beside.filter(|p| p.with.as_ref() == Some(&first.name));
        let all: Vec<Vec<String>> = [first].into_iter().chain(beside).map(names).collect();
        let row = |k: usize| -> Vec<Option<&String>> { all.iter().map(|v| v.get(k)).collect() };
        let again = (1..all[0].len()).filter(|k| (0..*k).any(|old| row(old) == row(*k)));
        let written = values::of(first).unwrap_or_default();
        found
            .extend(again.map(|k| twice(&format!("/parameters/{i}/values/{k}"), &written[k].name)));
    }
    found
}

/// What is wrong with a parameter that goes with another; `counts` are numbers of values up to its own.
fn of_with(sweep: &Sweep, index: usize, counts: &[usize]) -> Option<Fault> {
    let parameter = &sweep.parameters[index];
    let other = parameter.with.as_ref()?;
    let earlier = sweep.parameters[..index].iter();
    let what = match earlier.map(|p| &p.name).position(|name| name == other) {
        None => format!("'{other}' is no parameter that stands before this one"),
        Some(o) if counts[o] != counts[index] && counts[o] > 0 && counts[index] > 0 => format!(
            "'{}' has {} values and '{other}' has {}: what goes together has as many",
            parameter.name, counts[index], counts[o]
        ),
        Some(_) => return None,
    };
    Some(Fault::at("/with", what))
}

fn of_stage(sweep: &Sweep, index: usize, root: &Path) -> impl Iterator<Item = Fault> {
    let stage = &sweep.stages[index];
    let mut all = Vec::new();
    if !is_name(&stage.name, '-') {
        let what = format!(
            "'{}' must have small letters, digits and hyphens, and begin with a letter",
            stage.name
        );
        all.push(Fault::at("/name", what));
    }
    let names: Vec<&str> = sweep.parameters.iter().map(|p| p.name.as_str()).collect();
    let called = |at: String, text: &str| -> Vec<Fault> {
        let wrong = calls(text).into_iter();
        let wrong = wrong.filter_map(|call| unknown(call, &names, "parameter"));
        wrong.map(|what| Fault::at(&at, what)).collect()
    };
    for (at, text) in stage.template.iter().flat_map(texts) {
        all.extend(called(format!("/template{at}"), text));
    }
    if stage.template.as_ref().is_some_and(|t| !t.is_object()) {
        let what = "a template is a patch: an object with the keys that change";
        all.push(Fault::at("/template", what));
    }
    let mut file = |at: String, path: &str, made: bool| {
        let wrong = called(at.clone(), path);
        if wrong.is_empty() {
            all.extend(absent(sweep, path, made, root).map(|what| Fault::at(&at, what)));
        }
        all.extend(wrong);
    };
    file("/scene".to_owned(), &stage.scene, false);
    for (i, patch) in stage.patches.iter().enumerate() {
        file(format!("/patches/{i}"), patch, false);
    }
    for (i, input) in stage.inputs.iter().enumerate() {
        if let Some(path) = &input.file {
            file(format!("/inputs/{i}/file"), path, true);
        }
    }
    for (i, input) in stage.inputs.iter().enumerate() {
        all.extend(of_input(sweep, index, input).map(|f| f.within(&format!("/inputs/{i}"))));
    }
    all.into_iter()
}

fn of_input(sweep: &Sweep, index: usize, input: &Input) -> Option<Fault> {
    let earlier: Vec<&str> = sweep.stages[..index]
        .iter()
        .map(|s| s.name.as_str())
        .collect();
    match (&input.stage, &input.file) {
        (Some(of), None) if earlier.contains(&of.as_str()) => None,
        (Some(of), None) => {
            let near =
                nearest(of, &earlier).map_or(String::new(), |n| format!("; did you mean '{n}'?"));
            let what = format!("'{of}' is no stage that stands before this one{near}");
            Some(Fault::at("/stage", what))
        }
        (None, Some(_)) => None,
        _ => Some(Fault::at("", "must have one of \"stage\" and \"file\"")),
    }
}

/// What is wrong with a path, at any value that it calls: make knows no blanks, and what make does not make is there.
fn absent(sweep: &Sweep, path: &str, made: bool, root: &Path) -> Option<String> {
    let plain = |c: char| c.is_ascii_alphanumeric() || "._+-/${}".contains(c);
    if path.is_empty() || path.starts_with('/') || !path.chars().all(plain) {
        return Some(format!(
            "'{path}' must be a path from the repository root of letters, digits, '.', '_', '+', '-' and '/'"
        ));
    }
    if made && path.starts_with("build/") {
        return None;
    }
    let called = calls(path);
    let parameters = sweep
        .parameters
        .iter()
        .filter(|p| called.contains(&p.name.as_str()));
    let mut paths = vec![path.to_owned()];
    for parameter in parameters {
        let values: Vec<Named> = values::of(parameter).unwrap_or_default();
        let call = format!("${{{}}}", parameter.name);
        paths = paths
            .iter()
            .flat_map(|path| values.iter().map(|v| path.replace(&call, &v.name)))
            .collect();
    }
    let missing = paths.into_iter().find(|path| !root.join(path).is_file())?;
    Some(format!("there is no file {missing}"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::{Value, json};

    fn sound() -> Value {
        json!({
            "kind": "sweep", "version": 1, "study": "arc-currents",
            "parameters": [{"name": "current", "unit": "A", "values": [100, 200]}],
            "stages": [{
                "name": "arc", "tool": "arcfvm", "scene": "pipelines/gmaw-300a/arc.json",
                "template": {"title": "${current} A"},
                "inputs": [{"name": "gas", "file": "build/gases/argon.mcap"}]
            }],
            "figures": [{"name": "voltage", "unit": "V", "stage": "arc",
                         "from": {"record": {"channel": "/balance", "value": "voltage_v"}}}]
        })
    }

    fn said(change: impl FnOnce(&mut Value)) -> String {
        let mut value = sound();
        change(&mut value);
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("sweep.json");
        std::fs::write(&path, format!("{value:#}")).unwrap();
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
        match read(&path, &root) {
            Ok(_) => String::new(),
            Err(failure) => failure.to_string(),
        }
    }

    type Change = fn(&mut Value);

    /// Each change is told with all its words.
    fn told(wrong: &[(Change, &[&str])]) {
        for (change, words) in wrong {
            let told = said(change);
            for word in *words {
                assert!(told.contains(word), "'{word}' is missing in: {told}");
            }
        }
    }

    #[test]
    fn every_fault_of_a_stage_names_its_place_and_what_was_meant() {
        assert_eq!(said(|_| {}), "");
        told(&[
            (|v| v["study"] = json!("arc"), &["/study", "pipelines/arc"]),
            (
                |v| v["stages"][0]["tool"] = json!("arcfwm"),
                &["/stages/0/tool", "arcfwm"],
            ),
            (
                |v| v["stages"][0]["template"]["title"] = json!("${curent} A"),
                &[
                    "sweep.json:",
                    "/stages/0/template/title",
                    "'curent'",
                    "did you mean 'current'?",
                    "nothing changes with it",
                ],
            ),
            (
                |v| v["stages"][0]["scene"] = json!("pipelines/none.json"),
                &["/stages/0/scene", "pipelines/none.json"],
            ),
            (
                |v| v["stages"][0]["scene"] = json!("a b.json"),
                &["/stages/0/scene", "'a b.json'"],
            ),
            (
                |v| v["stages"][0]["patches"] = json!(["pipelines/${current}.json"]),
                &["/stages/0/patches/0", "pipelines/100.json"],
            ),
            (
                |v| v["stages"][0]["inputs"][0] = json!({"name": "gas", "stage": "pool"}),
                &["/stages/0/inputs/0/stage", "'pool'"],
            ),
            (
                |v| v["stages"][0]["inputs"][0] = json!({"name": "gas"}),
                &["/stages/0/inputs/0", "\"stage\" and \"file\""],
            ),
        ]);
    }

    #[test]
    fn a_number_that_is_written_in_two_ways_stands_twice() {
        let told = said(|v| v["parameters"][0]["values"] = json!([1, 1.0]));
        assert!(
            told.contains("/parameters/0/values/1") && told.contains("twice"),
            "{told}"
        );
    }

    #[test]
    fn what_goes_together_may_have_a_value_twice_if_no_point_stands_twice() {
        let told = said(|v| {
            v["parameters"] = json!([
                {"name": "current", "values": [100, 100, 200]},
                {"name": "speed", "values": [1, 2, 2], "with": "current"}
            ]);
            v["stages"][0]["template"]["title"] = json!("${current} ${speed}");
        });
        assert_eq!(told, "");
    }

    #[test]
    fn every_fault_of_a_parameter_or_figure_names_its_place_and_what_was_meant() {
        told(&[
            (
                |v| v["parameters"][0]["values"] = json!([]),
                &["/parameters/0/values"],
            ),
            (
                |v| v["parameters"][0]["values"] = json!([100, 100]),
                &["/parameters/0/values/1", "twice"],
            ),
            (
                |v| {
                    v["parameters"] = json!([
                        {"name": "current", "values": [100, 100, 200]},
                        {"name": "speed", "values": [1, 1, 1], "with": "current"}
                    ]);
                    v["stages"][0]["template"]["title"] = json!("${current} ${speed}");
                },
                &["/parameters/0/values/1", "twice"],
            ),
            (
                |v| v["parameters"][0]["with"] = json!("speed"),
                &["/parameters/0/with", "'speed'"],
            ),
            (
                |v| v["parameters"][0]["valuse"] = json!([1]),
                &["valuse", "did you mean 'values'?"],
            ),
            (
                |v| v["figures"][0]["stage"] = json!("ark"),
                &["/figures/0/stage", "did you mean 'arc'?"],
            ),
            (
                |v| {
                    v["parameters"][0] =
                        json!({"name": "current", "even": {"from": 1, "to": 2, "count": 1}})
                },
                &["count"],
            ),
        ]);
    }

    #[test]
    fn a_million_points_are_a_slip() {
        let told = said(|v| {
            let range = json!({"from": 1, "to": 2, "count": 1000});
            v["parameters"] =
                json!([{"name": "current", "even": range}, {"name": "b", "even": range}]);
            v["stages"][0]["template"] = json!({"title": "${current} ${b}"});
        });
        assert!(told.contains("1000000 points"), "{told}");
    }
}
