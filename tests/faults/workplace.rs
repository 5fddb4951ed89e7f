//! A folder to work in, the programs, and a small file to spoil.

use std::ffi::OsStr;
use std::path::{Path, PathBuf};
use std::process::Command;

use artefact::{Frame, Header, Precision, Record, Table, Version, Writer};
use tempfile::TempDir;

/// What a program said and how it ended.
#[derive(Debug)]
pub(crate) struct Told {
    pub(crate) code: i32,
    pub(crate) out: String,
    pub(crate) err: String,
}

impl Told {
    /// Asserts exit code and that the words stand in what was said.
    #[track_caller]
    pub(crate) fn must(&self, code: i32, words: &[&str]) {
        let said = format!("{}{}", self.out, self.err);
        assert_eq!(self.code, code, "{said}");
        for word in words {
            assert!(said.contains(word), "'{word}' is not in:\n{said}");
        }
        assert!(!said.contains("panicked"), "{said}");
    }
}

/// A program of the workspace, built with the tests.
pub(crate) fn program(name: &str) -> PathBuf {
    let path = Path::new(env!("CARGO_BIN_EXE_verify")).with_file_name(name);
    assert!(
        path.exists(),
        "{} is not built: run `cargo build --release` first",
        path.display()
    );
    path
}

pub(crate) fn tell<S: AsRef<OsStr>>(name: &str, arguments: &[S]) -> Told {
    told(Command::new(program(name)).args(arguments))
}

pub(crate) fn told(command: &mut Command) -> Told {
    let output = command.output().unwrap();
    Told {
        code: output.status.code().unwrap_or(-1),
        out: String::from_utf8_lossy(&output.stdout).into_owned(),
        err: String::from_utf8_lossy(&output.stderr).into_owned(),
    }
}

pub(crate) fn root() -> PathBuf {
    let tests = Path::new(env!("CARGO_MANIFEST_DIR"));
    tests.parent().unwrap().to_owned()
}

/// A folder of its own for each test.
pub(crate) struct Place {
    folder: TempDir,
}

impl Place {
    pub(crate) fn new() -> Self {
        Self {
            folder: tempfile::tempdir().unwrap(),
        }
    }

    pub(crate) fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    pub(crate) fn file(&self, name: &str, bytes: impl AsRef<[u8]>) -> PathBuf {
        let path = self.path(name);
        std::fs::write(&path, bytes).unwrap();
        path
    }

    /// A sound file of frames, a table and a record.
    pub(crate) fn frames(&self, name: &str, header: &Header) -> PathBuf {
        let path = self.path(name);
        let mut writer = Writer::create(&path, header).unwrap();
        fill(&mut writer);
        writer.finish().unwrap();
        path
    }

    /// A scene of averages that suits the frames.
    pub(crate) fn scene(&self) -> PathBuf {
        self.file("avg.json", SCENE)
    }

    /// Runs `avg` on `frames`; its output is `mean.mcap`.
    pub(crate) fn average(&self, frames: &Path) -> Told {
        self.average_to(frames, &self.path("mean.mcap"))
    }

    pub(crate) fn average_to(&self, frames: &Path, out: &Path) -> Told {
        told(self.averaging(frames, out).args(["--progress", "none"]))
    }

    pub(crate) fn averaging(&self, frames: &Path, out: &Path) -> Command {
        let mut command = Command::new(program("avg"));
        let mut input = std::ffi::OsString::from("frames=");
        input.push(frames);
        command.arg("run").arg(self.scene());
        command.arg("--input").arg(input).arg("--out").arg(out);
        command
    }
}

pub(crate) const SCENE: &str = r#"{
  "kind": "avg.scene",
  "version": 1,
  "channel": "/pool",
  "sections": [
    {
      "name": "section_x0",
      "cut": { "plane": { "normal": "x", "half_thickness_m": 1e-3 } },
      "first_m": [0, 2e-3],
      "second_m": [-1e-3, 0]
    }
  ]
}
"#;

/// The header of particle frames.
pub(crate) fn header() -> Header {
    Header {
        kind: "particle-frames".to_owned(),
        version: Version::new(1, 0),
        tool: "poolsph".to_owned(),
        tool_version: "0.1.0".to_owned(),
        scene: serde_json::json!({"kind": "poolsph.scene", "version": 2}),
        inputs: Default::default(),
    }
}

pub(crate) fn fill(writer: &mut Writer) {
    for step in 0..4 {
        let time = 0.25 * f64::from(step);
        writer.frame("/pool", time, &cloud()).unwrap();
        let record = Record::new().with("mass_kg", "kg", 0.25);
        writer.record("/balance", time, &record).unwrap();
    }
    let table = Table::new(3).column("radius_m", "m", [0.0, 1e-3, 2e-3]);
    writer.table("/surface", 0.0, &table).unwrap();
    let plate = serde_json::json!({"spacing_m": 5e-4});
    let schema = ("poolsph.plate.v1", "{\"type\": \"object\"}");
    writer.json("/plate", 0.0, schema, &plate).unwrap();
}

/// 500 particles of liquid in a block, with all columns that averages need.
fn cloud() -> Frame {
    let at = |i: u32| {
        let [x, y, z] = [i % 10, i / 10 % 10, i / 100].map(|k| 5e-4 * f64::from(k));
        [x - 2.25e-3, y - 1.25e-3, z - 2.25e-3]
    };
    let n = 500;
    Frame::new(Precision::F32)
        .positions((0..n).map(at))
        .vector("velocity", "m/s", (0..n).map(|_| [0.0, 0.01, 0.0]))
        .scalar("temperature", "K", (0..n).map(|i| 1800.0 + f64::from(i)))
        .flag("molten", (0..n).map(|_| 1))
        .scalar("fused", "1", (0..n).map(|_| 1.0))
        .flag("droplet", (0..n).map(|_| 0))
        .id("id", 0..n)
}
