//! `TOOL check` within a bound of time: what is known when it has passed is told.

use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::time::{Duration, Instant};

use crate::failure::Failure;
use crate::machine;

/// A bound is one of work: a machine that has other work to do may take longer by the clock, at most so many times.
const LONGER: u32 = 30;
/// Between two looks at the work done.
const LOOK: Duration = Duration::from_millis(20);
/// Stack of the thread that plans: that of the main thread.
const STACK: usize = 8 << 20;

/// What a plan comes to, step by step.
#[derive(Debug)]
pub(crate) enum Step<P, E> {
    /// The scene is read: the bound begins.
    Read,
    /// What is known before the plan.
    Outline(P),
    /// The plan.
    Plan(P),
    /// The estimate, the last step.
    Estimate(E),
}

/// What became known in time.
#[derive(Debug)]
pub(crate) struct Known<P, E> {
    pub(crate) outline: Option<P>,
    pub(crate) plan: Option<P>,
    pub(crate) estimate: Option<E>,
}

/// Does work that tells its steps, on a thread of its own; gives up on what it has not told within the bound.
///
/// # Errors
/// That with which the work ends, and where no thread can be had.
pub(crate) fn bounded<P: Send + 'static, E: Send + 'static>(
    bound: Duration,
    work: impl FnOnce(&dyn Fn(Step<P, E>)) -> Result<(), Failure> + Send + 'static,
) -> Result<Known<P, E>, Failure> {
    let (tell, told) = channel();
    let working = move || {
        let step = |step| {
            // Nobody listens once the bound has passed.
            let _ = tell.send(Ok(step));
        };
        if let Err(failure) = work(&step) {
            let _ = tell.send(Err(failure));
        }
    };
    std::thread::Builder::new()
        .stack_size(STACK)
        .spawn(working)
        .map_err(|e| Failure::Other(format!("cannot begin to plan: {e}")))?;
    listen(&told, bound)
}

type Told<P, E> = Result<Step<P, E>, Failure>;

fn listen<P, E>(told: &Receiver<Told<P, E>>, bound: Duration) -> Result<Known<P, E>, Failure> {
    let mut known = Known {
        outline: None,
        plan: None,
        estimate: None,
    };
    let mut begun: Option<(Instant, Option<f64>)> = None;
    loop {
        match told.recv_timeout(LOOK) {
            Ok(step) => match step? {
                Step::Read => begun = Some((Instant::now(), machine::work_s())),
                Step::Outline(plan) => known.outline = Some(plan),
                Step::Plan(plan) => known.plan = Some(plan),
                Step::Estimate(estimate) => known.estimate = Some(estimate),
            },
            Err(RecvTimeoutError::Disconnected) => return Ok(known),
            Err(RecvTimeoutError::Timeout) => {}
        }
        if begun.is_some_and(|(since, before)| passed(since, before, bound)) {
            return Ok(known);
        }
    }
}

/// Whether the bound has passed since then, when so much work had been done.
fn passed(since: Instant, before: Option<f64>, bound: Duration) -> bool {
    let clock = since.elapsed();
    let work = before.zip(machine::work_s()).map(|(then, now)| now - then);
    let worked = work.is_none_or(|work| work >= bound.as_secs_f64());
    clock >= bound.saturating_mul(LONGER) || clock >= bound && worked
}

#[cfg(test)]
mod tests {
    use super::*;

    use std::sync::atomic::{AtomicBool, Ordering};

    const BOUND: Duration = Duration::from_millis(500);

    #[test]
    fn what_is_known_in_time_is_told() {
        static HEARD: AtomicBool = AtomicBool::new(false);
        let known = bounded(BOUND, |tell| {
            tell(Step::Read);
            tell(Step::Plan(1));
            tell(Step::Estimate("two"));
            Ok(())
        });
        let known = known.unwrap();
        assert_eq!((known.plan, known.estimate), (Some(1), Some("two")));
        let began = Instant::now();
        let known = bounded::<_, ()>(BOUND, |tell| {
            tell(Step::Read);
            tell(Step::Plan(1));
            while !HEARD.load(Ordering::Relaxed) {
                std::hint::spin_loop();
            }
            Ok(())
        });
        HEARD.store(true, Ordering::Relaxed);
        let known = known.unwrap();
        assert_eq!((known.plan, known.estimate), (Some(1), None));
        assert!(began.elapsed() < LONGER * BOUND);
    }

    #[test]
    fn failures_are_told() {
        let known = bounded::<(), ()>(BOUND, |tell| {
            tell(Step::Read);
            Err(Failure::Usage("so".to_owned()))
        });
        assert_eq!(known.unwrap_err().exit_code(), 2);
    }
}
