//! A run from the first step to the last: what is written when, and what stops it.

use particles::{POSITION, sweep};
use run::{Failure, Session};
use steps::{Limit, even, instants};

use crate::assemble::Assembled;
use crate::balance::Balance;
use crate::frames;
use crate::resume;
use crate::scene::Scene;
use crate::stage::{StageError, place_text};
use crate::state::{State, VELOCITY};

/// More steps than this never end.
const STEPS_MOST: f64 = 1e9;
/// All numbers of the state are looked at once in so many steps, and before anything is kept.
const WATCH_STEPS: u64 = 50;
/// Shares of the progress bar.
const SHARES: f64 = 1e4;

/// Why a run would never end.
pub(crate) fn endless(scene: &Scene, limit: Limit) -> Option<String> {
    let steps = scene.time.end_s
        / limit
            .seconds
            .min(scene.time.step_s.unwrap_or(f64::INFINITY));
    // A limit that is no number is none that can be kept.
    (steps.is_nan() || steps > STEPS_MOST).then(|| {
        let Limit { seconds, name, .. } = limit;
        let end = scene.time.end_s;
        format!(
            "{end} s is {steps:.1e} steps of {seconds:.3e} s, the limit of '{name}'; at most {STEPS_MOST:.0e}"
        )
    })
}

/// Runs the scene.
///
/// # Errors
/// Divergence, the disk, the user.
pub fn run(scene: &Scene, run: Assembled, session: &mut Session) -> Result<(), Failure> {
    let mut simulation = Simulation::begin(scene, run, session)?;
    while simulation.run.state.time < scene.time.end_s {
        simulation.step(session)?;
    }
    simulation.close(session);
    Ok(())
}

/// A run under way.
struct Simulation<'a> {
    scene: &'a Scene,
    run: Assembled,
    start: Balance,
}

impl<'a> Simulation<'a> {
    /// Starts afresh, or where the checkpoint stands.
    fn begin(scene: &'a Scene, mut run: Assembled, session: &mut Session) -> Result<Self, Failure> {
        if let Some(mut checkpoint) = session.restored() {
            let start = resume::restore(&mut checkpoint, &mut run.state, &mut run.march)?;
            return Ok(Self { scene, run, start });
        }
        run.march
            .begin(&mut run.state)
            .map_err(|e| failure(e, &run.state))?;
        let start = Balance::of(&run.state, &run.march);
        let mut simulation = Self { scene, run, start };
        simulation.write(0.0, session)?;
        Ok(simulation)
    }

    /// The next time at which something is due \[s\].
    fn next_event(&self) -> f64 {
        let (time, output) = (self.run.state.time, &self.scene.output);
        let end = self.scene.time.end_s;
        let intervals = [output.frames_interval_s, output.balance_interval()];
        let events = intervals.map(|interval| instants::after(time, interval, end));
        events.into_iter().fold(end, f64::min)
    }

    /// One step: the way to the next event in equal parts, each within all limits.
    fn step(&mut self, session: &mut Session) -> Result<(), Failure> {
        let limit = self.run.march.limit(&self.run.state);
        if let Some(limit) = limit {
            session.limit(&format!("step_{}", limit.name), limit.seconds, "s");
            if let Some(what) = endless(self.scene, limit) {
                return Err(Failure::Diverged {
                    step: self.run.state.step,
                    time_s: self.run.state.time,
                    place: format!("the limit of '{}'", limit.name),
                    quantity: "step [s]".to_owned(),
                    what,
                });
            }
        }
        let given = self.scene.time.step_s.unwrap_or(f64::INFINITY);
        let longest = limit.map_or(given, |limit| limit.seconds.min(given));
        let (time, event) = (self.run.state.time, self.next_event());
        let parts = even::parts(event - time, longest);
        let dt = (event - time) / parts;
        if limit.is_some_and(|limit| limit.seconds < given) && self.scene.time.step_s.is_some() {
            session.substepped();
        }
        let Assembled { march, state, .. } = &mut self.run;
        march
            .step(state, dt, &mut |name, work| session.timed(name, work))
            .map_err(|e| failure(e, state))?;
        let arrived = parts < 1.5;
        state.time = if arrived { event } else { time + dt };
        if state.step.is_multiple_of(WATCH_STEPS) {
            watch(state)?;
        }
        if arrived {
            self.write(dt, session)?;
        }
        let (state, march, start) = (&self.run.state, &self.run.march, &self.start);
        let done = (SHARES * state.time / self.scene.time.end_s) as u64;
        session.progress(done, SHARES as u64, || status(state, march, dt, start));
        session.steps(state.step);
        session.keep(|checkpoint| resume::save(checkpoint, state, march, start))
    }

