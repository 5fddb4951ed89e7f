//! Force and heat of what closed surfaces enclose, and how far they are from those found at the bodies.

use num_complex::Complex;
use run::{Failure, Session};
use shapes::frame::Vector;

use super::about::about;
use super::enclosing::enclosing;
use super::forces::{seen, strength, unit};
use super::setting::Setting;
use crate::cloud::Cloud;
use crate::electric::traction::EPS0;
use crate::magnetic::fields::{Fields, Solution, cross_mean};
use crate::magnetic::source::{MU0, Source, minus};
use crate::magnetic::totals::{Acting, Totals, spread};
use crate::output::Found;
use crate::scene::{Geometry, Scene};
use crate::stencils::region::Region;
use crate::stencils::sides::Form;
use crate::surface::fits::Enclosed;

type C = Complex<f64>;

/// The enclosing surfaces of a scene with fits of the points about them; none where it asks for none.
///
/// # Errors
/// Where a surface does not enclose, or too few points lie about it.
pub(super) fn enclosed<const D: usize>(
    scene: &Scene,
    cloud: &Cloud,
    (region, form): (&Region<D>, &Form),
    session: &mut Session,
) -> Result<Vec<Enclosed<D>>, Failure> {
    if scene.output.enclosures.is_empty() {
        return Ok(Vec::new());
    }
    let surfaces = enclosing(scene, cloud)?;
    session.timed("enclosures", || {
        let each = surfaces.into_iter().map(|surface| {
            let name = surface.name.clone();
            let failed = |error: wls::Error| Failure::Other(format!("enclosure {name}: {error}"));
            Enclosed::new(region, form, surface).map_err(failed)
        });
        each.collect()
    })
}

/// Adds the components of a force that a scene has, and the largest difference between the ways of finding it.
fn push(scene: &Scene, name: &str, ways: &[Vector], all: &mut Found) {
    let unit = unit(scene.geometry);
    let had: &[usize] = match scene.geometry {
        Geometry::Plane => &[0, 1],
        // The radial forces of a full turn cancel.
        Geometry::Axisymmetric => &[2],
        Geometry::Space => &[0, 1, 2],
    };
    for k in had {
        let axis = ['x', 'y', 'z'][*k];
        all.totals
            .push((format!("{name}_{axis}"), unit, ways[0][*k]));
    }
    let part = |force: &Vector| seen(scene.geometry, *force);
    let ways: Vec<Vector> = ways.iter().map(part).collect();
    all.totals
        .push((format!("{name}_spread"), unit, spread(&ways)));
}

/// What the electric field does through a closed surface to all within.
pub(super) struct Closed<'a> {
    /// What the surface is called.
    pub(super) name: String,
    /// Force by Maxwell's stress \[N\].
    pub(super) force: Vector,
    /// Flux of the displacement outward \[C\].
    pub(super) charge: f64,
    /// Root of the mean square of the field \[V/m\].
    pub(super) field: f64,
    /// The points within; all bodies where it is absent.
    pub(super) within: Option<&'a [bool]>,
}

/// Force and flux of a potential by point over a closed surface.
fn closed<'a, const D: usize>(
    scene: &Scene,
    (region, potential): (&Region<D>, &[f64]),
    one: &'a Enclosed<D>,
) -> Closed<'a> {
    let surface = &one.surface;
    let eps = EPS0 * scene.medium(surface.medium as usize).relative_permittivity;
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
pub(super) fn electric<'a, const D: usize>(
    (scene, cloud): (&Scene, &Cloud),
    region: &Region<D>,
    (potential, pulls): (&[f64], &[Vector]),
    enclosed: &'a [Enclosed<D>],
    all: &mut Found,
) -> Vec<Closed<'a>> {
    let add = |one| {
        let closed = closed(scene, (region, potential), one);
        let mut bodies = [0.0; 3];
        for (s, pull) in cloud.surface.iter().zip(pulls) {
            if closed.within.is_none_or(|w| w[s.point as usize]) {
                bodies = std::array::from_fn(|k| bodies[k] + s.area * pull[k]);
            }
        }
        let name = format!("{}.electric_force", closed.name);
        push(scene, &name, &[closed.force, bodies], all);
        closed
    };
    enclosed.iter().map(add).collect()
}

