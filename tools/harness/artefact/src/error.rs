//! Everything that can be wrong with a file, with what was expected and what was found.

use std::io;
use std::path::{Path, PathBuf};

use thiserror::Error;

use crate::version::Version;

/// Why an artefact, a checkpoint or a JSON artefact could not be written or read.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum Error {
    /// The system refused to open, read, write, sync or rename a file.
    #[error("{path}: cannot {action}: {source}")]
    Io {
        /// The file or folder.
        path: PathBuf,
        /// What was tried: "create", "read", "write", ...
        action: &'static str,
        /// What the system said.
        source: io::Error,
    },
    /// The file does not begin as an MCAP file does.
    #[error("{path}: not an artefact: begins with {found}, an MCAP file begins with {expected}")]
    Foreign {
        /// The file.
        path: PathBuf,
        /// Its first bytes in hexadecimal.
        found: String,
        /// The MCAP magic in hexadecimal.
        expected: String,
    },
    /// A JSON file in the place of an artefact.
    #[error(
        "{path}: not an artefact: it is a JSON file{}, wanted is an MCAP file{}",
        .kind.as_ref().map(|k| format!(" of kind '{k}'")).unwrap_or_default(),
        .meant.as_ref().map(|m| format!("; did you mean {}?", m.display())).unwrap_or_default()
    )]
    IsJson {
        /// The file.
        path: PathBuf,
        /// Kind that it states, if it does.
        kind: Option<String>,
        /// The artefact that it is the record of, if it is one.
        meant: Option<PathBuf>,
    },
    /// What stands where a file is to be written is no file.
    #[error("{path}: is {what}, wanted is the name of a file to write")]
    NoPlace {
        /// Where the file is to be written.
        path: PathBuf,
        /// What stands there: "a folder", "a device", ...
        what: &'static str,
    },
    /// Another process holds the right to write a file.
    #[error("{path}: is written by another run{by}: wait for its end, or name another file")]
    Taken {
        /// What is to be written.
        path: PathBuf,
        /// " (process 4711)"; empty where it is not known.
        by: String,
    },
    /// A file that is to be written is one that is read.
    #[error("{path}: is {what} ({read}), which is read: name another file to write")]
    Read {
        /// What is to be written.
        path: PathBuf,
        /// What it is: "the scene", "the input 'frames'".
        what: String,
        /// The file as it is read.
        read: PathBuf,
    },
    /// A name that a file to write cannot bear.
    #[error("{path}: {what}")]
    Name {
        /// The name.
        path: PathBuf,
        /// What is wrong with it.
        what: String,
    },
    /// An MCAP file that no tool of ours wrote.
    #[error("{path}: an MCAP file, but not one of ours: it has no metadata record 'fusionline'")]
    NotOurs {
        /// The file.
        path: PathBuf,
    },
    /// The file ends before its end record.
    #[error(
        "{path}: truncated: it ends after {bytes} bytes without the end of an artefact; 'artefact recover' saves what is whole"
    )]
    Truncated {
        /// The file.
        path: PathBuf,
        /// Its length \[byte\].
        bytes: u64,
    },
    /// The file ends before the record that says what it is.
    #[error(
        "{path}: truncated: it ends after {bytes} bytes, before it says what it is; nothing of it can be saved"
    )]
    NoStart {
        /// The file.
        path: PathBuf,
        /// Its length \[byte\].
        bytes: u64,
    },
    /// A checksum differs.
    #[error("{path}: damaged: CRC of {place} is {found:08x}, recorded is {expected:08x}")]
    Crc {
        /// The file.
        path: PathBuf,
        /// Which part: "chunk 3 at byte 10240", "the summary", ...
        place: String,
        /// CRC recorded in the file.
        expected: u32,
        /// CRC of what was read.
        found: u32,
    },
    /// The structure of the file contradicts itself.
    #[error("{path}: damaged: {place}: {what}")]
    Damaged {
        /// The file.
        path: PathBuf,
        /// Which part.
        place: String,
        /// What is wrong with it.
        what: String,
    },
    /// What the file holds is not what it says: `artefact validate` tells all of it.
    #[error("{what}")]
    Unsound {
        /// File, place, and what is wrong there.
        what: String,
    },
    /// Another kind of artefact than the one asked for.
    #[error("{path}: is of kind '{found}', wanted is kind '{expected}'")]
    Kind {
        /// The file.
        path: PathBuf,
        /// Kind that the reader wants.
        expected: String,
        /// Kind that the file states.
        found: String,
    },
    /// A kind that none of our tools writes.
    #[error("{path}: is of kind '{found}', known are {known}")]
    UnknownKind {
        /// The file.
        path: PathBuf,
        /// Kind that the file states.
        found: String,
        /// Kinds that are known.
        known: String,
    },
    /// A newer or older major version than the one understood.
    #[error("{path}: '{kind}' is of version {found}, this program reads version {supported}.x")]
    Version {
        /// The file.
        path: PathBuf,
        /// Kind of the artefact.
        kind: String,
        /// Version that the file states.
        found: Version,
        /// Major version that the reader understands.
        supported: u32,
    },
    /// A channel that the file does not have.
    #[error(
        "{path}: has no channel '{channel}' (it has {present}): the run that wrote it did not compute it"
    )]
    NoChannel {
        /// The file.
        path: PathBuf,
        /// Channel asked for.
        channel: String,
        /// Channels that exist.
        present: String,
    },
    /// A column that the channel does not have: physics that the scene left out.
    #[error(
        "{origin}: has no column '{column}' (it has {present}): absent physics, the scene that made it did not name it"
    )]
    NoColumn {
        /// File and channel.
        origin: String,
        /// Column asked for.
        column: String,
        /// Columns that exist.
        present: String,
    },
    /// A channel holds other messages than asked for.
    #[error("{path}: channel '{channel}' holds '{found}', wanted is '{expected}'")]
    Schema {
        /// The file.
        path: PathBuf,
        /// The channel.
        channel: String,
        /// Schema that the reader wants.
        expected: String,
        /// Schema that the channel states.
        found: String,
    },
    /// A message beyond the end of its channel.
    #[error("{path}: channel '{channel}' has {count} messages, there is none with index {index}")]
    Index {
        /// The file.
        path: PathBuf,
        /// The channel.
        channel: String,
        /// Index asked for, from 0.
        index: usize,
        /// Number of messages.
        count: usize,
    },
    /// A message that is not what its schema says.
    #[error("{path}: channel '{channel}', message {index}: {what}")]
    Message {
        /// The file.
        path: PathBuf,
        /// The channel.
        channel: String,
        /// Index of the message, from 0.
        index: usize,
        /// What is wrong.
        what: String,
    },
    /// A NaN or an infinity about to be written.
    #[error(
        "{path}: channel '{channel}', column '{column}', entry {index}: {value} is not a finite number"
    )]
    NotFinite {
        /// The file.
        path: PathBuf,
        /// The channel.
        channel: String,
        /// The column.
        column: String,
        /// Index of the entry, from 0.
        index: usize,
        /// The value.
        value: f64,
    },
    /// What is about to be written does not fit together (lengths, columns, times).
    #[error("{path}: channel '{channel}': {what}")]
    Unfit {
        /// The file.
        path: PathBuf,
        /// The channel.
        channel: String,
        /// What does not fit.
        what: String,
    },
    /// A checkpoint or partial file made by another scene, input, tool or version.
    #[error("{path}: made with {what} {found}, this run has {expected}: it cannot be resumed")]
    NotSame {
        /// The file.
        path: PathBuf,
        /// "scene", "tool version", "input 'gas'", ...
        what: String,
        /// What this run has.
        expected: String,
        /// What the file states.
        found: String,
    },
    /// A JSON file that is not valid, with its place.
    #[error("{path}:{line}:{column}: {what}")]
    Json {
        /// The file.
        path: PathBuf,
        /// Line, from 1.
        line: usize,
        /// Column, from 1.
        column: usize,
        /// What is wrong.
        what: String,
    },
}

/// Result with [`enum@Error`].
pub type Result<T> = std::result::Result<T, Error>;

/// Adds file and action to an error of the system.
pub(crate) fn io_error(path: &Path, action: &'static str) -> impl FnOnce(io::Error) -> Error {
    let path = path.to_owned();
    move |source| Error::Io {
        path,
        action,
        source,
    }
}
