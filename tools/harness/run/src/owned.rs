//! An output that is owned while it is written: its name is vetted, it is nothing that is read, nobody else writes it.

use std::path::{Path, PathBuf};

use artefact::{Lock, beside, followed, must_be_nameable, must_be_replaceable, must_not_be_read};

use crate::failure::Failure;
use crate::record::path_of;

/// What stands beside an artefact while a run writes it, and after.
const BESIDE_ARTEFACT: [&str; 7] = [
    ".checkpoint.part",
    ".checkpoint.old",
    ".checkpoint",
    ".part.resumed",
    ".part.old",
    ".part",
    ".lock",
];
/// What stands beside any other file while it is written.
const BESIDE_FILE: [&str; 2] = [".part", ".lock"];

/// What an output is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Form {
    /// An artefact of a stage, with its record and checkpoint.
    Artefact,
    /// A page.
    Page,
    /// A record.
    Record,
}

impl Form {
    /// Ending of its name, and what it is called.
    fn words(self) -> (&'static str, &'static str) {
        match self {
            Self::Artefact => ("mcap", "an artefact is an MCAP file"),
            Self::Page => ("html", "a page is an HTML file"),
            Self::Record => ("json", "a record is a JSON file"),
        }
    }

    /// Every file that is written with `out`, itself among them.
    fn writes(self, out: &Path) -> Vec<PathBuf> {
        let with = |suffixes: &[&str]| suffixes.iter().map(|s| beside(out, s)).collect();
        let mut all: Vec<PathBuf> = match self {
            Self::Artefact => with(&BESIDE_ARTEFACT),
            Self::Page | Self::Record => with(&BESIDE_FILE),
        };
        if self == Self::Artefact {
            let record = path_of(out);
            all.extend([beside(&record, ".part"), record]);
        }
        all.insert(0, out.to_owned());
        all
    }

    /// The longest that is added to the name.
    fn suffix(self) -> &'static str {
        match self {
            Self::Artefact => BESIDE_ARTEFACT[0],
            Self::Page | Self::Record => BESIDE_FILE[0],
        }
    }
}

/// The right to write an output, until it is dropped.
#[derive(Debug)]
pub struct Owned {
    out: PathBuf,
    _lock: Lock,
}

impl Owned {
    /// Vets the name of an output and takes the right to write it, before anything is read. `reads` are the files
    /// that are read, each with what it is.
    ///
    /// # Errors
    /// With exit code 2: a name that cannot or should not be that of the output, an output that is read, another
    /// process that writes it.
    pub fn of<'a>(
        out: &Path,
        form: Form,
        reads: impl IntoIterator<Item = (String, &'a Path)> + Clone,
    ) -> Result<Self, Failure> {
        let refused = |what: String| Failure::Usage(format!("--out {what}"));
        let told = |e: artefact::Error| refused(e.to_string());
        must_be_replaceable(out).map_err(told)?;
        let (ending, called) = form.words();
        if out.extension().is_none_or(|e| e != ending) {
            return Err(refused(format!(
                "{}: {called}, and its name ends in .{ending}: {}",
                out.display(),
                out.with_extension(ending).display()
            )));
        }
        let out = followed(out);
        must_be_nameable(&out, form.suffix()).map_err(told)?;
        for written in form.writes(&out) {
            must_not_be_read(&written, reads.clone()).map_err(told)?;
        }
        let lock = Lock::of(&out).map_err(|e| match e {
            taken @ artefact::Error::Taken { .. } => told(taken),
            other => other.into(),
        })?;
        Ok(Self { out, _lock: lock })
    }

    /// The file to write: where links lead to.
    #[must_use]
    pub fn out(&self) -> &Path {
        &self.out
    }
}
