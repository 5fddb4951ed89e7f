//! Walls of electrostatics that stand for open space: where the moments of bodies are counted, and what is applied.

use run::{Failure, Fault, Session};

use super::about::{halfway, middle, surface};
use super::walls::Walls;
use crate::cloud::{Class, Cloud};
use crate::electric::open::Open;
use crate::electric::traction::EPS0;
use crate::output::Found;
use crate::scene::{Electrostatics, Geometry, Scene};
use crate::stencils::region::{Kind, Region};
use crate::stencils::sides::Form;
use crate::surface::fits::Enclosed;

/// Where what is wrong with open walls is told.
const AT: &str = "/electrostatics/outer";
/// Distance of the places where moments are counted over the room between them and bodies or walls: in space, where the
/// rule is that of Gauss, and in a plane or about an axis, where it is of second order.
const PART: [f64; 2] = [0.4, 0.0625];
/// Flux of an applied field out of a closed surface, over what its parts come to without their signs, from which it is told.
const SOURCES: f64 = 0.02;

/// Open walls of a scene.
pub(super) struct Opened {
    /// Their multipoles.
    pub(super) far: Open,
    /// Potential that is applied, by point, where it counts; zero elsewhere \[V\].
    pub(super) applied: Vec<f64>,
    /// By point: 1 on walls.
    pub(super) walls: Vec<[f64; 1]>,
    /// Whether the potential far away is unknown.
    pub(super) floats: bool,
}

impl Opened {
    /// Those of a scene; none where walls are not open, or where there is no body.
    ///
    /// # Errors
    /// Where a body reaches a wall, there is no room between them, or a formula has no value.
    pub(super) fn new<const D: usize>(
        (scene, cloud): (&Scene, &Cloud),
        walls: &Walls<'_>,
        (region, form): (&Region<D>, &Form),
        session: &mut Session,
    ) -> Result<Option<Self>, Failure> {
        if !walls.open || cloud.surface.is_empty() {
            return Ok(None);
        }
        let enclosed = session.timed("multipoles", || about(scene, cloud, (region, form)))?;
        let far = session.timed("multipoles", || {
            Open::new(region, &enclosed, region_centre(cloud))
        });
        let mut applied = vec![0.0; region.len()];
        for (i, applied) in applied.iter_mut().enumerate() {
            if far.asks(i) {
                *applied = walls.applied(cloud.position[i])?;
            }
        }
        if let Some(what) = sources(region, &enclosed, &applied) {
            session.warn(what);
        }
        let on_wall = |kind: &Kind| f64::from(u8::from(matches!(kind, Kind::Wall { .. })));
        let floats = far.logarithmic() && scene.bodies.iter().any(|b| b.potential_v.is_some());
        Ok(Some(Self {
            far,
            applied,
            walls: region.kinds.iter().map(|kind| [on_wall(kind)]).collect(),
            floats,
        }))
    }

    /// Charge and dipole moment of all bodies, as seen from afar.
    pub(super) fn totals(&self, scene: &Scene, potential: &[f64], found: &mut Found) {
        let eps = EPS0 * scene.surroundings.relative_permittivity;
        let plane = scene.geometry == Geometry::Plane;
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
        let axes: &[char] = match scene.geometry {
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

/// Refuses bodies that reach a wall that is open, or leave no room before it.
///
/// # Errors
/// The body or the room.
pub fn room(scene: &Scene, electrostatics: &Electrostatics, cloud: &Cloud) -> Result<(), Fault> {
    if !electrostatics.open() || cloud.surface.is_empty() {
        return Ok(());
    }
    for (class, [x, y, z]) in cloud.class.iter().zip(&cloud.position) {
        if let Class::Outer { medium, face } = class
            && *medium > 0
        {
            let wall = scene.domain.walls(scene.geometry)[*face as usize];
            let name = scene.medium_name(*medium as usize);
            let what = format!(
                "{name} touches the wall {wall} at ({x:.3e}, {y:.3e}, {z:.3e}) m: multipoles hold beyond all bodies; leave room, or give the potentials of the walls"
            );
            return Err(Fault::at(AT, what));
        }
    }
    let (_, room) = halfway(scene, cloud);
    let spacing = scene.points.spacing_m;
    if room < spacing {
        let what = format!(
            "bodies come as near as {:.3e} m to the walls, and the surface between them over which multipoles are counted wants room for two spacings of {spacing:.3e} m: move the walls away, or take finer points",
            2.0 * room
        );
        return Err(Fault::at(AT, what));
    }
    Ok(())
}

/// The surface over which moments are counted, with fits of the points about it.
fn about<const D: usize>(
    scene: &Scene,
    cloud: &Cloud,
    (region, form): (&Region<D>, &Form),
) -> Result<Enclosed<D>, Fault> {
    let (shape, room) = halfway(scene, cloud);
    let part = if D == 3 { PART[0] } else { PART[1] };
    let surface = surface(scene.geometry, &shape, part * room);
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
