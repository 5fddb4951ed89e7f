//! Worker threads that stay awake between loops.
//!
//! A step is hundreds of loops, each a small part of a millisecond long. A thread that falls asleep
//! between two of them takes about as long to be woken, and the others have done its work by then. So
//! while a stage runs, idle threads look for work again and again; one that finds none for a while
//! naps, and leaves its core to others.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::time::{Duration, Instant};

/// Time without work after which a thread naps.
const PATIENCE: Duration = Duration::from_millis(2);
/// How long it naps.
const NAP: Duration = Duration::from_micros(200);
/// Looks for work between two looks at the clock.
const LOOKS: u32 = 32;

/// Keeps the threads awake until it is dropped.
#[derive(Debug)]
pub(crate) struct Awake {
    stop: Arc<AtomicBool>,
}

impl Awake {
    /// Wakes all threads but this one.
    pub(crate) fn keep() -> Self {
        let (stop, seen) = (Arc::<AtomicBool>::default(), Arc::<AtomicUsize>::default());
        let own = rayon::current_thread_index();
        let others = rayon::current_num_threads() - usize::from(own.is_some());
        let (stopped, arrived) = (Arc::clone(&stop), Arc::clone(&seen));
        rayon::spawn_broadcast(move |thread| {
            if Some(thread.index()) != own {
                arrived.fetch_add(1, Ordering::Relaxed);
                watch(&stopped);
            }
        });
        // A thread that came to this from within a loop would never end the loop.
        while seen.load(Ordering::Relaxed) < others {
            std::hint::spin_loop();
        }
        Self { stop }
    }
}

impl Drop for Awake {
    fn drop(&mut self) {
        self.stop.store(true, Ordering::Relaxed);
    }
}

/// Works whenever there is work, until `stop`.
fn watch(stop: &AtomicBool) {
    let mut last = Instant::now();
    while !stop.load(Ordering::Relaxed) {
        let worked = (0..LOOKS).any(|_| {
            std::hint::spin_loop();
            rayon::yield_now() == Some(rayon::Yield::Executed)
        });
        if worked {
            last = Instant::now();
        } else if last.elapsed() > PATIENCE {
            std::thread::sleep(NAP);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rayon::prelude::*;

    #[test]
    fn work_is_done_while_threads_watch_and_after() {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(3).build();
        let sum = pool.unwrap().install(|| {
            let awake = Awake::keep();
            let first: u64 = (0..100_000_u64).into_par_iter().sum();
            std::thread::sleep(2 * PATIENCE);
            let second: u64 = (0..100_000_u64).into_par_iter().sum();
            drop(awake);
            first + second + (0..10_u64).into_par_iter().sum::<u64>()
        });
        assert_eq!(sum, 2 * 4_999_950_000 + 45);
    }
}
