//! Scenes with faults: exit code 2, with file, line, key, value, unit and range; nothing is run.

use std::path::Path;
use std::process::Command;

use crate::workplace::{Place, SCENE, Told, header, program, root, tell, told};

/// Checks and runs `avg` on a scene in which `from` became `to`; both must say the same.
fn refused(from: &str, to: &str) -> Told {
    assert!(SCENE.contains(from), "{from}");
    let place = Place::new();
    let frames = place.frames("pool.mcap", &header());
    let scene = place.file("faulty.json", SCENE.replace(from, to));
    let old = place.file("mean.mcap", "an older result");
    let input = format!("frames={}", frames.display());
    let scene = scene.to_str().unwrap();
    let checked = tell("avg", &["check", scene, "--input", &input]);
    let out = old.to_str().unwrap();
    let run = tell("avg", &["run", scene, "--input", &input, "--out", out]);
    assert_eq!(run.code, 2, "{}", run.err);
    assert_eq!(run.err, checked.err);
    assert_eq!(std::fs::read(&old).unwrap(), b"an older result");
    assert!(!place.path("mean.mcap.part").exists());
    checked
}

#[test]
fn an_unknown_key_is_refused_with_the_nearest_known_name() {
    let told = refused("\"channel\"", "\"chanel\"");
    told.must(
        2,
        &[
            "faulty.json:4:3",
            "/chanel",
            "unknown key",
            "did you mean 'channel'?",
        ],
    );
}

#[test]
fn a_wrong_unit_is_refused_with_the_right_one_and_its_value() {
    let told = refused("\"half_thickness_m\": 1e-3", "\"half_thickness_mm\": 1");
    told.must(
        2,
        &[
            "faulty.json:8:",
            "half_thickness_mm",
            "'half_thickness_m'",
            "0.001",
        ],
    );
    let told = refused("1e-3 } }", "\"1 mm\" } }");
    told.must(2, &["faulty.json:8:", "\"1 mm\"", "a number in m"]);
}

#[test]
fn a_negative_length_is_refused_with_its_range() {
    let told = refused("\"channel\": \"/pool\"", "\"spacing_m\": -5e-4");
    told.must(
        2,
        &[
            "faulty.json:4:",
            "/spacing_m",
            "-0.0005 m is out of range: above 0 m",
        ],
    );
}

#[test]
fn a_number_out_of_range_is_refused_with_its_range() {
    let told = refused(
        "\"channel\": \"/pool\"",
        "\"follow\": {}, \"phases\": {\"count\": 5000}",
    );
    told.must(
        2,
        &["/phases/count", "5000 is out of range", "at most 1000"],
    );
}

#[test]
fn a_missing_key_is_named() {
    let told = refused("      \"name\": \"section_x0\",\n", "");
    told.must(2, &["faulty.json:6:", "/sections/0", "no key 'name'"]);
}

#[test]
fn malformed_json_is_placed_at_its_line() {
    let told = refused("\"version\": 1,", "\"version\": 1,,");
    told.must(2, &["faulty.json:3:", "not valid JSON"]);
    let told = refused("  ]\n}\n", "");
    told.must(2, &["faulty.json:", "not valid JSON"]);
}

#[test]
fn another_tool_s_scene_and_a_newer_version_are_refused_by_name() {
    let told = refused("avg.scene", "poolsph.scene");
    told.must(2, &["poolsph.scene", "avg.scene"]);
    let told = refused("\"version\": 1", "\"version\": 7");
    told.must(2, &["version", "7"]);
}

#[test]
fn all_faults_are_told_at_once() {
    let told = refused(
        "\"channel\": \"/pool\"",
        "\"spaceing_m\": 1, \"smoothing_length_m\": 0",
    );
    told.must(
        2,
        &["spaceing_m", "/smoothing_length_m: 0 m is out of range"],
    );
}

#[test]
fn a_faulty_patch_and_an_absent_scene_are_named() {
    let place = Place::new();
    let frames = place.frames("pool.mcap", &header());
    let input = format!("frames={}", frames.display());
    let scene = place.scene();
    let patch = place.file("patch.json", "{\n  \"spacing_m\": -1\n}\n");
    let [scene, patch] = [&scene, &patch].map(|p| p.to_str().unwrap());
    let told = tell(
        "avg",
        &["check", scene, "--patch", patch, "--input", &input],
    );
    told.must(2, &["patch.json:2:", "/spacing_m", "-1 m is out of range"]);
    let absent = place.path("absent.json");
    let told = tell(
        "avg",
        &["check", absent.to_str().unwrap(), "--input", &input],
    );
    told.must(2, &["absent.json", "No such file"]);
    tell("avg", &["check", scene]).must(2, &["frames"]);
}

