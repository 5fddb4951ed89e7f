//! `artefact validate`: checksums, schemas, and that every number is one.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use artefact::{Channel, METADATA, Reader};
use jsonschema::Validator;
use serde_json::Value;

use super::open::is_json;
use super::schema::schema_faults;
use super::sheet::Sheet;
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
    let mut found = Vec::new();
    let channels = reader.channels();
    for channel in &channels {
        check_channel(&reader, channel, &mut found);
    }
    check_units(&reader, &channels, &mut found);
    let messages: usize = channels.iter().map(|c| c.messages).sum();
    let header = reader.header();
    let what = format!(
        "{} {}, {messages} messages in {} channels, {} bytes",
        header.kind,
        header.version,
        channels.len(),
        reader.bytes()
    );
    (found, what)
}

/// What the record of the header says of units must be what the channels say. Older files say it in
/// the channels alone.
fn check_units(reader: &Reader, channels: &[Channel], found: &mut Vec<String>) {
    let record = reader.metadata(METADATA);
    let Some(text) = record.and_then(|record| record.get("units")) else {
        return;
    };
    let at = format!(
        "{}: metadata record '{METADATA}', units",
        reader.path().display()
    );
    let stated: BTreeMap<String, BTreeMap<String, String>> = match serde_json::from_str(text) {
        Ok(stated) => stated,
        Err(e) => return found.push(format!("{at}: {e}")),
    };
    let nothing = BTreeMap::new();
    for channel in channels {
        let stated = stated.get(&channel.name).unwrap_or(&nothing);
        for name in stated.keys().chain(channel.units.keys()) {
            let (a, b) = (stated.get(name), channel.units.get(name));
            if a != b {
                let word = |unit: Option<&String>| unit.map_or("none", String::as_str).to_owned();
                let (a, b) = (word(a), word(b));
                let name = format!("channel '{}', column '{name}'", channel.name);
                found.push(format!("{at}: {name}: '{a}', the channel says '{b}'"));
            }
        }
    }
}

fn check_channel(reader: &Reader, channel: &Channel, found: &mut Vec<String>) {
    let at = format!("{}: channel '{}'", reader.path().display(), channel.name);
    let validator = match validator(reader, channel) {
        Ok(validator) => validator,
        Err(what) => return found.push(format!("{at}: {what}")),
    };
    let times = match reader.times(&channel.name) {
        Ok(times) => times,
        Err(e) => return found.push(e.to_string()),
    };
    if let Some(i) = times.windows(2).position(|w| w[1] < w[0]) {
        found.push(format!(
            "{at}, message {}: its time {} s is before {} s of the message before it",
            i + 1,
            times[i + 1],
            times[i]
        ));
    }
    for (index, time) in times.iter().enumerate() {
        let at = format!("{at}, t = {time} s");
        if let Some(validator) = &validator {
            let before = found.len();
            match reader.json_at::<Value>(&channel.name, index) {
                Ok(value) => schema_faults(validator, &value, &at, found),
                Err(e) => found.push(e.to_string()),
            }
            if found.len() > before {
                continue;
            }
        }
        match Sheet::read(reader, channel, index) {
            Ok(sheet) => check_sheet(&sheet, channel, &at, found),
            Err(e) => found.push(e.to_string()),
        }
    }
}

/// The validator of the JSON messages of a channel; `None` for frames.
fn validator(reader: &Reader, channel: &Channel) -> Result<Option<Validator>, String> {
    let schema = reader
        .json_schema(&channel.name)
        .map_err(|e| e.to_string())?;
    if schema.is_empty() {
        return Ok(None);
    }
    let wrong = |what: String| format!("its JSON Schema '{}': {what}", channel.schema);
    let schema: Value = serde_json::from_slice(schema).map_err(|e| wrong(e.to_string()))?;
    jsonschema::validator_for(&schema)
        .map(Some)
        .map_err(|e| wrong(e.to_string()))
}

fn check_sheet(sheet: &Sheet, channel: &Channel, at: &str, found: &mut Vec<String>) {
    for column in sheet.all() {
        let name = &column.name;
        let named = channel.units.get(name).is_some_and(|unit| !unit.is_empty());
        if !named && (column.unit.is_empty() || !channel.units.is_empty()) {
            found.push(format!(
                "{at}, column '{name}': the file states no unit for it"
            ));
        }
        let values = column.values.to_f64();
        let wrong = |x: &&f64| !x.is_finite();
        let Some(row) = values.iter().position(|x| !x.is_finite()) else {
            continue;
        };
        let more = match values.iter().filter(wrong).count() - 1 {
            0 => String::new(),
            n => format!(" (and {n} more in this column)"),
        };
        found.push(format!(
            "{at}, column '{name}', row {row}: {} is not a finite number{more}",
            values[row]
        ));
    }
}
