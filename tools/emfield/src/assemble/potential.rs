//! Electrostatics of a scene: its equations, their solution, potential, field and traction.

use krylov::{Options, Pair, Rows, System};
use run::{Failure, Session};
use shapes::frame::Vector;

use super::agree;
use super::broken::unsolvable;
use super::enclosed::{about_all, all_within, electric, enclosed};
use super::open::Opened;
use super::region::{raise, region};
use super::unfit::no_stencil;
use super::walls::Walls;
use crate::cloud::{Class, Cloud, SurfacePoint};
use crate::electric::equations::{Equations, Held, Problem, Smeared};
use crate::electric::traction::{dielectric, electrode};
use crate::output::{Column, Found};
use crate::scene::{Electrostatics, Interfaces, Scene};
use crate::stencils::region::Region;
use crate::stencils::sides::{Form, Sides};
use crate::surface::fits::Enclosed;

/// Solves the electrostatics of a scene in `D` coordinates.
///
/// # Errors
/// Where a stencil cannot be made, a formula has no value, or the solve breaks down.
pub fn electrostatics<const D: usize>(
    scene: &Scene,
    electrostatics: &Electrostatics,
    cloud: &Cloud,
    session: &mut Session,
) -> Result<Found, Failure> {
    let outer = Walls::new(scene, electrostatics)?;
    let region: Region<D> = region(scene, cloud, &|wall| outer.insulated(wall)).straight();
    let problem = problem(scene, cloud, &outer)?;
    let form = super::form(scene);
    let low = super::low_order(scene, region.len());
    let open = Opened::new((scene, cloud), &outer, (&region, &form), session)?;
    let open = open.as_ref();
    let stencil = |error: wls::Error| no_stencil("electrostatics", &error, (scene, cloud));
    let (value, inner, beyond) = match scene.method.interfaces {
        Interfaces::OneSided(_) => {
            let form = if region.axial {
                form.for_potentials()
            } else {
                form.for_harmonics(D)
            };
            let low = low.filter(|_| !form.compares());
            let sides = session
                .timed("weights", || Sides::new(&region, &form))
                .map_err(stencil)?;
            super::supports("potential", &sides.report(), session);
            let equations = session.timed("assemble", || problem.rows(&region, &sides));
            let low = low.map(|low| {
                let sides = session.timed("weights", || Sides::new(&region, &low))?;
                Ok(session.timed("assemble", || problem.rows(&region, &sides).0))
            });
            let low = low.transpose().map_err(stencil)?;
            let v = solve((scene, cloud), equations, (low, open), session)?;
            let field = |inner| Problem::field(&region, &sides, &v, inner);
            let (a, b) = session.timed("fields", || (field(true), field(false)));
            (v, a, b)
        }
        Interfaces::Smeared(_) => {
            let form = form.for_potentials();
            let made = session.timed("weights", || Smeared::new(&region, &form));
            let stencils = made.map_err(stencil)?;
            let equations = session.timed("assemble", || stencils.rows(&problem, &region));
            let low = low.map(|low| {
                let stencils = session.timed("weights", || Smeared::new(&region, &low))?;
                Ok(session.timed("assemble", || stencils.rows(&problem, &region).0))
            });
            let low = low.transpose().map_err(stencil)?;
            let v = solve((scene, cloud), equations, (low, open), session)?;
            let a = session.timed("fields", || stencils.field(&v));
            (v, a.clone(), a)
        }
    };
    if let Some(what) = beyond_given((cloud, outer.open), &problem, &value) {
        session.warn(what);
    }
    let fields = (value, [inner, beyond]);
    told((scene, cloud), (&region, &form), fields, open, session)
}