/// Each stage with a scene of its own and what it must be given.
const STAGES: [(&str, &str, &[&str]); 7] = [
    ("gasprop", "pipelines/gases/argon.json", &[]),
    ("arcfvm", "pipelines/verify/arc-potential/scene.json", &[]),
    (
        "poolsph",
        "pipelines/verify/pool-hydrostatic/scene.json",
        &[],
    ),
    (
        "avg",
        "pipelines/gmaw-300a/avg.json",
        &["--input", "frames=pool.mcap"],
    ),
    ("emfield", "pipelines/dielectric-sphere/scene.json", &[]),
    ("heatsph", "pipelines/verify/heat-patch/scene.json", &[]),
    ("jetsph", "pipelines/verify/solid-plate/scene.json", &[]),
];

/// What a stage says to a scene of its own with a patch, and that it wrote nothing.
fn patched(place: &Place, stage: (&str, &str, &[&str]), patch: &Path) -> Told {
    let (tool, scene, inputs) = stage;
    let out = place.path("out.mcap");
    let mut run = Command::new(program(tool));
    run.current_dir(place.path(""));
    run.arg("run").arg(root().join(scene)).args(inputs);
    let told = told(run.arg("--patch").arg(patch).arg("--out").arg(&out));
    assert!(!out.exists() && !place.path("out.mcap.part").exists());
    told
}

#[test]
fn every_stage_is_tried() {
    let tools = root().join("tools");
    let mut stages: Vec<String> = std::fs::read_dir(tools)
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .filter(|folder| folder.join("src/main.rs").is_file())
        .map(|folder| folder.file_name().unwrap().to_str().unwrap().to_owned())
        // They read no scene.
        .filter(|name| !["report", "sweep"].contains(&name.as_str()))
        .collect();
    stages.sort();
    let mut tried = STAGES.map(|(tool, ..)| tool);
    tried.sort_unstable();
    assert_eq!(stages, tried);
}

#[test]
fn every_stage_refuses_what_no_scene_may_say() {
    let place = Place::new();
    place.frames("pool.mcap", &header());
    for stage in STAGES {
        for (name, patch, words) in [
            (
                "unknown",
                "{\n  \"tittle\": \"A\"\n}",
                vec!["unknown.json:2:", "/tittle: unknown key", "'title'"],
            ),
            (
                "type",
                "{\n\n  \"title\": 3\n}",
                vec!["type.json:3:", "/title: is 3 (a number), wanted is a text"],
            ),
            (
                "version",
                "{\"version\": 9}",
                vec!["version.json:1:", "/version"],
            ),
            (
                "malformed",
                "{\n  \"title\": \"A\"\n  \"kind\": 1\n}",
                vec!["malformed.json:3:", "not valid JSON"],
            ),
        ] {
            let patch = place.file(&format!("{name}.json"), patch);
            patched(&place, stage, &patch).must(2, &words);
        }
    }
}

/// Scenes that are no text, or text that is no UTF-8.
#[test]
fn every_stage_says_of_a_file_that_is_no_json_what_it_is() {
    let place = Place::new();
    let frames = place.frames("pool.mcap", &header());
    for stage in STAGES {
        for (name, bytes, words) in [
            (
                "binary.json",
                b"{\n  \"title\": \"\x80\"\n}".as_slice(),
                ["binary.json:2:13: is no text", "0x80 is not UTF-8"],
            ),
            (
                "wide.json",
                b"\xff\xfe{\0}\0",
                ["wide.json:1:1: is in UTF-16", "wanted is UTF-8"],
            ),
        ] {
            let file = place.file(name, bytes);
            patched(&place, stage, &file).must(2, &words);
        }
        patched(&place, stage, &frames)
            .must(2, &["pool.mcap:1:1: is an MCAP file, wanted is JSON"]);
    }
}

#[test]
fn a_byte_order_mark_before_a_scene_changes_nothing() {
    let place = Place::new();
    let frames = place.frames("pool.mcap", &header());
    let input = format!("frames={}", frames.display());
    let marked = place.file("avg.json", format!("\u{feff}{SCENE}"));
    let marked = marked.to_str().unwrap();
    tell("avg", &["check", marked, "--input", &input]).must(0, &["avg.json"]);
    let faulty = SCENE.replace("\"channel\"", "\"chanel\"");
    let faulty = place.file("faulty.json", format!("\u{feff}{faulty}"));
    let told = tell(
        "avg",
        &["check", faulty.to_str().unwrap(), "--input", &input],
    );
    told.must(2, &["faulty.json:4:3", "did you mean 'channel'?"]);
}

