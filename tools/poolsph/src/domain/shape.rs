//! Shapes of bodies, and the lattice points that fill them.
//!
//! A lattice point stands at `anchor + (i + 1/2) d`, with the spacings d of the axes. A box whose edges are whole multiples of
//! them is filled exactly: as many particles as its volume over theirs, the outer ones d/2 inside its faces.

use std::f64::consts::PI;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use shapes::Body;
use shapes::shape::{BoxShape, Cylinder, EllipsoidShape, Sphere, Stl, Turned};

pub use super::container::Container;
use super::container::{container_points, walls};
use super::row::{lattice, product};

/// What a body looks like: a shape in the words of all programs, or walls.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Shape {
    /// A box along the axes.
    Box(BoxShape),
    /// A round bar.
    Cylinder(Cylinder),
    /// A ball.
    Sphere(Sphere),
    /// A ball drawn out along the axes.
    Ellipsoid(EllipsoidShape),
    /// Walls around a box.
    Container(Container),
    /// A closed surface from a file.
    Stl(Stl),
    /// A shape turned.
    Turned(Turned),
    /// What is in any of the shapes.
    Union(Vec<shapes::Shape>),
    /// What is in all of the shapes.
    Intersection(Vec<shapes::Shape>),
    /// What is in the first shape and in none of the others.
    Difference(Vec<shapes::Shape>),
}

/// A part of d by which a lattice point on the face of a composed shape may be outside for rounding.
const SLACK: f64 = 1e-9;

/// Points by which the volume of a composed shape is measured.
const MEASURED: u32 = 65_536;

impl Shape {
    /// The shape as the other programs read it; none of walls.
    #[must_use]
    pub fn plain(&self) -> Option<shapes::Shape> {
        Some(match self {
            Self::Box(own) => shapes::Shape::Box(own.clone()),
            Self::Cylinder(bar) => shapes::Shape::Cylinder(bar.clone()),
            Self::Sphere(ball) => shapes::Shape::Sphere(ball.clone()),
            Self::Ellipsoid(drawn) => shapes::Shape::Ellipsoid(drawn.clone()),
            Self::Container(_) => return None,
            Self::Stl(stl) => shapes::Shape::Stl(stl.clone()),
            Self::Turned(turned) => shapes::Shape::Turned(turned.clone()),
            Self::Union(parts) => shapes::Shape::Union(parts.clone()),
            Self::Intersection(parts) => shapes::Shape::Intersection(parts.clone()),
            Self::Difference(parts) => shapes::Shape::Difference(parts.clone()),
        })
    }

    /// Whether the lattice asks its body which places it holds.
    fn is_composed(&self) -> bool {
        matches!(
            self,
            Self::Stl(_)
                | Self::Turned(_)
                | Self::Union(_)
                | Self::Intersection(_)
                | Self::Difference(_)
        )
    }

    /// Lower and upper corner of the box around the shape \[m\].
    #[must_use]
    pub fn bounds(&self) -> ([f64; 3], [f64; 3]) {
        match self {
            Self::Box(b) => (three(&b.min_m), three(&b.max_m)),
            Self::Cylinder(c) => around(three(&c.centre_m), cylinder_half(c)),
            Self::Sphere(s) => around(three(&s.centre_m), [s.radius_m; 3]),
            Self::Ellipsoid(e) => around(three(&e.centre_m), three(&e.semi_axes_m)),
            Self::Container(c) => {
                let (mut low, mut high) = (c.min_m, c.max_m);
                for axis in 0..3 {
                    let walls = walls(c, axis);
                    low[axis] -= if walls[0] { c.thickness_m } else { 0.0 };
                    high[axis] += if walls[1] { c.thickness_m } else { 0.0 };
                }
                (low, high)
            }
            composed => {
                let [low, high] = composed.body().map_or([[0.0; 3]; 2], |body| body.bounds());
                (low, high)
            }
        }
    }

    /// The body of a composed shape.
    fn body(&self) -> Option<Body> {
        let shape = self.is_composed().then(|| self.plain())??;
        Some(Body::new(&shape, 3))
    }

