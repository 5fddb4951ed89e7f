//! What scenes take from files: substances by name, surfaces of triangles.

#![allow(clippy::expect_used, reason = "a test fails by panicking")]
#![allow(clippy::float_cmp, reason = "numbers are taken as they stand")]

use std::path::Path;

use run::property::Property;
use run::scene::{Expected, load, named, schema_of};
use run::{Failure, Migration};
use schemars::JsonSchema;
use serde::Deserialize;
use serde_json::{Value, json};

const POOL: Expected = Expected {
    kind: "test.scene",
    version: 1,
    migrations: &[] as &[Migration],
};

#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct Scene {
    /// A text, which no substance replaces.
    #[serde(default)]
    label: String,
    density_kg_m3: Option<f64>,
    material: Option<Material>,
    marangoni: Option<Marangoni>,
    losses: Option<Losses>,
    shape: Option<Shape>,
}

#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct Material {
    density_kg_m3: f64,
    conductivity_w_m_k: Property,
    melting: Option<Melting>,
}

#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct Melting {
    #[schemars(range(min = 1.0))]
    point_k: f64,
    latent_heat_j_kg: f64,
}

#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct Marangoni {
    slope_n_m_k: f64,
}

#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct Losses {
    evaporation: Evaporation,
}

#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct Evaporation {
    boiling_point_k: f64,
    latent_heat_j_kg: f64,
    thickness_m: f64,
}

#[derive(Debug, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
enum Shape {
    Stl(Stl),
}

#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct Stl {
    file: String,
    unit: Unit,
    sha256: Option<String>,
    vertices_m: Option<Vec<[f64; 3]>>,
    triangles: Option<Vec<[usize; 3]>>,
}

#[derive(Debug, Deserialize, JsonSchema, PartialEq)]
#[serde(rename_all = "lowercase")]
enum Unit {
    Mm,
    M,
}

const STEEL: &str = r#"{
  "kind": "substance",
  "version": 1,
  "title": "A steel",
  "source": "a table",
  "density_kg_m3": 7850,
  "thermal_conductivity_w_m_k": {"t_k": [300, 1800], "value": [60, 30]},
  "surface_tension_slope_n_m_k": -4e-4,
  "melting": {"point_k": 1750, "half_range_k": 50, "latent_heat_j_kg": 250000},
  "evaporation": {"boiling_k": 3134, "latent_heat_j_kg": 6.09e6}
}
"#;

/// The loaded scene, or all that is wrong with it, with `materials/steel.json` beside the folder of the scene.
fn read(folder: &Path, scene: &Value, patch: Option<&Value>) -> Result<(Scene, Value), String> {
    let inner = folder.join("study");
    for place in [&folder.join("materials"), &inner, &folder.join("patches")] {
        std::fs::create_dir_all(place).expect("a folder");
    }
    std::fs::write(folder.join("materials/steel.json"), STEEL).expect("a sheet");
    let mut whole = json!({"kind": "test.scene", "version": 1});
    if let (Value::Object(whole), Value::Object(own)) = (&mut whole, scene.clone()) {
        whole.extend(own);
    }
    let path = inner.join("scene.json");
    std::fs::write(&path, format!("{whole:#}")).expect("a scene");
    let patches: Vec<_> = patch
        .map(|patch| {
            let path = folder.join("patches/other.json");
            std::fs::write(&path, format!("{patch:#}")).expect("a patch");
            path
        })
        .into_iter()
        .collect();
    match load::<Scene>(&path, &patches, &schema_of::<Scene>(POOL), POOL) {
        Ok(loaded) => Ok((loaded.scene, loaded.merged.value().clone())),
        Err(failure @ Failure::Scene(_)) => Err(failure.to_string()),
        Err(other) => panic!("{other}"),
    }
}

fn steel() -> Value {
    json!({"steel": {"file": "../materials/steel.json"}})
}

