//! Every kind of fault in a scene: file, line, column, path, value, unit, range, suggestion.

#![allow(clippy::expect_used, reason = "a test fails by panicking")]

use std::path::{Path, PathBuf};

use run::property::Property;
use run::scene::{Expected, load, parse, schema_of};
use run::{Failure, Fault, Migration};
use schemars::JsonSchema;
use serde::Deserialize;
use serde_json::json;

const POOL: Expected = Expected {
    kind: "test.scene",
    version: 2,
    migrations: &[],
};

#[derive(Debug, Deserialize, JsonSchema, PartialEq)]
#[serde(deny_unknown_fields)]
struct Scene {
    /// Distance of the particles.
    #[schemars(extend("exclusiveMinimum" = 0.0), range(max = 0.1))]
    spacing_m: f64,
    /// Melting point.
    #[schemars(range(min = 1.0, max = 10_000.0))]
    melting_point_k: f64,
    conductivity_w_m_k: Property,
    shapes: Vec<Shape>,
    arc: Option<Arc>,
    #[serde(default)]
    method: Method,
}

#[derive(Debug, Deserialize, JsonSchema, PartialEq)]
#[serde(rename_all = "lowercase", deny_unknown_fields)]
enum Shape {
    Box { min_m: [f64; 3], max_m: [f64; 3] },
    Sphere { centre_m: [f64; 3], radius_m: f64 },
}

#[derive(Debug, Deserialize, JsonSchema, PartialEq)]
#[serde(deny_unknown_fields)]
struct Arc {
    /// Welding current \[A\].
    #[schemars(range(min = 0.0, max = 2000.0))]
    current_a: f64,
    speed_m_s: Option<f64>,
}

#[derive(Debug, Default, Deserialize, JsonSchema, PartialEq)]
#[serde(rename_all = "lowercase")]
enum Method {
    /// Projects.
    #[default]
    Projection,
    /// Homogenises.
    Homogenising,
}

const GOOD: &str = r#"{
  "kind": "test.scene",
  "version": 2,
  "comment": "A good one.",
  "spacing_m": 5e-4,
  "melting_point_k": 1750,
  "conductivity_w_m_k": {"t_k": [300, 1800], "value": [60, 30]},
  "shapes": [
    {"box": {"min_m": [0, 0, 0], "max_m": [1, 1, 1]}},
    {"sphere": {"centre_m": [0, 0, 0], "radius_m": 1e-3}}
  ],
  "arc": {"current_a": 300, "speed_m_s": 0.005}
}
"#;

/// The faults of GOOD with `old` replaced by `new`.
fn faults(old: &str, new: &str) -> String {
    assert_eq!(GOOD.matches(old).count(), 1, "{old}");
    match parse::<Scene>(&GOOD.replace(old, new), POOL) {
        Err(failure @ Failure::Scene(_)) => {
            assert_eq!(failure.exit_code(), 2);
            failure.to_string()
        }
        other => panic!("{new} was not refused: {other:?}"),
    }
}

fn expect(old: &str, new: &str, wanted: &[&str]) {
    let found = faults(old, new);
    for part in wanted {
        assert!(
            found.contains(part),
            "{new}\n  gives  {found}\n  wanted {part}"
        );
    }
}

#[test]
fn a_good_scene_is_read() {
    let scene = parse::<Scene>(GOOD, POOL).expect("good").scene;
    assert_eq!(scene.shapes.len(), 2);
    assert_eq!(scene.method, Method::Projection);
    assert_eq!(
        scene.arc,
        Some(Arc {
            current_a: 300.0,
            speed_m_s: Some(0.005)
        })
    );
}