/// Columns and totals of a potential and the fields of both sides, by point.
fn told<const D: usize>(
    (scene, cloud): (&Scene, &Cloud),
    at: (&Region<D>, &Form),
    (value, fields): (Vec<f64>, [Vec<[f64; D]>; 2]),
    open: Option<&Opened>,
    session: &mut Session,
) -> Result<Found, Failure> {
    let region = at.0;
    let enclosed = enclosed(scene, cloud, at, session)?;
    let up = |e| raise(cloud.geometry, e);
    let [inner, beyond] = fields.map(|field| field.into_iter().map(up).collect::<Vec<Vector>>());
    let (mut found, pulls) = columns(scene, cloud, value, &inner, &beyond);
    if let Some(open) = open {
        let potential = std::mem::take(&mut found.columns[0].values);
        open.totals(scene, &potential, &mut found);
        found.columns[0].values = potential;
    }
    if !cloud.surface.is_empty() {
        let about = about_all((scene, cloud), at, &enclosed, session);
        let with = (found.columns[0].values.as_slice(), pulls.as_slice());
        let (with, closed) = ((region, with), (enclosed.as_slice(), &about));
        found.join(forces((scene, cloud), with, [&inner, &beyond], closed));
    }
    Ok(found)
}

/// Electric forces on what surfaces enclose, and doubts about those on bodies, from potential by point, tractions by
/// surface point, and the fields of both sides by point.
fn forces<const D: usize>(
    at: (&Scene, &Cloud),
    (region, (potential, pulls)): (&Region<D>, (&[f64], &[Vector])),
    fields: [&[Vector]; 2],
    (enclosed, about): (&[Enclosed<D>], &Option<Enclosed<D>>),
) -> Found {
    let sides = fields.map(|field| on_surface(at.1, field));
    let sides = sides.each_ref().map(Vec::as_slice);
    let mut totals = Found::default();
    let mut closed = electric(at, region, (potential, pulls), enclosed, &mut totals);
    closed.extend(all_within(at.0, (region, potential), about));
    totals.doubts = agree::electric(at, (pulls, sides), &closed);
    totals
}

/// Share of the range of what is given by which a potential may lie outside it.
const BEYOND: f64 = 0.01;

