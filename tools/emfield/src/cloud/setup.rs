//! From a scene to the layout of its domain.

use shapes::Body;

use super::layout::{Layout, Solid, Wall, vector};
use crate::geometry::Geometry;
use crate::scene::{BodyScene, Domain, Scene};

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
