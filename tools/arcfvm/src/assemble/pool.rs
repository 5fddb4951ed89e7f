//! The surface of the pool, as another stage or a person left it.
//!
//! A pool is a profile of heights over the radius: of kind `surface-profile` as it is typed, or the
//! channel `/profile` of `mean-fields`, which `avg` makes of the frames of a pool. It is taken as it
//! is, without smoothing: straight between its radii, level on the axis and beyond the last ring.
//! Cells are metal where their middle lies below it, so that it is met to half a cell.

use std::path::Path;

use artefact::{Reader, Table};
use run::{Failure, Fault};
use serde::Deserialize;

use crate::case::Case;
use crate::curve::Surface;
use crate::scene::{Profile, Scene, Shape};

/// Least part of the places and frames of a ring that have metal.
const COVERED: f64 = 0.95;
/// Part of the whole bend of an averaged surface by which its last rings may differ: it is held level beyond them.
const LEVEL: f64 = 0.1;

/// A file of kind `surface-profile`: height over radius.
#[derive(Debug, Clone, Deserialize)]
struct File {
    radius_m: Vec<f64>,
    height_m: Vec<f64>,
}

/// The scene with the surface in `path` on the body that has a profile without one, and what is to be told of it.
///
/// # Errors
/// When the file holds no surface, no body waits for one, or the surface leaves the body or the domain.
pub(crate) fn deform(scene: &Scene, path: &Path) -> Result<(Scene, Option<String>), Failure> {
    let surface = read(path)?;
    let is_averaged = path.extension().is_some_and(|e| e == "mcap");
    let refused = |what: &str| Failure::Other(format!("{}: {what}", path.display()));
    if let Some(what) = surface.fault() {
        return Err(refused(what));
    }
    let mut scene = scene.clone();
    let domain = scene.domain.z_m;
    let open = scene
        .bodies
        .iter_mut()
        .find_map(|(name, body)| match &mut body.shape {
            Shape::Profile(profile) if profile.top.is_none() => Some((name, profile)),
            _ => None,
        });
    let Some((name, profile)) = open else {
        let what = "the input \"surface\" is given, but no body has a shape/profile without a top";
        return Err(Failure::Scene(vec![Fault::at("/bodies", what)]));
    };
    if let Some(what) = leaves(&surface, profile, domain) {
        let what = format!("the surface in {} {what}", path.display());
        return Err(Fault::at(&format!("/bodies/{name}/shape/profile"), what).into());
    }
    let told = is_averaged.then(|| ends(&surface, profile)).flatten();
    let told = told.map(|what| format!("the surface in {} {what}", path.display()));
    profile.top = Some(surface);
    Ok((scene, told))
}

/// How an averaged surface ends within its body where it is not level yet.
fn ends(surface: &Surface, profile: &Profile) -> Option<String> {
    let heights = surface.z_m.iter().copied();
    let bend =
        heights.clone().fold(f64::NEG_INFINITY, f64::max) - heights.fold(f64::INFINITY, f64::min);
    let ([.., r], [.., before, z]) = (surface.r_m.as_slice(), surface.z_m.as_slice()) else {
        return None;
    };
    let step = (z - before).abs();
    (*r < profile.r_m[1] && step > LEVEL * bend).then(|| {
        let [r, edge, step, bend] = [*r, profile.r_m[1], step, bend].map(|x| x * 1e3);
        format!(
            "ends at r = {r:.3} mm of {edge:.3} mm, where it still changes by {step:.3} mm in a ring, of {bend:.3} mm in all: \
             beyond it the metal is level; average over a greater profile/radius_m"
        )
    })
}

fn read(path: &Path) -> Result<Surface, Failure> {
    if path.extension().is_some_and(|e| e == "mcap") {
        return averaged(path);
    }
    let file = artefact::json_artefact::<File>(path, "surface-profile", 1)?;
    Ok(Surface {
        r_m: file.radius_m,
        z_m: file.height_m,
    })
}

