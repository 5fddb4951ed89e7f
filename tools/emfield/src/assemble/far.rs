//! How much the fields at bodies depend on points far from them.
//!
//! Ways to find a force or heat at a body share the field there: where points between body and wall are too far apart, all are wrong
//! by as much. So the scene is solved again with those points half as far again apart, and the fields on both sides of the
//! surfaces of bodies are compared. Errors fall at least as the square of the spacing: what is left is four fifths of the
//! change, or less. Where spacings rise slowly all points are as dense as those at the bodies, and nothing is solved again.

use run::{Failure, Session};

use super::steady;
use crate::cloud::{Cloud, SurfacePoint, setup};
use crate::frames::{Column, Found};
use crate::scene::Scene;

/// How many times as far apart points are in the second solution.
const WIDER: f64 = 1.5;
/// What is left of errors over the change.
const LEFT: f64 = 1.0 / (WIDER * WIDER - 1.0);
/// Rises of the spacing up to which points far away leave less than what is told.
const SLOW: f64 = 0.125;
/// Error over the field from which it is told, and from which it is a warning that matters.
const TOLD: f64 = 0.005;
const MATTERS: f64 = 0.02;

/// Whether spacings of a scene rise so fast that its far field is judged.
pub(crate) fn judged(scene: &Scene) -> bool {
    setup::layout(scene).steepest() > SLOW
}

/// Tells how far off the fields at the bodies of a scene are for points far from them.
///
/// # Errors
/// Where the run is interrupted.
pub(super) fn tell<const D: usize, const K: usize>(
    scene: &Scene,
    cloud: &Cloud,
    found: &Found,
    session: &mut Session,
) -> Result<(), Failure> {
    if cloud.surface.is_empty() || !judged(scene) {
        return Ok(());
    }
    let again = session.beside("far field", |session| {
        let (scene, cloud) = sparse(scene)?;
        let found = steady::<D, K>(&scene, &cloud, session)?;
        Ok((cloud, found))
    });
    let (wide, other) = match again {
        Ok(again) => again,
        Err(failure @ Failure::Interrupted { .. }) => return Err(failure),
        Err(failure) => {
            session.note(format!("the far field is not judged: {failure}"));
            return Ok(());
        }
    };
    if wide.surface.len() != cloud.surface.len() {
        session.note("the far field is not judged: surfaces have other points where those far away are fewer");
        return Ok(());
    }
    let [now, then] = [found, &other].map(|found| fields(found, cloud));
    let pairs = now.iter().zip(&then);
    let changes = pairs.map(|((name, now), (_, then))| (name, change(&cloud.surface, now, then)));
    let Some((name, change)) = changes.max_by(|a, b| a.1.total_cmp(&b.1)) else {
        return Ok(());
    };
    let off = LEFT * change;
    session.closing("far_field_error", "1", off);
    let told = || {
        format!(
            "far field: the {name} at bodies is off by about {:.1} % for points far from them, by a second solution with these {WIDER} times as far apart: take a smaller spacing_m, or a smaller \"outward\" or \"largest_m\" where these are given",
            100.0 * off
        )
    };
    if off > MATTERS {
        session.warn(told());
    } else if off > TOLD {
        session.note(told());
    }
    Ok(())
}

/// The scene with points far from bodies farther apart, and without what costs and is not asked for.
fn sparse(scene: &Scene) -> Result<(Scene, Cloud), Failure> {
    let mut sparse = scene.clone();
    sparse.output.enclosures.clear();
    sparse.points.extra_m.clear();
    let cloud = setup::wider(&sparse, WIDER)?;
    Ok((sparse, cloud))
}

/// Fields whose values at bodies are compared.
const FIELDS: [(&str, &str); 3] = [
    ("electric_field", "electric field"),
    ("magnetic_flux_density", "flux density"),
    ("magnetic_field", "magnetic field"),
];

/// Components of fields on both sides of surface points, by field.
type Sides = Vec<[Vec<f64>; 2]>;

/// The fields that were found, on both sides of surfaces.
fn fields(found: &Found, cloud: &Cloud) -> Vec<(&'static str, Sides)> {
    let sides = |column: &Column| {
        let inner = cloud
            .surface
            .iter()
            .map(|s| column.values[s.point as usize]);
        let inner: Vec<f64> = inner.collect();
        let outer = if column.beyond.is_empty() {
            inner.clone()
        } else {
            column.beyond.clone()
        };
        [inner, outer]
    };
    let of = |(start, name): (&str, &'static str)| {
        let own = found.columns.iter().filter(|c| c.name.starts_with(start));
        let sides: Sides = own.map(sides).collect();
        (!sides.is_empty()).then_some((name, sides))
    };
    FIELDS.into_iter().filter_map(of).collect()
}

/// Change of a field over its size, in the mean over surfaces.
fn change(surface: &[SurfacePoint], now: &Sides, then: &Sides) -> f64 {
    let (mut apart, mut size) = (0.0, 0.0);
    for (now, then) in now.iter().flatten().zip(then.iter().flatten()) {
        for ((s, now), then) in surface.iter().zip(now).zip(then) {
            apart += s.area.abs() * (now - then).powi(2);
            size += s.area.abs() * now.powi(2);
        }
    }
    if size > 0.0 {
        (apart / size).sqrt()
    } else {
        0.0
    }
}
