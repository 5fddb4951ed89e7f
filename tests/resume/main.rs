//! A run gives the same bytes on any number of threads, and after any interruption: Ctrl-C leaves
//! a checkpoint and exit code 130; a kill at any moment leaves the last checkpoint; `--resume`
//! goes on to the bytes of a run that nothing disturbed.

#![allow(clippy::unwrap_used, reason = "a test may fail")]

mod happens;
mod threads;

use std::path::{Path, PathBuf};
use std::process::{Child, Command, ExitStatus, Stdio};
use std::sync::OnceLock;
use std::thread::sleep;
use std::time::{Duration, Instant};

use artefact::{Reader, beside};
use serde_json::Value;
use tempfile::TempDir;

const OUT: &str = "pool.mcap";

/// A scene of this folder.
#[derive(Debug, Clone, Copy)]
enum Scene {
    /// A drop of molten steel falls on a plate: the least that moves, melts and sets.
    Drop,
    /// The same on a cold plate to which it sticks, as a flow without divergence.
    Cold,
    /// A short weld: all the physics there is, with an arc.
    Weld,
    /// Conduction on a random cloud, in implicit steps that follow their error.
    Heat,
    /// Conduction on a lattice, in explicit stages.
    Rod,
    /// Eddy currents in a ball, in steps of several lengths.
    Field,
    /// The same in steps that follow their error.
    Growing,
    /// The same in space, with charges on the ball.
    Charges,
    /// A drop of liquid that swings and falls.
    Liquid,
    /// A liquid that swings between faces.
    Basin,
    /// Two drops that become one.
    Drops,
}

const SCENES: [Scene; 11] = [
    Scene::Drop,
    Scene::Cold,
    Scene::Weld,
    Scene::Heat,
    Scene::Rod,
    Scene::Field,
    Scene::Growing,
    Scene::Charges,
    Scene::Liquid,
    Scene::Basin,
    Scene::Drops,
];

impl Scene {
    fn file(self) -> PathBuf {
        let name = match self {
            Self::Drop => "drop.json",
            Self::Cold => "cold.json",
            Self::Weld => "weld.json",
            Self::Heat => "heat.json",
            Self::Rod => "rod.json",
            Self::Field => "field.json",
            Self::Growing => "growing.json",
            Self::Charges => "charges.json",
            Self::Liquid => "liquid.json",
            Self::Basin => "basin.json",
            Self::Drops => "drops.json",
        };
        Path::new(env!("CARGO_MANIFEST_DIR"))
            .join("resume")
            .join(name)
    }

    fn tool(self) -> &'static str {
        match self {
            Self::Drop | Self::Cold | Self::Weld => "poolsph",
            Self::Heat | Self::Rod => "heatsph",
            Self::Field
            | Self::Growing
            | Self::Charges
            | Self::Liquid
            | Self::Basin
            | Self::Drops => "emfield",
        }
    }

    /// Channel of the frames.
    fn frames(self) -> &'static str {
        match self {
            Self::Drop | Self::Cold | Self::Weld => "/particles",
            _ => "/points",
        }
    }

    /// The program that runs the scene.
    fn program(self) -> PathBuf {
        let program = Path::new(env!("CARGO_BIN_EXE_verify")).with_file_name(self.tool());
        assert!(
            program.exists(),
            "{} is not built: run `cargo build --release` first",
            program.display()
        );
        program
    }

    /// The run of the scene, with a checkpoint every 50 ms.
    fn command(self, folder: &Path, threads: u8) -> Command {
        let mut command = Command::new(self.program());
        command
            .arg("run")
            .arg(self.file())
            .arg("--out")
            .arg(folder.join(OUT))
            .args(["--threads", &threads.to_string()])
            .args(["--checkpoint-s", "0.05", "--progress", "none", "-q"])
            .stderr(Stdio::piped());
        if matches!(self, Self::Weld) {
            let arc = folder.join("arc.mcap");
            if !arc.exists() {
                verification::bell::WELD.write(&arc).unwrap();
            }
            command.arg("--input").arg(format!("arc={}", arc.display()));
        }
        command
    }

    /// The undisturbed run on one thread, made once for all tests.
    fn straight(self) -> &'static Straight {
        static RUNS: [OnceLock<Straight>; SCENES.len()] = [const { OnceLock::new() }; SCENES.len()];
        RUNS[self as usize].get_or_init(|| {
            let folder = folder();
            let bytes = finish(&mut self.command(folder.path(), 1), folder.path());
            let reader = Reader::open(folder.path().join(OUT)).unwrap();
            match self {
                Self::Drop | Self::Cold | Self::Weld => happens::happens(&reader),
                Self::Heat | Self::Rod => happens::warms(&reader),
                Self::Field | Self::Growing | Self::Charges => happens::enters(&reader),
                Self::Liquid => happens::swings(&reader),
                Self::Basin => happens::sloshes(&reader),
                Self::Drops => happens::meet(&reader),
            }
            Straight {
                bytes,
                told: told(folder.path()),
            }
        })
    }
}

