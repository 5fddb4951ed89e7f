//! The evidence that `make verify`, `make stability` and `make bench` write fits the schemas that we publish.

#![allow(clippy::unwrap_used, reason = "a test may fail")]

mod certificates;
mod full_disk;
mod plans;

use std::path::{Path, PathBuf};
use std::process::Command;

use verification::bench::absence::{self, Absence};
use verification::bench::fields::Fields;
use verification::bench::others::Others;
use verification::bench::{Bench, Record, Stand, benches, in_order};
use verification::case::{Case, Errors, Measurement, Target};
use verification::extreme::{self, Extreme};
use verification::lab::{Lab, LabError};
use verification::speed;
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

/// A case whose error is the square of the spacing, by three methods, the last of which is exact and
/// only run at the coarser levels; one error is no number at the coarsest.
struct Square;

impl Case for Square {
    fn name(&self) -> &'static str {
        "square"
    }
    fn tool(&self) -> &'static str {
        "poolsph"
    }
    fn reference(&self) -> &'static str {
        "the square of the spacing"
    }
    fn methods(&self) -> &'static [&'static str] {
        &["first", "second", "exact"]
    }
    fn levels(&self, method: &str, asked: &[u32]) -> Vec<u32> {
        let most = if method == "exact" { 2 } else { 3 };
        asked.iter().copied().filter(|l| *l <= most).collect()
    }
    fn targets(&self) -> Vec<Target> {
        vec![
            Target::error("a_linf", 1e-3),
            Target::order("a_linf", 1.9),
            Target::error("a_linf", 3e-3).at_level(1).of("second"),
            Target::error("a_linf", 1e-9).at_level(4),
            Target::order("a_linf", 1.9)
                .of("exact")
                .or_error_below(1e-12),
        ]
    }
    fn measure(&self, lab: &Lab, level: u32, method: &str) -> Result<Measurement, LabError> {
        let patch = serde_json::json!({"time": {"end_s": 1e-4 * f64::from(level)}});
        let label = format!("{method}{level}");
        let run = lab.run(self.tool(), self.name(), &label, &patch)?;
        let spacing_m = 0.1 / f64::from(1 << level);
        let a = if method == "exact" {
            1e-16
        } else {
            spacing_m * spacing_m
        };
        let b = if level == 1 { f64::NAN } else { spacing_m };
        let errors = Errors::from([("a_linf".to_owned(), a), ("b_linf".to_owned(), b)]);
        Ok(Measurement::of(
            run,
            u64::from(level) * 100,
            spacing_m,
            errors,
        ))
    }
}

#[test]
fn the_record_of_an_exact_case_fits_its_schema() {
    let folder = tempfile::tempdir().unwrap();
    let scene = Path::new(env!("CARGO_MANIFEST_DIR")).join("resume/drop.json");
    let place = folder.path().join("pipelines/verify/square");
    std::fs::create_dir_all(&place).unwrap();
    std::fs::copy(scene, place.join("scene.json")).unwrap();
    let lab = Lab {
        root: folder.path().to_owned(),
        programs: programs(),
        out: folder.path().to_owned(),
        threads: 2,
        patch: None,
        repeat_s: 0.01,
    };
    let mut told = Vec::new();
    let tell = |line: &str| told.push(line.to_owned());
    let record = study(&Square, &lab, &[1, 2, 3], tell).unwrap();
    let line = "  first level 2: 200 points  a_linf 6.250e-4 b_linf 2.500e-2";
    assert_eq!((told.len(), told[3].as_str()), (8, line));
    assert!(record.holds, "{}", record.table());
    let path = folder.path().join("square.json");
    let mut value = serde_json::to_value(&record).unwrap();
    std::fs::write(&path, value.to_string()).unwrap();
    let (good, said) = validate(&path);
    assert!(
        good && said.contains("good: verification"),
        "{said}\n{value}"
    );
    assert_eq!(value["levels"][0]["repeats"], 3);
    assert_eq!(value["series"][1]["levels"].as_array().unwrap().len(), 2);
    assert!(value["levels"][2]["peak_memory_bytes"].as_u64().unwrap() > 1_000_000);
    let time = |key: &str| value["levels"][0][key].as_f64().unwrap();
    assert!(time("run_time_least_s") <= time("run_time_s"));
    assert!(time("run_time_s") < time("process_s"));
    assert!(value["stages"].as_array().unwrap().len() > 1);
    let targets = &value["targets"];
    assert_eq!(
        targets["a_linf_at_level_4"]["holds"],
        serde_json::Value::Null
    );
    assert_eq!(targets["a_linf_at_level_1_of_second"]["at_points"], 100);

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
    let (good, said) = written(&path, &record);
    assert!(good && said.contains("good: stability"), "{said}");
}