/// A surface about all bodies with fits of the points about it, where one has room and no other holds all bodies.
pub(super) fn about_all<const D: usize>(
    (scene, cloud): (&Scene, &Cloud),
    (region, form): (&Region<D>, &Form),
    others: &[Enclosed<D>],
    session: &mut Session,
) -> Option<Enclosed<D>> {
    let all = |one: &Enclosed<D>| {
        let mut points = cloud.surface.iter().map(|s| s.point as usize);
        points.all(|i| one.surface.within[i])
    };
    if others.iter().any(all) {
        return None;
    }
    let surface = about(scene, cloud)?;
    // Where no fit can be made nothing can be checked.
    session.timed("enclosures", || Enclosed::new(region, form, surface).ok())
}

/// What the field does through a surface about all bodies.
pub(super) fn all_within<'a, const D: usize>(
    scene: &Scene,
    at: (&Region<D>, &[f64]),
    about: &'a Option<Enclosed<D>>,
) -> Option<Closed<'a>> {
    about.as_ref().map(|one| closed(scene, at, one))
}

impl<const D: usize> Setting<'_, D> {
    /// Adds the forces and the heat of eddy currents; `totals` are those of all conductors.
    pub(super) fn enclosed<const K: usize>(
        &self,
        solution: Solution<'_, K>,
        (fields, totals): (&Fields, &Totals),
        (source, acting): (&Source, Acting<'_>),
        all: &mut Found,
    ) {
        for one in &self.enclosed {
            let surface = &one.surface;
            let medium = self.scene.medium(surface.medium as usize);
            let mu = MU0 * medium.relative_permeability;
            let (stress, heat) = self.stress(one, solution.found, source);
            let kept = |i: usize| surface.within[i];
            let bodies = Totals::bodies(&self.region, fields, &self.weights, (acting, kept));
            let mut ways = vec![
                stress.map(|f| f / mu),
                bodies.force_volume,
                bodies.force_stress,
            ];
            let mut points = self.weights.iter().enumerate();
            if points.all(|(i, w)| *w == 0.0 || kept(i)) {
                ways.push(totals.force_coil);
            }
            push(self.scene, &format!("{}.force", surface.name), &ways, all);
            if let Some(heat) = heat {
                let unit = match self.scene.geometry {
                    Geometry::Plane => "W/m",
                    Geometry::Axisymmetric | Geometry::Space => "W",
                };
                let name = format!("{}.power", surface.name);
                all.totals.push((name, unit, heat / mu));
            }
        }
    }

    /// Force over a surface, and in a sinusoidal steady state heat within, both times the permeability.
    ///
    /// Sources alone exert no force and bring no heat where the surface encloses none: what they give by themselves is
    /// left out, which near coils is most of what the sum over the places errs by. A potential V of charges, which is not
    /// computed in air, adds nothing to the heat: `grad V x H = curl(V H)` where no current flows.
    fn stress<const K: usize>(
        &self,
        one: &Enclosed<D>,
        found: &[[C; K]],
        source: &Source,
    ) -> (Vector, Option<f64>) {
        let surface = &one.surface;
        let alone = source.flux(&surface.places);
        let own = one.magnetic(self.unknown, found);
        let flux: Vec<[C; 3]> = own
            .iter()
            .zip(&alone)
            .map(|(a, s)| sum(&a.flux, s))
            .collect();
        let force = minus(surface.stress(&flux), surface.stress(&alone));
        // What is applied along bars has no part in the potential beyond them.
        let omega = self.omega.filter(|_| self.bars.is_empty());
        let heat = omega.map(|omega| {
            let given = one.potential(self.unknown, &self.given::<K>(source, &surface.places));
            let rate = C::new(0.0, -omega);
            let flow = |n: usize| {
                let electric = |a: &[C; 3]| a.map(|a| rate * a);
                let total = sum(&own[n].potential, &given[n]);
                let all = cross_mean(electric(&total), flux[n]);
                minus(all, cross_mean(electric(&given[n]), alone[n]))
            };
            surface.inward((0..own.len()).map(flow))
        });
        (force, heat)
    }
}

fn sum(a: &[C; 3], b: &[C; 3]) -> [C; 3] {
    std::array::from_fn(|k| a[k] + b[k])
}
