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

/// Says of a run that a full disk ended what is kept of it, and how to go on.
pub(crate) fn advised(failure: Failure, out: &Path) -> Failure {
    if !failure.is_full() {
        return failure;
    }
    let (checkpoint, part) = (beside(out, ".checkpoint"), beside(out, ".part"));
    let advice = if checkpoint.exists() {
        format!(
            "kept are {} and {}: make room, then go on to the same bytes with --resume",
            checkpoint.display(),
            part.display()
        )
    } else if part.is_file() {
        let part = part.display();
        format!(
            "kept are the whole frames in {part} ('artefact recover {part}' saves them): make room, or name an --out \
             on a larger disk, then run again from the start"
        )
    } else {
        "nothing is kept: make room, or name an --out on a larger disk, then run again".to_owned()
    };
    Failure::Full {
        failure: Box::new(failure),
        advice,
    }
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
