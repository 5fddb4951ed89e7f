//! An output has one writer at a time, is nothing that is read, and its name is vetted before any work.

use std::ffi::OsStr;
use std::os::unix::ffi::OsStrExt;
use std::os::unix::fs::symlink;
use std::path::Path;
use std::process::{Command, Stdio};

use artefact::{Lock, beside};

use crate::workplace::{Place, Told, header, program, root, tell, told};

/// The stages with a scene of each; what else they need is not reached.
const STAGES: [(&str, &str); 6] = [
    ("gasprop", "pipelines/gases/argon-1atm.json"),
    ("arcfvm", "pipelines/gmaw-300a/arc.json"),
    ("poolsph", "pipelines/gmaw-300a/pool.json"),
    ("avg", "pipelines/gmaw-300a/avg.json"),
    ("emfield", "pipelines/dielectric-sphere/scene.json"),
    ("heatsph", "pipelines/fgm-shock/disc-1023.json"),
];

fn stage(tool: &str, scene: &Path, out: &Path) -> Command {
    let mut command = Command::new(program(tool));
    command.arg("run").arg(scene).arg("--out").arg(out);
    command.args(["-q", "--threads", "1"]);
    command
}

#[test]
fn a_second_writer_of_any_program_is_refused_by_name_and_touches_nothing() {
    let place = Place::new();
    let out = place.file("out.mcap", "an older result");
    let owner = Lock::of(&out).unwrap();
    let words = ["out.mcap: is written by another run (process", "--out"];
    for (tool, scene) in STAGES {
        told(&mut stage(tool, &root().join(scene), &out)).must(2, &words);
    }
    let frames = place.frames("pool.mcap", &header());
    let recover = ["recover", "--force", "--out"].map(OsStr::new);
    let recover = [recover.as_slice(), &[out.as_os_str(), frames.as_os_str()]].concat();
    tell("artefact", &recover).must(2, &words[..1]);
    let left = std::fs::read_dir(place.path("")).unwrap().count();
    assert_eq!(left, 3, "the older result, its lock and the frames");
    assert_eq!(std::fs::read(&out).unwrap(), b"an older result");
    drop(owner);

    let page = place.path("page.html");
    let owner = Lock::of(&page).unwrap();
    let mut report = Command::new(program("report"));
    report.args(["page", "--study", "s", "--pool"]).arg(&frames);
    told(report.arg("--out").arg(&page)).must(2, &["page.html: is written by another run"]);
    drop(owner);
    let folder = place.path("csv");
    let owner = Lock::of(&folder.join("export")).unwrap();
    let mut export = Command::new(program("artefact"));
    export
        .arg("export")
        .arg(&frames)
        .args(["--to", "csv", "--out"]);
    told(export.arg(&folder)).must(2, &["is written by another run"]);
    drop(owner);
}

#[test]
fn of_two_runs_at_once_one_is_refused_and_the_other_writes_what_it_writes_alone() {
    let place = Place::new();
    let (out, alone) = (place.path("out.mcap"), place.path("alone.mcap"));
    let scene = root().join("tests/resume/rod.json");
    let mut first = stage("heatsph", &scene, &out)
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    while !beside(&out, ".part").exists() {
        assert!(first.try_wait().unwrap().is_none(), "it ended too soon");
        std::thread::sleep(std::time::Duration::from_millis(1));
    }
    let second = told(&mut stage("heatsph", &scene, &out));
    second.must(
        2,
        &[
            "out.mcap: is written by another run",
            &first.id().to_string(),
        ],
    );
    assert!(first.wait().unwrap().success());
    told(&mut stage("heatsph", &scene, &alone)).must(0, &[]);
    assert!(std::fs::read(&out).unwrap() == std::fs::read(&alone).unwrap());
    assert!(!beside(&out, ".lock").exists());
}

/// Runs `avg` on the frames, and looks whether any file that was there has changed.
fn changes_nothing(place: &Place, frames: &Path, out: &Path) -> Told {
    let held = || {
        let mut files: Vec<_> = std::fs::read_dir(place.path("")).unwrap().collect();
        files.sort_by_key(|f| f.as_ref().unwrap().path());
        let read = |f: std::io::Result<std::fs::DirEntry>| {
            let path = f.unwrap().path();
            let bytes = std::fs::read(&path).unwrap_or_default();
            (path, bytes)
        };
        files.into_iter().map(read).collect::<Vec<_>>()
    };
    place.scene();
    let before = held();
    let told = place.average_to(frames, out);
    assert!(before == held(), "{}", told.err);
    told
}

