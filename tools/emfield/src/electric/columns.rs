//! What is written of a potential: fields of points, tractions, forces on bodies and on what surfaces enclose.

use run::{Failure, Session};
use shapes::frame::Vector;

use super::doubts::doubts;
use super::enclosed::{all_within, through};
use super::equations::Problem;
use super::open::walls::OpenWalls;
use super::traction::{dielectric, electrode};
use crate::cloud::{Cloud, SurfacePoint};
use crate::geometry::Geometry;
use crate::output::{Column, Found};
use crate::stencils::region::Region;
use crate::stencils::setup::raise;
use crate::stencils::sides::Form;
use crate::surface::enclosing::Enclosing;
use crate::surface::fits::{self, Enclosed, about_all};

/// Columns and totals of a potential and the fields of both sides, by point.
pub(crate) fn told<const D: usize>(
    (cloud, problem): (&Cloud, &Problem),
    at: (&Region<D>, &Form),
    (value, fields): (Vec<f64>, [Vec<[f64; D]>; 2]),
    (open, around): (Option<&OpenWalls>, Vec<Enclosing>),
    session: &mut Session,
) -> Result<Found, Failure> {
    let region = at.0;
    let enclosed = fits::all(around, at, session)?;
    let up = |e| raise(cloud.geometry, e);
    let [inner, beyond] = fields.map(|field| field.into_iter().map(up).collect::<Vec<Vector>>());
    let (mut found, pulls) = columns(cloud, problem, value, &inner, &beyond);
    if let Some(open) = open {
        let potential = std::mem::take(&mut found.columns[0].values);
        open.totals(
            (cloud.geometry, problem.permittivity[0]),
            &potential,
            &mut found,
        );
        found.columns[0].values = potential;
    }
    if !cloud.surface.is_empty() {
        let about = about_all(cloud, at, &enclosed, session);
        let with = (found.columns[0].values.as_slice(), pulls.as_slice());
        let (with, closed) = ((region, with), (enclosed.as_slice(), &about));
        found.join(forces((cloud, problem), with, [&inner, &beyond], closed));
    }
    Ok(found)
}

/// Electric forces on what surfaces enclose, and doubts about those on bodies, from potential by point, tractions by
/// surface point, and the fields of both sides by point.
fn forces<const D: usize>(
    at: (&Cloud, &Problem),
    (region, (potential, pulls)): (&Region<D>, (&[f64], &[Vector])),
    fields: [&[Vector]; 2],
    (enclosed, about): (&[Enclosed<D>], &Option<Enclosed<D>>),
) -> Found {
    let sides = fields.map(|field| on_surface(at.0, field));
    let sides = sides.each_ref().map(Vec::as_slice);
    let mut totals = Found::default();
    let mut closed = through(at, region, (potential, pulls), enclosed, &mut totals);
    closed.extend(all_within(at.1, (region, potential), about));
    totals.doubts = doubts(at, (pulls, sides), &closed);
    totals
}

/// Values of points on surfaces.
fn on_surface(cloud: &Cloud, field: &[Vector]) -> Vec<Vector> {
    let points = cloud.surface.iter().map(|s| s.point as usize);
    points.map(|i| field[i]).collect()
}

/// Potential and field of all points, traction and fields of both sides on interfaces; the tractions.
fn columns(
    cloud: &Cloud,
    problem: &Problem,
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
    let mut force = vec![[0.0; 3]; cloud.media.len() - 1];
    let mut tractions = Vec::with_capacity(cloud.surface.len());
    for s in &cloud.surface {
        let pull = pull(problem, s, inner, beyond);
        tractions.push(pull);
        if s.inner > 0 {
            let total = &mut force[s.inner as usize - 1];
            *total = std::array::from_fn(|k| total[k] + s.area * pull[k]);
        }
    }
    found
        .surface
        .extend(Column::vector("traction", "N/m2", &tractions, &[]));
    for (body, force) in cloud.media.iter().skip(1).zip(force) {
        for (k, axis) in ['x', 'y', 'z'].iter().enumerate() {
            let unit = cloud.geometry.unit_of_force();
            // The radial forces of a full turn cancel.
            let lost = cloud.geometry == Geometry::Axisymmetric && k < 2;
            if !lost {
                let name = format!("electric_force_{body}_{axis}");
                found.totals.push((name, unit, force[k]));
            }
        }
    }
    (found, tractions)
}

/// Traction \[Pa\] on a surface: of a dielectric by its inner field, of an electrode by the outer one.
fn pull(problem: &Problem, s: &SurfacePoint, inner: &[Vector], beyond: &[Vector]) -> Vector {
    let eps = [s.inner, s.outer].map(|m| problem.permittivity[m as usize]);
    let point = s.point as usize;
    if problem.electrodes[s.inner as usize].is_some() {
        electrode(eps[1], beyond[point], s.normal)
    } else {
        dielectric(eps, [inner[point], beyond[point]], s.normal)
    }
}
