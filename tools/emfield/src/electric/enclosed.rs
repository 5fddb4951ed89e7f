//! Force and charge of what closed surfaces enclose.

use shapes::frame::Vector;

use super::equations::Problem;
use super::traction::EPS0;
use crate::cloud::Cloud;
use crate::output::Found;
use crate::stencils::region::Region;
use crate::surface::fits::Enclosed;
use crate::surface::ways::{push, strength};

/// What the electric field does through a closed surface to all within.
pub(crate) struct Closed<'a> {
    /// What the surface is called.
    pub(crate) name: String,
    /// Force by Maxwell's stress \[N\].
    pub(crate) force: Vector,
    /// Flux of the displacement outward \[C\].
    pub(crate) charge: f64,
    /// Root of the mean square of the field \[V/m\].
    pub(crate) field: f64,
    /// The points within; all bodies where it is absent.
    pub(crate) within: Option<&'a [bool]>,
}

/// Force and flux of a potential by point over a closed surface.
fn closed<'a, const D: usize>(
    problem: &Problem,
    (region, potential): (&Region<D>, &[f64]),
    one: &'a Enclosed<D>,
) -> Closed<'a> {
    let surface = &one.surface;
    let eps = EPS0 * problem.permittivity[surface.medium as usize];
    let field = one.electric(region, potential);
    Closed {
        name: surface.name.clone(),
        force: surface.stress(&field).map(|f| eps * f),
        charge: -eps * surface.inward(field.iter().map(|f| f.map(|e| e.re))),
        field: strength(&field, &surface.areas),
        within: (!surface.within.is_empty()).then_some(surface.within.as_slice()),
    }
}

/// Adds the electric forces of a potential by point; `pulls` are the tractions on surfaces of bodies.
pub(crate) fn through<'a, const D: usize>(
    (cloud, problem): (&Cloud, &Problem),
    region: &Region<D>,
    (potential, pulls): (&[f64], &[Vector]),
    enclosed: &'a [Enclosed<D>],
    all: &mut Found,
) -> Vec<Closed<'a>> {
    let add = |one| {
        let closed = closed(problem, (region, potential), one);
        let mut bodies = [0.0; 3];
        for (s, pull) in cloud.surface.iter().zip(pulls) {
            if closed.within.is_none_or(|w| w[s.point as usize]) {
                bodies = std::array::from_fn(|k| bodies[k] + s.area * pull[k]);
            }
        }
        let name = format!("{}.electric_force", closed.name);
        push(cloud.geometry, &name, &[closed.force, bodies], all);
        closed
    };
    enclosed.iter().map(add).collect()
}

/// What the field does through a surface about all bodies.
pub(crate) fn all_within<'a, const D: usize>(
    problem: &Problem,
    at: (&Region<D>, &[f64]),
    about: &'a Option<Enclosed<D>>,
) -> Option<Closed<'a>> {
    about.as_ref().map(|one| closed(problem, at, one))
}