#[test]
fn an_output_is_never_an_input_under_whatever_name() {
    let place = Place::new();
    let frames = place.frames("pool.mcap", &header());
    let soft = place.path("soft.mcap");
    symlink(&frames, &soft).unwrap();
    let hard = place.path("hard.mcap");
    std::fs::hard_link(&frames, &hard).unwrap();
    let dotted = place.path("../").join(place.path("").file_name().unwrap());
    for out in [&frames, &soft, &hard, &dotted.join("pool.mcap")] {
        changes_nothing(&place, &frames, out).must(2, &["--out", "is the input 'frames'"]);
    }
    // What a run writes beside its output is not read either.
    for (suffix, out) in [
        (".part", "a.mcap"),
        (".checkpoint", "b.mcap"),
        (".checkpoint.part", "c.mcap"),
        (".lock", "d.mcap"),
    ] {
        let read = beside(&place.path(out), suffix);
        std::fs::copy(&frames, &read).unwrap();
        changes_nothing(&place, &read, &place.path(out))
            .must(2, &["is the input 'frames'", suffix]);
    }
    let record = place.path("e.run.json");
    std::fs::copy(&frames, &record).unwrap();
    let words = ["e.run.json: is the input 'frames'"];
    changes_nothing(&place, &record, &place.path("e.mcap")).must(2, &words);
}

#[test]
fn an_output_is_never_a_scene_or_a_patch() {
    let place = Place::new();
    for (tool, scene) in STAGES {
        let own = place.path(&format!("{tool}.mcap"));
        std::fs::copy(root().join(scene), &own).unwrap();
        told(&mut stage(tool, &own, &own)).must(2, &["is the scene"]);
        // The record of the run would take its place.
        let own = place.path(&format!("{tool}.run.json"));
        std::fs::copy(root().join(scene), &own).unwrap();
        let out = place.path(&format!("{tool}.mcap"));
        told(&mut stage(tool, &own, &out)).must(2, &["is the scene"]);
        let other = root().join(scene);
        told(stage(tool, &other, &out).arg("--patch").arg(&own)).must(2, &["is a patch"]);
    }
}

#[test]
fn pages_and_exports_spare_what_they_are_made_from() {
    let place = Place::new();
    let frames = place.frames("pool.mcap", &header());
    let bytes = std::fs::read(&frames).unwrap();
    let linked = place.path("page.html");
    std::fs::hard_link(&frames, &linked).unwrap();
    let page = |out: &Path| {
        let mut report = Command::new(program("report"));
        report.args(["page", "--study", "s", "--pool"]).arg(&frames);
        told(report.arg("--out").arg(out))
    };
    page(&linked).must(2, &["page.html: is the file of 'pool'"]);
    page(&frames).must(2, &["pool.mcap: a page is an HTML file"]);
    let recover = |out: &Path| {
        let mut recover = Command::new(program("artefact"));
        recover.args(["recover", "--force"]).arg(&frames);
        told(recover.arg("--out").arg(out))
    };
    recover(&linked).must(2, &["is the file to be saved"]);
    std::fs::create_dir(place.path("csv")).unwrap();
    std::fs::hard_link(&frames, place.path("csv/balance.csv")).unwrap();
    let mut export = Command::new(program("artefact"));
    export
        .arg("export")
        .arg(&frames)
        .args(["--to", "csv", "--out"]);
    told(export.arg(place.path("csv"))).must(2, &["balance.csv: is the artefact"]);
    let scene = place.path("exact.json");
    std::fs::copy(root().join(STAGES[4].1), &scene).unwrap();
    let exact = [scene.as_os_str(), OsStr::new("--out"), scene.as_os_str()];
    tell("exact", &exact).must(2, &["exact.json: is the scene"]);
    for program_of_records in ["verify", "stability", "bench"] {
        let mut command = Command::new(program(program_of_records));
        command
            .current_dir(root())
            .args(["--out", "pipelines/stability"]);
        told(&mut command).must(1, &["records would be written over scenes"]);
    }
    assert!(std::fs::read(&frames).unwrap() == bytes);
}

#[test]
fn names_are_found_bad_before_any_work() {
    let place = Place::new();
    let frames = place.frames("pool.mcap", &header());
    let long = place.path(&format!("{}.mcap", "n".repeat(244)));
    let words = [
        "the name is 249 bytes long and 16 are added beside it",
        "at most 255 in all",
    ];
    place.average_to(&frames, &long).must(2, &words);
    let foreign = place.path("").join(OsStr::from_bytes(b"bad\xff.mcap"));
    place
        .average_to(&frames, &foreign)
        .must(2, &["is no name of a file in UTF-8"]);
    let left = std::fs::read_dir(place.path("")).unwrap().count();
    assert_eq!(left, 2, "frames and scene");
    let fits = place.path(&format!("{}.mcap", "n".repeat(234)));
    let told = place.average_to(&frames, &fits);
    assert!([0, 3].contains(&told.code) && fits.exists(), "{}", told.err);
}

#[test]
fn what_is_written_to_a_link_is_written_where_it_points() {
    let place = Place::new();
    let frames = place.frames("pool.mcap", &header());
    let (link, target) = (place.path("link.mcap"), place.path("elsewhere/real.mcap"));
    symlink("elsewhere/real.mcap", &link).unwrap();
    let told = place.average_to(&frames, &link);
    assert!([0, 3].contains(&told.code), "{}", told.err);
    assert!(link.is_symlink());
    tell("artefact", &["validate".as_ref(), target.as_os_str()]).must(0, &["good"]);
    assert!(target.with_extension("run.json").exists());
}
