//! Opens what the user names: finished artefacts, and all that is whole of others.

use std::path::Path;

use artefact::{Channel, Reader};

use super::Streams;
use super::trouble::Trouble;

/// Whether the file is a JSON record and no MCAP file, by its name.
pub(crate) fn is_json(path: &Path) -> bool {
    path.extension().is_some_and(|e| e == "json")
}

/// Opens an artefact; a partial file (`.part`) as far as it is whole, with a remark.
pub(crate) fn open(path: &Path, streams: &mut Streams<'_>) -> Result<Reader, Trouble> {
    if path.extension().is_none_or(|e| e != "part") {
        let reader = Reader::open(path).map_err(|e| damaged(e, path))?;
        reader.must_be_known()?;
        return Ok(reader);
    }
    let reader = Reader::recover(path)?;
    reader.must_be_known()?;
    writeln!(
        streams.err,
        "{}: not finished; read up to its last whole chunk, {} bytes lie behind it",
        path.display(),
        reader.lost_bytes()
    )?;
    for lost in reader.lost() {
        writeln!(streams.err, "  {lost}")?;
    }
    Ok(reader)
}

/// Advises to save what is whole where a file is damaged.
fn damaged(error: artefact::Error, path: &Path) -> Trouble {
    match error {
        artefact::Error::Crc { .. } | artefact::Error::Damaged { .. } => {
            let path = path.display();
            Trouble::Damaged(format!(
                "{error}; 'artefact recover {path}' saves what is whole"
            ))
        }
        other => other.into(),
    }
}

/// Opens all that is whole of an artefact, and says whether that is all before its end.
pub(crate) fn open_whole(
    path: &Path,
    streams: &mut Streams<'_>,
) -> Result<(Reader, bool), Trouble> {
    let reader = open(path, streams)?;
    if path.extension().is_some_and(|e| e == "part") {
        let whole = reader.lost().is_empty();
        return Ok((reader, whole));
    }
    let Err(damage) = reader.scrub() else {
        return Ok((reader, true));
    };
    writeln!(streams.err, "warning: {damage}")?;
    let reader = Reader::recover(path)?;
    for lost in reader.lost() {
        writeln!(streams.err, "  {lost}")?;
    }
    Ok((reader, false))
}

/// The channels that are asked for, all when none is named.
pub(crate) fn channels(reader: &Reader, wanted: &[String]) -> Result<Vec<Channel>, Trouble> {
    let all = reader.channels();
    for name in wanted {
        if !all.iter().any(|c| c.name == *name) {
            let present: Vec<&str> = all.iter().map(|c| c.name.as_str()).collect();
            return Err(Trouble::Usage(format!(
                "{}: has no channel '{name}'; it has {}",
                reader.path().display(),
                present.join(", ")
            )));
        }
    }
    let chosen = all.into_iter();
    Ok(chosen
        .filter(|c| wanted.is_empty() || wanted.contains(&c.name))
        .collect())
}
