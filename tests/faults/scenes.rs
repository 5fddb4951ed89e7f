//! Scenes with faults: exit code 2, with file, line, key, value, unit and range; nothing is run.

use crate::workplace::{Place, SCENE, Told, header, root, tell};

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
    let told = refused("\"sections\"", "\"comment\"");
    told.must(2, &["faulty.json:1:1", "no key 'sections'"]);
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

/// Each stage with a scene of its own.
const STAGES: [(&str, &str); 2] = [
    ("arcfvm", "pipelines/verify/arc-potential/scene.json"),
    ("poolsph", "pipelines/verify/pool-hydrostatic/scene.json"),
];

#[test]
fn every_stage_refuses_what_no_scene_may_say() {
    let place = Place::new();
    for (tool, scene) in STAGES {
        let scene = root().join(scene);
        let scene = scene.to_str().unwrap();
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
                "{\"version\": 2}",
                vec!["version.json:1:", "/version"],
            ),
            (
                "malformed",
                "{\n  \"title\": \"A\"\n  \"kind\": 1\n}",
                vec!["malformed.json:3:", "not valid JSON"],
            ),
        ] {
            let patch = place.file(&format!("{name}.json"), patch);
            let patch = patch.to_str().unwrap();
            let out = place.path("out.mcap");
            let arguments = ["--patch", patch, "--out", out.to_str().unwrap()];
            let told = tell(tool, &[&["run", scene][..], &arguments].concat());
            told.must(2, &words);
            assert!(!out.exists() && !place.path("out.mcap.part").exists());
        }
    }
}
