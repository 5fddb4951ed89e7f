//! The march from start to end: steps, outputs, checkpoints.

use run::{Failure, Session};
use steps::control::suited;
use steps::even;
use steps::instants::Instant;

use crate::course::Course;
use crate::course::prescribed::Heat;
use crate::frames::Output;
use crate::march::choice::{Steps, method};
use crate::march::{Method, State, StepError, nothing, too_cold};
use crate::pace::Pace;
use crate::scene::Scene;
use crate::scene::method::Beyond;
use crate::system::{Rates, System, extent};

/// Shortest step over the whole time.
const SHORTEST: f64 = 1e-14;
/// Part of the explicit limit that is used where no step is given.
const LIMIT: f64 = 0.9;
/// Shares of the progress bar.
const SHARES: f64 = 1e4;

/// A march under way.
struct March<'a> {
    system: &'a mut System,
    method: Box<dyn Method>,
    steps: Steps,
    state: State,
    rates: Rates,
    pace: Pace,
    course: Course,
    end: f64,
    /// Why the last step failed that was not too rough.
    failed: Option<StepError>,
}

/// Marches to the end.
///
/// # Errors
/// When the numerics diverge, the user interrupts or the disk refuses.
pub fn march(
    scene: &Scene,
    system: &mut System,
    temperature: Vec<f64>,
    session: &mut Session,
) -> Result<(), Failure> {
    let Some(time) = &scene.time else {
        return Ok(());
    };
    let (method, steps) = method(scene, system);
    let mut output = Output::new(scene, system, &temperature);
    let mut march = March {
        course: Course::new(system, &temperature, time.end_s),
        state: State::new(system, temperature),
        system,
        method,
        steps,
        rates: Rates::default(),
        pace: Pace::default(),
        end: time.end_s,
        failed: None,
    };
    let events = output.events();
    let resumed = session.restored();
    let fresh = resumed.is_none();
    if let Some(mut checkpoint) = resumed {
        let method = &mut *march.method;
        (march.pace, march.state) = Pace::restore(&mut checkpoint, march.system, method)?;
    }
    march.begin(session, fresh)?;
    while march.pace.next < events.len() {
        let event = events[march.pace.next];
        march.toward(event, session)?;
        march.write(&mut output, event, session)?;
        march.keep(session)?;
    }
    march.close(&output, session)
}

