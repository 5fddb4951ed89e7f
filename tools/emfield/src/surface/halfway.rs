//! A closed surface about all bodies, halfway to the walls, over which their forces are checked.

use shapes::Body;
use shapes::frame::{Vector, difference, length};
use shapes::rule::rule;
use shapes::shape::{BoxShape, Disc, Shape, Sphere};

use crate::cloud::layout::Wall;
use crate::cloud::{Class, Cloud, SurfacePoint};
use crate::geometry::Geometry;
use crate::surface::enclosing::Enclosing;

/// Places that may always be, and the most of them over the points: fits at places cost about as much as those at points.
const FEW: usize = 600;
const PART: usize = 10;
/// Places of a line over its distance from bodies and walls, where they are equally far from each other.
const FINE: f64 = 0.25;

/// The surface; none where a body reaches a wall or leaves no spacing of room on both sides, nor where one so near to
/// bodies or walls would need too many places.
pub(crate) fn about(cloud: &Cloud) -> Option<Enclosing> {
    let cut = |class: &Class| matches!(class, Class::Outer { medium, .. } if *medium > 0);
    if cloud.surface.is_empty() || cloud.class.iter().any(cut) {
        return None;
    }
    let (shape, room) = halfway(cloud);
    if room < cloud.pitch {
        return None;
    }
    // In space the rule is that of Gauss, of high order.
    let part = if cloud.geometry.dimensions() == 3 {
        1.0
    } else {
        FINE
    };
    let found = surface(cloud.geometry, &shape, part * room);
    (found.places.len() <= FEW.max(cloud.len() / PART)).then_some(found)
}

/// The surface halfway between all bodies and the walls, and its least distance from both \[m\].
pub(crate) fn halfway(cloud: &Cloud) -> (Shape, f64) {
    match &cloud.wall {
        Wall::Ball { centre, radius } => within_ball(*centre, *radius, cloud),
        Wall::Box { low, high, .. } => within_box([*low, *high], cloud),
    }
}

/// A surface by places about a spacing apart \[m\].
pub(crate) fn surface(geometry: Geometry, shape: &Shape, spacing: f64) -> Enclosing {
    let dimensions = geometry.dimensions();
    let mut pieces = rule(&Body::new(shape, dimensions), dimensions, spacing);
    if geometry == Geometry::Axisymmetric {
        pieces.retain(|p| p.place[0] > 1e-9 * spacing);
    }
    Enclosing::of("a surface about all bodies", geometry, &pieces)
}

/// The middle of all bodies between their ends along each coordinate of the scene, on the axis where there is one.
pub(crate) fn middle(cloud: &Cloud) -> Vector {
    let reach = reach(cloud);
    let mut middle: Vector = std::array::from_fn(|k| 0.5 * (reach[0][k] + reach[1][k]));
    if cloud.geometry == Geometry::Axisymmetric {
        middle[0] = 0.0;
    }
    middle
}

/// Places of surfaces of bodies in coordinates of the scene.
fn surfaces(cloud: &Cloud) -> impl Iterator<Item = Vector> + '_ {
    let place = |s: &SurfacePoint| cloud.geometry.coordinates(cloud.position[s.point as usize]);
    cloud.surface.iter().map(place)
}

/// The least and greatest coordinates of surfaces of bodies.
fn reach(cloud: &Cloud) -> [Vector; 2] {
    let none = [[f64::INFINITY; 3], [f64::NEG_INFINITY; 3]];
    surfaces(cloud).fold(none, |[low, high], x| {
        [
            std::array::from_fn(|k| low[k].min(x[k])),
            std::array::from_fn(|k| high[k].max(x[k])),
        ]
    })
}

/// The ball halfway between bodies and walls, and its distance from both.
fn within_ball(centre: Vector, radius: f64, cloud: &Cloud) -> (Shape, f64) {
    let away = surfaces(cloud).map(|x| length(difference(x, centre)));
    let radius_m = 0.5 * (away.fold(0.0, f64::max) + radius);
    let (centre_m, name) = (centre[..cloud.geometry.dimensions()].to_vec(), None);
    let shape = if cloud.geometry == Geometry::Space {
        Shape::Sphere(Sphere {
            name,
            centre_m,
            radius_m,
        })
    } else {
        Shape::Disc(Disc {
            name,
            centre_m,
            radius_m,
        })
    };
    (shape, radius - radius_m)
}

/// The box halfway between bodies and walls, and its least distance from both.
fn within_box(mut sides: [Vector; 2], cloud: &Cloud) -> (Shape, f64) {
    let dimensions = cloud.geometry.dimensions();
    let reach = reach(cloud);
    let mut room = f64::INFINITY;
    for (end, side) in sides.iter_mut().enumerate() {
        for k in 0..dimensions {
            let axial = cloud.geometry == Geometry::Axisymmetric && (end, k) == (0, 0);
            // There is no wall on an axis.
            if !axial || side[k] > 0.0 {
                room = room.min(0.5 * (side[k] - reach[end][k]).abs());
                side[k] = 0.5 * (side[k] + reach[end][k]);
            }
        }
    }
    let [min_m, max_m] = sides.map(|side| side[..dimensions].to_vec());
    let name = None;
    (Shape::Box(BoxShape { name, min_m, max_m }), room)
}
