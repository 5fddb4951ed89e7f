//! Walls of electrostatics that stand for open space: where the moments of bodies are counted, and what is applied.

use run::{Failure, Fault, Session};
use shapes::frame::Vector;

use super::rows::Open;
use crate::cloud::Cloud;
use crate::electric::equations::Problem;
use crate::electric::traction::EPS0;
use crate::frames::Found;
use crate::geometry::Geometry;
use crate::stencils::region::{Kind, Region};
use crate::stencils::sides::Form;
use crate::surface::fits::Enclosed;
use crate::surface::halfway::{halfway, middle, surface};

/// Where what is wrong with open walls is told.
pub(crate) const AT: &str = "/electrostatics/outer";
/// Distance of the places where moments are counted over the room between them and bodies or walls: in space, where the
/// rule is that of Gauss, and in a plane or about an axis, where it is of second order.
const PART: [f64; 2] = [0.4, 0.0625];
/// Flux of an applied field out of a closed surface, over what its parts come to without their signs, from which it is told.
const SOURCES: f64 = 0.02;

/// The potential that is applied at a place in space \[V\].
pub(crate) type Applied<'a> = &'a dyn Fn(Vector) -> Result<f64, Failure>;

/// Open walls of a scene.
pub(crate) struct OpenWalls {
    /// Their multipoles.
    pub(crate) far: Open,
    /// Potential that is applied, by point, where it counts; zero elsewhere \[V\].
    pub(crate) applied: Vec<f64>,
    /// By point: 1 on walls.
    pub(crate) walls: Vec<[f64; 1]>,
    /// Whether the potential far away is unknown.
    pub(crate) floats: bool,
}

impl OpenWalls {
    /// Those to which a potential is applied; none where walls are not open, or where there is no body.
    ///
    /// # Errors
    /// Where a body reaches a wall, there is no room between them, or a formula has no value.
    pub(crate) fn new<const D: usize>(
        cloud: &Cloud,
        problem: &Problem,
        potential: Option<Applied<'_>>,
        region: &Region<D>,
        form: &Form,
        session: &mut Session,
    ) -> Result<Option<Self>, Failure> {
        let Some(potential) = potential.filter(|_| !cloud.surface.is_empty()) else {
            return Ok(None);
        };
        let enclosed = session.timed("multipoles", || about(cloud, region, form))?;
        let far = session.timed("multipoles", || {
            Open::new(region, &enclosed, region_centre(cloud))
        });
        let mut applied = vec![0.0; region.len()];
        for (i, applied) in applied.iter_mut().enumerate() {
            if far.asks(i) {
                *applied = potential(cloud.position[i])?;
            }
        }
        if let Some(what) = sources(region, &enclosed, &applied) {
            session.warn(what);
        }
        let on_wall = |kind: &Kind| f64::from(u8::from(matches!(kind, Kind::Wall { .. })));
        let floats = far.logarithmic() && problem.electrodes.iter().any(Option::is_some);
        Ok(Some(Self {
            far,
            applied,
            walls: region.kinds.iter().map(|kind| [on_wall(kind)]).collect(),
            floats,
        }))
    }

    /// Charge and dipole moment of all bodies, as seen from afar.
    pub(crate) fn totals(
        &self,
        geometry: Geometry,
        permittivity: f64,
        potential: &[f64],
        found: &mut Found,
    ) {
        let eps = EPS0 * permittivity;
        let plane = geometry == Geometry::Plane;
        let (charge, dipole) = if plane { ("C/m", "C") } else { ("C", "C m") };
        let own: Vec<f64> = potential
            .iter()
            .zip(&self.applied)
            .map(|(v, a)| v - a)
            .collect();
        let whole = eps * self.far.flux(&own);
        found
            .totals
            .push(("electric_charge".to_owned(), charge, whole));
        let axes: &[char] = match geometry {
            Geometry::Axisymmetric => &['z'],
            Geometry::Plane | Geometry::Space => &['x', 'y', 'z'],
        };
        for (moment, axis) in self.far.dipole(&own).iter().zip(axes) {
            found
                .totals
                .push((format!("electric_dipole_{axis}"), dipole, eps * moment));
        }
    }
}

/// The middle of all bodies in the coordinates of the points.
fn region_centre<const D: usize>(cloud: &Cloud) -> [f64; D] {
    let middle = middle(cloud);
    std::array::from_fn(|k| middle[k])
}

/// The surface over which moments are counted, with fits of the points about it.
fn about<const D: usize>(
    cloud: &Cloud,
    region: &Region<D>,
    form: &Form,
) -> Result<Enclosed<D>, Fault> {
    let (shape, room) = halfway(cloud);
    let part = if D == 3 { PART[0] } else { PART[1] };
    let surface = surface(cloud.geometry, &shape, part * room);
    let failed = |error: wls::Error| {
        let what = format!("too few points lie between bodies and walls for multipoles: {error}");
        Fault::at(AT, what)
    };
    Enclosed::new(region, form, surface).map_err(failed)
}

/// Says where an applied potential has sources among the bodies, so that it does not come from outside alone.
fn sources<const D: usize>(
    region: &Region<D>,
    enclosed: &Enclosed<D>,
    applied: &[f64],
) -> Option<String> {
    let field = enclosed.electric(region, applied);
    let surface = &enclosed.surface;
    let (mut flux, mut gross) = (0.0, 0.0);
    for ((field, n), area) in field.iter().zip(&surface.normals).zip(&surface.areas) {
        let through: f64 = field.iter().zip(n).map(|(e, n)| e.re * n).sum();
        flux += area * through;
        gross += area * through.abs();
    }
    (flux.abs() > SOURCES * gross).then(|| {
        format!(
            "the applied potential has sources within the walls: the flux of its field out of a surface about all bodies is {:.0} % of its parts without their signs; \"multipole\" wants one without a Laplacian there",
            100.0 * flux.abs() / gross
        )
    })
}
