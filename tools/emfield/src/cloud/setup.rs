//! From a scene to the layout of its domain and to its points.

use run::Fault;
use shapes::Body;

use super::layout::{Layout, Solid, Wall, vector};
use super::{Cloud, Filling};
use crate::geometry::Geometry;
use crate::scene::{BodyScene, Domain, Scene};

/// Radius of a support of order up to 2, and of a higher one, over the spacing.
const SUPPORT: [f64; 2] = [2.5, 2.75];

/// The points of a scene.
///
/// # Errors
/// Faults of the scene: too many points, a body without points.
pub fn cloud(scene: &Scene) -> Result<Cloud, Vec<Fault>> {
    wider(scene, 1.0)
}

/// The points of a scene with those far from bodies so many times as far apart: on surfaces and in layers they are the same.
///
/// # Errors
/// As [`cloud`].
pub fn wider(scene: &Scene, by: f64) -> Result<Cloud, Vec<Fault>> {
    let faults = scene.faults();
    if !faults.is_empty() {
        return Err(faults);
    }
    Cloud::new(layout(scene).wider(by), &filling(scene))
}

/// How many points a scene without faults has at least, and their memory \[byte\]; see [`Cloud::least`].
#[must_use]
pub fn least(scene: &Scene) -> [f64; 2] {
    Cloud::least(&layout(scene), &filling(scene))
}

/// The layout of a scene without faults.
#[must_use]
pub fn layout(scene: &Scene) -> Layout {
    let dimensions = scene.geometry.dimensions();
    let solid = |body: &BodyScene| {
        let spacing = body.spacing_m.unwrap_or(scene.points.spacing_m);
        let shape = Body::new(&body.shape, dimensions);
        Solid::new(body.name.clone(), shape, spacing)
    };
    let solids = scene.bodies.iter().map(solid).collect();
    Layout::new(scene.geometry, wall(scene), solids, &scene.points)
}

/// The wall of the domain.
fn wall(scene: &Scene) -> Wall {
    match &scene.domain {
        Domain::Box(b) => {
            let (low, high) = (vector(&b.min_m), vector(&b.max_m));
            let axis = scene.geometry == Geometry::Axisymmetric && low[0] <= 0.0;
            Wall::Box { low, high, axis }
        }
        Domain::Sphere(s) => Wall::Ball {
            centre: vector(&s.centre_m),
            radius: s.radius_m,
        },
    }
}

/// What fills the layout: points have shares of conductors, magnets and coils where there are eddy currents.
fn filling(scene: &Scene) -> Filling<'_> {
    let shares =
        |m: usize| scene.medium(m).conductivity_s_m > 0.0 || scene.magnetic(m) || scene.carries(m);
    let currents = scene.eddy_currents.iter();
    let usual = SUPPORT[usize::from(scene.method.order > 2)];
    Filling {
        points: &scene.points,
        shares: currents
            .flat_map(|_| (0..=scene.bodies.len()).map(shares))
            .collect(),
        support: scene.method.support.unwrap_or(usual),
    }
}
