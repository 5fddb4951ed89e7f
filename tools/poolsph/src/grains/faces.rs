//! Faces of walls.
//!
//! A face gives a grain one contact, at the nearest place, which may be on an edge. The hollow of a box has six faces, that of a bar three.

use shapes::frame::{Frame, Vector, along, difference, dot, length};
use shapes::{Body, Kind, Shape};

/// Step of the slope of a distance over the radius of a grain.
const SLOPE: f64 = 1e-4;

/// What a face looks like.
#[derive(Debug, Clone, PartialEq)]
pub enum Face {
    /// A plane through a place; the wall is behind it.
    Plane(Vector, Vector),
    /// A round tube without ends, seen from within.
    Tube(Frame, f64),
    /// A ball, seen from within.
    Shell(Vector, f64),
    /// A body, seen from outside.
    Outside(Body),
    /// A body, seen from within.
    Inside(Body),
}

impl Face {
    /// Distance from the face \[m\] and the normal out of the wall.
    #[must_use]
    pub fn at(&self, x: Vector, radius: f64) -> (f64, Vector) {
        match self {
            Self::Plane(point, normal) => (dot(difference(x, *point), *normal), *normal),
            Self::Tube(frame, wide) => {
                let own = frame.own(x);
                let off = own[0].hypot(own[1]);
                let inward = [-own[0] / off, -own[1] / off, 0.0];
                (wide - off, frame.turn(inward))
            }
            Self::Shell(centre, wide) => {
                let off = difference(x, *centre);
                let far = length(off);
                (wide - far, off.map(|d| -d / far))
            }
            Self::Outside(body) => body.away(x, SLOPE * radius),
            Self::Inside(body) => {
                let normal = body.normal(x, SLOPE * radius);
                (-body.distance(x), normal.map(|n| -n))
            }
        }
    }

    /// Distance alone \[m\]; beside an edge no more than that.
    #[must_use]
    pub fn distance(&self, x: Vector) -> f64 {
        match self {
            Self::Outside(body) => body.distance(x),
            Self::Inside(body) => -body.distance(x),
            _ => self.at(x, 0.0).0,
        }
    }

    /// Faces of a shape seen from outside.
    #[must_use]
    pub fn outside(shape: &Shape) -> Vec<Self> {
        if let Shape::Union(parts) = shape {
            return parts.iter().flat_map(Self::outside).collect();
        }
        let body = Body::new(shape, 3);
        let plane = body.single().filter(|p| p.kind == Kind::HalfSpace);
        let face = plane.map(|p| Self::Plane(p.frame.origin, p.frame.axes[2]));
        vec![face.unwrap_or(Self::Outside(body))]
    }

    /// Faces of a shape seen from within.
    #[must_use]
    pub fn inside(shape: &Shape) -> Vec<Self> {
        let body = Body::new(shape, 3);
        let Some(single) = body.single() else {
            return vec![Self::Inside(body)];
        };
        let frame = single.frame;
        let across = |axis: usize, half: f64| {
            [1.0, -1.0].map(|side| {
                let out = frame.axes[axis].map(|a| side * a);
                Self::Plane(along(frame.origin, half, out), out.map(|n| -n))
            })
        };
        match single.kind {
            Kind::Box(half) => (0..3).flat_map(|k| across(k, half[k])).collect(),
            Kind::Cylinder { radius, half } => {
                let mut faces = vec![Self::Tube(frame, radius)];
                faces.extend(across(2, half));
                faces
            }
            Kind::Ball(radius) => vec![Self::Shell(frame.origin, radius)],
            _ => vec![Self::Inside(body)],
        }
    }
}
