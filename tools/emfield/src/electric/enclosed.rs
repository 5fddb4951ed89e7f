//! Force and charge of what closed surfaces enclose.

use run::{Failure, Session};
use shapes::frame::Vector;

use super::equations::Problem;
use super::traction::EPS0;
use crate::cloud::Cloud;
use crate::frames::Found;
use crate::stencils::region::Region;
use crate::stencils::sides::Form;
use crate::surface::enclosing::Enclosing;
use crate::surface::fits::{self, Enclosed, about_all};
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

/// Closed surfaces through which forces are taken, with fits of the points about them.
pub(crate) struct Surfaces<const D: usize> {
    /// Those that a scene asks for.
    asked: Vec<Enclosed<D>>,
    /// One about all bodies, where there is room for it and none of the others is one.
    all: Option<Enclosed<D>>,
}

impl<const D: usize> Surfaces<D> {
    /// Makes the fits.
    ///
    /// # Errors
    /// Where too few points lie about a surface that is asked for.
    pub(crate) fn new(
        cloud: &Cloud,
        region: &Region<D>,
        form: &Form,
        asked: Vec<Enclosing>,
        session: &mut Session,
    ) -> Result<Self, Failure> {
        let asked = fits::all(asked, region, form, session)?;
        let all = match cloud.surface.is_empty() {
            true => None,
            false => about_all(cloud, region, form, &asked, session),
        };
        Ok(Self { asked, all })
    }

    /// What the field of a potential by point does through the surfaces that are asked for.
    pub(crate) fn asked(
        &self,
        problem: &Problem,
        region: &Region<D>,
        potential: &[f64],
    ) -> Vec<Closed<'_>> {
        let each = self.asked.iter();
        each.map(|one| closed(problem, region, potential, one))
            .collect()
    }

    /// What it does through the surface about all bodies.
    pub(crate) fn all(
        &self,
        problem: &Problem,
        region: &Region<D>,
        potential: &[f64],
    ) -> Option<Closed<'_>> {
        let all = self.all.as_ref()?;
        Some(closed(problem, region, potential, all))
    }
}

/// Force and flux of a potential by point over a closed surface.
fn closed<'a, const D: usize>(
    problem: &Problem,
    region: &Region<D>,
    potential: &[f64],
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

/// Adds the electric forces on what surfaces enclose; `pulls` are the tractions on surfaces of bodies.
pub(crate) fn forces(cloud: &Cloud, pulls: &[Vector], closed: &[Closed], all: &mut Found) {
    for closed in closed {
        let mut bodies = [0.0; 3];
        for (s, pull) in cloud.surface.iter().zip(pulls) {
            if closed.within.is_none_or(|w| w[s.point as usize]) {
                bodies = std::array::from_fn(|k| bodies[k] + s.area * pull[k]);
            }
        }
        let name = format!("{}.electric_force", closed.name);
        push(cloud.geometry, &name, &[closed.force, bodies], all);
    }
}