/// The profile of a pool that was averaged.
fn averaged(path: &Path) -> Result<Surface, Failure> {
    let reader = Reader::open_kind(path, "mean-fields", 1)?;
    if !reader.has("/profile") {
        let what = "has no channel '/profile': average with the key 'profile' in the scene of avg";
        return Err(Failure::Other(format!("{}: {what}", path.display())));
    }
    let table = reader.table("/profile")?;
    if let Some(what) = uncovered(&table)? {
        return Err(Failure::Other(format!("{}: {what}", path.display())));
    }
    Ok(Surface {
        r_m: table.values("radius_m")?.to_vec(),
        z_m: table.values("height_m")?.to_vec(),
    })
}

/// The first ring that metal does not cover.
fn uncovered(table: &Table) -> artefact::Result<Option<String>> {
    let rings = table.values("outer_radius_m")?.iter();
    let mut rings = rings.zip(table.values("metal_share")?);
    let short = rings.find(|(_, share)| **share < COVERED);
    Ok(short.map(|(outer, share)| {
        format!(
            "channel '/profile': the ring up to r = {:.3} mm has metal at {:.1} % of its places and times; wanted are \
             {:.0} %: average over a smaller profile/radius_m",
            outer * 1e3,
            share * 1e2,
            COVERED * 1e2
        )
    }))
}

/// How the surface leaves its body or the domain.
fn leaves(surface: &Surface, profile: &Profile, domain: [f64; 2]) -> Option<String> {
    let mut points = surface.r_m.iter().zip(&surface.z_m);
    let outside = |z: f64| z <= profile.bottom_m || z >= domain[1];
    let (r, z) = points.find(|(_, z)| outside(**z))?;
    let (what, limit) = match *z <= profile.bottom_m {
        true => ("goes through the body, whose bottom_m is", profile.bottom_m),
        false => ("leaves the domain, which ends at", domain[1]),
    };
    let [r, z, limit] = [r, z, &limit].map(|x| x * 1e3);
    Some(format!(
        "{what} {limit:.3} mm: it is at z = {z:.3} mm at r = {r:.3} mm"
    ))
}

/// What a reader of the result should know: a surface that bends by less than the cells tell.
pub(crate) fn told(scene: &Scene, case: &Case) -> Option<String> {
    let base = case.base.as_ref().filter(|base| !base.is_deformed())?;
    let (name, body) = scene.bodies.iter().nth(base.material.checked_sub(1)?)?;
    let Shape::Profile(Profile { top: Some(top), .. }) = &body.shape else {
        return None;
    };
    let least = top.z_m.iter().copied().fold(f64::INFINITY, f64::min);
    let most = top.z_m.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let level = case.grid.zf[base.top()];
    let [bend, least, most, level] = [most - least, least, most, level].map(|z| z * 1e3);
    (bend > 0.0).then(|| {
        format!(
            "the surface of \"{name}\" bends by {bend:.3} mm alone, from z = {least:.3} to {most:.3} mm, which no cell \
             tells: the metal is level at z = {level:.3} mm"
        )
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_surface_that_ends_on_a_slope_is_told() {
        let profile = Profile {
            r_m: [0.0, 0.02],
            bottom_m: -0.01,
            top: None,
        };
        let of = |z_m: &[f64]| {
            let surface = Surface {
                r_m: vec![5e-4, 1.5e-3, 2.5e-3, 3.5e-3],
                z_m: z_m.to_vec(),
            };
            ends(&surface, &profile)
        };
        let told = of(&[-2e-3, -1.5e-3, -1e-3, -5e-4]).unwrap();
        assert!(told.contains("r = 3.500 mm of 20.000 mm"), "{told}");
        assert_eq!(of(&[-2e-3, -1e-3, 2e-4, 3e-4]), None);
    }
}
