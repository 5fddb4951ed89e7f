//! The Makefile with programs that only copy: what is changed wakes what is behind it, and nothing else.

use std::os::unix::fs::PermissionsExt;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// Writes what its files hold to its output, but for lines with comments, and notes its name; fails where they hold the word
/// "impossible", unless it makes pages.
const COPIES: &str = r#"#!/bin/sh
name=$(basename "$0")
echo "$name" >> log
while [ $# -gt 0 ]; do
    case $1 in
    --out) out=$2; shift 2 ;;
    --points) if [ "$name" = report ]; then cat "$2" >> "$name.gathered.$$"; else out=$2; fi; shift 2 ;;
    *) [ ! -f "${1#*=}" ] || cat "${1#*=}" >> "$name.gathered.$$"; shift ;;
    esac
done
if [ "$name" != report ] && grep -q impossible "$name.gathered.$$"; then
    echo "$name: that is impossible" >&2
    rm "$name.gathered.$$"
    exit 1
fi
mkdir -p "$(dirname "$out")"
grep -v comment "$name.gathered.$$" > "$out"
rm "$name.gathered.$$"
"#;

/// A copy of the repository's rules in a folder whose name has a space.
pub(crate) struct Workshop {
    _folder: tempfile::TempDir,
    pub(crate) root: PathBuf,
}

impl Workshop {
    pub(crate) fn new() -> Self {
        let folder = tempfile::tempdir().unwrap();
        let root = folder.path().join("welds of mine");
        let project = Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap();
        let programs = root.join("target/release");
        std::fs::create_dir_all(&programs).unwrap();
        for folder in ["tools", "tests"] {
            std::fs::create_dir(root.join(folder)).unwrap();
        }
        for file in ["Cargo.toml", "Cargo.lock"] {
            std::fs::write(root.join(file), "").unwrap();
        }
        std::fs::copy(project.join("Makefile"), root.join("Makefile")).unwrap();
        let copied = Command::new("cp")
            .arg("-r")
            .arg(project.join("pipelines"))
            .arg(&root)
            .status();
        assert!(copied.unwrap().success());
        for name in [
            "gasprop",
            "arcfvm",
            "poolsph",
            "heatsph",
            "emfield",
            "jetsph",
            "avg",
            "report",
            "certify",
            "fuzz",
            "faults",
            "artefact",
            "verify",
            "stability",
            "bench",
            "exact",
        ] {
            let program = programs.join(name);
            std::fs::write(&program, COPIES).unwrap();
            let mode = std::fs::Permissions::from_mode(0o755);
            std::fs::set_permissions(&program, mode).unwrap();
        }
        // Sweeps are written out by the program itself.
        let sweep = Path::new(env!("CARGO_BIN_EXE_verify")).with_file_name("sweep");
        std::fs::copy(sweep, programs.join("sweep")).unwrap();
        Self {
            _folder: folder,
            root,
        }
    }

    /// The programs that `make gmaw-quick` runs, in their order.
    fn make(&self) -> Vec<String> {
        self.programs_of("gmaw-quick")
    }

    /// Make with `words`.
    pub(crate) fn ask(&self, words: &[&str]) -> Output {
        Command::new("make")
            .current_dir(&self.root)
            .arg("--no-print-directory")
            .args(words)
            .env_remove("MAKEFLAGS")
            .env_remove("MAKELEVEL")
            .output()
            .unwrap()
    }

    /// The programs that `make STUDY` runs, in their order.
    pub(crate) fn programs_of(&self, study: &str) -> Vec<String> {
        let log = self.root.join("log");
        let _ = std::fs::remove_file(&log);
        let output = self.ask(&[study]);
        let said = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success(), "{said}");
        let log = std::fs::read_to_string(log).unwrap_or_default();
        log.lines().map(str::to_owned).collect()
    }

    /// Adds a line to a file of the pipelines.
    pub(crate) fn add(&self, file: &str, line: &str) {
        let path = self.root.join("pipelines").join(file);
        let text = std::fs::read_to_string(&path).unwrap();
        std::fs::write(path, format!("{text}{line}\n")).unwrap();
    }
}

#[test]
fn a_changed_scene_wakes_only_what_is_behind_it() {
    let workshop = Workshop::new();
    let all = ["gasprop", "arcfvm", "poolsph", "avg", "report"];
    assert_eq!(workshop.make(), all);
    assert!(workshop.make().is_empty(), "nothing has changed");
    for (file, woken) in [
        ("gmaw-300a/targets.json", &all[4..]),
        ("gmaw-300a/avg.json", &all[3..]),
        ("gmaw-quick/avg.patch.json", &all[3..]),
        ("gmaw-quick/pool.patch.json", &all[2..]),
        ("gmaw-300a/pool.json", &all[2..]),
        ("gmaw-300a/arc.json", &all[1..]),
    ] {
        workshop.add(file, "another value");
        assert_eq!(workshop.make(), woken, "{file}");
        assert!(workshop.make().is_empty(), "{file}: once is enough");
    }
    // What a scene names is of no less account than what its rule names.
    workshop.add("materials/mild-steel.json", " ");
    assert_eq!(workshop.make(), ["poolsph"]);
    assert!(workshop.make().is_empty());
    // What changes no byte of the arc wakes the arc alone, and what is written again as it was wakes nothing.
    workshop.add("gmaw-300a/arc.json", "a comment");
    assert_eq!(workshop.make(), ["arcfvm"]);
    workshop.add("gmaw-300a/pool.json", "");
    let path = workshop.root.join("pipelines/gmaw-300a/pool.json");
    let text = std::fs::read_to_string(&path).unwrap();
    std::fs::write(&path, text.strip_suffix('\n').unwrap()).unwrap();
    assert!(workshop.make().is_empty());
}