/// What a run that nothing disturbed leaves.
struct Straight {
    bytes: Vec<u8>,
    told: Value,
}

/// Runs to the end and gives the bytes.
fn finish(command: &mut Command, folder: &Path) -> Vec<u8> {
    let output = command.output().unwrap();
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(0), "{said}");
    let checkpoint = beside(&folder.join(OUT), ".checkpoint");
    assert!(!checkpoint.exists(), "a finished run needs no checkpoint");
    std::fs::read(folder.join(OUT)).unwrap()
}

/// Waits for the first checkpoint, and then for some part of a second.
fn after_a_checkpoint(child: &mut Child, folder: &Path, milliseconds: u64) {
    let checkpoint = beside(&folder.join(OUT), ".checkpoint");
    let start = Instant::now();
    while !checkpoint.exists() {
        let ended = child.try_wait().unwrap();
        assert!(ended.is_none(), "ended without a checkpoint: {ended:?}");
        assert!(start.elapsed() < Duration::from_secs(120), "no checkpoint");
        sleep(Duration::from_millis(2));
    }
    sleep(Duration::from_millis(milliseconds));
}

fn signal(child: &mut Child, name: &str) -> ExitStatus {
    let id = child.id().to_string();
    let sent = Command::new("kill").args(["-s", name, &id]).status();
    assert!(sent.unwrap().success());
    child.wait().unwrap()
}

fn folder() -> TempDir {
    tempfile::tempdir().unwrap()
}

fn record(folder: &Path) -> Value {
    let path = folder.join(OUT).with_extension("run.json");
    serde_json::from_str(&std::fs::read_to_string(path).unwrap()).unwrap()
}

/// What a record says of the whole run, whoever took it up, and how long that took. Of conduction it tells in how many
/// particles heat was looked for in the last step, and a run that is taken up looks for it in all of them at first.
fn told(folder: &Path) -> Value {
    let mut record = record(folder);
    if let Some(history) = record["history"].as_array_mut() {
        history.retain(|line| line["name"] != "conduction_conducting_particles");
    }
    let keys = [
        "steps",
        "substepped",
        "steps_divided",
        "warnings",
        "limits",
        "closing",
        "history",
    ];
    keys.map(|key| (key, record[key].clone()))
        .into_iter()
        .collect()
}

#[test]
fn two_threads_write_the_bytes_of_one() {
    for scene in SCENES {
        let folder = folder();
        let bytes = finish(&mut scene.command(folder.path(), 2), folder.path());
        assert!(bytes == scene.straight().bytes, "{scene:?}");
    }
}

#[test]
fn ctrl_c_leaves_a_checkpoint_and_the_run_goes_on_to_the_same_bytes() {
    let folder = folder();
    let folder = folder.path();
    let mut child = Scene::Weld.command(folder, 2).spawn().unwrap();
    after_a_checkpoint(&mut child, folder, 120);
    let status = signal(&mut child, "INT");
    assert_eq!(status.code(), Some(130));
    let out = folder.join(OUT);
    assert!(!out.exists(), "what is not whole does not bear the name");
    assert!(beside(&out, ".checkpoint").exists() && beside(&out, ".part").exists());
    let told = record(folder);
    assert_eq!(told["outcome"], "interrupted");
    assert_eq!(told["exit_code"], 130);
    let steps = told["steps"].as_u64().unwrap();
    assert!((1..400).contains(&steps), "{steps} steps");

    let mut resumed = Scene::Weld.command(folder, 1);
    let bytes = finish(resumed.arg("--resume"), folder);
    assert!(bytes == Scene::Weld.straight().bytes);
    let told = record(folder);
    assert_eq!(told["outcome"], "done");
    assert_eq!(told["resumed"], 1);
}

