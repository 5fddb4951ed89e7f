//! Eddy currents in time: two stages of an implicit Runge-Kutta method of second order that damps what
//! is stiff (SDIRK2, Alexander 1977, SIAM J. Numer. Anal. 14, 1006), so that a field may be switched on
//! at once.
//!
//! The equations are those of the sinusoidal steady state with `d/dt` for `j w`. In a stage this is `slope` times the
//! unknowns and what sources and memory drive, `slope (A + A_s - from)` with `slope = 1 / (gamma h)`. Rows without rates
//! (air, charges on conductors) hold at each stage, and so at the end of each step, which is the last stage.
//!
//! Of unknowns that follow from others at each instant, such as charges, the last stage knows the rate to first order
//! only. `gamma` times that of the first and `1 - gamma` times that of the last stage is the slope at the end of the
//! parabola through the values at start, first and last stage: of second order.

use krylov::{Error, Rescue, Rule, Solved};

/// `1 - 1/sqrt(2)`: with it the method is of second order and the last stage is the next state.
pub(crate) const GAMMA: f64 = 1.0 - std::f64::consts::FRAC_1_SQRT_2;

/// What a stage of a march of `step` \[s\] multiplies its unknowns by \[1/s\].
#[must_use]
pub fn slope(step: f64) -> f64 {
    1.0 / (GAMMA * step)
}

/// The equations of a stage.
pub trait Stage: Send {
    /// Makes them ready for another [`slope`].
    ///
    /// # Errors
    /// Where they cannot be factorised.
    fn pace(&mut self, slope: f64) -> Result<(), Error>;

    /// In which other way than it began it came to be solved, because that did not serve.
    fn rescued(&self) -> Option<Rescue>;

    /// Goes over to another way.
    ///
    /// # Errors
    /// Where the equations cannot be factorised.
    fn rescue(&mut self, way: Rescue) -> Result<(), Error>;

    /// What rates put into the rows of A, by unknown, with what is driven.
    fn moved(&self, driven: &[f64], unknown: &[f64]) -> Vec<f64>;

    /// What media whose permeability depends on the field took, where there are such.
    fn settled(&self) -> Option<Settled> {
        None
    }

    /// Solves them for `unknown`, which is the first guess: its rate is `slope` times it and what is `driven`; the
    /// sources are `wave` times themselves; `more` is what else stands on the right of the rows of A, or nothing.
    fn solve(
        &mut self,
        driven: &[f64],
        wave: f64,
        more: &[f64],
        unknown: &mut [f64],
        rule: Rule,
    ) -> Solved;
}

/// What solves with media whose permeability depends on the field took.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Settled {
    /// Steps of all solves.
    pub steps: u64,
    /// Largest change of the flux density in the last step of a solve \[T\].
    pub residual: f64,
    /// The same of solves that did not come to an end, with the point.
    pub lost: Option<(f64, usize)>,
}

impl Settled {
    /// Counts a solve that ended after so many steps with a change \[T\] at a point, `found` or not.
    pub fn count(&mut self, steps: u64, change: f64, point: usize, found: bool) {
        self.steps += steps;
        self.residual = self.residual.max(change);
        if !found {
            self.lose(change, point);
        }
    }

    fn lose(&mut self, change: f64, point: usize) {
        if self.lost.is_none_or(|(most, _)| change > most) {
            self.lost = Some((change, point));
        }
    }

    /// Both together.
    #[must_use]
    pub fn with(mut self, other: Self) -> Self {
        self.steps += other.steps;
        self.residual = self.residual.max(other.residual);
        if let Some((change, point)) = other.lost {
            self.lose(change, point);
        }
        self
    }
}

/// What a march has reached, by unknown.
#[derive(Debug, Clone, PartialEq)]
pub struct State {
    /// The unknown: the reaction, and what charges make after it.
    pub unknown: Vec<f64>,
    /// Sources and reaction together.
    pub total: Vec<f64>,
    /// Their rate in the last stage, over a second.
    pub change: Vec<f64>,
    /// The rate of those unknowns which follow from others at each instant, to second order.
    pub following: Vec<f64>,
}

