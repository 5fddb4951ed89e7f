//! Who wrote a file, from what: the metadata record `fusionline`.

use std::collections::BTreeMap;
use std::fs::File;
use std::io::Read;
use std::path::Path;

use serde::{Deserialize, Serialize};
use serde_json::Value;
use sha2::{Digest, Sha256};

use crate::error::{Error, Result, io_error};
use crate::version::Version;

/// Name of the metadata record that makes an MCAP file one of ours.
pub const METADATA: &str = "fusionline";

/// Key of a recorded scene that named files: the hash of the scene as it was written, before what it names was read.
pub const WRITTEN: &str = "written_sha256";

/// Kinds of artefacts, each with its major version and the stages that write it.
pub const KINDS: [(&str, u32, &[&str]); 7] = [
    ("arc-source", 1, &["arcfvm"]),
    ("gas-table", 1, &["gasprop"]),
    ("mean-fields", 1, &["avg"]),
    ("particle-frames", 1, &["poolsph"]),
    ("jet-frames", 1, &["jetsph"]),
    ("point-fields", 1, &["heatsph", "emfield"]),
    (
        "preview",
        1,
        &["arcfvm", "poolsph", "heatsph", "emfield", "jetsph"],
    ),
];

/// Who wrote a file, from what. Two runs with equal headers write equal bytes.
#[derive(Debug, Clone, PartialEq)]
pub struct Header {
    /// Kind of the artefact, for example `particle-frames`.
    pub kind: String,
    /// Version of the kind.
    pub version: Version,
    /// Tool that wrote it.
    pub tool: String,
    /// Version of the tool.
    pub tool_version: String,
    /// Scene as the tool ran it, patches applied.
    pub scene: Value,
    /// SHA-256 of each input by name.
    pub inputs: BTreeMap<String, String>,
}

impl Header {
    /// SHA-256 of the canonical scene.
    #[must_use]
    pub fn scene_sha256(&self) -> String {
        sha256(canonical(&self.scene).as_bytes())
    }

    /// The header as the metadata record stores it.
    #[must_use]
    pub fn to_metadata(&self) -> BTreeMap<String, String> {
        let inputs = serde_json::to_value(&self.inputs).unwrap_or_default();
        [
            ("kind", self.kind.clone()),
            ("version", self.version.to_string()),
            ("tool", self.tool.clone()),
            ("tool_version", self.tool_version.clone()),
            ("scene", canonical(&self.scene)),
            ("scene_sha256", self.scene_sha256()),
            ("inputs", inputs.to_string()),
        ]
        .map(|(key, value)| (key.to_owned(), value))
        .into()
    }

    /// The header from a metadata record.
    ///
    /// # Errors
    /// When an entry is missing or not readable, or the scene does not have the recorded hash.
    pub fn from_metadata(path: &Path, map: &BTreeMap<String, String>) -> Result<Self> {
        let wrong = |what: String| Error::Damaged {
            path: path.to_owned(),
            place: format!("metadata record '{METADATA}'"),
            what,
        };
        let entry = |key: &str| {
            map.get(key)
                .cloned()
                .ok_or_else(|| wrong(format!("no entry '{key}'")))
        };
        let header = Self {
            kind: entry("kind")?,
            version: entry("version")?.parse().map_err(wrong)?,
            tool: entry("tool")?,
            tool_version: entry("tool_version")?,
            scene: serde_json::from_str(&entry("scene")?)
                .map_err(|e| wrong(format!("scene: {e}")))?,
            inputs: serde_json::from_str(&entry("inputs")?)
                .map_err(|e| wrong(format!("inputs: {e}")))?,
        };
        let (expected, found) = (entry("scene_sha256")?, header.scene_sha256());
        if expected != found {
            return Err(wrong(format!(
                "the scene has hash {found}, recorded is {expected}"
            )));
        }
        Ok(header)
    }

