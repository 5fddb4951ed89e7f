//! JSON files: artefacts with a kind and a version, read with line and column in every error.

use std::path::Path;

use mcap::MAGIC;
use serde::Deserialize;
use serde::de::DeserializeOwned;

use crate::error::{Error, Result, io_error};
use crate::version::Version;

#[derive(Deserialize)]
struct Envelope {
    kind: String,
    version: String,
}

/// Reads a JSON artefact of a kind and major version.
///
/// # Errors
/// When the file cannot be read, is not JSON, is of another kind or major version, or does not
/// fit `T`; with file, line and column where there is one.
pub fn json_artefact<T: DeserializeOwned>(
    path: impl AsRef<Path>,
    kind: &str,
    major: u32,
) -> Result<T> {
    let path = path.as_ref();
    let text = json_text(path)?;
    let envelope: Envelope = parse(path, &text)?;
    if envelope.kind != kind {
        return Err(Error::Kind {
            path: path.to_owned(),
            expected: kind.to_owned(),
            found: envelope.kind,
        });
    }
    let found: Version = envelope.version.parse().map_err(|what| Error::Json {
        path: path.to_owned(),
        line: 1 + text
            .lines()
            .position(|line| line.contains("\"version\""))
            .unwrap_or(0),
        column: 1,
        what,
    })?;
    if found.major != major {
        return Err(Error::Version {
            path: path.to_owned(),
            kind: kind.to_owned(),
            found,
            supported: major,
        });
    }
    parse(path, &text)
}

/// Reads the text of a JSON file; a byte order mark before it is no part of it.
///
/// # Errors
/// When the file cannot be read or is no text in UTF-8, with line and column, and what it is where that
/// can be told.
pub fn json_text(path: &Path) -> Result<String> {
    let bytes = bounded(path)?;
    let wrong = |line, column, what: String| Error::Json {
        path: path.to_owned(),
        line,
        column,
        what,
    };
    let bytes = match bytes.strip_prefix(b"\xef\xbb\xbf") {
        Some(rest) => rest,
        None => &bytes,
    };
    if bytes.starts_with(MAGIC) {
        return Err(wrong(1, 1, "is an MCAP file, wanted is JSON".to_owned()));
    }
    if bytes.starts_with(b"\xff\xfe") || bytes.starts_with(b"\xfe\xff") {
        return Err(wrong(1, 1, "is in UTF-16, wanted is UTF-8".to_owned()));
    }
    match std::str::from_utf8(bytes) {
        Ok(text) => Ok(text.to_owned()),
        Err(e) => {
            let (before, after) = bytes.split_at(e.valid_up_to());
            let line = 1 + before.iter().filter(|b| **b == b'\n').count();
            let tail = before.rsplit(|b| *b == b'\n').next().unwrap_or_default();
            let column = 1 + String::from_utf8_lossy(tail).chars().count();
            let byte = after.first().copied().unwrap_or_default();
            let what = format!("is no text: byte {byte:#04x} is not UTF-8; wanted is JSON");
            Err(wrong(line, column, what))
        }
    }
}

/// Longest JSON file that is read \[byte\].
const LONGEST: u64 = 1 << 28;

/// The bytes of a regular file that is not too long: a device may have no end, and a pipe no writer.
fn bounded(path: &Path) -> Result<Vec<u8>> {
    let found = std::fs::metadata(path).map_err(io_error(path, "read"))?;
    let refused = |what: String| Err(io_error(path, "read")(std::io::Error::other(what)));
    if found.is_dir() {
        return refused("it is a folder".to_owned());
    }
    if !found.is_file() {
        return refused("it is no regular file".to_owned());
    }
    if found.len() > LONGEST {
        let (long, most) = (found.len(), LONGEST);
        return refused(format!("it has {long} bytes, at most {most} are read"));
    }
    std::fs::read(path).map_err(io_error(path, "read"))
}

/// The error for a JSON file where an artefact is wanted; `None` for any other file.
pub(crate) fn mistaken(path: &Path) -> Option<Error> {
    // The longest JSON artefacts are gas tables of some MB: what is longer is no file of ours.
    if std::fs::metadata(path).ok()?.len() > 1 << 26 {
        return None;
    }
    let text = std::fs::read_to_string(path).ok()?;
    let value: serde_json::Value = serde_json::from_str(&text).ok()?;
    if !value.is_object() && !value.is_array() {
        return None;
    }
    let artefact = || {
        let stem = path.file_name()?.to_str()?.strip_suffix(".run.json")?;
        Some(path.with_file_name(format!("{stem}.mcap")))
    };
    Some(Error::IsJson {
        path: path.to_owned(),
        kind: value["kind"].as_str().map(str::to_owned),
        meant: artefact().filter(|a| a.is_file()),
    })
}

fn parse<T: DeserializeOwned>(path: &Path, text: &str) -> Result<T> {
    serde_json::from_str(text).map_err(|e| json_error(path, &e))
}

/// An error of the JSON reader with file, line and column, each said once.
#[must_use]
pub fn json_error(path: &Path, error: &serde_json::Error) -> Error {
    let text = error.to_string();
    let what = text.split(" at line ").next().unwrap_or(&text);
    Error::Json {
        path: path.to_owned(),
        line: error.line(),
        column: error.column(),
        what: what.to_owned(),
    }
}
