//! What would be there before a run: points by medium, walls with what holds there, coils, probes; the points of a liquid.

use std::f64::consts::TAU;

use run::Failure;
use run::preview::{Coordinates, Marked, Preview, Spot};
use shapes::frame::{Frame, Vector};

use super::liquid::filled;
use crate::cloud::{self, Class};
use crate::geometry::Geometry;
use crate::liquid::vector::spatial;
use crate::scene::currents::Loop;
use crate::scene::{Coil, Faces, Liquid, Scene};

/// Sides of the polygon that a loop is drawn as.
const SIDES: usize = 48;

/// Points, walls, coils and probes of a scene.
///
/// # Errors
/// Faults of the scene.
pub(crate) fn preview(scene: &Scene) -> Result<Preview, Failure> {
    let faults = scene.faults();
    if !faults.is_empty() {
        return Err(faults.into());
    }
    if let Some(part) = &scene.liquid {
        return liquid(scene, part);
    }
    let cloud = cloud::setup::cloud(scene)?;
    let mut preview = Preview::new(match scene.geometry {
        Geometry::Plane => Coordinates::Plane,
        Geometry::Axisymmetric => Coordinates::Axisymmetric,
        Geometry::Space => Coordinates::Space,
    });
    for medium in 0..=scene.bodies.len() {
        preview.material(scene.medium_name(medium));
    }
    let walls = scene.domain.walls(scene.geometry);
    for point in 0..cloud.len() {
        let (medium, condition) = match cloud.class[point] {
            Class::Inside(medium) => (medium, 0),
            Class::Interface { inner, .. } => {
                let name = on_body(scene, usize::from(inner));
                (inner, preview.condition(&name))
            }
            Class::Outer { medium, face } => {
                let wall = walls.get(usize::from(face)).copied().unwrap_or("wall");
                (medium, preview.condition(&at_wall(scene, wall)))
            }
        };
        preview.spot(Spot {
            place: cloud.position[point],
            size: extent(scene.geometry, cloud.spacing[point]),
            material: u32::from(medium),
            condition,
        });
    }
    coils(scene, &mut preview);
    for probe in &scene.output.probes {
        let own = std::array::from_fn(|k| probe.place_m.get(k).copied().unwrap_or(0.0));
        let place = scene.geometry.place(own);
        preview.mark(Marked::Probe, &probe.name, vec![vec![place]]);
    }
    Ok(preview)
}

/// The points of a liquid at its start.
fn liquid(scene: &Scene, part: &Liquid) -> Result<Preview, Failure> {
    match (&part.faces, scene.geometry) {
        (Some(faces), Geometry::Space) => return between::<3>(scene, part, faces),
        (Some(faces), _) => return between::<2>(scene, part, faces),
        (None, _) => {}
    }
    let filled = filled(scene, part)?;
    let mut preview = Preview::new(Coordinates::Space);
    let material = preview.material("liquid");
    let free = preview.condition("free surface");
    for (i, place) in filled.position.iter().enumerate() {
        preview.spot(Spot {
            place: *place,
            size: [scene.points.spacing_m; 3],
            material,
            condition: if i < filled.normal.len() { free } else { 0 },
        });
    }
    Ok(preview)
}

/// The points of a liquid between faces at its start.
fn between<const D: usize>(
    scene: &Scene,
    part: &Liquid,
    faces: &Faces,
) -> Result<Preview, Failure> {
    let (room, filled) = super::liquid::between::filled::<D>(scene, part, faces)?;
    let mut preview = Preview::new(match scene.geometry {
        Geometry::Space => Coordinates::Space,
        _ => Coordinates::Plane,
    });
    let material = preview.material("liquid");
    let surface = filled.normal.len();
    let walls = surface..surface + room.held.len();
    let free = preview.condition("free surface");
    let held = preview.condition("wall");
    for (i, place) in filled.position.iter().enumerate() {
        preview.spot(Spot {
            place: spatial(place),
            size: extent(scene.geometry, scene.points.spacing_m),
            material,
            condition: match i {
                _ if i < surface => free,
                _ if walls.contains(&i) => held,
                _ => 0,
            },
        });
    }
    Ok(preview)
}

fn extent(geometry: Geometry, spacing: f64) -> Vector {
    match geometry {
        Geometry::Space => [spacing; 3],
        Geometry::Plane => [spacing, spacing, 0.0],
        Geometry::Axisymmetric => [spacing, 0.0, spacing],
    }
}

/// What the surface of a medium's body is called.
fn on_body(scene: &Scene, medium: usize) -> String {
    let name = scene.medium_name(medium);
    let body = medium.checked_sub(1).map(|k| &scene.bodies[k]);
    match body.is_some_and(|b| b.potential_v.is_some()) {
        true => format!("surface of {name}: potential"),
        false => format!("surface of {name}"),
    }
}

/// What holds at a wall.
fn at_wall(scene: &Scene, wall: &str) -> String {
    let electric = scene.electrostatics.as_ref().map(|e| {
        let names = |faces: &Option<Vec<String>>| {
            faces.as_ref().is_none_or(|f| f.iter().any(|f| f == wall))
        };
        let entry = e.walls().iter().find(|entry| names(&entry.faces));
        match entry.is_some_and(|entry| entry.potential_v.is_some()) {
            _ if e.open() => "open space",
            true => "potential",
            false => "no field through it",
        }
    });
    match electric {
        Some(what) => format!("wall {wall}: {what}"),
        None => format!("wall {wall}"),
    }
}

/// Coils that are no points.
fn coils(scene: &Scene, preview: &mut Preview) {
    let all = scene.eddy_currents.iter().flat_map(|e| &e.coils);
    for (k, coil) in all.enumerate() {
        let lines = match coil {
            Coil::Loop(of) => vec![ring(of, scene.geometry)],
            Coil::Segments(of) => {
                let first = of.points_m.first().copied();
                let closing = first.filter(|_| of.closed);
                vec![of.points_m.iter().copied().chain(closing).collect()]
            }
            Coil::Wire(of) => vec![vec![[of.place_m[0], of.place_m[1], 0.0]]],
            Coil::Region(_) => continue,
        };
        preview.mark(Marked::Coil, &format!("coil {}", k + 1), lines);
    }
}

/// A loop as a polygon; where the scene turns about an axis, the place where it crosses the half plane.
fn ring(of: &Loop, geometry: Geometry) -> Vec<Vector> {
    let centre = std::array::from_fn(|k| of.centre_m.get(k).copied().unwrap_or(0.0));
    if geometry == Geometry::Axisymmetric {
        return vec![[of.radius_m, 0.0, centre[1]]];
    }
    let frame = Frame::facing(centre, of.normal.unwrap_or([0.0, 0.0, 1.0]));
    let corner = |k: usize| {
        let angle = TAU * k as f64 / SIDES as f64;
        let (own, other) = (of.radius_m * angle.cos(), of.radius_m * angle.sin());
        std::array::from_fn(|c| centre[c] + own * frame.axes[0][c] + other * frame.axes[1][c])
    };
    (0..=SIDES).map(corner).collect()
}
