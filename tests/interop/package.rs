//! Our own Python package, `tools/python`: it runs a small scene with each program, reads every kind and form of file
//! to the last bit as our reader does, says what is wrong with others, and can be installed.

use std::path::Path;
use std::process::Command;
use std::sync::OnceLock;

use serde_json::{Value, json};

use super::{ask, program, programs_in, python, root};

/// What `use_package.py` finds with the package on its path; it runs once for all tests.
fn found(python: &Path) -> &'static Value {
    static FOUND: OnceLock<Value> = OnceLock::new();
    FOUND.get_or_init(|| {
        let folder = tempfile::tempdir().unwrap();
        let arc = folder.path().join("arc-of-a-weld.mcap");
        verification::bell::WELD.write(&arc).unwrap();
        let programs = program("poolsph").parent().unwrap().to_owned();
        let arguments = [root(), programs, folder.path().to_owned(), arc];
        let arguments: Vec<&str> = arguments.iter().map(|p| p.to_str().unwrap()).collect();
        ask(python, "use_package.py", &arguments)
    })
}

#[test]
fn our_package_runs_every_program_and_reads_every_kind_as_our_reader_does() {
    let Some(python) = python() else { return };
    let found = found(&python);
    for (name, kind, forms) in [
        ("gas", "gas-table", ["table", "words"].as_slice()),
        ("arc", "arc-source", &["grid", "record"]),
        ("pool", "particle-frames", &["points", "record", "words"]),
        ("mean", "mean-fields", &["grid"]),
        ("heat", "point-fields", &["points", "record"]),
        ("field", "point-fields", &["points", "record"]),
        ("jet", "jet-frames", &["points", "record"]),
    ] {
        let file = &found[name];
        assert_eq!(file["kind"], kind, "{found:#}");
        for form in forms {
            let same = file["same"][form].as_u64();
            assert!(same > Some(0), "{name}: no array of form {form}: {file}");
        }
        assert_eq!(file["warned"][0], file["warned"][1], "{name}: {file}");
        let rows = file["rows"][0].as_u64();
        assert!(
            rows > Some(0) && file["rows"][0] == file["rows"][1],
            "{file}"
        );
    }
    assert_eq!(found["heat"]["patched"], "Two patches", "the last one wins");
    let vector = &found["vector"];
    assert_eq!(vector[0], json!([vector[2], 3]));
    assert_eq!(vector[1], "m/s");
    assert!(found["series"][0].as_u64() > Some(1) && found["series"][1] == true);
    assert_eq!(found["words"], json!(["m", 5e-4, [0.0, 1.0, 0.0]]));
}

#[test]
fn our_package_says_what_is_wrong() {
    let Some(python) = python() else { return };
    let found = found(&python);
    let said = |what: &str, words: &[&str]| {
        let text = found["refused"][what].as_str().unwrap();
        for word in words {
            assert!(text.contains(word), "{what}: no '{word}' in: {text}");
        }
    };
    said("cut", &["ArtefactError", "cut.mcap", "artefact recover"]);
    said("turned", &["ArtefactError", "turned.mcap"]);
    said("channel", &["KeyError", "/points", "/particles"]);
    said("column", &["KeyError", "pressure", "temperature"]);
    said(
        "scene",
        &["RunError", "initial_temperature_k", "out of range"],
    );
    said("plan", &["points"]);
}

#[test]
fn our_package_is_installed_by_pip_and_its_page_tells_the_truth() {
    let Some(python) = python() else { return };
    let folder = tempfile::tempdir().unwrap();
    let site = folder.path().join("site");
    let output = Command::new(&python)
        .args([
            "-m",
            "pip",
            "install",
            "--quiet",
            "--no-deps",
            "--no-build-isolation",
        ])
        .arg("--target")
        .arg(&site)
        .arg(root().join("tools/python"))
        .output()
        .unwrap();
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{said}");
    assert!(site.join("fusionline/py.typed").exists(), "it is typed");

    let scene = "build/hot-ring.mcap";
    let page = programs_in("tools/python/README.md").join("\n");
    assert!(page.contains(scene), "the page runs a scene");
    let page = page.replace(scene, folder.path().join("ring.mcap").to_str().unwrap());
    let script = folder.path().join("page.py");
    std::fs::write(&script, page).unwrap();
    let output = Command::new(&python)
        .arg(&script)
        .current_dir(root())
        .env("PYTHONPATH", &site)
        .env("FUSIONLINE_PROGRAMS", program("heatsph").parent().unwrap())
        .output()
        .unwrap();
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{said}");
    let told = String::from_utf8(output.stdout).unwrap();
    assert!(told.contains("0.06 s") && told.contains(" K"), "{told}");
}