#[test]
fn an_unknown_key_is_refused_with_the_nearest_name() {
    expect(
        r#""melting_point_k""#,
        r#""melting_pont_k""#,
        &["scene.json:6:3: /melting_pont_k: unknown key; did you mean 'melting_point_k'?"],
    );
    expect(
        r#""speed_m_s""#,
        r#""sped_m_s""#,
        &["scene.json:12:29: /arc/sped_m_s", "'speed_m_s'"],
    );
    expect(
        r#""radius_m""#,
        r#""radus_m""#,
        &["/shapes/1/sphere/radus_m: unknown key", "'radius_m'"],
    );
    expect(r#""comment""#, r#""colour""#, &["/colour: unknown key"]);
}

#[test]
fn another_unit_is_refused_with_the_si_key_and_the_value_in_it() {
    expect(
        r#""spacing_m": 5e-4"#,
        r#""spacing_mm": 0.5"#,
        &["did you mean 'spacing_m' in m: 0.0005?"],
    );
    expect(
        r#""speed_m_s": 0.005"#,
        r#""speed_cm_min": 30"#,
        &["'speed_m_s' in m/s: 0.005?"],
    );
    expect(
        r#""melting_point_k": 1750"#,
        r#""melting_point_c": 1477"#,
        &["'melting_point_k' in K: 1750.15?"],
    );
}

#[test]
fn ranges_tell_value_unit_and_limits() {
    expect(
        "5e-4",
        "-0.5",
        &["5:16: /spacing_m: -0.5 m is out of range: above 0 m and at most 0.1 m"],
    );
    expect("5e-4", "0", &["/spacing_m: 0 m is out of range: above 0 m"]);
    expect(
        "1750",
        "2e4",
        &["/melting_point_k: 20000.0 K is out of range: at least 1 K and at most 10000 K"],
    );
    expect(
        r#""current_a": 300"#,
        r#""current_a": -300"#,
        &["/arc/current_a: -300 A", "at least 0 A and at most 2000 A"],
    );
}

#[test]
fn wrong_types_tell_both() {
    expect(
        "1750",
        r#""hot""#,
        &[r#"/melting_point_k: is "hot" (a text), wanted is a number in K"#],
    );
    expect(
        "1750",
        "null",
        &["/melting_point_k: is null (null), wanted is a number in K"],
    );
    expect(
        "[1, 1, 1]",
        "[1, 1]",
        &["/shapes/0/box/max_m: [1,1] has 2 entries, wanted are exactly 3"],
    );
    expect(
        "[1, 1, 1]",
        "[1, 1, 1, 1]",
        &["has 4 entries, wanted are exactly 3"],
    );
}

#[test]
fn missing_keys_are_named_with_their_meaning() {
    expect(
        "  \"spacing_m\": 5e-4,\n",
        "",
        &["has no key 'spacing_m' in m (Distance of the particles.)"],
    );
    expect(
        r#""current_a": 300, "#,
        "",
        &["scene.json:12:10: /arc: has no key 'current_a' in A (Welding current [A].)"],
    );
}

#[test]
fn choices_are_named() {
    expect(
        r#""sphere""#,
        r#""spere""#,
        &["scene.json:10:", "/shapes/1", "sphere"],
    );
    let found = faults(r#""arc": {"#, r#""method": "projction", "arc": {"#);
    assert!(
        found.contains("/method") && found.contains(r#"did you mean "projection"?"#),
        "{found}"
    );
    expect(
        r#""t_k": [300, 1800]"#,
        r#""tk": [300, 1800]"#,
        &["/conductivity_w_m_k", "t_k"],
    );
    expect(
        r#"{"t_k": [300, 1800], "value": [60, 30]}"#,
        r#"{"expression": "3"}"#,
        &["did you mean 'expr'?"],
    );
}

#[test]
fn a_mistyped_tag_and_a_value_in_place_of_an_object_are_told() {
    expect(
        r#""sphere""#,
        r#""spere""#,
        &["scene.json:10:6: /shapes/1/spere: unknown key; did you mean 'sphere'?"],
    );
    let text = r#"{"current_a": 300, "speed_m_s": 0.005}"#;
    expect(
        text,
        "300",
        &[r#"/arc: is 300 (a number), wanted is {"current_a", "speed_m_s"}"#],
    );
    expect(
        r#"{"t_k": [300, 1800], "value": [60, 30]}"#,
        r#""60""#,
        &[r#""60" fits none of: number | {"t_k""#],
    );
}

#[test]
fn all_faults_are_told_at_once_in_the_order_of_the_file() {
    let text = GOOD
        .replace("5e-4", "-1")
        .replace("1750", "0")
        .replace("\"arc\"", "\"ark\"")
        .replace("300, 1800", "300");
    let failure = parse::<Scene>(&text, POOL).expect_err("four faults");
    let Failure::Scene(found) = &failure else {
        panic!("{failure}")
    };
    let paths: Vec<&str> = found.iter().map(run::Fault::path).collect();
    assert_eq!(
        paths,
        [
            "/spacing_m",
            "/melting_point_k",
            "/conductivity_w_m_k/t_k",
            ""
        ],
        "{failure}"
    );
}

#[test]
fn malformed_json_has_its_line() {
    expect("1750,", "1750", &["scene.json:7:3: not valid JSON"]);
    expect("\"arc\": {", "\"arc\": ", &["scene.json:12:"]);
    expect("5e-4", "5e-4, // a comment", &["scene.json:5:"]);
    expect("5e-4", "NaN", &["scene.json:5:16: not valid JSON"]);
    expect("5e-4", "1e999", &["scene.json:5:", "not valid JSON"]);
    let twice = faults(
        r#""melting_point_k": 1750"#,
        r#""spacing_m": 1e-3, "melting_point_k": 1750"#,
    );
    assert!(
        twice.contains("scene.json:6:3: /spacing_m: stands twice"),
        "{twice}"
    );
    for text in ["", "[]", "3", "\"kind\""] {
        assert!(
            matches!(parse::<Scene>(text, POOL), Err(Failure::Scene(_))),
            "{text}"
        );
    }
}

#[test]
fn another_kind_or_version_is_refused_by_name() {
    expect(
        r#""test.scene""#,
        r#""arcfvm.scene""#,
        &[r#"2:11: /kind: is "arcfvm.scene", this tool reads "test.scene""#],
    );
    expect(
        r#""version": 2"#,
        r#""version": 3"#,
        &["/version: 'test.scene' is of version 3, this tool reads version 2"],
    );
    expect(
        r#""version": 2"#,
        r#""version": 1"#,
        &["is of version 1, this tool reads version 2"],
    );
    expect(
        "  \"version\": 2,\n",
        "",
        &["has no \"version\"; this tool reads version 2"],
    );
    expect(
        "  \"kind\": \"test.scene\",\n",
        "",
        &["has no \"kind\"; this tool reads \"test.scene\""],
    );
}

fn file(folder: &Path, name: &str, text: &str) -> PathBuf {
    let path = folder.join(name);
    std::fs::write(&path, text).expect("a file");
    path
}

#[test]
fn patches_merge_and_faults_name_the_file_that_set_the_value() {
    let folder = tempfile::tempdir().expect("a folder");
    let scene = file(folder.path(), "scene.json", GOOD);
    let schema = schema_of::<Scene>(POOL);
    let read = |patches: &[PathBuf]| load::<Scene>(&scene, patches, &schema, POOL);
    let finer = file(
        folder.path(),
        "finer.json",
        r#"{"spacing_m": 1e-4, "arc": {"speed_m_s": null}, "method": "homogenising"}"#,
    );
    let loaded = read(std::slice::from_ref(&finer)).expect("good");
    assert!((loaded.scene.spacing_m - 1e-4).abs() < 1e-18);
    assert_eq!(
        loaded.scene.arc,
        Some(Arc {
            current_a: 300.0,
            speed_m_s: None
        })
    );
    assert_eq!(loaded.merged.value()["arc"], json!({"current_a": 300}));
    let off = file(
        folder.path(),
        "off.json",
        "{\"arc\": null,\n \"spacing_m\": -1}",
    );
    let failure = read(&[finer, off.clone()])
        .expect_err("negative")
        .to_string();
    assert!(
        failure.starts_with(&format!("{}:2:15: /spacing_m: -1 m", off.display())),
        "{failure}"
    );
    let broken = file(folder.path(), "broken.json", "{");
    assert!(
        read(&[broken])
            .expect_err("broken")
            .to_string()
            .contains("broken.json:1:")
    );
    let absent = read(&[folder.path().join("absent.json")]).expect_err("absent");
    assert_eq!(absent.exit_code(), 2);
}

#[test]
fn merge_patches_follow_the_examples_of_rfc_7386() {
    let folder = tempfile::tempdir().expect("a folder");
    let cases = [
        (json!({"a": "b"}), json!({"a": "c"}), json!({"a": "c"})),
        (
            json!({"a": "b"}),
            json!({"b": "c"}),
            json!({"a": "b", "b": "c"}),
        ),
        (json!({"a": "b"}), json!({"a": null}), json!({})),
        (
            json!({"a": "b", "b": "c"}),
            json!({"a": null}),
            json!({"b": "c"}),
        ),
        (json!({"a": ["b"]}), json!({"a": "c"}), json!({"a": "c"})),
        (json!({"a": "c"}), json!({"a": ["b"]}), json!({"a": ["b"]})),
        (
            json!({"a": {"b": "c"}}),
            json!({"a": {"b": "d", "c": null}}),
            json!({"a": {"b": "d"}}),
        ),
        (
            json!({"a": [{"b": "c"}]}),
            json!({"a": [1]}),
            json!({"a": [1]}),
        ),
        (
            json!({"e": null}),
            json!({"a": 1}),
            json!({"e": null, "a": 1}),
        ),
        (
            json!({}),
            json!({"a": {"bb": {"ccc": null}}}),
            json!({"a": {"bb": {}}}),
        ),
    ];
    let any = json!({});
    for (i, (mut scene, patch, mut wanted)) in cases.into_iter().enumerate() {
        for value in [&mut scene, &mut wanted] {
            value["kind"] = json!("test.scene");
            value["version"] = json!(2);
        }
        let scene = file(folder.path(), "scene.json", &scene.to_string());
        let patch = file(folder.path(), "patch.json", &patch.to_string());
        let loaded = load::<serde_json::Value>(&scene, &[patch], &any, POOL).expect("any scene");
        assert_eq!(loaded.merged.value(), &wanted, "case {i}");
    }
}

#[test]
fn the_schema_is_closed_and_knows_the_envelope() {
    let schema = schema_of::<Scene>(POOL);
    assert_eq!(schema["properties"]["kind"]["const"], "test.scene");
    assert_eq!(schema["additionalProperties"], false);
    assert_eq!(schema["required"][0], "kind");
    assert_eq!(
        schema["properties"]["spacing_m"]["description"],
        "Distance of the particles."
    );
}

#[derive(Debug, Deserialize, JsonSchema, PartialEq)]
#[serde(deny_unknown_fields)]
struct Toy {
    drop: Drop,
}

#[derive(Debug, Deserialize, JsonSchema, PartialEq)]
#[serde(deny_unknown_fields)]
struct Drop {
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    radius_m: f64,
}

/// Version 2 measures in metres; version 3 puts the radius into an object.
const TOY: Expected = Expected {
    kind: "toy.scene",
    version: 3,
    migrations: &[
        Migration {
            from: 1,
            change: |scene| match scene.shift_remove("diameter_mm").map(|d| d.as_f64()) {
                Some(Some(d)) => {
                    scene.insert("radius_m".to_owned(), json!(0.5e-3 * d));
                    Ok(())
                }
                Some(None) => Err(Fault::at("/diameter_mm", "is no number")),
                None => Err(Fault::at("", "has no key 'diameter_mm'")),
            },
            renames: false,
        },
        Migration {
            from: 2,
            change: |scene| {
                let radius = scene.shift_remove("radius_m").unwrap_or_default();
                scene.insert("drop".to_owned(), json!({"radius_m": radius}));
                Ok(())
            },
            renames: false,
        },
    ],
};

fn toy(text: &str) -> Result<(Toy, Option<u32>), String> {
    match parse::<Toy>(text, TOY) {
        Ok(loaded) => {
            assert_eq!(loaded.merged.value()["version"], 3);
            Ok((loaded.scene, loaded.migrated))
        }
        Err(failure) => Err(failure.to_string()),
    }
}

#[test]
fn an_older_scene_is_read_by_a_chain_of_migrations() {
    let drop = Toy {
        drop: Drop { radius_m: 0.00075 },
    };
    for (text, from) in [
        (
            r#"{"kind": "toy.scene", "version": 1, "diameter_mm": 1.5}"#,
            Some(1),
        ),
        (
            r#"{"kind": "toy.scene", "version": 2, "radius_m": 0.00075}"#,
            Some(2),
        ),
        (
            r#"{"kind": "toy.scene", "version": 3, "drop": {"radius_m": 0.00075}}"#,
            None,
        ),
    ] {
        let (scene, migrated) = toy(text).expect(text);
        assert!((scene.drop.radius_m - drop.drop.radius_m).abs() < 1e-15);
        assert_eq!(migrated, from);
    }
}

/// Version 2 calls the width of a door by its unit.
const DOOR: Expected = Expected {
    kind: "door.scene",
    version: 2,
    migrations: &[Migration {
        from: 1,
        change: |scene| {
            if let Some(width) = scene.shift_remove("width") {
                scene.entry("width_m").or_insert(width);
            }
            Ok(())
        },
        renames: true,
    }],
};

#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct Door {
    width_m: f64,
}

#[test]
fn patches_may_have_older_and_newer_words_than_their_scene() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = |name: &str, text: &str| {
        let path = folder.path().join(name);
        std::fs::write(&path, text).expect("a file");
        path
    };
    let old = file(
        "old.json",
        r#"{"kind": "door.scene", "version": 1, "width": 1}"#,
    );
    let new = file(
        "new.json",
        r#"{"kind": "door.scene", "version": 2, "width_m": 1}"#,
    );
    let words = ["width", "width_m"].map(|word| {
        file(
            &format!("{word}.patch.json"),
            &format!(r#"{{"{word}": 2}}"#),
        )
    });
    for scene in [old, new] {
        for word in &words {
            let patches = std::slice::from_ref(word);
            let loaded = load::<Door>(&scene, patches, &schema_of::<Door>(DOOR), DOOR);
            let door = loaded.unwrap_or_else(|e| panic!("{e}")).scene;
            assert!((door.width_m - 2.0).abs() < 1e-15, "{scene:?} {word:?}");
        }
    }
}

#[test]
fn what_no_migration_reads_is_refused_by_name() {
    for (text, words) in [
        (
            "{\"kind\": \"toy.scene\",\n \"version\": 4}",
            [
                "scene.json:2:13: /version",
                "version 4, this tool reads version 3 and nothing newer",
            ],
        ),
        (
            r#"{"kind": "toy.scene", "version": 0}"#,
            [
                "/version",
                "of version 0, this tool reads version 3 and knows no way",
            ],
        ),
        (
            r#"{"kind": "toy.scene", "version": "one"}"#,
            ["/version", "\"one\""],
        ),
        (
            r#"{"kind": "toy.scene"}"#,
            ["scene.json:1:1", "has no \"version\""],
        ),
        (
            "{\"kind\": \"toy.scene\", \"version\": 1,\n\"diameter_mm\": \"wide\"}",
            ["scene.json:2:16: /diameter_mm", "is no number"],
        ),
        // Faults of what a migration made stand where the scene begins.
        (
            r#"{"kind": "toy.scene", "version": 1, "diameter_mm": -1}"#,
            ["scene.json:1:1: /drop/radius_m", "out of range: above 0 m"],
        ),
    ] {
        let said = toy(text).expect_err(text);
        for word in words {
            assert!(said.contains(word), "{word} is not in\n{said}");
        }
    }
}

#[test]
fn a_patch_is_of_the_version_of_its_scene() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = |name: &str, text: &str| {
        let path = folder.path().join(name);
        std::fs::write(&path, text).expect("a file");
        path
    };
    let scene = file(
        "a.json",
        r#"{"kind": "toy.scene", "version": 1, "diameter_mm": 1.5}"#,
    );
    let patch = file("b.json", r#"{"diameter_mm": 3}"#);
    let loaded = load::<Toy>(&scene, &[patch], &schema_of::<Toy>(TOY), TOY).expect("a scene");
    assert!((loaded.scene.drop.radius_m - 0.0015).abs() < 1e-15);
}
