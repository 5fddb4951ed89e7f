//! The evidence that `make verify` and `make stability` write fits the schemas that we publish.

#![allow(clippy::unwrap_used, reason = "a test may fail")]

use std::path::{Path, PathBuf};
use std::process::Command;

use verification::case::{Case, Errors, Measurement, Target};
use verification::extreme::{self, Extreme};
use verification::lab::{Lab, LabError};
use verification::study::study;

fn programs() -> PathBuf {
    Path::new(env!("CARGO_BIN_EXE_verify"))
        .parent()
        .unwrap()
        .to_owned()
}

/// What `artefact validate` says of a record.
fn validate(path: &Path) -> (bool, String) {
    let output = Command::new(programs().join("artefact"))
        .arg("validate")
        .arg(path)
        .output()
        .unwrap();
    let said = String::from_utf8_lossy(&output.stdout).into_owned();
    (output.status.success(), said)
}

/// A case whose error is the square of the spacing, by two methods, with an error that is no
/// number at the coarsest level.
struct Square;

impl Case for Square {
    fn name(&self) -> &'static str {
        "square"
    }
    fn tool(&self) -> &'static str {
        "none"
    }
    fn reference(&self) -> &'static str {
        "the square of the spacing"
    }
    fn methods(&self) -> &'static [&'static str] {
        &["first", "second"]
    }
    fn targets(&self) -> Vec<Target> {
        vec![
            Target::Error {
                quantity: "a_linf",
                max: 1e-3,
            },
            Target::Order {
                quantity: "a_linf",
                min: 1.9,
            },
        ]
    }
    fn measure(&self, _: &Lab, level: u32, _: &str) -> Result<Measurement, LabError> {
        let spacing_m = 0.1 / f64::from(1 << level);
        let b = if level == 1 { f64::NAN } else { spacing_m };
        Ok(Measurement {
            points: u64::from(level) * 100,
            spacing_m,
            steps: 10,
            run_time_s: 0.5,
            errors: Errors::from([
                ("a_linf".to_owned(), spacing_m * spacing_m),
                ("b_linf".to_owned(), b),
            ]),
        })
    }
}

#[test]
fn the_record_of_an_exact_case_fits_its_schema() {
    let folder = tempfile::tempdir().unwrap();
    let lab = Lab {
        root: folder.path().to_owned(),
        programs: programs(),
        out: folder.path().to_owned(),
        threads: 2,
        patch: None,
    };
    let record = study(&Square, &lab, &[1, 2, 3]).unwrap();
    assert!(record.holds);
    let path = folder.path().join("square.json");
    let mut value = serde_json::to_value(&record).unwrap();
    std::fs::write(&path, value.to_string()).unwrap();
    let (good, said) = validate(&path);
    assert!(
        good && said.contains("good: verification"),
        "{said}\n{value}"
    );

    value["levels"][1]["run_time_s"] = "fast".into();
    std::fs::write(&path, value.to_string()).unwrap();
    let (good, said) = validate(&path);
    assert!(!good && said.contains("/levels/1/run_time_s"), "{said}");
}

#[test]
fn the_record_of_an_extreme_case_fits_its_schema() {
    let folder = tempfile::tempdir().unwrap();
    let scene = Path::new(env!("CARGO_MANIFEST_DIR")).join("resume/drop.json");
    let case: Extreme = serde_json::from_value(serde_json::json!({
        "case": "drop",
        "tool": "poolsph",
        "scene": scene,
        "runs": [
            {"name": "short", "patch": {"time": {"end_s": 2e-4}}, "expect": ["stable", "substepped"]},
            {"name": "negative", "patch": {"density_kg_m3": -1}, "expect": ["refused"]}
        ]
    }))
    .unwrap();
    let record = extreme::run(&case, &programs(), folder.path(), 1).unwrap();
    assert!(record.holds, "{}", record.table());
    let path = folder.path().join("drop.json");
    std::fs::write(&path, serde_json::to_string(&record).unwrap()).unwrap();
    let (good, said) = validate(&path);
    assert!(good && said.contains("good: stability"), "{said}");
}
