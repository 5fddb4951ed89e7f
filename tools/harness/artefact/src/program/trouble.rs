//! How a command can end.

use std::io;
use std::path::{Path, PathBuf};

use thiserror::Error;

/// What a command found.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Verdict {
    /// As it should be: exit code 0.
    Good,
    /// Damaged or different, said on stdout: exit code 1.
    Bad,
}

impl Verdict {
    pub(crate) fn from_good(good: bool) -> Self {
        if good { Self::Good } else { Self::Bad }
    }
}

/// Why a command could not do its work.
#[derive(Debug, Error)]
pub(crate) enum Trouble {
    /// A file that cannot be read or is damaged.
    #[error(transparent)]
    Artefact(#[from] artefact::Error),
    /// A file that is damaged, of which more may be whole.
    #[error("{0}")]
    Damaged(String),
    /// A file that cannot be written or read.
    #[error("{path}: cannot {action}: {source}")]
    File {
        path: PathBuf,
        action: &'static str,
        source: io::Error,
    },
    /// What was typed asks for something that is not there.
    #[error("{0}")]
    Usage(String),
    /// Our own output was refused.
    #[error("standard output: {0}")]
    Output(#[from] io::Error),
}

impl Trouble {
    /// Exit code of the program.
    pub(crate) fn code(&self) -> u8 {
        match self {
            Self::Usage(_) => 2,
            Self::Artefact(
                artefact::Error::NoChannel { .. }
                | artefact::Error::Taken { .. }
                | artefact::Error::Read { .. }
                | artefact::Error::Name { .. },
            ) => 2,
            _ => 1,
        }
    }
}

/// Adds file and action to an error of the system.
pub(crate) fn file_error(path: &Path, action: &'static str) -> impl FnOnce(io::Error) -> Trouble {
    let path = path.to_owned();
    move |source| Trouble::File {
        path,
        action,
        source,
    }
}
