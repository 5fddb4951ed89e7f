//! Names that cannot be those of an output or an input: folders, pipes, devices, other formats, nothing.

use std::os::unix::fs::FileTypeExt;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::workplace::{Place, header, program, tell, told};

/// A pipe with a name.
fn pipe(place: &Place) -> PathBuf {
    let pipe = place.path("pipe.mcap");
    let made = Command::new("mkfifo").arg(&pipe).status().unwrap();
    assert!(made.success());
    pipe
}

#[test]
fn an_artefact_takes_the_place_of_files_only() {
    let place = Place::new();
    let frames = place.frames("pool.mcap", &header());
    let folder = place.path("folder.mcap");
    std::fs::create_dir(&folder).unwrap();
    place
        .average_to(&frames, &folder)
        .must(2, &["--out", "folder.mcap: is a folder"]);
    let pipe = pipe(&place);
    place
        .average_to(&frames, &pipe)
        .must(2, &["--out", "pipe.mcap: is a pipe"]);
    let mut recover = Command::new(program("artefact"));
    recover.arg("recover").arg(&frames).arg("--out").arg(&pipe);
    told(recover.arg("--force")).must(1, &["pipe.mcap: is a pipe"]);
    let kind = std::fs::metadata(&pipe).unwrap().file_type();
    assert!(kind.is_fifo(), "it stays what it was");
    // A rename would replace the device.
    let device = place.path("null.mcap");
    std::os::unix::fs::symlink("/dev/null", &device).unwrap();
    place
        .average_to(&frames, &device)
        .must(2, &["--out", "null.mcap: is a device"]);
    assert!(device.is_symlink());
    // A link to a file is the name of a file.
    let linked = place.path("linked.mcap");
    std::os::unix::fs::symlink(place.file("real", ""), &linked).unwrap();
    let told = place.average_to(&frames, &linked);
    assert!([0, 3].contains(&told.code), "{}", told.err);
}

#[test]
fn an_artefact_is_not_called_as_another_format_is() {
    let place = Place::new();
    let frames = place.frames("pool.mcap", &header());
    for (name, meant) in [("x.json", "x.mcap"), ("x", "x.mcap"), ("x.csv", "x.mcap")] {
        let out = place.path(name);
        let words = [
            &format!("{name}: an artefact is an MCAP file"),
            "ends in .mcap",
            meant,
        ];
        place.average_to(&frames, &out).must(2, &words);
        assert!(!out.exists());
    }
}

#[test]
fn a_json_file_in_the_place_of_an_artefact_is_called_so() {
    let place = Place::new();
    let scene = place.scene();
    let words = [
        "avg.json: not an artefact: it is a JSON file of kind 'avg.scene', wanted is an MCAP file",
    ];
    place.average(&scene).must(1, &words);
    // The record beside an artefact, by the slip of a Tab.
    let frames = place.frames("pool.mcap", &header());
    let record = place.file("pool.run.json", "{\"kind\": \"run-record\"}");
    let words = [
        "of kind 'run-record'",
        "did you mean",
        frames.to_str().unwrap(),
    ];
    place.average(&record).must(1, &words);
    let text = place.file("notes", "[see pool.mcap]");
    place
        .average(&text)
        .must(1, &["not an artefact: begins with 5b736565"]);
}

#[test]
fn artefacts_are_not_read_from_folders_and_pipes() {
    let place = Place::new();
    let folder = place.path("");
    tell("artefact", &["info".as_ref(), folder.as_os_str()]).must(1, &["it is a folder"]);
    let pipe = pipe(&place);
    tell("artefact", &["info".as_ref(), pipe.as_os_str()]).must(1, &["no regular file"]);
}

#[test]
fn a_report_on_nothing_is_refused() {
    let place = Place::new();
    let out = place.path("report.html");
    let out = out.to_str().unwrap();
    let nothing = "there is nothing to report on: name at least one of";
    tell("report", &["page", "--study", "s", "--out", out])
        .must(2, &[nothing, "--arc, --pool or --mean"]);
    tell("report", &["index", "--out", out]).must(2, &[nothing, "--verify"]);
    let targets = place.file("targets.json", "{}");
    let validate = ["validate", "--targets", targets.to_str().unwrap()];
    tell("report", &validate).must(2, &[nothing, "--pool or --arc"]);
    assert!(!Path::new(out).exists());
}

#[test]
fn a_report_takes_the_place_of_files_only() {
    let place = Place::new();
    let frames = place.frames("pool.mcap", &header());
    let mut page = Command::new(program("report"));
    page.args(["page", "--study", "s", "--pool"]).arg(&frames);
    told(page.arg("--out").arg(place.path(""))).must(2, &["--out", "is a folder"]);
}