#[test]
fn values_come_from_the_sheet_and_the_merged_scene_tells_them() {
    let folder = tempfile::tempdir().expect("a folder");
    let scene = json!({
        "label": "steel",
        "substances": steel(),
        "density_kg_m3": "steel",
        "material": "steel",
        "marangoni": {"slope_n_m_k": "steel"},
        "losses": {"evaporation": {"boiling_point_k": "steel", "latent_heat_j_kg": "steel", "thickness_m": 1e-4}},
    });
    let (scene, merged) = read(folder.path(), &scene, None).expect("good");
    assert_eq!(
        (scene.label.as_str(), scene.density_kg_m3),
        ("steel", Some(7850.0))
    );
    let material = scene.material.expect("a material");
    assert_eq!(material.density_kg_m3, 7850.0);
    assert!(matches!(material.conductivity_w_m_k, Property::Table(_)));
    // What the scene does not know of melting, the half range, it does not take.
    let melting = material.melting.expect("melting");
    assert_eq!(
        (melting.point_k, melting.latent_heat_j_kg),
        (1750.0, 250_000.0)
    );
    assert_eq!(scene.marangoni.expect("a slope").slope_n_m_k, -4e-4);
    let evaporation = scene.losses.expect("losses").evaporation;
    assert_eq!(
        (evaporation.boiling_point_k, evaporation.latent_heat_j_kg),
        (3134.0, 6.09e6)
    );
    assert_eq!(evaporation.thickness_m, 1e-4);
    assert_eq!(
        merged["material"]["conductivity_w_m_k"]["value"],
        json!([60, 30])
    );
    let hash = artefact::sha256(STEEL.as_bytes());
    assert_eq!(
        merged["substances"],
        json!({"steel": {"title": "A steel", "source": "a table", "from": "../materials/steel.json", "sha256": hash}})
    );
    // The scene of the artefact is a scene: it runs again where no sheet is.
    let (again, same) =
        read(tempfile::tempdir().expect("a folder").path(), &merged, None).expect("good");
    assert_eq!(again.density_kg_m3, Some(7850.0));
    assert_eq!(same, merged);
}

#[test]
fn own_values_go_before_the_sheet_and_patches_name_files_beside_themselves() {
    let folder = tempfile::tempdir().expect("a folder");
    let scene = json!({"substances": steel(), "density_kg_m3": "steel", "marangoni": {"slope_n_m_k": "steel"}});
    let own = json!({"substances": {"steel": {"density_kg_m3": 7000}}});
    let (found, _) = read(folder.path(), &scene, Some(&own)).expect("good");
    assert_eq!(found.density_kg_m3, Some(7000.0));
    assert_eq!(found.marangoni.expect("a slope").slope_n_m_k, -4e-4);
    std::fs::write(
        folder.path().join("patches/light.json"),
        STEEL.replace("7850", "2700"),
    )
    .expect("a sheet");
    let other = json!({"substances": {"steel": {"file": "light.json"}}});
    let (found, _) = read(folder.path(), &scene, Some(&other)).expect("good");
    assert_eq!(found.density_kg_m3, Some(2700.0));
    let plain = json!({"substances": {"mud": {"density_kg_m3": 1800}}, "density_kg_m3": "mud"});
    assert_eq!(
        read(folder.path(), &plain, None)
            .expect("good")
            .0
            .density_kg_m3,
        Some(1800.0)
    );
}

#[test]
fn members_that_a_patch_puts_in_place_of_a_name_join_those_of_the_sheet() {
    let folder = tempfile::tempdir().expect("a folder");
    let whole = json!({"substances": steel(), "material": "steel"});
    let read = |scene: &Value, patch: Value| read(folder.path(), scene, Some(&patch));
    let (scene, _) = read(&whole, json!({"material": {"density_kg_m3": 7000}})).expect("good");
    let material = scene.material.expect("a material");
    assert_eq!(material.density_kg_m3, 7000.0);
    assert!(matches!(material.conductivity_w_m_k, Property::Table(_)));
    assert_eq!(material.melting.expect("melting").point_k, 1750.0);
    // Of parts in it as well, but for what a patch takes away.
    let part = json!({"substances": steel(), "material":
        {"density_kg_m3": "steel", "conductivity_w_m_k": "steel", "melting": "steel"}});
    let (scene, _) =
        read(&part, json!({"material": {"melting": {"point_k": 1600}}})).expect("good");
    let melting = scene
        .material
        .expect("a material")
        .melting
        .expect("melting");
    assert_eq!(
        (melting.point_k, melting.latent_heat_j_kg),
        (1600.0, 250_000.0)
    );
    let none = json!({"material": {"melting": {"point_k": 1600, "latent_heat_j_kg": null}}});
    let told = read(&part, none).expect_err("refused");
    assert!(told.contains("latent_heat_j_kg"), "{told}");
    // A property is replaced whole.
    let own = json!({"material": {"conductivity_w_m_k": {"t_k": [300, 900], "value": [1, 2]}}});
    let (_, merged) = read(&part, own).expect("good");
    assert_eq!(
        merged["material"]["conductivity_w_m_k"]["value"],
        json!([1, 2])
    );
}