    /// Writes all that is due at the present time.
    fn write(&mut self, dt: f64, session: &mut Session) -> Result<(), Failure> {
        let Assembled { march, state, .. } = &mut self.run;
        let output = &self.scene.output;
        let (time, end) = (state.time, self.scene.time.end_s);
        let is_due = |interval: f64| instants::is_at(time, interval) || time >= end;
        watch(state)?;
        if is_due(output.frames_interval_s) {
            for stage in &march.stages {
                stage.show(state);
            }
            frames::write(state, output.precision, session)?;
        }
        if is_due(output.balance_interval()) {
            let balance = Balance::of(state, march);
            let mut record = balance
                .record(state.time, &self.start)
                .with("step_s", "s", dt);
            for figure in march.stages.iter().flat_map(|stage| stage.figures(state)) {
                record = record.with(&figure.name, figure.unit, figure.value);
            }
            session.record("/balance", state.time, &record)?;
        }
        Ok(())
    }

    /// Totals and memory for the record.
    fn close(&self, session: &mut Session) {
        let Assembled { march, state, .. } = &self.run;
        let balance = Balance::of(state, march);
        for (name, unit, value) in balance.closing(&self.start) {
            session.closing(name, unit, value);
        }
        for figure in march.stages.iter().flat_map(|stage| stage.closing(state)) {
            session.closing(&figure.name, figure.unit, figure.value);
        }
        if let Some(warning) = balance.unclosed(&self.start) {
            session.warn(warning);
        }
        for warning in march.stages.iter().filter_map(|stage| stage.warning(state)) {
            session.warn(warning);
        }
        for (name, bytes) in state.memory() {
            session.memory(&name, bytes as u64);
        }
        for stage in march.stages.iter().filter(|stage| stage.bytes() > 0) {
            session.memory(stage.name(), stage.bytes() as u64);
        }
    }
}

/// Numbers for the status row.
fn status(
    state: &State,
    march: &crate::march::March,
    dt: f64,
    start: &Balance,
) -> Vec<(&'static str, f64, &'static str)> {
    let balance = Balance::of(state, march);
    vec![
        ("time", state.time, "s"),
        ("step", dt, "s"),
        ("kinetic", balance.kinetic, "J"),
        ("stored", balance.entry.stored - start.entry.stored, "J"),
        ("energy_error", balance.energy_error(start), ""),
    ]
}

/// Stops the run where a number is none.
fn watch(state: &State) -> Result<(), Failure> {
    for set in &state.sets {
        let sums = |column: &[[f64; 3]]| {
            let worst = sweep::greatest(column.len(), |a| {
                let [x, y, z] = column[a];
                let sum = x + y + z;
                if sum.is_finite() { 0.0 } else { f64::NAN }
            });
            worst.filter(|(_, value)| value.is_nan()).map(|(a, _)| a)
        };
        let found = [
            ("position [m]", set.column(&POSITION)),
            ("velocity [m/s]", set.column(&VELOCITY)),
        ];
        for (quantity, column) in found {
            if let Some(a) = sums(column) {
                return Err(Failure::Diverged {
                    step: state.step,
                    time_s: state.time,
                    place: format!(
                        "particle {a} of {} at {}",
                        set.name(),
                        place_text(set.column(&POSITION)[a])
                    ),
                    quantity: quantity.to_owned(),
                    what: format!("is {:?}", column[a]),
                });
            }
        }
    }
    Ok(())
}

/// The failure of a stage.
#[must_use]
pub fn failure(error: StageError, state: &State) -> Failure {
    match error {
        StageError::Diverged {
            set,
            particle,
            place,
            quantity,
            what,
        } => Failure::Diverged {
            step: state.step,
            time_s: state.time,
            place: format!("particle {particle} of {set} at {}", place_text(place)),
            quantity: quantity.to_owned(),
            what,
        },
        StageError::Data(what) => Failure::Other(what),
    }
}