    /// Lattice points of the spacings `pitch` \[m\] along each edge of the box around the shape, before any is
    /// made: as many as [`Shape::points`] looks at.
    #[must_use]
    pub fn sites(&self, pitch: [f64; 3]) -> [f64; 3] {
        let (low, high) = self.bounds();
        [0, 1, 2].map(|k| ((high[k] - low[k]) / pitch[k]).round().max(1.0))
    }

    /// Lattice points of the spacings `pitch` \[m\] along the axes within the shape, x fastest; `anchor` defaults to the
    /// lower corner of the box around it.
    #[must_use]
    pub fn points(&self, pitch: [f64; 3], anchor: Option<[f64; 3]>) -> Vec<[f64; 3]> {
        if let Self::Container(c) = self {
            return container_points(c, edge(pitch));
        }
        let (low, high) = self.bounds();
        let anchor = anchor.unwrap_or(low);
        let axes = [0, 1, 2].map(|k| lattice(anchor[k], low[k], high[k], pitch[k]));
        let mut points = product(&axes);
        let body = self.body();
        points.retain(|p| match &body {
            Some(body) => body.distance(*p) <= SLACK * pitch[0],
            None => self.holds(*p),
        });
        points
    }

    /// Sides that a whole number of layers has to fill \[m\], along each axis.
    #[must_use]
    pub fn sides(&self) -> [Option<f64>; 3] {
        match self {
            Self::Box(b) => [0, 1, 2].map(|k| Some(b.max_m[k] - b.min_m[k])),
            Self::Cylinder(c) => {
                [0, 1, 2].map(|k| Some(c.length_m).filter(|_| k == c.axis.index()))
            }
            _ => [None; 3],
        }
    }

    /// Centre \[m\] and volume \[m3\] of a round body; none of others.
    #[must_use]
    pub fn round(&self) -> Option<([f64; 3], f64)> {
        match self {
            Self::Cylinder(c) => {
                let volume = PI * c.radius_m * c.radius_m * c.length_m;
                Some((three(&c.centre_m), volume))
            }
            Self::Sphere(s) => Some((three(&s.centre_m), 4.0 / 3.0 * PI * s.radius_m.powi(3))),
            Self::Ellipsoid(e) => {
                let volume = 4.0 / 3.0 * PI * e.semi_axes_m.iter().product::<f64>();
                Some((three(&e.centre_m), volume))
            }
            _ => None,
        }
    }

    /// Volume \[m3\]; of a composed shape measured to about a thousandth of the box around it. None of a container.
    #[must_use]
    pub fn volume(&self) -> Option<f64> {
        let (low, high) = self.bounds();
        let side = |k: usize| high[k] - low[k];
        let around = side(0) * side(1) * side(2);
        if let Self::Box(_) = self {
            return Some(around);
        }
        let Some(body) = self.body() else {
            return self.round().map(|(_, volume)| volume);
        };
        // Points that fill the box evenly and follow no face: multiples of the powers of 1/g, g^4 = g + 1.
        const STEPS: [f64; 3] = [
            0.819_172_513_396_164_4,
            0.671_043_606_703_789_2,
            0.549_700_477_901_970_3,
        ];
        let point =
            |n: u32| [0, 1, 2].map(|k| low[k] + side(k) * (f64::from(n) * STEPS[k]).fract());
        let within = (0..MEASURED).filter(|n| body.distance(point(*n)) <= 0.0);
        Some(around * within.count() as f64 / f64::from(MEASURED))
    }

    fn holds(&self, p: [f64; 3]) -> bool {
        match self {
            // Of composed shapes the body knows.
            Self::Box(_)
            | Self::Container(_)
            | Self::Stl(_)
            | Self::Turned(_)
            | Self::Union(_)
            | Self::Intersection(_)
            | Self::Difference(_) => true,
            Self::Cylinder(c) => {
                let along = c.axis.index();
                let square: f64 = (0..3)
                    .filter(|k| *k != along)
                    .map(|k| (p[k] - c.centre_m[k]).powi(2))
                    .sum();
                square <= c.radius_m * c.radius_m
            }
            Self::Sphere(s) => {
                let square: f64 = (0..3).map(|k| (p[k] - s.centre_m[k]).powi(2)).sum();
                square <= s.radius_m * s.radius_m
            }
            Self::Ellipsoid(e) => {
                let part = |k: usize| ((p[k] - e.centre_m[k]) / e.semi_axes_m[k]).powi(2);
                part(0) + part(1) + part(2) <= 1.0
            }
        }
    }
}

