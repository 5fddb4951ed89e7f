//! A drop at rest on a wall: from a scene to its shape.

use artefact::{Frame, Record, Table};
use run::{Failure, Session};
use shapes::shape::Sphere;

use crate::liquid::sessile::{Place, Sessile, Stood, stands};
use crate::scene::{Liquid as Part, Scene};

/// Finds the shape and writes it.
///
/// # Errors
/// Where no drop is at rest, or the disk refuses.
pub(super) fn sessile(
    scene: &Scene,
    (part, sphere, angle): (&Part, &Sphere, f64),
    session: &mut Session,
) -> Result<(), Failure> {
    let (radius, tension) = (sphere.radius_m, part.surface_tension_n_m.unwrap_or(0.0));
    let along = part.gravity_m_s2.as_ref().and_then(|g| g.get(2));
    let gravity = -along.copied().unwrap_or(0.0);
    let bond = part.density_kg_m3 * gravity * radius * radius / tension;
    let found = session.timed("equilibrium", || stands(angle.to_radians(), bond));
    let shape = match found {
        Stood::Rest(shape) => shape,
        Stood::Falls(most) => {
            let larger = 0.75 * most / std::f64::consts::PI;
            return Err(Failure::Other(format!(
                "no drop is at rest: the wall holds one of {:.4e} m at most, as the radius of a sphere",
                larger.cbrt() * radius
            )));
        }
        Stood::Lost => {
            return Err(Failure::Other(format!(
                "no drop at rest is found at a contact angle of {angle} deg and rho g R^2/gamma = {bond:.3e}"
            )));
        }
    };
    let stress = tension / radius;
    let record = Record::new()
        .with("height", "m", shape.height() * radius)
        .with("radius_base", "m", shape.base() * radius)
        .with("radius_widest", "m", shape.widest() * radius)
        .with("volume", "m3", shape.volume * radius.powi(3))
        .with("bond_number", "1", bond)
        .with(
            "pressure",
            "Pa",
            part.gas_pressure_pa + shape.pressure * stress,
        );
    session.record("/liquid", 0.0, &record)?;
    outline((scene, sphere), &shape, session)?;
    session.closing("height", "m", shape.height() * radius);
    session.closing("radius_base", "m", shape.base() * radius);
    Ok(())
}

/// Writes places of the outline as a table and, on both sides of the axis, as a frame.
fn outline(
    (scene, sphere): (&Scene, &Sphere),
    shape: &Sessile,
    session: &mut Session,
) -> Result<(), Failure> {
    let radius = sphere.radius_m;
    let places = &shape.places;
    let up = |p: &Place| (shape.height() - p.z) * radius;
    let bent = |p: &Place| p.curvature / radius;
    let table = Table::new(places.len())
        .column("r_m", "m", places.iter().map(|p| p.r * radius))
        .column("z_m", "m", places.iter().map(up))
        .column("curvature", "1/m", places.iter().map(bent));
    session.table("/outline", 0.0, &table)?;
    let precision = scene.output.precision.into();
    let both: Vec<(&Place, f64)> = places.iter().flat_map(|p| [(p, 1.0), (p, -1.0)]).collect();
    let position = both.iter().map(|(p, side)| {
        let at = [side * p.r * radius, 0.0, up(p)];
        std::array::from_fn(|k| sphere.centre_m[k] + at[k])
    });
    let frame = Frame::new(precision).positions(position).scalar(
        "curvature",
        "1/m",
        both.iter().map(|(p, _)| bent(p)),
    );
    session.frame("/surface", 0.0, &frame)
}
