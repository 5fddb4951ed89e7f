//! A few steps taken to tell how long a run will last.

use std::time::{Duration, Instant};

use run::{Estimate, Failure};

use crate::assemble::Assembled;
use crate::scene::Scene;
use crate::simulate::failure;

/// The timed steps end with this number or after this time.
const MOST: u64 = 50;
const LONGEST: Duration = Duration::from_millis(300);

/// Time of the whole run, if every step lasts as long as the first ones.
///
/// # Errors
/// What a step reports.
pub(crate) fn estimate(scene: &Scene, mut run: Assembled) -> Result<Estimate, Failure> {
    run.march
        .begin(&mut run.state)
        .map_err(|e| failure(e, &run.state))?;
    let limit = run
        .march
        .limit(&run.state)
        .map_or(f64::INFINITY, |limit| limit.seconds);
    let dt = limit
        .min(scene.time.step_s.unwrap_or(f64::INFINITY))
        .min(scene.time.end_s);
    let mut step = || {
        let done = run.march.step(&mut run.state, dt, &mut |_, work| work());
        done.map_err(|e| failure(e, &run.state))
    };
    step()?;
    let (began, mut taken) = (Instant::now(), 0);
    while taken < MOST && (taken == 0 || began.elapsed() < LONGEST) {
        step()?;
        taken += 1;
    }
    let each = began.elapsed().as_secs_f64() / taken as f64;
    Ok(Estimate {
        seconds: each * (scene.time.end_s / dt).ceil(),
        basis: format!("{:.3} ms a step of {dt:.2e} s, as the first", 1e3 * each),
        memory: Vec::new(),
    })
}
