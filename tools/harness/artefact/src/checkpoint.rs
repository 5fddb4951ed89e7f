//! Checkpoints: named arrays, bit for bit, of one run at one instant.
//!
//! Layout, little endian: 8 bytes `FLCKPT01`; length of the head as `u64`; the head as JSON
//! (identity of the run, free JSON, name, type, length of each array); the arrays one after
//! another; CRC-32 of all before it.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use serde_json::Value;

use crate::atomic::write_atomically;
use crate::error::{Error, Result, io_error};
use crate::header::{Header, Identity, sha256_file};

const MAGIC: &[u8; 8] = b"FLCKPT01";

#[derive(Debug, Clone, PartialEq)]
enum Array {
    F64(Vec<f64>),
    U64(Vec<u64>),
    U8(Vec<u8>),
}

#[derive(Serialize, Deserialize)]
struct Head {
    identity: Identity,
    /// Hash of the program that wrote it: what it keeps is the inside of that program alone.
    #[serde(default)]
    build: String,
    json: BTreeMap<String, Value>,
    arrays: Vec<(String, String, u64)>,
}

/// Named arrays and JSON of one run at one instant.
#[derive(Debug, Clone, PartialEq)]
pub struct Checkpoint {
    identity: Identity,
    build: String,
    json: BTreeMap<String, Value>,
    arrays: BTreeMap<String, Array>,
    path: PathBuf,
}

impl Checkpoint {
    /// An empty checkpoint of the run that `header` describes.
    #[must_use]
    pub fn new(header: &Header) -> Self {
        Self {
            identity: header.identity(),
            build: build().to_owned(),
            json: BTreeMap::new(),
            arrays: BTreeMap::new(),
            path: PathBuf::new(),
        }
    }

    /// Keeps an array of `f64`.
    pub fn put_f64(&mut self, name: &str, values: &[f64]) {
        self.arrays
            .insert(name.to_owned(), Array::F64(values.to_vec()));
    }

    /// Keeps an array of vectors.
    pub fn put_vectors(&mut self, name: &str, values: &[[f64; 3]]) {
        self.arrays
            .insert(name.to_owned(), Array::F64(values.as_flattened().to_vec()));
    }

    /// Keeps an array of `u64`.
    pub fn put_u64(&mut self, name: &str, values: &[u64]) {
        self.arrays
            .insert(name.to_owned(), Array::U64(values.to_vec()));
    }

    /// Keeps an array of `u8`.
    pub fn put_u8(&mut self, name: &str, values: &[u8]) {
        self.arrays
            .insert(name.to_owned(), Array::U8(values.to_vec()));
    }

    /// Keeps any serialisable value. Floats in it must be finite; arrays of floats belong in
    /// [`Checkpoint::put_f64`].
    ///
    /// # Errors
    /// When it does not serialise.
    pub fn put_json<T: Serialize>(&mut self, name: &str, value: &T) -> Result<()> {
        let value = serde_json::to_value(value).map_err(|e| self.wrong(name, e))?;
        self.json.insert(name.to_owned(), value);
        Ok(())
    }

    /// Takes an array of `f64` out.
    ///
    /// # Errors
    /// When it is absent or of another type.
    pub fn f64(&mut self, name: &str) -> Result<Vec<f64>> {
        match self.arrays.remove(name) {
            Some(Array::F64(v)) => Ok(v),
            other => Err(self.absent(name, "f64", other.is_some())),
        }
    }

    /// Takes an array of vectors out.
    ///
    /// # Errors
    /// When it is absent or of another type.
    pub fn vectors(&mut self, name: &str) -> Result<Vec<[f64; 3]>> {
        let flat = self.f64(name)?;
        let (vectors, rest) = flat.as_chunks::<3>();
        if rest.is_empty() {
            Ok(vectors.to_vec())
        } else {
            Err(self.wrong(name, "not a multiple of 3 values"))
        }
    }

    /// Takes an array of `u64` out.
    ///
    /// # Errors
    /// When it is absent or of another type.
    pub fn u64(&mut self, name: &str) -> Result<Vec<u64>> {
        match self.arrays.remove(name) {
            Some(Array::U64(v)) => Ok(v),
            other => Err(self.absent(name, "u64", other.is_some())),
        }
    }

    /// Takes an array of `u8` out.
    ///
    /// # Errors
    /// When it is absent or of another type.
    pub fn u8(&mut self, name: &str) -> Result<Vec<u8>> {
        match self.arrays.remove(name) {
            Some(Array::U8(v)) => Ok(v),
            other => Err(self.absent(name, "u8", other.is_some())),
        }
    }

    /// A value kept by [`Checkpoint::put_json`].
    ///
    /// # Errors
    /// When it is absent or does not fit `T`.
    pub fn json<T: DeserializeOwned>(&self, name: &str) -> Result<T> {
        let value = self
            .json
            .get(name)
            .ok_or_else(|| self.wrong(name, "absent"))?;
        serde_json::from_value(value.clone()).map_err(|e| self.wrong(name, e))
    }

    /// Writes the checkpoint so that the file holds the old one or the new one, never a part.
    ///
    /// # Errors
    /// When the disk refuses; the old checkpoint is then untouched.
    pub fn write(&self, path: impl AsRef<Path>) -> Result<()> {
        write_atomically(path.as_ref(), &self.encode()?)
    }

