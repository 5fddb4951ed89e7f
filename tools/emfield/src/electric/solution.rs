//! The potential of what is given: stencils, equations, their solution and the fields of it.

use krylov::{Options, Pair, Rows, System};
use run::{Failure, Session};

use super::columns::{Potential, told};
use super::enclosed::Surfaces;
use super::equations::{Equations, Held, Problem, Smeared};
use super::open::walls::{Applied, OpenWalls};
use crate::cloud::Cloud;
use crate::frames::Found;
use crate::solve::broken::unsolvable;
use crate::solve::{Numerics, report, supports};
use crate::stencils::region::Region;
use crate::stencils::sides::Sides;
use crate::stencils::unfit::no_stencil;
use crate::surface::enclosing::Enclosing;

/// What is given, and how it is solved.
pub(crate) struct Given<'a> {
    pub(crate) problem: Problem,
    /// Whether stencils cross interfaces, weighted by the harmonic mean of the permittivity.
    pub(crate) smeared: bool,
    pub(crate) numerics: Numerics,
    /// What is applied, where walls stand for open space.
    pub(crate) applied: Option<Applied<'a>>,
}

/// Solves what is given on points; `around` are surfaces through which forces are wanted.
///
/// # Errors
/// Where a stencil cannot be made, a formula has no value, or the solve breaks down.
pub(crate) fn found<const D: usize>(
    cloud: &Cloud,
    region: &Region<D>,
    given: &Given<'_>,
    around: Vec<Enclosing>,
    session: &mut Session,
) -> Result<Found, Failure> {
    let Given {
        problem, numerics, ..
    } = given;
    let form = numerics.form;
    let low = numerics.low_order(region.len());
    let open = OpenWalls::new(cloud, problem, given.applied, region, &form, session)?;
    let open = open.as_ref();
    let stencil = |error: wls::Error| no_stencil("electrostatics", &error, cloud);
    let potential = if given.smeared {
        let form = form.for_potentials();
        let made = session.timed("weights", || Smeared::new(region, &form));
        let stencils = made.map_err(stencil)?;
        let equations = session.timed("assemble", || stencils.rows(problem, region));
        let low = low.map(|low| {
            let stencils = session.timed("weights", || Smeared::new(region, &low))?;
            Ok(session.timed("assemble", || stencils.rows(problem, region).0))
        });
        let low = low.transpose().map_err(stencil)?;
        let value = solve(cloud, numerics, equations, low, open, session)?;
        let inner = session.timed("fields", || stencils.field(&value));
        Potential {
            value,
            beyond: inner.clone(),
            inner,
        }
    } else {
        let form = if region.axial {
            form.for_potentials()
        } else {
            form.for_harmonics(D)
        };
        let low = low.filter(|_| !form.compares());
        let sides = session
            .timed("weights", || Sides::new(region, &form))
            .map_err(stencil)?;
        supports("potential", &sides.report(), session);
        let equations = session.timed("assemble", || problem.rows(region, &sides));
        let low = low.map(|low| {
            let sides = session.timed("weights", || Sides::new(region, &low))?;
            Ok(session.timed("assemble", || problem.rows(region, &sides).0))
        });
        let low = low.transpose().map_err(stencil)?;
        let value = solve(cloud, numerics, equations, low, open, session)?;
        let field = |inner| Problem::field(region, &sides, &value, inner);
        let (inner, beyond) = session.timed("fields", || (field(true), field(false)));
        Potential {
            value,
            inner,
            beyond,
        }
    };
    if let Some(what) = beyond_given(cloud, given.applied.is_some(), problem, &potential.value) {
        session.warn(what);
    }
    let surfaces = Surfaces::new(cloud, region, &form, around, session)?;
    Ok(told(cloud, problem, region, potential, open, &surfaces))
}

/// Share of the range of what is given by which a potential may lie outside it.
const BEYOND: f64 = 0.01;

/// Says where a potential lies outside what walls and electrodes give: between them no permittivity has a maximum or a
/// minimum, so that the points do not resolve what is there.
fn beyond_given(cloud: &Cloud, open: bool, problem: &Problem, value: &[f64]) -> Option<String> {
    let each = problem.held.iter().zip(value);
    let walls = each.filter_map(|(held, value)| match held.as_ref()? {
        Held::Potential(_) if open => Some(*value),
        Held::Potential(v) => Some(*v),
        Held::Insulated => None,
    });
    let given = walls.chain(problem.electrodes.iter().flatten().copied());
    let (low, high) = given.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| {
        (low.min(v), high.max(v))
    });
    let beyond = |v: f64| (low - v).max(v - high);
    let worst = (0..value.len()).max_by(|a, b| beyond(value[*a]).total_cmp(&beyond(value[*b])))?;
    // A field between equal potentials is none.
    let slack = BEYOND * (high - low) + 1e-6 * low.abs().max(high.abs());
    (beyond(value[worst]) > slack).then(|| {
        let x = cloud.position[worst];
        format!(
            "potential: {:.4e} V at ({:.3e}, {:.3e}, {:.3e}) m lies outside what walls and electrodes give, {low:.4e} to {high:.4e} V: points there do not resolve an edge, a wedge or a gap; take smaller spacings or a lower order",
            value[worst], x[0], x[1], x[2]
        )
    })
}

/// Solves the equations; rows of low order, where there are some, precondition them.
fn solve(
    cloud: &Cloud,
    numerics: &Numerics,
    equations: Equations,
    low: Option<Rows<f64>>,
    open: Option<&OpenWalls>,
    session: &mut Session,
) -> Result<Vec<f64>, Failure> {
    let (rows, mut right) = equations;
    let options = Options {
        fluxes: true,
        ..numerics.options
    };
    let made = session.timed("factorise", || match low {
        Some(low) => System::with_low_order(rows, Vec::new(), low, options),
        None => System::new(rows, Vec::new(), options),
    });
    let mut ready = Ready {
        cloud,
        numerics,
        system: made.map_err(|error| unsolvable("potential", &error, cloud))?,
        pairs: open.map_or_else(Vec::new, |open| open.far.pairs()),
    };
    let Some(open) = open else {
        return ready.solve("potential", &right, session);
    };
    open.far.applied(&open.applied, &mut right);
    let mut found = ready.solve("potential", &right, session)?;
    if open.floats {
        let name = "potential_far";
        let unit = ready.solve(name, &open.walls, session)?;
        let far = (open.far.flux(&open.applied) - open.far.flux(&found)) / open.far.flux(&unit);
        for (v, unit) in found.iter_mut().zip(unit) {
            *v += far * unit;
        }
        session.closing(name, "V", far);
    }
    Ok(found)
}

/// Equations that are ready to be solved.
struct Ready<'a> {
    cloud: &'a Cloud,
    numerics: &'a Numerics,
    system: System<f64, f64>,
    /// What multipoles put into the rows of open walls.
    pairs: Vec<Pair<f64>>,
}

impl Ready<'_> {
    /// The potential that a right side has; what is said of the solve has this name.
    fn solve(
        &mut self,
        name: &str,
        right: &[[f64; 1]],
        session: &mut Session,
    ) -> Result<Vec<f64>, Failure> {
        let mut x = vec![[0.0]; right.len()];
        let stop = session.interrupt();
        let rule = self.numerics.rule(&*stop);
        let solved = session.timed("solve", || {
            self.system.solve_with(&self.pairs, right, &mut x, rule)
        });
        let size = |i: usize| x[i][0].abs();
        report(name, "V", &solved, self.cloud, size, session)?;
        Ok(x.into_iter().map(|x| x[0]).collect())
    }
}
