//! `artefact validate`: checksums, schemas, and that every number is one.

use std::path::{Path, PathBuf};

use artefact::Reader;

use super::open::is_json;
use super::trouble::{Trouble, Verdict};
use super::{Streams, json};

/// Arguments of `validate`.
#[derive(Debug, clap::Args)]
#[command(after_help = "Example:
  target/release/artefact validate build/gmaw-quick/*.mcap build/gmaw-quick/*.run.json
Of an MCAP file it reads every byte: checksums of data, chunks and index; order of times; each JSON
message against the JSON Schema in the file; strides, lengths and place of grids; units; and NaN or infinity in any column, named by
channel, time, column and row. Of a JSON record it checks the schema of its kind.
Exit code 1 when anything is wrong in any file.")]
pub(crate) struct Arguments {
    /// Artefacts (.mcap) or JSON records.
    #[arg(value_name = "FILE", required = true)]
    files: Vec<PathBuf>,
}

pub(crate) fn run(arguments: &Arguments, streams: &mut Streams<'_>) -> Result<Verdict, Trouble> {
    let mut good = true;
    for path in &arguments.files {
        let (findings, what) = if is_json(path) {
            json::findings(path)
        } else {
            findings(path)
        };
        for finding in &findings {
            writeln!(streams.out, "{finding}")?;
        }
        if findings.is_empty() {
            writeln!(streams.out, "{}: good: {what}", path.display())?;
        }
        good &= findings.is_empty();
    }
    Ok(Verdict::from_good(good))
}

/// All that is wrong with an MCAP file, and what it is when nothing is.
fn findings(path: &Path) -> (Vec<String>, String) {
    let reader = match Reader::open(path) {
        Ok(reader) => reader,
        Err(e) => return (vec![e.to_string()], String::new()),
    };
    if let Err(e) = reader.must_be_known().and_then(|()| reader.scrub()) {
        return (vec![e.to_string()], String::new());
    }
    let channels = reader.channels();
    let messages: usize = channels.iter().map(|c| c.messages).sum();
    let header = reader.header();
    let what = format!(
        "{} {}, {messages} messages in {} channels, {} bytes",
        header.kind,
        header.version,
        channels.len(),
        reader.bytes()
    );
    (reader.faults(usize::MAX), what)
}