    fn encode(&self) -> Result<Vec<u8>> {
        let arrays = self
            .arrays
            .iter()
            .map(|(name, array)| {
                let (kind, n) = match array {
                    Array::F64(v) => ("f64", v.len()),
                    Array::U64(v) => ("u64", v.len()),
                    Array::U8(v) => ("u8", v.len()),
                };
                (name.clone(), kind.to_owned(), n as u64)
            })
            .collect();
        let head = Head {
            identity: self.identity.clone(),
            build: self.build.clone(),
            json: self.json.clone(),
            arrays,
        };
        let head = serde_json::to_vec(&head).map_err(|e| self.wrong("head", e))?;
        let mut bytes = MAGIC.to_vec();
        bytes.extend((head.len() as u64).to_le_bytes());
        bytes.extend(head);
        for array in self.arrays.values() {
            match array {
                Array::F64(v) => v.iter().for_each(|x| bytes.extend(x.to_le_bytes())),
                Array::U64(v) => v.iter().for_each(|x| bytes.extend(x.to_le_bytes())),
                Array::U8(v) => bytes.extend(v),
            }
        }
        bytes.extend(crc32fast::hash(&bytes).to_le_bytes());
        Ok(bytes)
    }

    /// Reads a checkpoint of the run that `header` describes.
    ///
    /// # Errors
    /// When the file is foreign, truncated, damaged, or of another scene, input, tool, version or build.
    pub fn read(path: impl AsRef<Path>, header: &Header) -> Result<Self> {
        let checkpoint = Self::open(path)?;
        header
            .identity()
            .must_equal(&checkpoint.identity, &checkpoint.path)?;
        if checkpoint.build != build() {
            let short = |hash: &str| hash.get(..12).unwrap_or("(none)").to_owned();
            return Err(Error::NotSame {
                what: "build".to_owned(),
                expected: short(build()),
                found: short(&checkpoint.build),
                path: checkpoint.path,
            });
        }
        Ok(checkpoint)
    }

    /// Reads a checkpoint of any run.
    ///
    /// # Errors
    /// When the file is foreign, truncated or damaged.
    pub fn open(path: impl AsRef<Path>) -> Result<Self> {
        let path = path.as_ref();
        let bytes = std::fs::read(path).map_err(io_error(path, "read"))?;
        Self::decode(path, &bytes)
    }

    fn decode(path: &Path, bytes: &[u8]) -> Result<Self> {
        let damaged = |what: String| Error::Damaged {
            path: path.to_owned(),
            place: "checkpoint".to_owned(),
            what,
        };
        let Some((body, crc)) = bytes
            .split_last_chunk::<4>()
            .filter(|(body, _)| body.starts_with(MAGIC))
        else {
            return Err(damaged("it does not begin as a checkpoint does".to_owned()));
        };
        let (expected, found) = (u32::from_le_bytes(*crc), crc32fast::hash(body));
        if expected != found {
            return Err(Error::Crc {
                path: path.to_owned(),
                place: "the checkpoint".to_owned(),
                expected,
                found,
            });
        }
        let short = || damaged("it is shorter than its head says".to_owned());
        let (length, rest) = body[MAGIC.len()..]
            .split_first_chunk::<8>()
            .ok_or_else(short)?;
        let length = usize::try_from(u64::from_le_bytes(*length)).map_err(|_| short())?;
        let (head, mut rest) = rest.split_at_checked(length).ok_or_else(short)?;
        let head: Head = serde_json::from_slice(head).map_err(|e| damaged(e.to_string()))?;
        let mut arrays = BTreeMap::new();
        for (name, kind, n) in head.arrays {
            let n = usize::try_from(n).map_err(|_| short())?;
            let width = if kind == "u8" { 1 } else { 8 };
            let (data, after) = n
                .checked_mul(width)
                .and_then(|l| rest.split_at_checked(l))
                .ok_or_else(short)?;
            rest = after;
            let words = data.as_chunks::<8>().0.iter();
            let array = match kind.as_str() {
                "f64" => Array::F64(words.map(|w| f64::from_le_bytes(*w)).collect()),
                "u64" => Array::U64(words.map(|w| u64::from_le_bytes(*w)).collect()),
                "u8" => Array::U8(data.to_vec()),
                other => {
                    return Err(damaged(format!(
                        "array '{name}' has unknown type '{other}'"
                    )));
                }
            };
            arrays.insert(name, array);
        }
        if !rest.is_empty() {
            return Err(damaged("it is longer than its head says".to_owned()));
        }
        Ok(Self {
            identity: head.identity,
            build: head.build,
            json: head.json,
            arrays,
            path: path.to_owned(),
        })
    }

    fn absent(&self, name: &str, wanted: &str, other_type: bool) -> Error {
        let what = if other_type {
            "of another type than"
        } else {
            "absent, wanted is"
        };
        self.wrong(name, format!("{what} {wanted}"))
    }

    fn wrong(&self, name: &str, what: impl ToString) -> Error {
        Error::Damaged {
            path: self.path.clone(),
            place: format!("checkpoint entry '{name}'"),
            what: what.to_string(),
        }
    }
}

/// Hash of the program that runs.
fn build() -> &'static str {
    static BUILD: OnceLock<String> = OnceLock::new();
    BUILD.get_or_init(|| {
        // The file that runs, also where another has taken its name meanwhile.
        let hash = sha256_file(Path::new("/proc/self/exe"));
        // Where the system does not show it, the version has to do.
        hash.unwrap_or_default()
    })
}
