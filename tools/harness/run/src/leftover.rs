//! What an earlier run left where this one is to begin: work that must not be lost unasked.

use std::path::{Path, PathBuf};

use artefact::{Checkpoint, Header, beside};

use crate::failure::Failure;
use crate::ledger::Ledger;
use crate::plan::duration;
use crate::session::LEDGER;

/// Makes way for a run from the start. A checkpoint that `--resume` would take up is refused; one of
/// another scene, input or version, or one that cannot be read, is set aside with its partial file.
/// Gives what to tell of it.
///
/// # Errors
/// [`Failure::Usage`] with both ways to go on; the disk.
pub(crate) fn make_way(out: &Path, header: &Header) -> Result<Option<String>, Failure> {
    let (checkpoint, part) = (beside(out, ".checkpoint"), beside(out, ".part"));
    if !checkpoint.exists() {
        return Ok(None);
    }
    let why = match Checkpoint::read(&checkpoint, header) {
        Ok(_) if !part.exists() => format!("{}: {} is gone", checkpoint.display(), part.display()),
        Ok(found) => return Err(Failure::Usage(both_ways(&checkpoint, &found))),
        Err(e) => e.to_string(),
    };
    let kept = set_aside(&checkpoint)?;
    if part.exists() {
        set_aside(&part)?;
    }
    let kept = kept.display();
    Ok(Some(format!(
        "{why}; it is kept as {kept}, this run starts afresh"
    )))
}

fn both_ways(path: &Path, checkpoint: &Checkpoint) -> String {
    let ledger: Ledger = checkpoint.json(LEDGER).unwrap_or_default();
    let path = path.display();
    format!(
        "{path}: holds this very run at step {}, after {} of work: go on from there with --resume, \
         or start afresh by removing it (rm {path})",
        ledger.steps,
        duration(ledger.earlier_s)
    )
}

/// Renames a file to `NAME.old`, in the place of an older one.
fn set_aside(path: &Path) -> Result<PathBuf, Failure> {
    let old = beside(path, ".old");
    std::fs::rename(path, &old).map_err(|source| Failure::Io {
        path: path.to_owned(),
        action: "set aside",
        source,
    })?;
    Ok(old)
}
