//! Every number of a scene, one after another, at the ends of what can be typed: the run is done or
//! warned, refused with its place, or found to diverge; it never panics and always ends.

use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use serde_json::{Value, json};
use verification::bell::WELD;

use crate::workplace::{Place, Told, program, root, told};

/// Steps of each run.
const STEPS: f64 = 3.0;
/// No run of so few steps may last longer, on however busy a machine.
const LONGEST: Duration = Duration::from_secs(60);

/// JSON pointers of all numbers but the version; of a long list the first and the last.
fn numbers(value: &Value, at: String, found: &mut Vec<String>) {
    match value {
        Value::Object(map) => {
            for (key, value) in map.iter().filter(|(key, _)| *key != "version") {
                numbers(value, format!("{at}/{key}"), found);
            }
        }
        Value::Array(list) => {
            for (i, value) in list.iter().enumerate() {
                if list.len() <= 3 || i == 0 || i + 1 == list.len() {
                    numbers(value, format!("{at}/{i}"), found);
                }
            }
        }
        Value::Number(_) => found.push(at),
        _ => {}
    }
}

/// What is wrong with the end of a run, if anything.
fn wrong(place: &Place, scene: &Value, input: Option<&Path>) -> Option<String> {
    let file = place.file("extreme.json", scene.to_string());
    let out = place.path("extreme.mcap");
    let mut command = Command::new(program("poolsph"));
    command.arg("run").arg(file).arg("--out").arg(&out);
    command.args(["--threads", "1", "--progress", "none", "-q"]);
    if let Some(arc) = input {
        command.arg("--input").arg(format!("arc={}", arc.display()));
    }
    let mut child = command.stderr(Stdio::piped()).spawn().unwrap();
    let began = Instant::now();
    while child.try_wait().unwrap().is_none() {
        if began.elapsed() > LONGEST {
            child.kill().unwrap();
            child.wait().unwrap();
            return Some("does not end".to_owned());
        }
        std::thread::sleep(Duration::from_millis(5));
    }
    let output = child.wait_with_output().unwrap();
    let said = String::from_utf8_lossy(&output.stderr);
    let record = std::fs::read_to_string(out.with_extension("run.json")).unwrap_or_default();
    let good = match output.status.code() {
        Some(0 | 3) => true,
        Some(1) => record.contains("\"outcome\": \"diverged\""),
        Some(2) => said.contains("extreme.json:"),
        _ => false,
    };
    let clean = !said.contains("internal error") && !said.contains("panicked");
    (!good || !clean).then(|| format!("ends with {:?}: {said}", output.status.code()))
}

fn each_number_at(values: &[f64], scene: &str, arc: bool) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(scene);
    let mut scene: Value = serde_json::from_str(&std::fs::read_to_string(path).unwrap()).unwrap();
    scene["time"]["end_s"] = json!(STEPS * scene["time"]["step_s"].as_f64().unwrap());
    let mut places = Vec::new();
    numbers(&scene, String::new(), &mut places);
    assert!(places.len() > 10, "{places:?}");
    let place = Place::new();
    let input = arc.then(|| place.path("arc.mcap"));
    if let Some(path) = &input {
        WELD.write(path).unwrap();
    }
    let mut faults = Vec::new();
    for at in &places {
        for value in values {
            let mut extreme = scene.clone();
            *extreme.pointer_mut(at).unwrap() = json!(value);
            let found = wrong(&place, &extreme, input.as_deref());
            faults.extend(found.map(|what| format!("{at} = {value:e} {what}")));
        }
    }
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

#[test]
fn a_drop_with_any_number_at_its_extremes() {
    each_number_at(
        &[0.0, -1.0, 1e-300, 1e300, -1e300],
        "resume/drop.json",
        false,
    );
}

#[test]
fn a_weld_with_any_number_at_its_extremes() {
    each_number_at(&[1e-300, 1e300], "resume/weld.json", true);
}

/// A column of gas whose residuals may end the iteration by `iterate`.
fn column(iterate: &Value) -> Told {
    let scene = root().join("pipelines/verify/arc-column/scene.json");
    let place = Place::new();
    let patch = place.file("patch.json", json!({"iterate": iterate}).to_string());
    let (mut command, out) = (Command::new(program("arcfvm")), place.path("column.mcap"));
    command.arg("run").arg(scene).arg("--patch").arg(patch);
    told(command.arg("--out").arg(out).args(["--threads", "1", "-q"]))
}

#[test]
fn an_arc_that_a_loose_limit_ends_is_told_as_not_converged() {
    column(&json!({"tolerance": 1e-6})).must(0, &[]);
    let words = ["not converged", "of its scale", "iterate/tolerance"];
    column(&json!({"tolerance": 0.1})).must(3, &words);
    let watts = json!({"tolerance": 1e-6, "stop": {"heat_w": 1e9, "charge_a": 1e9}});
    column(&watts).must(3, &words);
}
