//! Disks that are full or cannot be written: the error names the file, and what was there stays.

use std::os::unix::fs::{PermissionsExt, symlink};
use std::process::Command;

use artefact::{Checkpoint, Error, Reader, beside, write_atomically};
use verification::skipped::skip;

use crate::workplace::{Place, header, program, root, told};

#[test]
fn a_full_disk_fails_the_run_and_keeps_the_old_file() {
    let place = Place::new();
    let frames = place.frames("pool.mcap", &header());
    let out = place.file("mean.mcap", "an older result");
    symlink("/dev/full", beside(&out, ".part")).unwrap();
    place.average_to(&frames, &out).must(
        1,
        &[
            "mean.mcap.part",
            "cannot write",
            "No space left on device",
            "nothing is kept: make room",
        ],
    );
    assert_eq!(std::fs::read(&out).unwrap(), b"an older result");
}

#[test]
fn a_disk_that_fills_on_the_way_leaves_what_is_whole() {
    let place = Place::new();
    let frames = place.frames("pool.mcap", &header());
    let size = std::fs::metadata(&frames).unwrap().len();
    let out = place.path("copy.mcap");
    // Files of this shell may have half the size, in blocks of 512 bytes; the signal is ignored.
    let script = format!(
        "trap '' 25; ulimit -f {}; exec \"$0\" recover \"$1\" --out \"$2\"",
        size / 1024
    );
    let mut command = Command::new("sh");
    command.args(["-c", &script]).arg(program("artefact"));
    told(command.arg(&frames).arg(&out)).must(1, &["cannot write", "File too large"]);
    assert!(!out.exists(), "no file that is not whole bears the name");
    let part = beside(&out, ".part.recovered");
    let saved = Reader::recover(part).unwrap();
    let count = saved.count("/pool");
    assert!((1..4).contains(&count), "{count} frames");
    for frame in saved.frames("/pool").unwrap() {
        assert_eq!(frame.unwrap().len(), 500);
    }
}

#[test]
fn a_checkpoint_is_replaced_whole_or_not_at_all() {
    let place = Place::new();
    let path = place.path("pool.mcap.checkpoint");
    let mut old = Checkpoint::new(&header());
    old.put_f64("temperature", &[300.0]);
    old.write(&path).unwrap();
    symlink("/dev/full", beside(&path, ".part")).unwrap();
    let mut new = Checkpoint::new(&header());
    new.put_f64("temperature", &vec![1800.0; 100_000]);
    let error = new.write(&path).unwrap_err();
    assert!(
        error.to_string().contains("No space left on device"),
        "{error}"
    );
    let mut found = Checkpoint::read(&path, &header()).unwrap();
    assert_eq!(found.f64("temperature").unwrap(), [300.0]);
    // The failed attempt is cleared away, and the next one succeeds.
    new.write(&path).unwrap();
    let mut found = Checkpoint::read(&path, &header()).unwrap();
    assert_eq!(found.f64("temperature").unwrap().len(), 100_000);
}

#[test]
fn a_folder_that_cannot_be_written_is_named() {
    let place = Place::new();
    let frames = place.frames("pool.mcap", &header());
    // A file stands where the folder should be: refused to every user.
    let file = place.file("taken", "");
    place
        .average_to(&frames, &file.join("mean.mcap"))
        .must(1, &["/taken", "cannot create the folder"]);

    let folder = place.path("readonly");
    std::fs::create_dir(&folder).unwrap();
    std::fs::set_permissions(&folder, std::fs::Permissions::from_mode(0o555)).unwrap();
    if std::fs::write(folder.join("probe"), "").is_ok() {
        skip("user", "this user may write into read-only folders");
        return;
    }
    place
        .average_to(&frames, &folder.join("mean.mcap"))
        .must(1, &["readonly", "Permission denied"]);
    let error = write_atomically(&folder.join("a.json"), b"{}").unwrap_err();
    assert!(matches!(error, Error::Io { .. }));
}

#[test]
fn the_plan_tells_the_size_of_frames_and_foretells_the_pool_of_a_cold_weld() {
    let weld = root().join("pipelines/gmaw-300a/pool.json");
    let place = Place::new();
    // Without what needs an arc, and at a coarse spacing.
    let bare = r#"{"spacing_m": 1e-3, "gas_shear": null, "lorentz": null, "arc_pressure": null, "arc": null,
        "time": {"end_s": 1.0}, "output": {"particles_interval_s": 0.1, "precision": "f32",
        "pool": {"from_s": 0.5, "interval_s": 0.01, "beside_m": 0.005, "behind_m": 0.01, "ahead_m": 0.005}}}"#;
    let bare = place.file("bare.json", bare);
    let mut check = Command::new(program("poolsph"));
    check.arg("check").arg(&weld).arg("--patch").arg(&bare);
    let said = told(&mut check);
    said.must(
        0,
        &[
            "output               at most ",
            "/particles                   11 x ",
            "/pool                        51 x ",
            "time                 about ",
            "a step, with a pool of some ",
        ],
    );
    // Without a source nobody knows where the pool will be.
    let placeless = r#"{"source": null, "droplets": null, "arc": {"flux_w_m2": 1e7}}"#;
    let placeless = place.file("placeless.json", placeless);
    check.arg("--patch").arg(&placeless);
    told(&mut check).must(
        0,
        &[
            "time                 at least ",
            "with the 0 liquid particles of the start; steps last longer once there is a pool",
        ],
    );
    // The frames of a run without heat are those that are told: no particle comes or melts.
    let tank = root().join("pipelines/verify/pool-hydrostatic/scene.json");
    let short = place.file(
        "short.json",
        r#"{"time": {"end_s": 0.01}, "output": {"particles_interval_s": 0.001}}"#,
    );
    let mut check = Command::new(program("poolsph"));
    check.arg("check").arg(&tank).arg("--patch").arg(&short);
    let said = told(&mut check);
    assert!(said.out.contains(" x "), "{}", said.out);
    let line = said.out.lines().find(|l| l.contains("/particles")).unwrap();
    let frames: usize = line.split_whitespace().nth(1).unwrap().parse().unwrap();
    let out = place.path("tank.mcap");
    let mut run = Command::new(program("poolsph"));
    run.arg("run").arg(&tank).arg("--patch").arg(&short);
    told(run.arg("-q").arg("--out").arg(&out)).must(0, &[]);
    let reader = Reader::open(&out).unwrap();
    assert_eq!(reader.count("/particles"), frames);
}

#[test]
fn exports_name_the_file_that_cannot_be_written() {
    let place = Place::new();
    let frames = place.frames("pool.mcap", &header());
    let taken = place.file("taken", "");
    let mut command = Command::new(program("artefact"));
    command
        .arg("export")
        .arg(&frames)
        .args(["--to", "vtu", "--out"]);
    told(command.arg(&taken)).must(1, &["taken", "cannot create"]);
}
