//! A drop at rest on a wall: from a scene to its shape.

use artefact::Record;
use run::{Failure, Session};
use shapes::shape::Sphere;

use super::meridian;
use crate::liquid::sessile::{Stood, stands};
use crate::scene::{Liquid as Part, Scene};

/// Finds the shape and writes it.
///
/// # Errors
/// Where no drop is at rest, or the disk refuses.
pub(crate) fn sessile(
    scene: &Scene,
    part: &Part,
    sphere: &Sphere,
    angle: f64,
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
    let places: Vec<[f64; 2]> = (shape.places.iter())
        .map(|p| [p.r * radius, (shape.height() - p.z) * radius])
        .collect();
    let bent = shape.places.iter().map(|p| p.curvature / radius);
    let carried = [("curvature", "1/m", bent.collect())];
    let (centre, turned) = (&sphere.centre_m, [-1.0, 1.0]);
    meridian::write(scene, centre, &places, turned, &carried, session)?;
    session.closing("height", "m", shape.height() * radius);
    session.closing("radius_base", "m", shape.base() * radius);
    Ok(())
}
