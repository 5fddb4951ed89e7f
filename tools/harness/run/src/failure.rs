//! Why a run ended without a result, and the exit code that goes with it.

use std::path::PathBuf;

use thiserror::Error;

use crate::fault::Fault;

/// Why a run ended without a result.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum Failure {
    /// The command line asks for what cannot be.
    #[error("{0}")]
    Usage(String),
    /// The scene is not valid; every fault at once.
    #[error("{}", lines(.0))]
    Scene(Vec<Fault>),
    /// The numerics diverged or left the range of a property.
    #[error("step {step}, t = {time_s:.6e} s, {place}: {quantity}: {what}")]
    Diverged {
        /// Step or iteration.
        step: u64,
        /// Simulated time \[s\]; 0 for a steady solver.
        time_s: f64,
        /// Where: "particle 812 at (1e-3, 0, 0) m", "cell (12, 40)".
        place: String,
        /// Which quantity, with its unit.
        quantity: String,
        /// What happened, with values.
        what: String,
    },
    /// A file could not be read or written.
    #[error(transparent)]
    Artefact(#[from] artefact::Error),
    /// The user interrupted the run; the checkpoint is written if the tool keeps one.
    #[error("interrupted{}", if *.resumable { "; a checkpoint is written" } else { "" })]
    Interrupted {
        /// Whether `--resume` can take the run up.
        resumable: bool,
    },
    /// The system refused something.
    #[error("{path}: cannot {action}: {source}")]
    Io {
        /// The file or folder.
        path: PathBuf,
        /// What was tried.
        action: &'static str,
        /// What the system said.
        source: std::io::Error,
    },
    /// The disk is full: what happened, what is kept and how to go on.
    #[error("{failure}\n{advice}")]
    Full {
        /// What the system refused.
        failure: Box<Failure>,
        /// What is kept, and how to go on.
        advice: String,
    },
    /// Anything else that went wrong.
    #[error("{0}")]
    Other(String),
}

impl Failure {
    /// Exit code: 2 usage or scene, 130 interrupted, 1 all else.
    #[must_use]
    pub fn exit_code(&self) -> u8 {
        match self {
            Self::Usage(_) | Self::Scene(_) => 2,
            Self::Interrupted { .. } => 130,
            _ => 1,
        }
    }

    /// Whether the disk, a quota or a limit on files leaves no room.
    pub(crate) fn is_full(&self) -> bool {
        use std::io::ErrorKind;
        match self {
            Self::Io { source, .. } | Self::Artefact(artefact::Error::Io { source, .. }) => {
                matches!(
                    source.kind(),
                    ErrorKind::StorageFull | ErrorKind::QuotaExceeded | ErrorKind::FileTooLarge
                )
            }
            _ => false,
        }
    }

    /// The word for the run record.
    #[must_use]
    pub fn outcome(&self) -> &'static str {
        match self {
            // A value that is not finite is a divergence that only the writer noticed.
            Self::Diverged { .. } | Self::Artefact(artefact::Error::NotFinite { .. }) => "diverged",
            Self::Interrupted { .. } => "interrupted",
            _ => "failed",
        }
    }
}

impl From<Fault> for Failure {
    fn from(fault: Fault) -> Self {
        Self::Scene(vec![fault])
    }
}

impl From<Vec<Fault>> for Failure {
    fn from(faults: Vec<Fault>) -> Self {
        Self::Scene(faults)
    }
}

fn lines(faults: &[Fault]) -> String {
    faults
        .iter()
        .map(ToString::to_string)
        .collect::<Vec<_>>()
        .join("\n")
}