/// A march from rest.
pub struct March<'a> {
    stage: Box<dyn Stage + 'a>,
    /// What sources give of the unknown where their wave is 1; those beyond it follow from the others.
    source: Vec<f64>,
    step: f64,
    state: State,
    driven: Vec<f64>,
}

impl<'a> March<'a> {
    /// A march of `step` \[s\], for the slope of which the stage is ready, with so many unknowns.
    #[must_use]
    pub fn new(stage: Box<dyn Stage + 'a>, source: Vec<f64>, unknowns: usize, step: f64) -> Self {
        let none = vec![0.0; unknowns];
        Self {
            stage,
            step,
            state: State {
                unknown: none.clone(),
                total: none.clone(),
                change: none.clone(),
                following: vec![0.0; unknowns - source.len()],
            },
            source,
            driven: none,
        }
    }

    /// Goes on in steps of another length \[s\].
    ///
    /// # Errors
    /// Those of the stage.
    pub fn pace(&mut self, step: f64) -> Result<(), Error> {
        self.step = step;
        self.stage.pace(slope(step))
    }

    /// What has been reached.
    #[must_use]
    pub fn state(&self) -> &State {
        &self.state
    }

    /// Takes the rates at the end of the last step from elsewhere.
    pub fn set_rates(&mut self, change: Vec<f64>) {
        self.state.change = change;
    }

    /// Takes back a step.
    pub fn set_back(&mut self, before: &State) {
        self.state.clone_from(before);
    }

    /// What media whose permeability depends on the field took, where there are such.
    #[must_use]
    pub fn settled(&self) -> Option<Settled> {
        self.stage.settled()
    }

    /// In which other way than they began stages came to be solved.
    #[must_use]
    pub fn rescued(&self) -> Option<Rescue> {
        self.stage.rescued()
    }

    /// Goes on from another unknown and total, in the other way if that march had come to it.
    ///
    /// # Errors
    /// Those of the stage.
    pub fn restore(
        &mut self,
        unknown: Vec<f64>,
        total: Vec<f64>,
        rescued: Option<Rescue>,
    ) -> Result<(), Error> {
        (self.state.unknown, self.state.total) = (unknown, total);
        rescued.map_or(Ok(()), |way| self.stage.rescue(way))
    }

    /// Makes a step that begins at `time` \[s\]; the sources follow `wave`.
    ///
    /// # Errors
    /// Those of `wave`.
    pub fn advance<E>(
        &mut self,
        time: f64,
        wave: impl Fn(f64) -> Result<f64, E>,
        rule: Rule,
    ) -> Result<[Solved; 2], E> {
        let early = wave(time + GAMMA * self.step)?;
        let late = wave(time + self.step)?;
        let first = self.stage(early, rule);
        let part = (1.0 - GAMMA) * self.step;
        let state = &mut self.state;
        for (total, change) in state.total.iter_mut().zip(&state.change) {
            *total += part * change;
        }
        let follow = self.source.len();
        state.following.copy_from_slice(&state.change[follow..]);
        let second = self.stage(late, rule);
        let state = &mut self.state;
        state.total.copy_from_slice(&state.unknown);
        for (total, source) in state.total.iter_mut().zip(&self.source) {
            *total += source * late;
        }
        let changes = state.following.iter_mut().zip(&state.change[follow..]);
        for (following, change) in changes {
            *following = GAMMA * *following + (1.0 - GAMMA) * change;
        }
        Ok([first, second])
    }

    /// A stage from the total of the state: its unknown, and the rate there.
    fn stage(&mut self, wave: f64, rule: Rule) -> Solved {
        let (slope, state) = (slope(self.step), &mut self.state);
        let sources = self.source.iter().copied();
        let sources = sources.chain(std::iter::repeat(0.0));
        for ((driven, total), source) in self.driven.iter_mut().zip(&state.total).zip(sources) {
            *driven = slope * (source * wave - total);
        }
        let unknown = &mut state.unknown;
        let solved = self.stage.solve(&self.driven, wave, &[], unknown, rule);
        let rates = state.change.iter_mut().zip(&state.unknown);
        for ((change, unknown), driven) in rates.zip(&self.driven) {
            *change = slope * unknown + driven;
        }
        solved
    }
}