#[test]
fn what_is_wrong_is_told_where_it_stands() {
    let folder = tempfile::tempdir().expect("a folder");
    let wrong = |scene: Value, parts: &[&str]| {
        let told = read(folder.path(), &scene, None).expect_err("refused");
        for part in parts {
            assert!(told.contains(part), "{told}\n  lacks  {part}");
        }
    };
    wrong(
        json!({"substances": steel(), "density_kg_m3": "stel"}),
        &[
            "scene.json:",
            "/density_kg_m3: \"stel\" is no substance of this scene; did you mean \"steel\"?",
        ],
    );
    wrong(
        json!({"substances": {"steel": {"file": "../materials/stel.json"}}}),
        &[
            "/substances/steel/file: there is no file",
            "did you mean steel.json?",
        ],
    );
    wrong(
        json!({"substances": {"steel": {"file": "../materials/steel.json", "densty_kg_m3": 1}}}),
        &["/substances/steel/densty_kg_m3: unknown key; did you mean 'density_kg_m3'?"],
    );
    wrong(
        json!({"substances": {"mud": {"density_kg_m3": 1800}}, "marangoni": {"slope_n_m_k": "mud"}}),
        &["/marangoni/slope_n_m_k: mud has no 'surface_tension_slope_n_m_k'; it has density_kg_m3"],
    );
    // A value that does not fit is told in the sheet: of density a number is wanted here.
    std::fs::write(
        folder.path().join("bad.json"),
        STEEL.replace("\"point_k\": 1750", "\"point_k\": 0.5"),
    )
    .expect("a sheet");
    wrong(
        json!({"substances": {"steel": {"file": "../bad.json"}}, "material": "steel"}),
        &[
            "bad.json:9:26: ",
            "/material/melting/point_k",
            "0.5 K is out of range: at least 1 K",
        ],
    );
    std::fs::write(
        folder.path().join("odd.json"),
        STEEL.replace("\"source\"", "\"sauce\""),
    )
    .expect("a sheet");
    wrong(
        json!({"substances": {"steel": {"file": "../odd.json"}}}),
        &["odd.json:5:3: /sauce: unknown key; did you mean 'source'?"],
    );
    // Without substances a text is what it was.
    wrong(
        json!({"density_kg_m3": "steel"}),
        &["/density_kg_m3: is \"steel\" (a text), wanted is a number in kg/m3"],
    );
}

#[test]
fn editors_are_offered_names_where_values_stand() {
    let schema = named(schema_of::<Scene>(POOL));
    let forms = schema["properties"]["density_kg_m3"]["anyOf"]
        .as_array()
        .expect("forms");
    assert!(forms.iter().any(|form| form["type"] == "string"));
    assert_eq!(schema["properties"]["label"]["type"], "string");
    assert!(schema["properties"]["substances"].is_object());
}

/// A tetrahedron as text, in the unit of whoever reads it.
fn tetrahedron() -> String {
    let corners = [[0, 0, 0], [10, 0, 0], [0, 10, 0], [0, 0, 10]];
    let faces = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];
    let vertex = |k: usize| {
        let [x, y, z] = corners[k];
        format!("vertex {x} {y} {z}\n")
    };
    let facet = |face: [usize; 3]| {
        let corners: String = face.map(vertex).concat();
        format!("facet normal 0 0 0\nouter loop\n{corners}endloop\nendfacet\n")
    };
    format!("solid t\n{}endsolid t\n", faces.map(facet).concat())
}

#[test]
fn surfaces_are_read_in_their_unit_and_told_by_the_merged_scene() {
    let folder = tempfile::tempdir().expect("a folder");
    std::fs::write(folder.path().join("part.stl"), tetrahedron()).expect("a file");
    let shape = |file: &str, unit: &str| json!({"shape": {"stl": {"file": file, "unit": unit}}});
    let (scene, merged) = read(folder.path(), &shape("../part.stl", "mm"), None).expect("good");
    let Some(Shape::Stl(stl)) = scene.shape else {
        panic!("no shape");
    };
    assert_eq!((stl.file.as_str(), stl.unit), ("../part.stl", Unit::Mm));
    assert_eq!(
        stl.triangles,
        Some(vec![[0, 1, 2], [0, 2, 3], [2, 1, 3], [1, 0, 3]])
    );
    assert_eq!(stl.vertices_m.expect("corners")[1], [0.0, 0.01, 0.0]);
    assert_eq!(stl.sha256.map(|hash| hash.len()), Some(64));
    let (again, _) =
        read(tempfile::tempdir().expect("a folder").path(), &merged, None).expect("good");
    assert!(matches!(again.shape, Some(Shape::Stl(stl)) if stl.triangles.is_some()));
    let told = read(folder.path(), &shape("../prt.stl", "mm"), None).expect_err("refused");
    assert!(
        told.contains("/shape/stl/file") && told.contains("did you mean part.stl?"),
        "{told}"
    );
    let told = read(folder.path(), &shape("../part.stl", "mil"), None).expect_err("refused");
    assert!(told.contains("/shape/stl/unit"), "{told}");
    let text = "nothing like it, and long enough to have a header of eighty characters and a number behind it";
    std::fs::write(folder.path().join("odd.stl"), text).expect("a file");
    let told = read(folder.path(), &shape("../odd.stl", "mm"), None).expect_err("refused");
    assert!(told.contains("is no STL file"), "{told}");
}
