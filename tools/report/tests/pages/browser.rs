//! Pages in a browser: no error, nothing fetched, sliders, enlarged pictures, saved numbers, 400 pixels, dark, print.

use std::path::{Path, PathBuf};
use std::process::Command;

use serde_json::Value;

use super::sample;
use super::skipped::skip;

/// Node's modules and the browser, where both are here.
fn browser() -> Option<(PathBuf, PathBuf)> {
    let modules = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../build/browser");
    let found = ["chromium", "chromium-browser", "google-chrome"]
        .into_iter()
        .find_map(|name| {
            let path = Command::new("sh")
                .args(["-c", &format!("command -v {name}")])
                .output()
                .ok()?;
            let path = String::from_utf8(path.stdout).ok()?;
            path.trim_end()
                .starts_with('/')
                .then(|| PathBuf::from(path.trim_end()))
        });
    let installed = modules.join("node_modules/playwright-core").is_dir();
    installed.then_some(modules).zip(found)
}

fn report(words: &[&str]) {
    let output = super::report(words);
    assert!(
        output.status.success(),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
}

/// What holds of every page.
fn is_sound(page: &Value) {
    for nothing in ["said", "asked"] {
        assert_eq!(
            page[nothing].as_array().unwrap().len(),
            0,
            "{nothing}: {page}"
        );
    }
    assert_eq!(page["too_wide"], serde_json::json!([0, 0]), "{page}");
    assert_eq!(page["enlarged"], 1200.0, "{page}");
    assert!(
        page["small"].as_f64() < Some(1100.0) && page["small"] == page["small_again"],
        "{page}"
    );
    assert_ne!(page["light"], page["dark"]);
    assert_eq!(page["printed_links"], 0);
    let (name, text) = (
        page["saved"].as_str().unwrap(),
        page["csv"].as_str().unwrap(),
    );
    assert!(
        name.ends_with(".csv") && text.lines().count() > 3 && text.contains(" [mm]"),
        "{name}: {text}"
    );
}

#[test]
fn a_browser_shows_pages_as_they_are_meant() {
    let Some((modules, browser)) = browser() else {
        let why = "chromium or build/browser is not here (make build/browser/.installed): no page is looked at";
        skip("browser", why);
        return;
    };
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("seen");
    let _ = std::fs::remove_dir_all(&folder);
    for run in ["a", "b"] {
        std::fs::create_dir_all(folder.join(run)).unwrap();
        sample::weld(&folder.join(run).join("pool.mcap"), 8.0, 6, true);
        sample::arc(&folder.join(run).join("arc.mcap"));
    }
    let at = |name: &str| folder.join(name).display().to_string();
    let (study, pair) = (at("study.html"), at("pair.html"));
    let (pool, arc) = (at("a/pool.mcap"), at("a/arc.mcap"));
    report(&[
        "page", "--study", "a", "--out", &study, "--pool", &pool, "--arc", &arc,
    ]);
    report(&["compare", "--a", &at("a"), "--b", &at("b"), "--out", &pair]);
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/pages/look.mjs");
    let output = Command::new("node")
        .arg(script)
        .arg(modules)
        .arg(browser)
        .args([&study, &pair])
        .output()
        .unwrap();
    assert!(
        output.status.success(),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
    let seen: Vec<Value> = serde_json::from_slice(&output.stdout).unwrap();
    seen.iter().for_each(is_sound);
    let weld = &seen[0];
    assert_eq!([&weld["frames"], &weld["sliders"]], [6, 1], "{weld}");
    assert_eq!([&weld["shown"], &weld["shown_after"]], [1, 1], "{weld}");
    assert_eq!(weld["without_script"], 6, "the pictures stay");
    let moments = ["first", "last", "playing"].map(|key| weld[key].as_str().unwrap());
    assert_eq!(moments, ["0.000 s", "8.000 s", "stop"]);
    assert_eq!(seen[1]["sliders"], 0, "what has no frames has no slider");
}
