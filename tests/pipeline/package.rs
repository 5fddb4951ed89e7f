//! What `make install` and `make deb` leave: programs that run, completions, pages for man.

use std::path::{Path, PathBuf};
use std::process::Command;

use verification::skipped::skip;

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .parent()
        .unwrap()
        .to_owned()
}

/// Whether a program can be called here.
fn there(program: &str) -> bool {
    Command::new(program)
        .arg("--version")
        .output()
        .is_ok_and(|o| o.status.success())
}

fn sh(words: &[&str]) -> String {
    let output = Command::new(words[0])
        .args(&words[1..])
        .current_dir(root())
        .env_remove("MAKEFLAGS")
        .env_remove("MAKELEVEL")
        .output()
        .unwrap();
    assert!(output.status.success(), "{words:?}: {output:?}");
    String::from_utf8_lossy(&output.stdout).into_owned()
}

/// Completions and pages of a prefix; `end` is what man's pages end in.
fn is_whole(prefix: &Path, end: &str) {
    let program = prefix.join("bin/poolsph");
    let told = sh(&[program.to_str().unwrap(), "--version"]);
    assert!(told.starts_with("poolsph "), "{told}");
    for file in [
        "share/bash-completion/completions/poolsph",
        "share/zsh/site-functions/_emfield",
        "share/fish/vendor_completions.d/report.fish",
        &format!("share/man/man1/poolsph-run.1{end}"),
        &format!("share/man/man1/artefact-export.1{end}"),
        &format!("share/man/man1/sweep.1{end}"),
    ] {
        assert!(prefix.join(file).is_file(), "{file}");
    }
}

#[test]
fn programs_completions_and_pages_are_installed_below_a_prefix() {
    let folder = tempfile::tempdir().unwrap();
    let destination = format!("DESTDIR={}", folder.path().display());
    sh(&[
        "make",
        "--old-file=programs",
        "install",
        &destination,
        "PREFIX=/opt",
    ]);
    is_whole(&folder.path().join("opt"), "");
    if there("bash") {
        let file = folder
            .path()
            .join("opt/share/bash-completion/completions/poolsph");
        let line = format!(
            "source '{}'; COMP_WORDS=(poolsph run --ou); COMP_CWORD=2; _poolsph poolsph --ou run; echo \"${{COMPREPLY[*]}}\"",
            file.display()
        );
        assert_eq!(sh(&["bash", "-c", &line]).trim(), "--out");
    } else {
        skip("bash", "it is not here: no completion is tried");
    }
}

#[test]
fn a_package_for_debian_holds_them_too() {
    if !there("dpkg-deb") {
        skip("dpkg", "dpkg-deb is not here: no package is made");
        return;
    }
    let told = sh(&["make", "--old-file=programs", "deb"]);
    let package = told.trim().strip_prefix("made: ").unwrap();
    let folder = tempfile::tempdir().unwrap();
    let into = folder.path().to_str().unwrap();
    sh(&["dpkg-deb", "--extract", package, into]);
    is_whole(&folder.path().join("usr"), ".gz");
    let field = sh(&["dpkg-deb", "--field", package, "Version"]);
    assert_eq!(field.trim(), env!("CARGO_PKG_VERSION"));
}
