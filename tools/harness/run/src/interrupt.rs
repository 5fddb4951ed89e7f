//! Ctrl-C and what else tells a run to end: the first asks for a checkpoint, the second ends at once. Where a run
//! has nothing to keep, the first soon ends it too.
//!
//! So do terminals that close (HUP) and queues that warn before they kill (TERM, USR1, XCPU). A limit on the length of
//! files (XFSZ) must not kill: the write that is refused says so in words.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{RecvTimeoutError, Sender, channel};
use std::time::Duration;

use signal_hook::consts::{SIGHUP, SIGINT, SIGQUIT, SIGTERM, SIGUSR1, SIGXCPU, SIGXFSZ};
use signal_hook::flag;

use crate::console::line;
use crate::failure::Failure;

/// Signals that tell a run to end.
const ENDS: [i32; 6] = [SIGTERM, SIGQUIT, SIGINT, SIGHUP, SIGUSR1, SIGXCPU];

/// Exit code of an interrupted run.
pub(crate) const EXIT: u8 = 130;
/// Time between two looks at the flag.
const LOOK: Duration = Duration::from_millis(50);
/// Looks at a flag that is set until the run is ended from outside.
const LOOKS: u32 = 15;

/// Whether the user wants the run to stop.
#[derive(Debug, Clone, Default)]
pub(crate) struct Interrupt(Arc<AtomicBool>);

impl Interrupt {
    /// Listens to the signals.
    pub(crate) fn listen() -> Result<Self, Failure> {
        let wanted = Arc::new(AtomicBool::new(false));
        let told =
            |signal| move |e| Failure::Other(format!("cannot listen to signal {signal}: {e}"));
        let ignored = ignored();
        // What the caller has turned off, as nohup does with HUP, stays off.
        for signal in ENDS
            .into_iter()
            .filter(|signal| ignored >> (signal - 1) & 1 == 0)
        {
            flag::register_conditional_shutdown(signal, i32::from(EXIT), wanted.clone())
                .and_then(|_| flag::register(signal, wanted.clone()))
                .map_err(told(signal))?;
        }
        flag::register(SIGXFSZ, Arc::default()).map_err(told(SIGXFSZ))?;
        Ok(Self(wanted))
    }

    pub(crate) fn wanted(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }

    pub(crate) fn flag(&self) -> Arc<AtomicBool> {
        self.0.clone()
    }

    /// Ends the program where it does not notice by itself that it is to stop.
    pub(crate) fn expendable(&self, tool: &str) -> Expendable {
        let (alive, gone) = channel();
        let (wanted, tool) = (self.clone(), tool.to_owned());
        std::thread::spawn(move || {
            let mut looks = 0;
            while gone.recv_timeout(LOOK) == Err(RecvTimeoutError::Timeout) {
                looks += u32::from(wanted.wanted());
                if looks > LOOKS {
                    line(&format!("{tool}: interrupted"));
                    std::process::exit(i32::from(EXIT));
                }
            }
        });
        Expendable { _alive: alive }
    }
}

/// Signals that the caller has turned off, a bit each; none where the system does not say.
fn ignored() -> u64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    line.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok())
        .unwrap_or(0)
}

/// Work that may end anywhere: see [`Session::expendable`](crate::Session::expendable).
#[derive(Debug)]
pub struct Expendable {
    _alive: Sender<()>,
}
