//! Words for people, on stderr.

use std::io::Write;

use artefact::shown;

/// How much is said.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Level {
    /// Only warnings and errors.
    Quiet,
    /// Head, progress, closing block.
    Normal,
    /// Also hashes, checkpoints, every stage.
    Verbose,
}

/// Writes a line to stderr. A closed stderr is no reason to stop a run.
pub(crate) fn line(text: &str) {
    let _ = writeln!(std::io::stderr().lock(), "{}", shown(text));
}

/// Writes data to stdout.
pub(crate) fn data(text: &str) -> std::io::Result<()> {
    let mut out = std::io::stdout().lock();
    out.write_all(shown(text).as_bytes())?;
    out.flush()
}
