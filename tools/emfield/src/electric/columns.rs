//! What is written of a potential: fields of points, tractions, forces on bodies and on what surfaces enclose.

use shapes::frame::Vector;

use super::doubts::doubts;
use super::enclosed::{Surfaces, forces};
use super::equations::Problem;
use super::open::walls::OpenWalls;
use super::traction::{dielectric, electrode};
use crate::cloud::{Cloud, SurfacePoint};
use crate::frames::{Column, Found};
use crate::geometry::Geometry;
use crate::stencils::region::Region;
use crate::stencils::setup::raise;

/// A potential and its field, by point.
pub(crate) struct Potential<const D: usize> {
    /// The potential \[V\].
    pub(crate) value: Vec<f64>,
    /// Its field; on interfaces that of the inner side \[V/m\].
    pub(crate) inner: Vec<[f64; D]>,
    /// Its field; on interfaces that of the outer side \[V/m\].
    pub(crate) beyond: Vec<[f64; D]>,
}

/// Columns and totals of a potential, with the forces on what surfaces enclose.
pub(crate) fn told<const D: usize>(
    cloud: &Cloud,
    problem: &Problem,
    region: &Region<D>,
    potential: Potential<D>,
    open: Option<&OpenWalls>,
    surfaces: &Surfaces<D>,
) -> Found {
    let up = |e| raise(cloud.geometry, e);
    let fields = [potential.inner, potential.beyond];
    let [inner, beyond] = fields.map(|field| field.into_iter().map(up).collect::<Vec<Vector>>());
    let (mut found, pulls) = columns(cloud, problem, potential.value, &inner, &beyond);
    let potential = std::mem::take(&mut found.columns[0].values);
    if let Some(open) = open {
        open.totals(
            cloud.geometry,
            problem.permittivity[0],
            &potential,
            &mut found,
        );
    }
    if !cloud.surface.is_empty() {
        let mut closed = surfaces.asked(problem, region, &potential);
        forces(cloud, &pulls, &closed, &mut found);
        closed.extend(surfaces.all(problem, region, &potential));
        let sides = [&inner, &beyond].map(|field| on_surface(cloud, field));
        let sides = sides.each_ref().map(Vec::as_slice);
        let doubts = doubts(cloud, problem, &pulls, sides, &closed);
        found.doubts.extend(doubts);
    }
    found.columns[0].values = potential;
    found
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
