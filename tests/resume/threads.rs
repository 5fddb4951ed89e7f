//! Arcs and averages of any number of threads have the same bytes, as the marches of this test have.

use std::path::Path;
use std::process::Command;

use crate::{Scene, finish, folder};

/// `TOOL run SCENE` on some threads; its bytes.
fn made(tool: &str, scene: &Path, input: Option<&str>, threads: u8) -> Vec<u8> {
    let folder = folder();
    let mut run = Command::new(Path::new(env!("CARGO_BIN_EXE_verify")).with_file_name(tool));
    run.arg("run")
        .arg(scene)
        .arg("--out")
        .arg(folder.path().join(crate::OUT));
    if let Some(input) = input {
        run.args(["--input", input]);
    }
    let threads = threads.to_string();
    finish(run.args(["--threads", &threads, "-q"]), folder.path())
}

#[test]
fn an_arc_has_the_same_bytes_on_one_and_two_threads() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap();
    // Flow, heat and current at once, and heat alone.
    for case in ["arc-pinch", "arc-elenbaas"] {
        let scene = root.join("pipelines/verify").join(case).join("scene.json");
        let one = made("arcfvm", &scene, None, 1);
        assert!(one == made("arcfvm", &scene, None, 2), "{case}");
    }
}

#[test]
fn an_average_has_the_same_bytes_on_one_and_two_threads() {
    let folder = folder();
    let frames = folder.path().join("frames.mcap");
    std::fs::write(&frames, &Scene::Drop.straight().bytes).unwrap();
    let scene = folder.path().join("avg.json");
    let text = r#"{"kind": "avg.scene", "version": 1, "channel": "/particles", "sections": [
        {"name": "middle", "cut": {"plane": {"normal": "x", "half_thickness_m": 1e-3}},
         "first_m": [-4e-3, 4e-3], "second_m": [-2e-3, 5e-3]}]}"#;
    std::fs::write(&scene, text).unwrap();
    let input = format!("frames={}", frames.display());
    let one = made("avg", &scene, Some(&input), 1);
    assert!(one == made("avg", &scene, Some(&input), 2));
}
