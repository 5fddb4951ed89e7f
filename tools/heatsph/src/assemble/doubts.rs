//! What a scene asks for that the points do not show.

use crate::boundary::Surface;
use crate::scene::Scene;

/// Part of an area by which held points may miss it: a row more or less on a face of five.
const COARSE: f64 = 0.25;

/// Entries whose held points stand for another area than the one asked for.
pub(super) fn held(scene: &Scene, surface: &Surface) -> Vec<String> {
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
