//! What stops a run: steps that never end, particles too fast for any step, numbers that are none.

use particles::{POSITION, Store};
use run::Failure;
use shapes::frame::squared;
use steps::{Beyond, Limit};

use crate::stage::StageError;
use crate::state::State;

/// A step that would be divided into more parts than this is refused: it would never end.
const PARTS_MOST: f64 = 1e4;
/// A particle that crosses so many diameters in a step belongs to no flow.
const LEAP: f64 = 12.8;

/// Why a step so far beyond its limit cannot be taken.
pub(crate) fn endless(dt: f64, limit: Limit) -> Option<String> {
    let parts = dt / limit.seconds;
    // A limit that is no number is none that can be kept.
    (parts.is_nan() || parts > PARTS_MOST).then(|| {
        let Limit { seconds, name, .. } = limit;
        format!(
            "{dt} s is {parts:.1e} times the limit of '{name}', {seconds:.3e} s; \
             a step is divided into at most {PARTS_MOST:.0e} parts"
        )
    })
}

/// Why a step beyond a limit that nothing divides cannot be taken.
pub(crate) fn undivided(dt: f64, limit: Limit) -> Option<String> {
    let Limit { seconds, name, .. } = limit;
    let beyond = limit.is_passed(dt) && limit.beyond == Beyond::Refuses;
    beyond.then(|| {
        format!("{dt} s is beyond the limit of '{name}', {seconds:.3e} s, and nothing divides it")
    })
}

/// Stops the run where a particle has become too fast for any step.
pub(crate) fn bounded(state: &State, dt: f64) -> Result<(), Failure> {
    let limit = LEAP * state.metal.matter.spacing / dt;
    let near = &state.near;
    if near.fastest_squared() <= limit * limit {
        return Ok(());
    }
    let speeds = near.velocity.iter().map(|u| squared(*u).sqrt());
    let leaps = |(_, speed): &(usize, f64)| speed.is_nan() || *speed > limit;
    let Some((member, speed)) = speeds.enumerate().find(leaps) else {
        return Ok(());
    };
    let a = near.id[member] as usize;
    Err(Failure::Diverged {
        step: state.step,
        time_s: state.time,
        place: place(a, state.metal.column(&POSITION)[a]),
        quantity: "speed [m/s]".to_owned(),
        what: format!("is {speed:.4e} m/s, beyond {limit:.4e} m/s"),
    })
}

/// Stops the run where a number is none.
pub(crate) fn watch(state: &State) -> Result<(), Failure> {
    for column in state.metal.declared().filter(|column| column.saved) {
        let sum = |[x, y, z]: &[f64; 3]| x + y + z;
        let none = |x: &f64| !x.is_finite();
        let found = match column.values {
            Store::Scalars(values) => values.iter().copied().enumerate().find(|(_, x)| none(x)),
            Store::Vectors(values) => {
                let sums = values.iter().map(sum);
                sums.enumerate().find(|(_, x)| none(x))
            }
            _ => None,
        };
        if let Some((a, value)) = found {
            return Err(Failure::Diverged {
                step: state.step,
                time_s: state.time,
                place: place(a, state.metal.column(&POSITION)[a]),
                quantity: format!("{} [{}]", column.name, column.unit),
                what: format!("is {value}"),
            });
        }
    }
    Ok(())
}

/// An error of a stage as the failure of the run.
pub(crate) fn failure(error: StageError, time_s: f64) -> Failure {
    match error {
        StageError::Diverged {
            step,
            particle,
            place: at,
            quantity,
            value,
            limit,
            unit,
        } => Failure::Diverged {
            step,
            time_s,
            place: place(particle, at),
            quantity: format!("{quantity} [{unit}]"),
            what: format!("is {value:.4e} {unit}, beyond {limit:.4e} {unit}"),
        },
        StageError::Data(what) => Failure::Other(what),
    }
}

/// A particle by number and place.
pub(crate) fn place(particle: usize, x: [f64; 3]) -> String {
    format!(
        "particle {particle} at ({:.4e}, {:.4e}, {:.4e}) m",
        x[0], x[1], x[2]
    )
}
