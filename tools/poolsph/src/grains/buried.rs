//! Grains that begin inside walls: a contact pushes by its depth, and from there it would throw them out.

use particles::{POSITION, Set};
use run::Fault;
use shapes::Body;

use super::wall_parameters::WallScene;
use super::{DRIVEN, RADIUS};

/// Faults of walls that hold whole grains.
pub fn buried(walls: &[WallScene], grains: &Set) -> Vec<Fault> {
    let (places, radii) = (grains.column(&POSITION), grains.column(&RADIUS));
    let driven = grains.column(&DRIVEN);
    let free = |a: usize| driven.get(a).is_none_or(|body| *body == 0);
    let mut faults = Vec::new();
    for (number, wall) in walls.iter().enumerate() {
        let body = Body::new(&wall.shape, 3);
        let side = if wall.hollow { -1.0 } else { 1.0 };
        let inside = |a: &usize| free(*a) && side * body.distance(places[*a]) < -radii[*a];
        let mut within = (0..grains.len()).filter(inside);
        let Some(first) = within.next() else {
            continue;
        };
        let (count, all) = (1 + within.count(), places.len());
        let [x, y, z] = places[first];
        let what = format!(
            "{count} of {all} grains begin wholly inside this wall, the first at ({x:.4e}, {y:.4e}, {z:.4e}) m: \
             move it, or cut their bodies to its face"
        );
        faults.push(Fault::at(&format!("/walls/{number}"), what).or_at("/bodies"));
    }
    faults
}
