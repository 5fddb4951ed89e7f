//! Ctrl-C and SIGTERM: the first asks for a checkpoint, the second ends at once.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use signal_hook::consts::TERM_SIGNALS;
use signal_hook::flag;

use crate::failure::Failure;

/// Exit code of an interrupted run.
pub(crate) const EXIT: u8 = 130;

/// Whether the user wants the run to stop.
#[derive(Debug, Clone, Default)]
pub(crate) struct Interrupt(Arc<AtomicBool>);

impl Interrupt {
    /// Listens to the signals.
    pub(crate) fn listen() -> Result<Self, Failure> {
        let wanted = Arc::new(AtomicBool::new(false));
        for &signal in TERM_SIGNALS {
            flag::register_conditional_shutdown(signal, i32::from(EXIT), wanted.clone())
                .and_then(|_| flag::register(signal, wanted.clone()))
                .map_err(|e| Failure::Other(format!("cannot listen to signal {signal}: {e}")))?;
        }
        Ok(Self(wanted))
    }

    pub(crate) fn wanted(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }
}
