//! A drop at rest in a uniform field: from a scene to its shape.

use artefact::{Frame, Record, Table};
use run::{Failure, Session};
use shapes::Shape;
use shapes::shape::Sphere;

use super::levitated::levitated;
use super::sessile::sessile;
use crate::liquid::equilibrium::{self, FEWEST, Found, Kind, MOST, Place, Sought};
use crate::scene::{Equilibrium, Liquid as Part, Scene};
use crate::surface::traction::EPS0;

/// Finds the shape and writes it.
///
/// # Errors
/// Where no drop is at rest, or the disk refuses.
pub fn rest(
    scene: &Scene,
    (part, rest): (&Part, &Equilibrium),
    session: &mut Session,
) -> Result<(), Failure> {
    let Shape::Sphere(sphere) = &part.shape else {
        return Ok(());
    };
    if let Some(angle) = rest.contact_angle_deg {
        return sessile(scene, (part, sphere, angle), session);
    }
    match rest.field_v_m {
        Some(applied) => drawn(scene, (part, rest), (sphere, applied), session),
        None => levitated(scene, part, session),
    }
}

/// A drop in a uniform field.
fn drawn(
    scene: &Scene,
    (part, rest): (&Part, &Equilibrium),
    (sphere, applied): (&Sphere, f64),
    session: &mut Session,
) -> Result<(), Failure> {
    let radius = sphere.radius_m;
    let stress = part.surface_tension_n_m.unwrap_or(0.0) / radius;
    // Ca = eps0 E^2 R/gamma.
    let field = |capillary: f64| (capillary * stress / EPS0).sqrt();
    let capillary = EPS0 * applied * applied / stress;
    let kind = rest
        .relative_permittivity
        .map_or(Kind::Conductor, Kind::Dielectric);
    let harmonics = (radius / scene.points.spacing_m).round();
    let harmonics = harmonics.clamp(FEWEST as f64, MOST as f64) as usize;
    let sought = Sought { kind, harmonics };
    let found = session.timed("equilibrium", || equilibrium::rest(sought, capillary));
    let at = format!("{applied} V/m (Ca = {capillary:.4})");
    let absent = |why: String| Failure::Other(format!("no drop is at rest at {at}: {why}"));
    let shape = match found {
        Found::Rest(shape) => Ok(shape),
        Found::Limit(most) => Err(absent(format!(
            "the greatest field is {:.4e} V/m (Ca = {most:.4})",
            field(most)
        ))),
        Found::Lost(height) => Err(absent(format!(
            "none is found whose pole is {height:.3} radii high"
        ))),
    }?;
    let pressure = part.gas_pressure_pa + shape.pressure * stress;
    let mut record = row(&shape, radius).with("pressure", "Pa", pressure).with(
        "residual",
        "Pa",
        shape.residual * stress,
    );
    if rest.limit {
        match session.timed("limit", || equilibrium::limit(sought)) {
            Some(most) => {
                record = record.with("capillary_limit", "1", most).with(
                    "field_limit",
                    "V/m",
                    field(most),
                );
            }
            None => session.note(
                "drops of this permittivity have no limit of the field up to twice their height",
            ),
        }
    }
    session.record("/liquid", 0.0, &record)?;
    outline(
        scene,
        sphere,
        (&shape.places(kind), capillary * stress),
        session,
    )?;
    session.closing("deformation", "1", shape.deformation());
    session.closing("residual", "Pa", shape.residual * stress);
    Ok(())
}

/// Radii and deformation.
fn row(shape: &equilibrium::Shape, radius: f64) -> Record {
    let [a, b] = shape.axes();
    Record::new()
        .with("radius_x", "m", b * radius)
        .with("radius_y", "m", b * radius)
        .with("radius_z", "m", a * radius)
        .with("axis_ratio", "1", a / b)
        .with("deformation", "1", shape.deformation())
        .with("capillary_number", "1", shape.capillary)
}

/// Writes places of the outline over the radius, with tractions over `traction` \[Pa\], as a table and as a frame.
fn outline(
    scene: &Scene,
    sphere: &Sphere,
    (places, traction): (&[Place], f64),
    session: &mut Session,
) -> Result<(), Failure> {
    let radius = sphere.radius_m;
    let bent = |p: &Place| p.curvature / radius;
    let pulled = |p: &Place| p.traction * traction;
    let table = Table::new(places.len())
        .column("r_m", "m", places.iter().map(|p| p.r * radius))
        .column("z_m", "m", places.iter().map(|p| p.z * radius))
        .column("curvature", "1/m", places.iter().map(bent))
        .column("traction", "Pa", places.iter().map(pulled));
    session.table("/outline", 0.0, &table)?;
    let precision = scene.output.precision.into();
    let both: Vec<(&Place, f64)> = places.iter().flat_map(|p| [(p, 1.0), (p, -1.0)]).collect();
    let position = both.iter().map(|(p, side)| {
        let at = [p.r * radius, 0.0, side * p.z * radius];
        std::array::from_fn(|k| sphere.centre_m[k] + at[k])
    });
    let frame = Frame::new(precision)
        .positions(position)
        .scalar("curvature", "1/m", both.iter().map(|(p, _)| bent(p)))
        .scalar("traction", "Pa", both.iter().map(|(p, _)| pulled(p)));
    session.frame("/surface", 0.0, &frame)
}