/// Edge d of the cube that a cell of these edges fills \[m\]: d itself where all are equal.
#[must_use]
pub fn edge(pitch: [f64; 3]) -> f64 {
    let [x, y, z] = pitch;
    if x.to_bits() == y.to_bits() && y.to_bits() == z.to_bits() {
        return x;
    }
    (x * y * z).cbrt()
}

fn cylinder_half(c: &Cylinder) -> [f64; 3] {
    let mut half = [c.radius_m; 3];
    half[c.axis.index()] = 0.5 * c.length_m;
    half
}

/// Three coordinates; those that a scene with faults lacks are zero.
fn three(coordinates: &[f64]) -> [f64; 3] {
    [0, 1, 2].map(|k| coordinates.get(k).copied().unwrap_or(0.0))
}

fn around(centre: [f64; 3], half: [f64; 3]) -> ([f64; 3], [f64; 3]) {
    (
        [0, 1, 2].map(|k| centre[k] - half[k]),
        [0, 1, 2].map(|k| centre[k] + half[k]),
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use shapes::Axis;

    const D: f64 = 0.5e-3;

    #[test]
    fn the_plate_of_the_thesis_has_its_52000_particles() {
        let plate = Shape::Box(BoxShape {
            name: None,
            min_m: vec![-10e-3, 0.0, -5e-3],
            max_m: vec![10e-3, 65e-3, 0.0],
        });
        let points = plate.points([D; 3], None);
        assert_eq!(points.len(), 52_000);
        let top = points.iter().fold(f64::MIN, |m, p| m.max(p[2]));
        assert!((top + 0.5 * D).abs() < 1e-15);
    }

    #[test]
    fn an_anchor_shifts_the_lattice() {
        let shape = Shape::Box(BoxShape {
            name: None,
            min_m: vec![0.0; 3],
            max_m: vec![4.0 * D; 3],
        });
        let shifted = shape.points([D; 3], Some([0.25 * D; 3]));
        assert_eq!(shifted.len(), 64);
        assert!((shifted[0][0] - 0.75 * D).abs() < 1e-15);
    }

    #[test]
    fn round_bodies_fill_their_volume() {
        let (radius, length) = (10.0 * D, 20.0 * D);
        let sphere = Shape::Sphere(Sphere {
            name: None,
            centre_m: vec![1e-3, 2e-3, 3e-3],
            radius_m: radius,
        });
        let volume = sphere.points([D; 3], None).len() as f64 * D.powi(3);
        let exact = 4.0 / 3.0 * PI * radius.powi(3);
        assert!((volume / exact - 1.0).abs() < 0.02, "{}", volume / exact);
        let half = [8.0 * D, 12.0 * D, 10.0 * D];
        let drawn = Shape::Ellipsoid(EllipsoidShape {
            name: None,
            centre_m: vec![1e-3, 2e-3, 3e-3],
            semi_axes_m: half.to_vec(),
        });
        let points = drawn.points([D; 3], None);
        let exact = 4.0 / 3.0 * PI * half.iter().product::<f64>();
        let ratio = points.len() as f64 * D.powi(3) / exact;
        assert!((ratio - 1.0).abs() < 0.02, "{ratio}");
        let reach = points.iter().fold(0.0, |m: f64, p| m.max(p[1] - 2e-3));
        assert!((reach - 12.0 * D).abs() <= D, "{reach}");
        for axis in [Axis::X, Axis::Y, Axis::Z] {
            let bar = Shape::Cylinder(Cylinder {
                name: None,
                centre_m: vec![0.0; 3],
                axis,
                radius_m: radius,
                length_m: length,
            });
            let volume = bar.points([D; 3], None).len() as f64 * D.powi(3);
            let exact = PI * radius * radius * length;
            assert!((volume / exact - 1.0).abs() < 0.02, "{}", volume / exact);
        }
    }
}
