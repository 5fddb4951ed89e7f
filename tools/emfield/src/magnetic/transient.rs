//! A stage of a march, and the fields of its state at an instant.

use run::{Failure, Session};

use super::charge::fields::{Coupling, Lack, spread};
use super::charge::stage::Charged;
use super::columns::Driven;
use super::driven::right::{Drive, pairs};
use super::fields::Solution;
use super::open::multipoles::Multipoles;
use super::problem::Problem;
use super::source::C;
use super::stage::{Alone, Equations};
use crate::frames::Found;
use crate::march::scheme::{Stage, State, slope};
use crate::stencils::sides::{Form, Sides};
use crate::stencils::unfit::no_stencil;

/// Rates that solves leave, over their tolerance times potentials over a stage.
const NOISE: f64 = 1e3;

/// The equations of a stage, ready for a slope: of A alone, or with charges.
///
/// # Errors
/// Where stencils cannot be made, or the equations have no solution.
pub(crate) fn stage<'a, const D: usize, const K: usize>(
    problem: &'a Problem<'_, D>,
    drive: &Drive<K>,
    charges: Option<&'a Coupling>,
    slope: f64,
    session: &mut Session,
) -> Result<Box<dyn Stage + 'a>, Failure> {
    let Some(charges) = charges else {
        let equations = equations(problem, drive, session)?;
        let made = session.timed("factorise", || Alone::new(equations, slope));
        let alone = Box::new(made.map_err(|error| failed(&error))?);
        return Ok(problem.saturated::<K>(alone, session));
    };
    let given: Vec<[f64; 3]> = charges.given.iter().map(|g| g.map(|g| g.re)).collect();
    let source: Vec<[f64; K]> = drive.source.iter().map(|a| a.map(|a| a.re)).collect();
    let options = problem.parameters.numerics.options;
    let made = session.timed("factorise", || {
        let source = spread(&source);
        Charged::new(&charges.equations, &source, given, slope, options)
    });
    let charged = Box::new(made.map_err(|error| failed(&error))?);
    Ok(problem.saturated::<K>(charged, session))
}

/// The equations of A alone, and what drives them.
fn equations<const D: usize, const K: usize>(
    problem: &Problem<'_, D>,
    drive: &Drive<K>,
    session: &mut Session,
) -> Result<Equations<K>, Failure> {
    let mut given = problem.given_rows::<K>();
    let (region, sides, unknown) = (&problem.region, &problem.sides, problem.parameters.unknown);
    let conductors = &problem.conductors;
    let low = problem
        .parameters
        .numerics
        .low_order(region.len())
        .map(|low| {
            let low = Form {
                around: unknown.around(),
                ..low
            };
            let sides = session.timed("weights", || Sides::new(region, &low))?;
            Ok(conductors.rows(region, &sides, unknown))
        });
    let low = low.transpose();
    let unfit = |error: wls::Error| no_stencil("eddy currents", &error, problem.cloud);
    let held = |i| {
        let held = conductors.held(region, unknown, i);
        held.then(|| drive.held.map(|h| h.re))
    };
    let open = problem.parameters.open;
    let multipoles = open.then(|| Multipoles::new(region, &problem.weights));
    let bound = multipoles
        .iter()
        .flat_map(|all| problem.bound(all, &mut given));
    let bound = bound.collect();
    Ok(Equations {
        low: low.map_err(unfit)?,
        rates: session.timed("assemble", || conductors.rates(region, sides, unknown)),
        rows: session.timed("assemble", || conductors.rows(region, sides, unknown)),
        held: (0..region.len()).map(held).collect(),
        given: given.iter().map(|g| g.map(|g| g.re)).collect(),
        pairs: multipoles
            .iter()
            .flat_map(|all| pairs(conductors, region, unknown, all))
            .collect(),
        bound,
        options: problem.parameters.numerics.options,
    })
}

fn failed(error: &dyn std::fmt::Display) -> Failure {
    Failure::Other(format!("eddy currents: {error}"))
}

/// What fields of a state are made from.
pub(crate) struct View<'a, const D: usize, const K: usize> {
    pub(crate) problem: &'a Problem<'a, D>,
    pub(crate) drive: &'a Drive<K>,
    /// Flux density of the sources where their wave is 1 \[T\].
    pub(crate) flux: &'a [[C; 3]],
    pub(crate) charges: Option<&'a Coupling>,
}

impl<const D: usize, const K: usize> View<'_, D, K> {
    /// Columns and totals of a state, with the wave then and the step before it \[s\]; and how far fields point out of
    /// conductors.
    pub(crate) fn fields(&self, state: &State, wave: f64, step: f64) -> (Found, Lack) {
        let Self { problem, drive, .. } = *self;
        let real = |values: &[f64]| -> Vec<[C; K]> {
            let points = values.as_chunks::<K>().0.iter();
            let points = points.take(problem.region.len());
            points.map(|v| v.map(C::from)).collect()
        };
        let source: Vec<[C; K]> = drive.source.iter().map(|a| a.map(|a| a * wave)).collect();
        let flux: Vec<[C; 3]> = self.flux.iter().map(|b| b.map(|b| b * wave)).collect();
        let mut change = real(&state.change);
        let charges = self.charges.filter(|charges| charges.charged());
        let charged = charges.map(|charges| {
            let potential = |phi: &[f64]| -> Vec<C> {
                let whole = charges.equations.whole(phi);
                whole.into_iter().map(C::from).collect()
            };
            let phi = potential(&state.change[K * problem.region.len()..]);
            let voltage = potential(&state.following);
            problem.charged(&charges.stencils, &phi, &voltage, &mut change)
        });
        // What solves leave is no field.
        let most = state.total.iter().fold(0.0, |m: f64, a| m.max(a.abs()));
        let least = NOISE * problem.parameters.numerics.tolerance * slope(step) * most;
        let lack = problem.lack(&change, least);
        let solution = Solution {
            found: &real(&state.unknown),
            source: &source,
            change: &change,
            waves: None,
        };
        let windings = problem.windings.as_ref().map(|w| w.times(wave));
        let driven = Driven {
            source: &problem.source.times(wave),
            flux: &flux,
            windings: windings.as_ref(),
        };
        (problem.found(solution, charged.as_ref(), driven), lack)
    }
}
