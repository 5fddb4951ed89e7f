//! One owner of each truth: what numbers and formulas tell that stand in one file alone.

use std::collections::BTreeSet;

use super::{root, sources};

/// What is looked for, what it is, and the files below `tools` that may have it.
const OWNED: [(&str, &str, &[&str]); 9] = [
    ("577_350_269", "a rule of Gauss", QUADRATURE),
    ("788_675_134", "a rule of Gauss", QUADRATURE),
    ("887_298_334", "a rule of Gauss", QUADRATURE),
    ("661_209_386", "a rule of Gauss", QUADRATURE),
    (
        "0xBF58_476D_1CE4_E5B9",
        "the generator splitmix64",
        &["numerics/shapes/src/jitter.rs"],
    ),
    // The harness knows no crate of numerics.
    (
        "a[1] * b[2] - a[2] * b[1]",
        "the vector product",
        &[
            "numerics/shapes/src/frame.rs",
            "harness/artefact/src/lattice.rs",
        ],
    ),
    (
        "a[0] * b[0] + a[1] * b[1] + a[2] * b[2]",
        "the scalar product",
        &["numerics/shapes/src/frame.rs"],
    ),
    (
        "b * c - f * f",
        "the inverse of moments",
        &["numerics/kernels/src/moments.rs"],
    ),
    (
        "(seconds % 60.0)",
        "a span of time",
        &["harness/run/src/plan.rs"],
    ),
];
const QUADRATURE: &[&str] = &["numerics/quadrature/src/lib.rs"];

#[test]
fn each_truth_has_one_owner() {
    let tools = root().join("tools");
    let mut found = Vec::new();
    sources(&tools, &mut found);
    let texts: Vec<(String, String)> = found
        .iter()
        .map(|path| {
            let name = path.strip_prefix(&tools).unwrap().display().to_string();
            (name, std::fs::read_to_string(path).unwrap())
        })
        .collect();
    for (mark, what, owners) in OWNED {
        let has = texts.iter().filter(|(_, text)| text.contains(mark));
        let has: BTreeSet<&str> = has.map(|(name, _)| name.as_str()).collect();
        let owners: BTreeSet<&str> = owners.iter().copied().collect();
        assert_eq!(has, owners, "{what} belongs into one file: '{mark}'");
    }
}
