//! Recombined iterations lead where plain ones do, and go on from a checkpoint to the same bits.
#![allow(clippy::unwrap_used, reason = "a test may fail")]

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use arcfvm::assemble::assemble;
use arcfvm::recombination::Recombination;
use arcfvm::resume;
use arcfvm::scene::Scene;
use arcfvm::settings::Settings;
use arcfvm::solver::Arc;
use artefact::{Checkpoint, Header, Version};
use serde_json::Value;

fn read(path: &str) -> String {
    let root: PathBuf = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    std::fs::read_to_string(root.join(path)).unwrap()
}

/// A small arc between wire and plate in argon.
fn an_arc() -> Arc {
    let text = read("pipelines/verify/arc-surface/scene.json");
    let mut scene: Value = serde_json::from_str(&text).unwrap();
    for key in ["$schema", "kind", "version", "comment"] {
        scene.as_object_mut().unwrap().remove(key);
    }
    let scene: Scene = serde_json::from_value(scene).unwrap();
    let gas = serde_json::from_str(&read("pipelines/gases/argon-1atm.json")).unwrap();
    let case = assemble(&scene, Some(&gas)).unwrap();
    Arc::new(case, Settings::from(&scene.iterate))
}

/// Iterates `times`; gives the last of the greatest residuals.
fn iterate(arc: &mut Arc, recombination: &mut Option<Recombination>, times: usize) -> f64 {
    let mut worst = f64::INFINITY;
    for _ in 0..times {
        let residuals = arc.iterate(&mut ()).unwrap();
        worst = residuals.worst();
        if let Some(recombination) = recombination {
            recombination.recombine(arc, &residuals);
        }
    }
    worst
}

#[test]
fn they_lead_where_plain_iterations_do_and_sooner() {
    let (mut plain, mut mixed) = (an_arc(), an_arc());
    iterate(&mut plain, &mut None, 60);
    iterate(&mut mixed, &mut None, 60);
    let mut recombination = Some(Recombination::new(&mut mixed));
    let slow = iterate(&mut plain, &mut None, 400);
    let fast = iterate(&mut mixed, &mut recombination, 400);
    assert!(fast < 1e-2 * slow, "{fast:e} {slow:e}");
    for (a, b) in plain.temperature().iter().zip(mixed.temperature()) {
        assert!((a / b - 1.0).abs() < 1e-6, "{a} {b}");
    }
}

#[test]
fn a_checkpoint_goes_on_to_the_same_bits() {
    let mut straight = an_arc();
    iterate(&mut straight, &mut None, 30);
    let mut recombination = Some(Recombination::new(&mut straight));
    iterate(&mut straight, &mut recombination, 14);
    let mut checkpoint = Checkpoint::new(&Header {
        kind: "arc-source".to_owned(),
        version: Version { major: 1, minor: 0 },
        tool: "arcfvm".to_owned(),
        tool_version: "0".to_owned(),
        scene: Value::Null,
        inputs: BTreeMap::new(),
    });
    resume::keep(&straight, &mut checkpoint).unwrap();
    let kept = recombination.as_ref().unwrap();
    kept.keep(&mut checkpoint).unwrap();
    let mut resumed = an_arc();
    resume::restore(&mut resumed, &mut checkpoint).unwrap();
    let mut restored = Some(Recombination::restored(&mut checkpoint).unwrap());
    iterate(&mut straight, &mut recombination, 9);
    iterate(&mut resumed, &mut restored, 9);
    for (a, b) in straight.temperature().iter().zip(resumed.temperature()) {
        assert_eq!(a.to_bits(), b.to_bits());
    }
}