impl March<'_> {
    /// Rates at the start, the scale of errors and the first step.
    fn begin(&mut self, session: &mut Session, fresh: bool) -> Result<(), Failure> {
        self.evaluate()?;
        let limit = self.system.explicit_limit(&self.rates);
        if fresh {
            let (low, high) = self.system.surface.extent(extent(&self.state.temperature));
            let skin = self.system.skin(&self.state.temperature, &self.rates);
            self.pace.range = (high - low).max(skin).max(self.course.range);
            self.pace.limit = limit;
            self.pace.step = match self.steps {
                Steps::Given(step, _) => step,
                _ => LIMIT * limit.min(self.end),
            };
            session.limit("step_explicit", limit, "s");
        }
        Ok(())
    }

    /// Rates of the state; tables are widened where they end.
    fn evaluate(&mut self) -> Result<(), Failure> {
        let reached = self.system.reach(&self.state.temperature).map(|_| ());
        reached
            .and_then(|()| {
                self.system
                    .rates(self.state.time, &self.state.temperature, &mut self.rates)
            })
            .map_err(|error| self.diverged("property", &error.to_string(), None))
    }

    /// Steps until the event.
    fn toward(&mut self, event: Instant, session: &mut Session) -> Result<(), Failure> {
        while self.state.time < event.time {
            if let Some(after) = self.course.jump(self.state.time) {
                self.jump(after)?;
                continue;
            }
            let until = self.course.until(self.state.time, event.time);
            let step = self.length(until, session)?;
            self.take(step, until, session)?;
            let done = (SHARES * self.state.time / self.end) as u64;
            let (state, rates, pace) = (&self.state, &self.rates, &self.pace);
            session.progress(done.min(SHARES as u64), SHARES as u64, || {
                let (low, high) = extent(&state.temperature);
                vec![
                    ("time", state.time, "s"),
                    ("step", pace.taken[0], "s"),
                    ("least", low, "K"),
                    ("greatest", high, "K"),
                    (
                        "heat",
                        rates.entries.iter().sum::<f64>() + rates.source,
                        "W",
                    ),
                ]
            });
            session.steps(self.pace.steps);
            if self.state.time < event.time {
                self.keep(session)?;
            }
        }
        self.pace.next += 1;
        Ok(())
    }

    /// Keeps the march where a checkpoint is due.
    fn keep(&self, session: &mut Session) -> Result<(), Failure> {
        session.keep(|checkpoint| self.pace.save(&self.state, &*self.method, checkpoint))
    }

    /// Goes across a jump of what varies in time, to the first instant after it.
    fn jump(&mut self, after: f64) -> Result<(), Failure> {
        let before = self.state.temperature.clone();
        self.state.time = after;
        let held = self.state.hold(self.system);
        held.map_err(|error| self.diverged("property", &error.to_string(), None))?;
        self.state.settle(self.system, &before);
        self.evaluate()?;
        // What the last steps erred says nothing of the next.
        let limit = self.system.explicit_limit(&self.rates);
        self.pace.step = self.pace.step.min(LIMIT * limit);
        Ok(())
    }

    /// The length of the next step \[s\].
    fn length(&mut self, until: f64, session: &mut Session) -> Result<f64, Failure> {
        let step = self.plain_length(until, session)?;
        let longest = self.course.longest(self.state.time);
        let step = if step <= longest {
            step
        } else {
            if let Steps::Given(..) = self.steps {
                session.substepped();
            }
            if let (Steps::Given(..), false) = (self.steps, self.pace.substepped) {
                self.pace.substepped = true;
                session.note(format!(
                    "steps of {step:.3e} s are divided where what varies in time asks for {longest:.3e} s"
                ));
            }
            even::step(self.state.time, until, longest)
        };
        let whole = self.state.time + step >= until * (1.0 - f64::EPSILON);
        let jumps = self.course.jump(until).is_some();
        // No rounding may carry a step across a jump.
        Ok(if whole && jumps {
            step - 4.0 * f64::EPSILON * until
        } else {
            step
        })
    }

    /// The same, whatever varies in time \[s\].
    fn plain_length(&mut self, until: f64, session: &mut Session) -> Result<f64, Failure> {
        let time = self.state.time;
        let longest = self.method.longest(self.system, &self.rates);
        self.pace.limit = self.pace.limit.min(self.system.explicit_limit(&self.rates));
        match self.steps {
            Steps::Limited => Ok(even::step(time, until, LIMIT * longest)),
            Steps::Controlled { .. } => Ok(even::toward(time, until, self.pace.step.min(longest))),
            Steps::Given(step, beyond) => {
                let step = even::step(time, until, step);
                if step <= longest * (1.0 + 1e-9) {
                    return Ok(step);
                }
                if beyond == Beyond::Refuse {
                    let what = format!(
                        "a step of {step:.3e} s is beyond the explicit limit of {longest:.3e} s"
                    );
                    return Err(self.diverged("step", &what, None));
                }
                let parts = (step / longest).ceil();
                session.substepped();
                if !self.pace.substepped {
                    self.pace.substepped = true;
                    session.note(format!(
                        "steps of {step:.3e} s are beyond the limit of {longest:.3e} s: they are divided by {parts} and more"
                    ));
                }
                Ok(step / parts)
            }
        }
    }

    /// Takes a step; one that errs too much is taken again, shorter.
    fn take(&mut self, step: f64, until: f64, session: &mut Session) -> Result<(), Failure> {
        let (state, rates) = (self.state.clone(), self.rates.clone());
        let mut step = step;
        loop {
            let last = (until - state.time - step).abs() <= 1e-12 * until;
            let taken = session.timed("march", || {
                let (state, rates) = (&mut self.state, &mut self.rates);
                self.method.advance(self.system, state, rates, step)
            });
            let verdict = self.judge(taken, step)?;
            if let Some(shorter) = verdict {
                self.state.clone_from(&state);
                self.rates.clone_from(&rates);
                if shorter < SHORTEST * self.end {
                    let why = self.failed.take().map(|failed| format!(": {failed}"));
                    let what = format!("no step is short enough{}", why.unwrap_or_default());
                    return Err(self.diverged("step", &what, None));
                }
                if shorter < step {
                    self.pace.rejected += 1;
                } else {
                    // The tables have grown: the same step again, from rates of the wider tables.
                    self.evaluate()?;
                }
                step = shorter;
                continue;
            }
            if last {
                self.state.time = until;
            }
            self.pace.steps += 1;
            self.pace.taken = [self.pace.taken[0].max(step), self.pace.taken[1].min(step)];
            let (low, high) = extent(&self.state.temperature);
            self.pace.range = self.pace.range.max(high - low);
            return Ok(());
        }
    }

    /// Whether a step is good: none, or the step to take instead \[s\].
    fn judge(&mut self, taken: Result<f64, StepError>, step: f64) -> Result<Option<f64>, Failure> {
        let controlled = matches!(self.steps, Steps::Controlled { .. });
        let error = match taken {
            Ok(error) => error,
            Err(failed @ StepError::Solve(_)) if controlled => {
                self.failed = Some(failed);
                return Ok(Some(0.25 * step));
            }
            Err(failed) => return Err(self.diverged("temperature", &failed.to_string(), None)),
        };
        if let Some(i) = self.state.lost() {
            if controlled {
                return Ok(Some(0.25 * step));
            }
            return Err(self.diverged("temperature [K]", "no number any more", Some(i)));
        }
        let grown = self.system.reach(&self.state.temperature);
        if grown.map_err(|error| self.diverged("property", &error.to_string(), None))? {
            return Ok(Some(step));
        }
        let (low, high) = extent(&self.state.temperature);
        self.pace.erred(error, nothing(low, high));
        if let Steps::Controlled { tolerance, floor } = self.steps {
            let wanted = tolerance * self.pace.range.max(high - low);
            let floor = floor.unwrap_or_else(|| nothing(low, high));
            let ratio = error / wanted.max(floor).max(f64::MIN_POSITIVE);
            if ratio.is_nan() {
                return Ok(Some(0.25 * step));
            }
            let next = suited(step, ratio);
            if ratio > 1.0 {
                return Ok(Some(next));
            }
            // A step that was cut short by an output says little of the next.
            self.pace.step = if step < 0.5 * self.pace.step {
                next.max(self.pace.step)
            } else {
                next
            };
        }
        if let Some(i) = self.state.cold(self.pace.strays(self.steps)) {
            let what = too_cold(self.state.temperature[i], self.system.takes());
            return Err(self.diverged("temperature [K]", &what, Some(i)));
        }
        Ok(None)
    }

    fn write(
        &mut self,
        output: &mut Output,
        event: Instant,
        session: &mut Session,
    ) -> Result<(), Failure> {
        let (low, _) = extent(&self.state.temperature);
        self.pace.mark(event.time, low);
        output.write(self.system, &self.state, &self.rates, event, session)
    }

    fn diverged(&self, quantity: &str, what: &str, point: Option<usize>) -> Failure {
        let place = point.map_or("all points".to_owned(), |i| self.system.spot(i));
        Failure::Diverged {
            step: self.pace.steps + 1,
            time_s: self.state.time,
            place,
            quantity: quantity.to_owned(),
            what: what.to_owned(),
        }
    }

    /// Heat prescribed beside heat delivered. A run that is interrupted here keeps the end of its march, from which this
    /// alone is left to do.
    fn heats(&self, session: &mut Session) -> Result<Vec<Heat>, Failure> {
        let halt = session.interrupt();
        let heats = session.timed("prescribed heat", || {
            self.course.heat(self.system, &self.state, &halt)
        });
        let heats = heats.map_err(|error| self.diverged("property", &error.to_string(), None))?;
        if heats.is_none() {
            self.keep(session)?;
        }
        Ok(heats.unwrap_or_default())
    }

    /// Tells heat prescribed beside heat delivered, and what was not resolved.
    fn compare(&self, heats: Vec<Heat>, session: &mut Session) {
        if self.rates.hidden {
            session.warn(crate::source::HIDDEN);
        }
        let content = self.system.storage.varies();
        if content.is_some_and(|content| !content.is_resolved()) {
            session.warn(
                "density times specific heat has more peaks over temperature than could be followed: heat may be missed",
            );
        }
        if !self.course.resolved {
            session.warn(
                "what varies in time has more jumps and peaks than could be followed: heat may have been missed",
            );
        }
        let unit = if self.system.cloud.dimensions == 2 {
            "J/m"
        } else {
            "J"
        };
        for heat in heats {
            let (name, asked, came) = (&heat.name, heat.prescribed, heat.delivered);
            session.closing(&format!("heat_prescribed {name}"), unit, asked);
            session.closing(&format!("heat_delivered {name}"), unit, came);
            if !heat.holds() {
                session.warn(format!(
                    "{name}: {came:.6e} {unit} of heat were delivered, {asked:.6e} {unit} are prescribed; shorter steps follow what varies in time better"
                ));
            }
        }
    }

    fn close(&self, output: &Output, session: &mut Session) -> Result<(), Failure> {
        let heats = self.heats(session)?;
        session.steps(self.pace.steps);
        session.limit("step_explicit_least", self.pace.limit, "s");
        session.closing("step_greatest", "s", self.pace.taken[0]);
        session.closing("step_least", "s", self.pace.taken[1]);
        if matches!(self.steps, Steps::Controlled { .. }) {
            session.closing("steps_rejected", "1", self.pace.rejected as f64);
        }
        for (name, value) in self.method.report() {
            session.closing(name, "1", value);
        }
        output.close(self.system, &self.state, session);
        self.pace.tell(session);
        self.compare(heats, session);
        Ok(())
    }
}