#[test]
fn ctrl_c_soon_ends_a_steady_run_that_has_nothing_to_keep() {
    let folder = folder();
    let out = folder.path().join(OUT);
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).with_file_name("pipelines");
    let mut command = Command::new(Scene::Field.program());
    command
        .arg("run")
        .arg(root.join("verify/em-sphere-loops/scene.json"))
        .arg("--patch")
        .arg(root.join("bench/em-levitation-118k/points.json"))
        .arg("--out")
        .arg(&out)
        .args(["--threads", "2", "--progress", "none", "-q"]);
    let mut child = command.spawn().unwrap();
    while !beside(&out, ".part").exists() {
        assert!(child.try_wait().unwrap().is_none(), "ended before it began");
        sleep(Duration::from_millis(2));
    }
    sleep(Duration::from_millis(300));
    let sent = Instant::now();
    let status = signal(&mut child, "INT");
    // Weights and factors of so many points alone take twice as long.
    assert!(sent.elapsed() < Duration::from_secs(3));
    assert_eq!(status.code(), Some(130));
    assert!(!out.exists() && !beside(&out, ".checkpoint").exists());
    let part = Reader::recover(beside(&out, ".part")).unwrap();
    assert!(!part.has("/points"), "nothing was found yet");
}

#[test]
fn a_run_killed_at_any_moment_goes_on_to_the_same_bytes() {
    for scene in SCENES {
        let folder = folder();
        let folder = folder.path();
        let out = folder.join(OUT);
        let mut child = scene.command(folder, 2).spawn().unwrap();
        // Clock and load choose the steps: no two runs of this test are killed at the same ones.
        for wait in [10, 170, 70] {
            after_a_checkpoint(&mut child, folder, wait);
            let status = signal(&mut child, "KILL");
            assert_eq!(status.code(), None, "killed, not ended");
            assert!(!out.exists());
            let part = Reader::recover(beside(&out, ".part")).unwrap();
            assert_eq!(part.times(scene.frames()).unwrap()[0].to_bits(), 0);
            let mut resumed = scene.command(folder, 2);
            child = resumed.arg("--resume").spawn().unwrap();
        }
        let ended = child.wait().unwrap();
        assert!(ended.success(), "{ended:?}");
        assert!(
            std::fs::read(&out).unwrap() == scene.straight().bytes,
            "{scene:?}"
        );
        assert_eq!(record(folder)["outcome"], "done");
        let (told, straight) = (told(folder), &scene.straight().told);
        for (key, value) in straight.as_object().unwrap() {
            match (value.as_array(), told[key].as_array()) {
                (Some(lines), Some(others)) if lines.len() == others.len() => {
                    for (line, other) in lines.iter().zip(others) {
                        assert_eq!(other, line, "{scene:?}: {key}");
                    }
                }
                _ => assert_eq!(&told[key], value, "{scene:?}: {key}"),
            }
        }
    }
}

#[test]
fn a_changed_scene_is_not_taken_up_and_nothing_is_lost() {
    let folder = folder();
    let folder = folder.path();
    let out = folder.join(OUT);
    let mut child = Scene::Drop.command(folder, 1).spawn().unwrap();
    after_a_checkpoint(&mut child, folder, 0);
    signal(&mut child, "INT");
    let kept = [beside(&out, ".checkpoint"), beside(&out, ".part")];
    let read = || kept.each_ref().map(|path| std::fs::read(path).unwrap());
    let before = read();
    let patch = folder.join("patch.json");
    std::fs::write(&patch, "{\"flow\": {\"viscosity_pa_s\": 0.005}}").unwrap();
    let mut other = Scene::Drop.command(folder, 1);
    other.args(["--resume", "--patch"]).arg(&patch);
    let output = other.output().unwrap();
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(!output.status.success());
    assert!(
        said.contains("made with scene") && said.contains("cannot be resumed"),
        "{said}"
    );
    assert!(read() == before);
}
