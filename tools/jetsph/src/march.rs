//! The march in time: knows stages, not physics.
//!
//! ```text
//! kick      u += dt/2 a               velocity Verlet: of second order, and it keeps the energy of a solid for ever
//! drift     x += dt u                 in two halves where there is water
//! flow      rho += dt d(rho)/dt       between them: with x and u of the middle of the step
//! act       every stage adds to a     in the order of the list; then impulses that some have for others
//! kick      u += dt/2 a
//! exchange  particles come and leave
//! ```
//!
//! The midpoint rule of Shinohara et al. (2004, eqs 41 and 42) sees everything twice a step, and lets sound grow: by
//! 1 + (omega dt)^4/8 a step without friction. Here density is taken by the midpoint rule and motion by Verlet: both see
//! the pairs once, and sound keeps its energy up to omega dt = 2.

use particles::{POSITION, sweep};
use steps::Limit;

use crate::stage::{Stage, StageError};
use crate::state::{ACCELERATION, DENSITY, DENSITY_RATE, State, VELOCITY};

/// Stages in the order of a step.
pub struct March {
    /// The stages.
    pub stages: Vec<Box<dyn Stage>>,
}

/// Wraps the work of a stage, so that a clock can stand outside: given the stage's name, it must call the work once.
pub type Timed<'a> = dyn FnMut(&'static str, &mut dyn FnMut() -> Result<(), StageError>) -> Result<(), StageError>
    + 'a;

impl March {
    /// The smallest limit of all stages.
    #[must_use]
    pub fn limit(&self, state: &State) -> Option<Limit> {
        Limit::least(self.stages.iter().filter_map(|stage| stage.limit(state)))
    }

    /// Accelerations at the start.
    ///
    /// # Errors
    /// What a stage reports.
    pub fn begin(&mut self, state: &mut State) -> Result<(), StageError> {
        self.act(state, 0.0, &mut |_, work| work())
    }

    /// One step of `dt` \[s\].
    ///
    /// # Errors
    /// What a stage reports.
    pub fn step(
        &mut self,
        state: &mut State,
        dt: f64,
        timed: &mut Timed<'_>,
    ) -> Result<(), StageError> {
        let flows = self.stages.iter().any(|stage| stage.flows());
        timed("motion", &mut || {
            kick(state, 0.5 * dt);
            drift(state, if flows { 0.5 * dt } else { dt });
            Ok(())
        })?;
        if flows {
            self.flow(state, dt, timed)?;
            drift(state, 0.5 * dt);
        }
        self.act(state, dt, timed)?;
        timed("motion", &mut || {
            kick(state, 0.5 * dt);
            Ok(())
        })?;
        for stage in &mut self.stages {
            stage.exchange(state, dt)?;
        }
        state.step += 1;
        Ok(())
    }

    fn flow(
        &mut self,
        state: &mut State,
        dt: f64,
        timed: &mut Timed<'_>,
    ) -> Result<(), StageError> {
        for set in &mut state.sets {
            set.column_mut(&DENSITY_RATE).fill(0.0);
        }
        for stage in &mut self.stages {
            stage.look(state, state.time + 0.5 * dt);
        }
        for stage in self.stages.iter_mut().filter(|stage| stage.flows()) {
            timed(stage.name(), &mut || stage.flow(state, dt))?;
        }
        condense(state, dt);
        Ok(())
    }

    fn act(&mut self, state: &mut State, dt: f64, timed: &mut Timed<'_>) -> Result<(), StageError> {
        for set in &mut state.sets {
            set.column_mut(&ACCELERATION).fill([0.0; 3]);
        }
        for stage in &mut self.stages {
            stage.look(state, state.time + dt);
        }
        for stage in &mut self.stages {
            timed(stage.name(), &mut || stage.act(state, dt))?;
        }
        for stage in &mut self.stages {
            stage.receive(state, dt);
        }
        Ok(())
    }
}

/// u += dt a.
fn kick(state: &mut State, dt: f64) {
    for set in &mut state.sets {
        let mut velocity = set.take(&VELOCITY);
        let acceleration = set.column(&ACCELERATION);
        if !acceleration.is_empty() {
            sweep::change(&mut velocity, |a, u| {
                (0..3).for_each(|k| u[k] += dt * acceleration[a][k]);
            });
        }
        set.put(&VELOCITY, velocity);
    }
}

/// rho += dt d(rho)/dt.
fn condense(state: &mut State, dt: f64) {
    for set in state.sets.iter_mut().filter(|set| set.has(&DENSITY)) {
        let mut density = set.take(&DENSITY);
        let rate = set.column(&DENSITY_RATE);
        sweep::change(&mut density, |a, rho| *rho += dt * rate[a]);
        set.put(&DENSITY, density);
    }
}

/// x += dt u.
fn drift(state: &mut State, dt: f64) {
    for set in &mut state.sets {
        let mut position = set.take(&POSITION);
        let velocity = set.column(&VELOCITY);
        sweep::change(&mut position, |a, x| {
            (0..3).for_each(|k| x[k] += dt * velocity[a][k]);
        });
        set.put(&POSITION, position);
    }
}