/// A map of temperature over viscosity: bounds that hold, and bounds that the middle row breaks.
#[test]
fn the_record_of_a_map_fits_its_schema_and_names_what_is_broken() {
    let folder = tempfile::tempdir().unwrap();
    let scene = Path::new(env!("CARGO_MANIFEST_DIR")).join("resume/drop.json");
    let mut case = serde_json::json!({
        "case": "map",
        "tool": "poolsph",
        "scene": scene,
        "bounds": {"column": "temperature", "min": 0.99, "max": 2.61, "times": "y"},
        "grid": {
            "x": {"name": "viscosity [Pa s]", "set": "/flow/viscosity_pa_s",
                  "values": [0.004, {"value": -1, "expect": ["refused"]}]},
            "y": {"name": "temperature [K]", "set": "/bodies/0/temperature_k",
                  "values": [1000, 1500]},
            "patch": {"time": {"end_s": 2e-4}},
            "expect": ["stable", "substepped"]
        }
    });
    let run = |case: &serde_json::Value| {
        let case: Extreme = serde_json::from_value(case.clone()).unwrap();
        extreme::run(&case, &programs(), folder.path(), 1).unwrap()
    };
    let record = run(&case);
    assert!(record.holds, "{}", record.table());
    let (good, said) = written(&folder.path().join("map.json"), &record);
    assert!(good && said.contains("good: stability"), "{said}");

    case["bounds"]["min"] = 1.001.into();
    case["grid"]["y"]["values"] = serde_json::json!([1000]);
    let record = run(&case);
    let told = serde_json::to_value(&record).unwrap();
    assert!(!record.holds && told["runs"][1]["holds"] == true);
    let broken = told["runs"][0]["broken"][0].as_str().unwrap();
    assert!(broken.contains("temperature is 1.000"), "{broken}");
}

/// What `artefact validate` says of a record written to `path`.
fn written(path: &Path, record: &impl serde::Serialize) -> (bool, String) {
    std::fs::write(path, serde_json::to_string(record).unwrap()).unwrap();
    validate(path)
}

#[test]
fn the_record_of_a_bench_fits_its_schema() {
    let folder = tempfile::tempdir().unwrap();
    let scene = Path::new(env!("CARGO_MANIFEST_DIR")).join("resume/drop.json");
    let patch = folder.path().join("short.json");
    std::fs::write(&patch, r#"{"time": {"end_s": 1e-3}}"#).unwrap();
    let bench: Bench = serde_json::from_value(serde_json::json!({
        "tool": "poolsph", "scene": scene, "patches": [patch],
        "aims": [{"name": "step", "unit": "ms", "threads": 2, "max": 1e9},
                 {"name": "step", "unit": "ms", "threads": 64, "max": 1e9}]
    }))
    .unwrap();
    let stand = Stand {
        programs: programs(),
        out: folder.path().to_owned(),
        threads: vec![1, 2],
        runs: 2,
    };
    let record = serde_json::to_value(stand.time(&bench).unwrap()).unwrap();
    let path = folder.path().join("drop.json");
    let (good, said) = written(&path, &record);
    assert!(good && said.contains("good: bench"), "{said}\n{record}");
    let rows = record["rows"].as_array().unwrap();
    let repeats = |threads| {
        let row = rows
            .iter()
            .find(|r| r["name"] == "step" && r["threads"] == threads);
        row.unwrap()["repeats"].as_u64()
    };
    assert_eq!((repeats(1), repeats(2)), (Some(1), Some(2)));
    let names: Vec<&str> = record["counts"]
        .as_array()
        .unwrap()
        .iter()
        .map(|c| c["name"].as_str().unwrap())
        .collect();
    let wanted = [
        "steps",
        "particles",
        "liquid at the start",
        "liquid at the end",
    ];
    assert_eq!(names, wanted);
    assert_eq!(record["aims"][0]["holds"], true);
    assert_eq!(record["aims"][1]["holds"], serde_json::Value::Null);

    let mut spoilt = record.clone();
    spoilt["rows"][0]["unit"] = "furlong".into();
    let (good, said) = written(&path, &spoilt);
    assert!(!good && said.contains("/rows/0/unit"), "{said}");
    let cores = Record::of_rows("cores", speed::cores(&[1], 1).unwrap());
    let (good, said) = written(&path, &cores);
    assert!(good, "{said}");
}

#[test]
fn physics_that_is_absent_costs_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let scene = Path::new(env!("CARGO_MANIFEST_DIR")).join("resume/drop.json");
    let pair = |adds: serde_json::Value| -> Absence {
        serde_json::from_value(serde_json::json!({"physics": "tension", "tool": "poolsph",
            "scene": scene, "patch": {"time": {"end_s": 5e-4}, "tension": null}, "adds": adds}))
        .unwrap()
    };
    let programs = programs();
    let bench = absence::Bench {
        programs: &programs,
        out: folder.path(),
        runs: 1,
    };
    let idle = pair(serde_json::json!({"tension": {"surface_tension_n_m": 0}}));
    let record = bench.time(&idle).unwrap();
    let told = serde_json::to_value(&record).unwrap();
    let (good, said) = written(&folder.path().join("absent.json"), &told);
    assert!(good && said.contains("good: absence"), "{said}\n{told}");
    // The time of a single run is not judged here.
    let claims = told["claims"].as_array().unwrap();
    assert!(claims[..3].iter().all(|c| c["holds"] == true), "{told}");
    // A patch that adds something else adds no tension.
    let other = pair(serde_json::json!({"title": "another"}));
    let record = serde_json::to_value(bench.time(&other).unwrap()).unwrap();
    assert_eq!(record["claims"][1]["holds"], false);
    assert_eq!(record["holds"], false);
}

