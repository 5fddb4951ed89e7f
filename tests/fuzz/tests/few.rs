//! A few hundred changed scenes and artefacts on every change; `make fuzz N=...` does as many as there is time for.

#![allow(clippy::unwrap_used, reason = "a test may fail")]

use std::path::Path;

use fuzz::{Breadth, Campaign};

/// Changed scenes and changed artefacts.
const TRIALS: u64 = 300;

#[test]
fn nothing_that_is_given_to_the_programs_harms() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let folder = tempfile::tempdir().unwrap();
    let campaign = Campaign {
        seed: 1,
        scenes: TRIALS,
        runs: TRIALS / 30,
        files: TRIALS,
        only: None,
        breadth: Breadth::Quick,
        programs: Path::new(env!("CARGO_BIN_EXE_fuzz"))
            .parent()
            .unwrap()
            .to_owned(),
        out: folder.path().to_owned(),
        root: root.canonicalize().unwrap(),
        threads: 2,
    };
    let outcome = fuzz::run(&campaign).unwrap();
    assert!(outcome.findings.is_empty(), "{}", outcome.table());
    assert!(outcome.programs > 3 * TRIALS, "{}", outcome.table());
}
