//! Records of evidence on the disk: whole or not at all, as artefacts are.

use std::path::Path;

use serde::Serialize;

/// Writes a record as JSON in the place of an older one, which stays where the disk refuses.
///
/// # Errors
/// What cannot be written, with its file.
pub fn keep(path: &Path, record: &impl Serialize) -> Result<(), String> {
    let text =
        serde_json::to_string_pretty(record).map_err(|e| format!("{}: {e}", path.display()))?;
    artefact::write_atomically(path, (text + "\n").as_bytes()).map_err(|e| e.to_string())
}