/// A lab whose programs are not there.
fn nowhere(root: &Path, folder: &Path) -> Lab {
    Lab {
        root: root.to_owned(),
        programs: folder.join("nowhere"),
        out: folder.to_owned(),
        threads: 1,
        patch: None,
        repeat_s: 0.0,
    }
}

#[test]
fn programs_that_cannot_be_run_are_told_as_missing() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap();
    let others = Others::read(root).unwrap();
    for path in others.files() {
        assert!(root.join(&path).is_file(), "{}", path.display());
    }
    let folder = tempfile::tempdir().unwrap();
    let lab = nowhere(root, folder.path());
    let record = others.solve(&lab, Path::new("no-python"));
    assert!(
        !record.whole()
            && record
                .table()
                .contains("MISSING sin-xy, 41 x 41: FiPy, SuperLU")
    );
    let (good, said) = written(&folder.path().join("others.json"), &record);
    assert!(good && said.contains("good: others"), "{said}");
    let record = Fields::read(root)
        .unwrap()
        .solve(&lab, Path::new("no-python"));
    assert!(!record.whole() && record.table().contains("MISSING levitation-field, order 4"));
    let (good, said) = written(&folder.path().join("em.json"), &record);
    assert!(good && said.contains("good: others"), "{said}");
}

#[test]
fn exact_fields_of_the_studies_fit_their_schema() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap();
    let folder = tempfile::tempdir().unwrap();
    for study in ["dielectric-sphere", "levitation-field"] {
        let scene = root.join("pipelines").join(study).join("scene.json");
        let out = folder.path().join(format!("{study}.json"));
        let mut exact = Command::new(env!("CARGO_BIN_EXE_exact"));
        let status = exact.arg(&scene).arg("--out").arg(&out).status();
        assert!(status.unwrap().success(), "{study}");
        let (good, said) = validate(&out);
        assert!(good && said.contains("good: field-exact"), "{said}");
    }
}

#[test]
fn the_benches_of_the_pipeline_can_be_read_and_ordered() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap();
    for pair in absence::absences(&root.join("pipelines/bench/absent")).unwrap() {
        assert!(root.join(&pair.scene).is_file(), "{}", pair.name);
    }
    let all = benches(&root.join("pipelines/bench")).unwrap();
    let order = in_order(&all, &["weld-developed".to_owned()]).unwrap();
    let names: Vec<&str> = order.iter().map(|bench| bench.name.as_str()).collect();
    assert_eq!(names, ["arc-gmaw-300a", "weld-developed"]);
    for bench in &all {
        for path in bench.patches.iter().chain([&bench.scene]) {
            assert!(root.join(path).is_file(), "{}", path.display());
        }
    }
}

#[test]
fn the_extreme_cases_of_the_pipeline_can_be_read() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap();
    let cases = extreme::cases(&root.join("pipelines/stability")).unwrap();
    for case in &cases {
        assert!(
            root.join(&case.scene).is_file(),
            "{}: {}",
            case.case,
            case.scene.display()
        );
    }
}

#[test]
fn the_published_schemas_of_scenes_are_what_the_programs_print() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap();
    let scenes = [
        "gasprop.scene.v1",
        "arcfvm.scene.v1",
        "poolsph.scene.v2",
        "heatsph.scene.v1",
        "emfield.scene.v1",
        "jetsph.scene.v1",
        "avg.scene.v1",
    ];
    for scene in scenes {
        let tool = scene.split('.').next().unwrap();
        let printed = Command::new(programs().join(tool))
            .arg("schema")
            .output()
            .unwrap();
        let published = std::fs::read(root.join(format!("schemas/{scene}.json"))).unwrap();
        assert!(
            printed.stdout == published,
            "schemas/{scene}.json is not what '{tool} schema' prints: make schemas"
        );
    }
}
