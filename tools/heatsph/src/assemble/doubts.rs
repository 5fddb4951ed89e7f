//! What a scene asks for that the points do not show.

use crate::boundary::Surface;
use crate::material::cells::Ground;
use crate::material::{Materials, Meetings};
use crate::scene::Scene;

/// Part of an area by which held points may miss it: a row more or less on a face of five.
const COARSE: f64 = 0.25;

/// All of them.
pub(super) fn all(
    scene: &Scene,
    surface: &Surface,
    materials: &Materials,
    ground: Ground<'_>,
) -> Vec<String> {
    let mut told = held(scene, surface);
    told.extend(unmet(scene, materials, ground));
    told
}

/// Entries whose held points stand for another area than the one asked for.
fn held(scene: &Scene, surface: &Surface) -> Vec<String> {
    let unit = if scene.dimensions == 2 { "m" } else { "m2" };
    let each = surface.asked.iter().zip(&surface.area).enumerate();
    let coarse = each.filter(|(_, (asked, held))| (*held - *asked).abs() > COARSE * *asked);
    let told = coarse.map(|(entry, (asked, held))| {
        format!(
            "boundaries/{entry}: the temperature holds on {held:.4e} {unit}, by whole points, where {asked:.4e} {unit} of the faces \
             lie within the shape; a smaller \"points/spacing_m\" follows it"
        )
    });
    told.collect()
}

/// Materials and contacts that no point and no link between points meets.
fn unmet(scene: &Scene, materials: &Materials, ground: Ground<'_>) -> Vec<String> {
    let (cloud, links) = (ground.cloud, ground.links);
    let points = Meetings::of_points(materials, cloud);
    let alone = (0..materials.len()).all(|m| points.materials[m]);
    if alone && scene.contacts.is_empty() {
        return Vec::new();
    }
    let met = Meetings::of_links(materials, cloud, links);
    let mut told = Vec::new();
    for (number, material) in scene.materials.iter().enumerate() {
        if !points.materials[number] && !met.materials[number] {
            told.push(format!(
                "materials/{number}: no point and no link between points meets \"{}\", which takes no part; its region lies \
                 outside of the body or within those of materials before it, or the points are too coarse for it",
                material.name
            ));
        }
    }
    for (number, contact) in scene.contacts.iter().enumerate() {
        let place = |name: &String| scene.materials.iter().position(|m| m.name == *name);
        let [a, b] = contact.between.each_ref().map(place);
        if let (Some(a), Some(b)) = (a, b)
            && !met.touch(a, b)
        {
            let [a, b] = &contact.between;
            told.push(format!(
                "contacts/{number}: \"{a}\" and \"{b}\" touch on no link between points, so that its resistance takes no part"
            ));
        }
    }
    told
}
