//! The march in time: knows stages, not physics.

use steps::{Figure, Limit, Strides};

use crate::stage::{Stage, StageError};
use crate::state::State;

/// Stages that belong together, in order.
pub struct Group {
    /// For example `heat`.
    pub name: &'static str,
    /// Whether the moving particles are gathered ahead of it: it begins to work on [`State::near`].
    pub gathers: bool,
    /// May be none.
    pub stages: Vec<Box<dyn Stage>>,
}

impl Group {
    /// No stages yet.
    #[must_use]
    pub fn new(name: &'static str) -> Self {
        Self {
            name,
            gathers: false,
            stages: Vec::new(),
        }
    }

    /// The same, with the moving particles gathered ahead.
    #[must_use]
    pub fn gathering(mut self) -> Self {
        self.gathers = true;
        self
    }

    /// The same, with the given stages.
    #[must_use]
    pub fn of(mut self, stages: Vec<Box<dyn Stage>>) -> Self {
        self.stages = stages;
        self
    }
}

/// Groups of stages in the order of a step; see [`crate::stage`].
pub struct March {
    groups: Vec<Group>,
    strides: Strides,
}

/// How a step went.
#[derive(Debug, Clone, Copy)]
pub struct Stepped {
    /// Step taken \[s\].
    pub dt: f64,
    /// Steps of the scene's length that it holds.
    pub stride: u64,
    /// The smallest limit and who set it, if any stage has one.
    pub limit: Option<Limit>,
    /// Whether a stage has divided the step.
    pub divided: bool,
}

impl March {
    /// A march of step `dt` \[s\].
    #[must_use]
    pub fn new(groups: Vec<Group>, dt: f64) -> Self {
        Self {
            groups,
            strides: Strides::even(dt),
        }
    }

    /// The same with steps that hold up to `greatest` of the given length.
    #[must_use]
    pub fn adaptive(mut self, greatest: u64) -> Self {
        self.strides.greatest = greatest;
        self
    }

    /// How long its steps are.
    #[must_use]
    pub fn strides(&self) -> &Strides {
        &self.strides
    }

    /// The same, to restore it.
    pub fn strides_mut(&mut self) -> &mut Strides {
        &mut self.strides
    }

    /// All stages in order.
    pub fn stages(&self) -> impl Iterator<Item = &dyn Stage> {
        let groups = self.groups.iter();
        groups.flat_map(|group| group.stages.iter().map(AsRef::as_ref))
    }

    /// All stages in order, to restore them.
    pub fn stages_mut(&mut self) -> impl Iterator<Item = &mut Box<dyn Stage>> {
        self.groups.iter_mut().flat_map(|group| &mut group.stages)
    }

    /// The smallest limit of all stages.
    #[must_use]
    pub fn limit(&self, state: &State) -> Option<Limit> {
        Limit::least(self.stages().filter_map(|stage| stage.limit(state)))
    }

    /// Fills the columns that only frames show.
    pub fn show(&self, state: &mut State) {
        self.stages().for_each(|stage| stage.show(state));
    }

    /// Takes one step, which does not go beyond `until` steps of the scene's length. `timed` wraps each stage so that a
    /// clock can stand outside: it is given the stage's name and must call the work exactly once.
    ///
    /// The step is the scene's, or a whole number of these where steps are adaptive; a stage that cannot take it whole
    /// divides it within itself, so that frames and droplets keep their times.
    ///
    /// # Errors
    /// What a stage reports.
    pub fn step(
        &mut self,
        state: &mut State,
        until: u64,
        mut timed: impl FnMut(
            &'static str,
            &mut dyn FnMut() -> Result<(), StageError>,
        ) -> Result<(), StageError>,
    ) -> Result<Stepped, StageError> {
        if self.strides.grows() {
            let longest = self.stages().map(|stage| stage.follows(state));
            let longest = longest.fold(f64::INFINITY, f64::min);
            let marks = self.stages().filter_map(|stage| stage.next(state.time));
            let mark = marks.fold(f64::INFINITY, f64::min);
            self.strides.choose(state.step, until, mark, longest);
        }
        state.stride = self.strides.stride;
        let dt = self.strides.step();
        for group in &mut self.groups {
            if group.gathers {
                timed("gather", &mut || {
                    state.gather();
                    Ok(())
                })?;
            }
            for stage in &mut group.stages {
                timed(stage.name(), &mut || stage.advance(state, dt))?;
            }
        }
        state.time = state.end(dt);
        state.step += state.stride;
        self.strides.taken += 1;
        Ok(Stepped {
            dt,
            stride: state.stride,
            limit: self.limit(state),
            divided: self.stages().any(|stage| stage.parts() > 1),
        })
    }

    /// Numbers of all stages after the last step, each with its stage's name.
    #[must_use]
    pub fn figures(&self) -> Vec<(&'static str, Figure)> {
        self.stages()
            .flat_map(|stage| {
                stage
                    .figures()
                    .into_iter()
                    .map(|figure| (stage.name(), figure))
            })
            .collect()
    }
}
