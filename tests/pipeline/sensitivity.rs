//! `tools/sweep/sensitivity`: its points, and its measures where the answer is known.

use std::path::Path;
use std::process::Command;

/// Elementary effects of y = 3 a + 2 b^2 + 0 c over ranges from 0 to 1: of a 3 everywhere, of b 2 (b + b') along each step,
/// of c none; and the points of the plan of a study as a sweep.
const KNOWN: &str = r"
import importlib.machinery, importlib.util, json, pathlib, sys
loader = importlib.machinery.SourceFileLoader('sensitivity', 'tools/sweep/sensitivity')
s = importlib.util.module_from_spec(importlib.util.spec_from_loader('sensitivity', loader))
loader.exec_module(s)
morris = {'levels': 4, 'trajectories': 40, 'seed': 7}
ways = s.trajectories(3, morris)
y = lambda p: 3 * p[0] + 2 * p[1] ** 2
for order, way in ways:
    assert sorted(order) == [0, 1, 2] and len(way) == 4
    assert all(-1e-12 <= x <= 1 + 1e-12 for p in way for x in p)
    for before, after in zip(way, way[1:]):
        changed = [abs(a - b) for a, b in zip(before, after)]
        assert sum(c > 1e-9 for c in changed) == 1 and abs(max(changed) - 2 / 3) < 1e-12
a, b, c = s.effects(ways, [[y(p) for p in way] for _, way in ways])
assert all(abs(x - 3) < 1e-9 for x in a[:2]) and a[2] < 1e-9, a
exact = [2 * (w[k + 1][1] + w[k][1]) for o, w in ways for k, i in enumerate(o) if i == 1]
assert abs(b[0] - sum(exact) / len(exact)) < 1e-9 and b[2] > 0.3, b
assert c[:3] == (0.0, 0.0, 0.0) and c[3] == 40, c
assert s.effects(ways[:1], [[y(p) for p in ways[0][1]]])[0][2:] == (None, 1)
assert ways == s.trajectories(3, morris)
lost = s.effects(ways[:1], [[None] * 4])
assert lost == [None, None, None]
for place in sorted(pathlib.Path('pipelines').glob('*/sensitivity.json')):
    plan = s.read(place)
    points, single, ways, along = s.points_of(plan)
    assert len(set(points)) == len(points) and points[single[0]] == tuple(i['base'] for i in plan['inputs'])
    assert len(single) == 1 + 2 * len(plan['inputs']) and all(len(w) == 1 + len(plan['inputs']) for w in along)
    json.dump(s.sweep_of(plan, points), open(pathlib.Path(sys.argv[1], place.parent.name + '.json'), 'w'))
";

#[test]
fn points_and_measures_are_those_of_morris_and_the_sweep_is_sound() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap();
    let folder = tempfile::tempdir().unwrap();
    let found = Command::new("python3")
        .args(["-c", KNOWN])
        .arg(folder.path())
        .current_dir(root)
        .output()
        .unwrap();
    let said = String::from_utf8_lossy(&found.stderr);
    assert!(found.status.success(), "{said}");
    let program = Path::new(env!("CARGO_BIN_EXE_verify")).with_file_name("sweep");
    let plans: Vec<_> = std::fs::read_dir(folder.path()).unwrap().collect();
    assert!(plans.len() > 1, "{plans:?}");
    for plan in plans {
        let checked = Command::new(&program)
            .arg("check")
            .arg(plan.unwrap().path())
            .current_dir(root)
            .output()
            .unwrap();
        let said = String::from_utf8_lossy(&checked.stderr);
        assert!(checked.status.success(), "{said}");
    }
}

#[test]
fn plans_that_are_wrong_are_refused_with_the_place() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap();
    let folder = tempfile::tempdir().unwrap();
    let plan = folder.path().join("plan.json");
    let text = std::fs::read_to_string(root.join("pipelines/first-weld/sensitivity.json")).unwrap();
    for (old, new, words) in [
        ("\"to\": 330", "\"to\": 200", "/inputs/0/to"),
        ("\"base\": 0.4", "\"base\": 0.9", "/inputs/1/base"),
        ("\"figures\"", "\"figurs\"", "/figurs"),
        ("\"trajectories\": 3", "\"levels\": 3", "/morris/levels"),
        (
            "\"trajectories\": 3",
            "\"trajectorys\": 3",
            "did you mean 'trajectories'?",
        ),
        (
            "\"trajectories\": 3",
            "\"trajectories\": -3",
            "/morris/trajectories",
        ),
        ("\"trajectories\": 3", "\"levels\": \"4\"", "/morris/levels"),
        ("\"base\": 0.4", "\"base\": \"0.4\"", "/inputs/1/base"),
        (
            "\"to\": 330",
            "\"to\": 330, \"units\": \"A\"",
            "did you mean 'unit'?",
        ),
    ] {
        std::fs::write(&plan, text.replace(old, new)).unwrap();
        let refused = Command::new(root.join("tools/sweep/sensitivity"))
            .arg(&plan)
            .current_dir(folder.path())
            .output()
            .unwrap();
        let said = String::from_utf8_lossy(&refused.stderr);
        assert_eq!(refused.status.code(), Some(2), "{said}");
        assert!(said.contains(words), "{words}: {said}");
    }
}
