//! A drop at rest in a uniform field: from a scene to its shape.

mod levitated;
mod meridian;
mod sessile;

use artefact::Record;
use run::{Failure, Session};
use shapes::Shape;
use shapes::shape::Sphere;

use self::levitated::levitated;
use self::sessile::sessile;
use crate::electric::traction::EPS0;
use crate::liquid::equilibrium::{self, FEWEST, Found, Kind, MOST, Sought};
use crate::scene::{Equilibrium, Liquid as Part, Scene};

/// Finds the shape and writes it.
///
/// # Errors
/// Where no drop is at rest, or the disk refuses.
pub(crate) fn rest(
    scene: &Scene,
    part: &Part,
    rest: &Equilibrium,
    session: &mut Session,
) -> Result<(), Failure> {
    let Shape::Sphere(sphere) = &part.shape else {
        return Ok(());
    };
    // A shape that is not found yet is worth no checkpoint.
    let _expendable = session.expendable();
    if let Some(angle) = rest.contact_angle_deg {
        return sessile(scene, part, sphere, angle, session);
    }
    match rest.field_v_m {
        Some(applied) => drawn(scene, part, rest, sphere, applied, session),
        None => levitated(scene, part, session),
    }
}

/// Harmonics of a shape so many spacings large, as far as there are.
fn harmonics(asked: f64, session: &mut Session) -> usize {
    let asked = asked.round();
    if asked > MOST as f64 {
        session.note(format!(
            "the spacing asks for {asked} harmonics of the shape, of which {MOST} are taken: the residual tells what they leave"
        ));
    }
    asked.clamp(FEWEST as f64, MOST as f64) as usize
}

/// A drop in a uniform field.
fn drawn(
    scene: &Scene,
    part: &Part,
    rest: &Equilibrium,
    sphere: &Sphere,
    applied: f64,
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
    let harmonics = harmonics(radius / scene.points.spacing_m, session);
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
    let found = shape.places(kind);
    let places: Vec<[f64; 2]> = (found.iter())
        .map(|p| [p.r * radius, p.z * radius])
        .collect();
    let bent = found.iter().map(|p| p.curvature / radius);
    let traction = capillary * stress;
    let pulled = found.iter().map(|p| p.traction * traction);
    let carried = [
        ("curvature", "1/m", bent.collect()),
        ("traction", "Pa", pulled.collect()),
    ];
    let (centre, turned) = (&sphere.centre_m, [1.0, -1.0]);
    meridian::write(scene, centre, &places, turned, &carried, session)?;
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
