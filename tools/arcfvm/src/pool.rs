//! The surface of the pool, as another stage left it.

use std::path::Path;

use run::{Failure, Fault};
use serde::Deserialize;

use crate::scene::{Scene, Shape, Surface};

/// A file of kind `surface-profile`: height over radius.
#[derive(Debug, Clone, Deserialize)]
struct File {
    radius_m: Vec<f64>,
    height_m: Vec<f64>,
}

/// The scene with the surface in `path` on the body that has a profile without one.
pub(crate) fn deform(scene: &Scene, path: &Path) -> Result<Scene, Failure> {
    let file = artefact::json_artefact::<File>(path, "surface-profile", 1)?;
    let surface = Surface {
        r_m: file.radius_m,
        z_m: file.height_m,
    };
    if let Some(what) = surface.fault() {
        return Err(Failure::Other(format!("{}: {what}", path.display())));
    }
    let mut scene = scene.clone();
    let open = scene
        .bodies
        .values_mut()
        .find_map(|body| match &mut body.shape {
            Shape::Profile(profile) if profile.top.is_none() => Some(profile),
            _ => None,
        });
    let Some(profile) = open else {
        let what = "the input \"surface\" is given, but no body has a shape/profile without a top";
        return Err(Failure::Scene(vec![Fault::at("/bodies", what)]));
    };
    profile.top = Some(surface);
    Ok(scene)
}