/// Says where a potential lies outside what walls and electrodes give: between them no permittivity has a maximum or a
/// minimum, so that the points do not resolve what is there.
fn beyond_given((cloud, open): (&Cloud, bool), problem: &Problem, value: &[f64]) -> Option<String> {
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

/// What is given where.
fn problem(scene: &Scene, cloud: &Cloud, outer: &Walls<'_>) -> Result<Problem, Failure> {
    let mut held = vec![None; cloud.len()];
    for (i, held) in held.iter_mut().enumerate() {
        if let Class::Outer { .. } = cloud.class[i] {
            *held = Some(outer.held(cloud.position[i])?);
        }
    }
    Ok(Problem {
        permittivity: (0..cloud.media)
            .map(|m| scene.medium(m).relative_permittivity)
            .collect(),
        electrodes: std::iter::once(None)
            .chain(scene.bodies.iter().map(|b| b.potential_v))
            .collect(),
        held,
    })
}

/// Solves the equations; rows of low order, where there are some, precondition them.
fn solve(
    at: (&Scene, &Cloud),
    (rows, mut right): Equations,
    (low, open): (Option<Rows<f64>>, Option<&Opened>),
    session: &mut Session,
) -> Result<Vec<f64>, Failure> {
    let (scene, cloud) = at;
    let options = Options {
        fluxes: true,
        ..super::options(scene)
    };
    let made = session.timed("factorise", || match low {
        Some(low) => System::with_low_order(rows, Vec::new(), low, options),
        None => System::new(rows, Vec::new(), options),
    });
    let mut system = made.map_err(|error| unsolvable("potential", &error, cloud))?;
    let Some(open) = open else {
        return solve_for(at, (&mut system, &[]), ("potential", &right), session);
    };
    let pairs = open.far.pairs();
    open.far.applied(&open.applied, &mut right);
    let mut found = solve_for(at, (&mut system, &pairs), ("potential", &right), session)?;
    if open.floats {
        let name = "potential_far";
        let unit = solve_for(at, (&mut system, &pairs), (name, &open.walls), session)?;
        let far = (open.far.flux(&open.applied) - open.far.flux(&found)) / open.far.flux(&unit);
        for (v, unit) in found.iter_mut().zip(unit) {
            *v += far * unit;
        }
        session.closing(name, "V", far);
    }
    Ok(found)
}

/// The potential that a right side has.
fn solve_for(
    (scene, cloud): (&Scene, &Cloud),
    (system, pairs): (&mut System<f64, f64>, &[Pair<f64>]),
    (name, right): (&str, &[[f64; 1]]),
    session: &mut Session,
) -> Result<Vec<f64>, Failure> {
    let mut x = vec![[0.0]; right.len()];
    let stop = session.interrupt();
    let rule = super::rule(scene, &*stop);
    let solved = session.timed("solve", || system.solve_with(pairs, right, &mut x, rule));
    let at = (cloud, |i: usize| x[i][0].abs());
    super::report((name, "V"), &solved, at, session)?;
    Ok(x.into_iter().map(|x| x[0]).collect())
}

/// Values of points on surfaces.
fn on_surface(cloud: &Cloud, field: &[Vector]) -> Vec<Vector> {
    let points = cloud.surface.iter().map(|s| s.point as usize);
    points.map(|i| field[i]).collect()
}

/// Potential and field of all points, traction and fields of both sides on interfaces; the tractions.
fn columns(
    scene: &Scene,
    cloud: &Cloud,
    value: Vec<f64>,
    inner: &[Vector],
    beyond: &[Vector],
) -> (Found, Vec<Vector>) {
    let mut found = Found::default();
    let on_surface = |field| on_surface(cloud, field);
    let potential = Column::new("potential", "V", value);
    found.columns.push(potential.without_laplacian());
    let field = Column::vector("electric_field", "V/m", inner, &on_surface(beyond));
    found.columns.extend(field.map(Column::without_laplacian));
    found.surface.extend(Column::vector(
        "electric_field_inner",
        "V/m",
        &on_surface(inner),
        &[],
    ));
    found.surface.extend(Column::vector(
        "electric_field_outer",
        "V/m",
        &on_surface(beyond),
        &[],
    ));
    let mut force = vec![[0.0; 3]; scene.bodies.len()];
    let mut tractions = Vec::with_capacity(cloud.surface.len());
    for s in &cloud.surface {
        let pull = pull(scene, s, inner, beyond);
        tractions.push(pull);
        if s.inner > 0 {
            let total = &mut force[s.inner as usize - 1];
            *total = std::array::from_fn(|k| total[k] + s.area * pull[k]);
        }
    }
    found
        .surface
        .extend(Column::vector("traction", "N/m2", &tractions, &[]));
    for (body, force) in scene.bodies.iter().zip(force) {
        for (k, axis) in ['x', 'y', 'z'].iter().enumerate() {
            let unit = if scene.geometry == crate::scene::Geometry::Plane {
                "N/m"
            } else {
                "N"
            };
            // The radial forces of a full turn cancel.
            let lost = scene.geometry == crate::scene::Geometry::Axisymmetric && k < 2;
            if !lost {
                let name = format!("electric_force_{}_{axis}", body.name);
                found.totals.push((name, unit, force[k]));
            }
        }
    }
    (found, tractions)
}

/// Traction \[Pa\] on a surface: of a dielectric by its inner field, of an electrode by the outer one.
fn pull(scene: &Scene, s: &SurfacePoint, inner: &[Vector], beyond: &[Vector]) -> Vector {
    let eps = [s.inner, s.outer].map(|m| scene.medium(m as usize).relative_permittivity);
    let own = s.inner.checked_sub(1).map(|k| &scene.bodies[k as usize]);
    let point = s.point as usize;
    if own.is_some_and(|body| body.potential_v.is_some()) {
        electrode(eps[1], beyond[point], s.normal)
    } else {
        dielectric(eps, [inner[point], beyond[point]], s.normal)
    }
}