    /// Refuses a header of another run.
    ///
    /// # Errors
    /// [`Error::NotSame`] naming the first difference.
    pub fn must_equal(&self, other: &Self, path: &Path) -> Result<()> {
        self.identity().must_equal(&other.identity(), path)?;
        let differ = |what: &str, expected: String, found: String| Error::NotSame {
            path: path.to_owned(),
            what: what.to_owned(),
            expected,
            found,
        };
        if self.kind != other.kind {
            return Err(differ("kind", self.kind.clone(), other.kind.clone()));
        }
        if self.version != other.version {
            return Err(differ(
                "format version",
                self.version.to_string(),
                other.version.to_string(),
            ));
        }
        Ok(())
    }

    /// What two runs must share for one to resume the other.
    #[must_use]
    pub fn identity(&self) -> Identity {
        Identity {
            tool: self.tool.clone(),
            tool_version: self.tool_version.clone(),
            scene_sha256: self.scene_sha256(),
            inputs: self.inputs.clone(),
        }
    }
}

/// What two runs must share for one to resume the other.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Identity {
    /// Tool.
    pub tool: String,
    /// Version of the tool.
    pub tool_version: String,
    /// Hash of the canonical scene.
    pub scene_sha256: String,
    /// Hash of each input by name.
    pub inputs: BTreeMap<String, String>,
}

impl Identity {
    /// Refuses the identity of another run; `self` is this run's, `found` the file's.
    ///
    /// # Errors
    /// [`Error::NotSame`] naming the first difference.
    pub fn must_equal(&self, found: &Self, path: &Path) -> Result<()> {
        let mut pairs = vec![
            ("tool".to_owned(), self.tool.clone(), found.tool.clone()),
            (
                "tool version".to_owned(),
                self.tool_version.clone(),
                found.tool_version.clone(),
            ),
            (
                "scene".to_owned(),
                self.scene_sha256.clone(),
                found.scene_sha256.clone(),
            ),
        ];
        let names = self.inputs.keys().chain(found.inputs.keys());
        for name in names {
            let of = |map: &BTreeMap<String, String>| {
                map.get(name)
                    .cloned()
                    .unwrap_or_else(|| "(none)".to_owned())
            };
            pairs.push((
                format!("input '{name}'"),
                of(&self.inputs),
                of(&found.inputs),
            ));
        }
        match pairs.into_iter().find(|(_, ours, theirs)| ours != theirs) {
            None => Ok(()),
            Some((what, expected, found)) => Err(Error::NotSame {
                path: path.to_owned(),
                what,
                expected,
                found,
            }),
        }
    }
}

/// JSON without white space and with sorted keys: equal for scenes that mean the same.
#[must_use]
pub fn canonical(value: &Value) -> String {
    fn sorted(value: &Value) -> Value {
        match value {
            Value::Object(map) => {
                let ordered: BTreeMap<&String, Value> =
                    map.iter().map(|(k, v)| (k, sorted(v))).collect();
                Value::Object(ordered.into_iter().map(|(k, v)| (k.clone(), v)).collect())
            }
            Value::Array(items) => Value::Array(items.iter().map(sorted).collect()),
            other => other.clone(),
        }
    }
    sorted(value).to_string()
}

/// SHA-256 in hexadecimal.
#[must_use]
pub fn sha256(bytes: &[u8]) -> String {
    hexadecimal(&Sha256::digest(bytes))
}

/// SHA-256 of a file in hexadecimal.
///
/// # Errors
/// When the file cannot be read.
pub fn sha256_file(path: &Path) -> Result<String> {
    let mut file = File::open(path).map_err(io_error(path, "open"))?;
    let mut digest = Sha256::new();
    let mut block = vec![0; 1 << 16];
    loop {
        let n = file.read(&mut block).map_err(io_error(path, "read"))?;
        if n == 0 {
            return Ok(hexadecimal(&digest.finalize()));
        }
        digest.update(&block[..n]);
    }
}

pub(crate) fn hexadecimal(bytes: &[u8]) -> String {
    use std::fmt::Write;
    bytes
        .iter()
        .fold(String::with_capacity(2 * bytes.len()), |mut text, byte| {
            let _ = write!(text, "{byte:02x}");
            text
        })
}
