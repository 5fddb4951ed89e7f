//! Records of evidence on the disk: whole or not at all, as artefacts are.

use std::path::Path;

use artefact::Lock;
use serde::Serialize;

/// Writes a record as JSON in the place of an older one, which stays where the disk refuses.
///
/// # Errors
/// What cannot be written, with its file.
pub fn keep(path: &Path, record: &impl Serialize) -> Result<(), String> {
    let _owned = Lock::of(path).map_err(|e| e.to_string())?;
    keep_owned(path, record)
}

/// The same in a place that the caller owns.
///
/// # Errors
/// What cannot be written, with its file.
pub fn keep_owned(path: &Path, record: &impl Serialize) -> Result<(), String> {
    let text =
        serde_json::to_string_pretty(record).map_err(|e| format!("{}: {e}", path.display()))?;
    artefact::write_atomically(path, (text + "\n").as_bytes()).map_err(|e| e.to_string())
}

/// Refuses to put records among the scenes that they are made from.
///
/// # Errors
/// With the folder.
pub fn apart(out: &Path, scenes: &Path) -> Result<(), String> {
    match (out.canonicalize(), scenes.canonicalize()) {
        (Ok(own), Ok(scenes)) if own.starts_with(&scenes) => Err(format!(
            "--out {}: records would be written over scenes: name a folder outside {}",
            out.display(),
            scenes.display()
        )),
        _ => Ok(()),
    }
}
