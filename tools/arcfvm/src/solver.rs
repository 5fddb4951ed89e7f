//! The algorithm (Komen 2019, figs 3.10 and 5.2).

use crate::case::Case;
use crate::current::magnetic::Magnetic;
use crate::current::potential::Potential;
use crate::error::Error;
use crate::flow::field::Flow;
use crate::flow::pressure::FlowSolver;
use crate::heat::balance::Balance;
use crate::heat::energy::Energy;
use crate::heat::sources::Sources;
use crate::properties::Properties;
use crate::residual::Residuals;
use crate::settings::{Advance, Settings};
use crate::vapour::field::Vapour;

/// Relaxation of the speed of the wire.
const FEED_RELAXATION: f64 = 0.1;
/// Tells how long the parts of an iteration take.
pub trait Stopwatch {
    /// Does `work` and books its time under `name`.
    fn timed<R>(&mut self, name: &'static str, work: impl FnOnce() -> R) -> R;
}

/// No clock.
impl Stopwatch for () {
    fn timed<R>(&mut self, _name: &'static str, work: impl FnOnce() -> R) -> R {
        work()
    }
}

/// Currents and their field.
#[derive(Debug, Clone)]
pub struct Electric {
    /// Potential and currents.
    pub potential: Potential,
    /// Magnetic field and Lorentz force.
    pub magnetic: Magnetic,
}

/// The flow and its solver.
#[derive(Debug, Clone)]
pub struct Flowing {
    /// Velocities and pressure.
    pub flow: Flow,
    pub(crate) solver: FlowSolver,
}

/// Temperatures and heat sources.
#[derive(Debug, Clone)]
pub struct Heating {
    /// Temperatures.
    pub energy: Energy,
    /// Sources of the last iteration.
    pub sources: Sources,
}

/// The arc: every solved field, iterated to a steady state.
#[derive(Debug, Clone)]
pub struct Arc {
    /// The problem.
    pub case: Case,
    pub(crate) advance: Advance,
    /// Iterations done.
    pub iteration: usize,
    /// Properties of every cell.
    pub properties: Properties,
    /// Currents, where solved.
    pub electric: Option<Electric>,
    /// Flow, where solved.
    pub flowing: Option<Flowing>,
    /// Heat, where solved.
    pub heating: Option<Heating>,
    /// Iron vapour, where solved.
    pub vapour: Option<Vapour>,
    /// Speed of the wire \[m/s\].
    pub feed: f64,
    /// Part of the bed of flux that changed when it was last looked at; none while its heat is too far from balance to look.
    pub(crate) boiled: Option<f64>,
    /// Part of all heat that was out of balance in the last iteration.
    pub(crate) unsettled: f64,
}

impl Arc {
    /// Memory for what `case` solves.
    #[must_use]
    pub fn new(case: Case, settings: Settings) -> Self {
        let (grid, solvers) = (&case.grid, settings.solvers);
        let electric = case.potential.as_ref().map(|_| Electric {
            potential: Potential::new(grid, solvers.potential),
            magnetic: Magnetic::new(grid),
        });
        let flowing = case.flow.as_ref().map(|setup| Flowing {
            flow: Flow::new(&case, setup),
            solver: FlowSolver::new(grid, solvers.momentum, solvers.pressure),
        });
        let heating = case.heat.as_ref().map(|_| Heating {
            energy: Energy::new(&case, solvers.energy.clone()),
            sources: Sources::default(),
        });
        let vapour = case.vapour.as_ref();
        let vapour = vapour.map(|setup| Vapour::new(&case, setup, solvers.energy));
        let properties = Properties::new(&case);
        let mut arc = Self {
            case,
            advance: settings.advance,
            iteration: 0,
            properties,
            electric,
            flowing,
            heating,
            vapour,
            feed: 0.0,
            boiled: None,
            unsettled: 1.0,
        };
        arc.feed = arc.first_feed();
        arc
    }

    /// Sets the under-relaxation of velocities and temperature.
    pub fn relax(&mut self, velocity: f64, temperature: f64) {
        self.advance.heat = temperature;
        self.advance.flow.velocity = velocity;
    }

    /// Temperatures: solved, or those of the start \[K\].
    #[must_use]
    pub fn temperature(&self) -> &[f64] {
        self.heating
            .as_ref()
            .map_or(&self.case.start, |h| &h.energy.temperature)
    }

    /// One iteration: properties, current and field, momentum and pressure, heat.
    ///
    /// # Errors
    /// When a field diverges; names the equation and the place.
    pub fn iterate(&mut self, clock: &mut impl Stopwatch) -> Result<Residuals, Error> {
        self.iteration += 1;
        let mut residuals = Residuals {
            cavity: self.boil(),
            ..Residuals::default()
        };
        clock.timed("properties", || self.take_properties());
        if self.electric.is_some() {
            let (part, found) = clock.timed("current", || self.solve_current())?;
            (residuals.charge, residuals.unbalanced[0]) = (Some(part), Some(found));
        }
        if self.iteration == 1 {
            self.begin_surfaces();
        }
        if self.flowing.is_some() {
            let [force, mass] = clock.timed("flow", || self.solve_flow())?;
            (residuals.force, residuals.unbalanced[1]) = (Some(force.0), Some(force.1));
            (residuals.mass, residuals.unbalanced[2]) = (Some(mass.0), Some(mass.1));
        }
        if self.vapour.is_some() {
            residuals.iron = Some(clock.timed("vapour", || self.solve_vapour())?);
        }
        if self.heating.is_some() {
            clock.timed("heat sources", || self.take_sources());
            let (part, found, limited) = clock.timed("heat", || self.solve_heat())?;
            (residuals.heat, residuals.limited) = (Some(part), limited);
            residuals.unbalanced[3] = Some(found);
            self.unsettled = part;
        }
        if let Some(feed) = self.next_feed() {
            residuals.feed = Some((feed / self.feed - 1.0).abs());
            self.feed += FEED_RELAXATION * (feed - self.feed);
        }
        Ok(residuals)
    }

    /// Brings properties, conductances and sources to the last temperatures, so that what is
    /// written belongs together; returns the balance.
    pub fn settle(&mut self) -> Option<Balance> {
        self.take_properties();
        self.settle_vapour();
        self.take_sources();
        let (Heating { energy, sources }, around) = self.heating_within()?;
        Some(Balance::new(around, energy, sources))
    }

    pub(crate) fn take_properties(&mut self) {
        let Self {
            case,
            properties,
            heating,
            vapour,
            ..
        } = self;
        let iron = vapour.as_ref().map(|v| v.iron.as_slice());
        let temperature = heating
            .as_ref()
            .map_or(&case.start, |h| &h.energy.temperature);
        properties.update(case, temperature, iron);
    }
}
