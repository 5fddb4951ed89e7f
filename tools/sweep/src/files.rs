//! Files that are written where they are not yet as they should be.

use std::path::Path;

use run::Failure;

/// Writes a text, with its folder, unless the file holds it already: what is not changed keeps its times.
///
/// # Errors
/// When the file or its folder cannot be written.
pub(crate) fn keep(path: &Path, text: &str) -> Result<(), Failure> {
    if std::fs::read_to_string(path).is_ok_and(|old| old == text) {
        return Ok(());
    }
    if let Some(folder) = path.parent() {
        std::fs::create_dir_all(folder).map_err(|source| Failure::Io {
            path: folder.to_owned(),
            action: "create",
            source,
        })?;
    }
    Ok(artefact::write_atomically(path, text.as_bytes())?)
}