#[test]
fn a_property_of_a_patch_is_blamed_in_the_patch() {
    let place = Place::new();
    let weld = ("poolsph", "pipelines/gmaw-300a/pool.json", &[][..]);
    let of = |key: &str, property: &str| {
        let text = format!("{{\"heat\": {{\n  \"{key}\":\n    {property}}}}}");
        place.file("metal.json", text)
    };
    for (key, unit) in [
        ("thermal_conductivity_w_m_k", "W/(m K)"),
        ("specific_heat_j_kg_k", "J/(kg K)"),
    ] {
        let table = of(
            key,
            "{\"t_k\": [200, 4000],\n    \"value\": [40,\n     -1]}",
        );
        let place_of = format!("metal.json:5:6: /heat/{key}/value/1: -1 {unit} is out of range");
        patched(&place, weld, &table).must(2, &[&place_of]);
        let number = of(key, "-3");
        let place_of = format!("metal.json:3:5: /heat/{key}: -3 {unit} is out of range");
        patched(&place, weld, &number).must(2, &[&place_of]);
        let formula = of(
            key,
            "{\"expr\": \"1000 - T\", \"t_k\": null, \"value\": null, \"extrapolate\": null}",
        );
        let place_of = format!("metal.json:3:14: /heat/{key}/expr: gives ");
        patched(&place, weld, &formula).must(2, &[&place_of, "above 0"]);
    }
}

#[test]
fn a_shape_that_fits_no_form_is_told_its_keys_and_the_nearest_form() {
    let place = Place::new();
    let tank = (
        "poolsph",
        "pipelines/verify/pool-hydrostatic/scene.json",
        &[][..],
    );
    for (shape, words) in [
        (
            r#"{"centre_m": [0, 0, 0], "radius_m": 0.01, "length_m": 0.02}"#,
            vec![
                "it has 'centre_m', 'radius_m', 'length_m'; nearest is {\"cylinder\": {",
                "\"axis\"",
            ],
        ),
        (
            r#"{"min_m": [0, 0, 0], "max_m": [1, 1, 1]}"#,
            vec![
                "fits none of",
                "it has 'min_m', 'max_m'; nearest is {\"box\": {\"name\", \"min_m\", \"max_m\"",
            ],
        ),
        (r#"{}"#, vec!["fits none of", "it has no key"]),
    ] {
        let text = format!("{{\"bodies\": [\n{{\"shape\": {shape}, \"state\": \"liquid\"}}]}}");
        let patch = place.file("shape.json", text);
        let at = ["shape.json:2:11: /bodies/0/shape"];
        patched(&place, tank, &patch).must(2, &[&at[..], &words].concat());
    }
}

#[test]
fn a_current_of_nothing_is_blamed_at_its_own_place() {
    let place = Place::new();
    let arc = root().join("pipelines/gmaw-300a/arc.json");
    let scene = std::fs::read_to_string(&arc).unwrap();
    let scene: serde_json::Value = serde_json::from_str(&scene).unwrap();
    let mut edges = scene["current"]["edges"].clone();
    let (side, index) = driven(&edges);
    edges[&side][index]["total_current_a"] = 0.into();
    let patch = serde_json::json!({"current": {"edges": edges}});
    let patch = place.file("none.json", patch.to_string());
    let gas = format!(
        "gas={}",
        root().join("pipelines/gases/argon-1atm.json").display()
    );
    let mut check = Command::new(program("arcfvm"));
    check.arg("check").arg(&arc).arg("--patch").arg(&patch);
    let at = format!("/current/edges/{side}/{index}/total_current_a: 0 A drives nothing");
    told(check.args(["--input", &gas])).must(2, &["none.json:1:", &at]);
}

/// Side and index of the edge with a total current.
fn driven(edges: &serde_json::Value) -> (String, usize) {
    let sides = edges.as_object().unwrap().iter();
    sides
        .filter_map(|(side, list)| {
            let list = list.as_array()?;
            let index = list
                .iter()
                .position(|e| e.get("total_current_a").is_some())?;
            Some((side.clone(), index))
        })
        .next()
        .unwrap()
}
