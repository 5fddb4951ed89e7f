//! Coils of a scene with media of different permeability: whether their field is known where they lie.

use run::Fault;

use crate::cloud;
use crate::geometry::Geometry;
use crate::magnetic::setup::source;
use crate::magnetic::source::Source;
use crate::scene::{Coil, EddyCurrents, Scene};

/// Pieces of a loop or segment that are looked at.
const PIECES: usize = 48;

/// Looks whether coils lie where their field is known.
///
/// # Errors
/// Faults of coils that are bodies of another permeability than the surroundings, and of exact ones that lie in such.
pub(crate) fn magnets(scene: &Scene, currents: &EddyCurrents) -> Result<(), Vec<Fault>> {
    let magnetic = |m: usize| scene.magnetic(m);
    if !(1..=scene.bodies.len()).any(magnetic) {
        return Ok(());
    }
    let mut faults = Vec::new();
    for (k, body) in scene.bodies.iter().enumerate() {
        if magnetic(k + 1) && scene.carries(k + 1) {
            let what = format!(
                "{}: {} is a coil, whose current is given where the permeability is that of the surroundings, {}",
                body.relative_permeability.initial(),
                body.name,
                scene.surroundings.relative_permeability
            );
            let at = format!("/bodies/{k}/relative_permeability");
            faults.push(Fault::at(&at, what));
        }
    }
    let layout = cloud::setup::layout(scene);
    for (k, coil) in currents.coils.iter().enumerate() {
        let one = EddyCurrents {
            coils: vec![coil.clone()],
            applied_flux_density_t: None,
            ..currents.clone()
        };
        let kind = match coil {
            Coil::Loop(_) => "loop",
            Coil::Segments(_) => "segments",
            Coil::Wire(_) => "wire",
            Coil::Region(_) => continue,
        };
        let within = places(scene.geometry, &source(scene, &one))
            .into_iter()
            .map(|x| layout.medium(scene.geometry.coordinates(x)) as usize)
            .find(|m| magnetic(*m));
        if let Some(m) = within {
            let what = format!(
                "it runs through {}, of another permeability: its exact field is that in the surroundings; a coil of points may lie anywhere beside such a body",
                scene.medium_name(m)
            );
            faults.push(Fault::at(&format!("/eddy_currents/coils/{k}/{kind}"), what));
        }
    }
    if faults.is_empty() {
        Ok(())
    } else {
        Err(faults)
    }
}

/// Places through which currents run, in space.
fn places(geometry: Geometry, source: &Source) -> Vec<[f64; 3]> {
    let mut places = Vec::new();
    for one in &source.loops {
        if geometry == Geometry::Axisymmetric {
            places.push([one.radius, 0.0, one.centre[2]]);
        } else {
            places.extend(one.pieces(PIECES).into_iter().map(|(place, _)| place));
        }
    }
    for one in &source.segments {
        places.extend(one.pieces(PIECES).into_iter().map(|(place, _)| place));
    }
    places.extend(source.wires.iter().map(|w| [w.place[0], w.place[1], 0.0]));
    places
}
