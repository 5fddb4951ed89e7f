//! A few steps taken to tell how long a run will last.

use std::time::{Duration, Instant};

use run::{Estimate, Failure, Inputs, duration};

use crate::assemble::{Assembled, assemble};
use crate::scene::{Scene, StartState};

/// Steps ahead of those that are timed: they fill the lists.
const WARM: u64 = 2;
/// The timed steps end with this number or after this time.
const MOST: u64 = 50;
const LONGEST: Duration = Duration::from_millis(500);

/// Time of the whole run, if every step lasts as long as the first ones.
///
/// # Errors
/// What assembling or a step reports.
pub(crate) fn estimate(scene: &Scene, inputs: &Inputs) -> Result<Estimate, Failure> {
    let Assembled {
        mut march,
        mut state,
        ..
    } = assemble(scene, inputs)?;
    let total = scene.steps();
    let mut step = || {
        let done = march.step(&mut state, u64::MAX, |_, work| work());
        done.map_err(|e| Failure::Other(e.to_string()))
    };
    for _ in 0..WARM.min(total) {
        step()?;
    }
    let began = Instant::now();
    let (mut taken, mut passed) = (0, 0);
    while taken < MOST && (taken == 0 || began.elapsed() < LONGEST) {
        passed += step()?.stride;
        taken += 1;
    }
    let spent = began.elapsed().as_secs_f64();
    let each = spent / taken as f64;
    Ok(Estimate {
        seconds: spent / passed as f64 * total as f64,
        basis: if scene.has_metal() {
            format!(
                "{} a step, with the {} liquid particles of the start",
                short(each),
                state.liquid()
            )
        } else {
            format!("{} a step", short(each))
        },
        memory: Vec::new(),
    })
}

/// Why steps become longer than those that are timed: a pool that is still to melt.
pub(crate) fn grows(scene: &Scene) -> Option<&'static str> {
    let melts = scene.heat.as_ref().is_some_and(|h| h.melting.is_some()) && scene.flow.is_some();
    let fed = scene.arc.is_some() || scene.wires().next().is_some();
    let dry = scene.bodies.iter().all(|b| b.state != StartState::Liquid);
    (melts && fed && dry).then_some("steps last longer once there is a pool")
}

/// Milliseconds with digits where they are few.
fn short(seconds: f64) -> String {
    if seconds < 0.1 {
        format!("{:.2} ms", 1e3 * seconds)
    } else {
        duration(seconds)
    }
}
