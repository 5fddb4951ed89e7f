//! Faces of primitives: each is a rectangle of two parameters (one in a plane scene), which is laid on the primitive.

use crate::body::{Kind, Primitive};
use crate::ellipsoid::Ellipsoid;
use crate::frame::{Frame, Vector, along, cross, difference, direction, length};
use crate::mesh::Mesh;

/// The shape of a face in the primitive's frame, with its two parameters.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Sheet {
    /// Own axis and side; parameters along the two other axes.
    Flat(usize, f64),
    /// Angle and height.
    Side,
    /// Sign of the end; radius and angle.
    End(f64),
    /// Angle and height over radius.
    Globe,
    /// Two lengths in the plane.
    Plane,
    /// Number of a triangle; shares of the way from its first corner to the edge across, and of that edge.
    Facet(usize),
}

/// A face of a primitive.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Face {
    pub(crate) sheet: Sheet,
    pub(crate) label: &'static str,
    pub(crate) range: [[f64; 2]; 2],
    /// Length of the whole range of each parameter \[m\].
    pub(crate) lengths: [f64; 2],
}

pub(crate) fn faces(primitive: &Primitive, dimensions: usize, reach: f64) -> Vec<Face> {
    use std::f64::consts::TAU;
    let face = |sheet, label, range: [[f64; 2]; 2], lengths| Face {
        sheet,
        label,
        range,
        lengths,
    };
    match &primitive.kind {
        &Kind::Box(half) => {
            const LABELS: [[&str; 2]; 3] = [["x-", "x+"], ["y-", "y+"], ["z-", "z+"]];
            let sides = (0..dimensions).flat_map(|axis| [(axis, 0), (axis, 1)]);
            sides
                .map(|(axis, side)| {
                    let [u, v] = others(axis, dimensions);
                    let range = [u, v].map(|k| if k < dimensions { half[k] } else { 0.5 });
                    face(
                        Sheet::Flat(axis, [-1.0, 1.0][side]),
                        LABELS[axis][side],
                        range.map(|h| [-h, h]),
                        range.map(|h| 2.0 * h),
                    )
                })
                .collect()
        }
        &Kind::Cylinder { radius, half } if dimensions == 3 => {
            let half = half.min(reach);
            let side = [[0.0, TAU], [-half, half]];
            let end = [[0.0, radius], [0.0, TAU]];
            let mut all = vec![face(Sheet::Side, "side", side, [TAU * radius, 2.0 * half])];
            for (sign, label) in [(-1.0, "bottom"), (1.0, "top")] {
                all.push(face(Sheet::End(sign), label, end, [radius, TAU * radius]));
            }
            all
        }
        &Kind::Cylinder { radius, .. } => {
            let range = [[0.0, TAU], [-0.5, 0.5]];
            vec![face(Sheet::Side, "rim", range, [TAU * radius, 1.0])]
        }
        &Kind::Ball(radius) => {
            let lengths = [TAU * radius, 0.5 * TAU * radius];
            vec![face(
                Sheet::Globe,
                "surface",
                [[0.0, TAU], [-1.0, 1.0]],
                lengths,
            )]
        }
        Kind::Ellipsoid(e) => vec![skin(e, dimensions)],
        Kind::Mesh(mesh) => (0..mesh.len()).map(|t| facet(mesh, t)).collect(),
        Kind::HalfSpace => {
            let second = if dimensions == 3 { reach } else { 0.5 };
            let range = [[-reach, reach], [-second, second]];
            vec![face(
                Sheet::Plane,
                "plane",
                range,
                [2.0 * reach, 2.0 * second],
            )]
        }
    }
}

/// A triangle as a face.
fn facet(mesh: &Mesh, number: usize) -> Face {
    let [a, b, c] = mesh.corners(number);
    let far = length(difference(b, a)).max(length(difference(c, a)));
    Face {
        sheet: Sheet::Facet(number),
        label: "surface",
        range: [[0.0, 1.0]; 2],
        lengths: [far, length(difference(c, b))],
    }
}

/// The face of an ellipsoid: angle and height over the semi-axis; of an ellipse the angle.
fn skin(e: &Ellipsoid, dimensions: usize) -> Face {
    use std::f64::consts::TAU;
    let wide = e.half[0].max(e.half[1]) + e.beyond;
    let (sheet, label, end, length) = if dimensions == 2 {
        (Sheet::Side, "rim", 0.5, 1.0)
    } else {
        let high = wide.max(e.half[2] + e.beyond);
        (Sheet::Globe, "surface", 1.0, 0.5 * TAU * high)
    };
    Face {
        sheet,
        label,
        range: [[0.0, TAU], [-end, end]],
        lengths: [TAU * wide, length],
    }
}

/// The two axes beside `axis`, the one of the plane first.
fn others(axis: usize, dimensions: usize) -> [usize; 2] {
    match (dimensions, axis) {
        (2, 0) => [1, 2],
        (2, _) => [0, 2],
        _ => [(axis + 1) % 3, (axis + 2) % 3],
    }
}

impl Face {
    /// Place, outward normal of the primitive, and area over that of the parameters, in the primitive's frame.
    fn own(&self, kind: &Kind, [u, v]: [f64; 2], dimensions: usize) -> (Vector, Vector, f64) {
        let high = if dimensions == 3 { v } else { 0.0 };
        match (self.sheet, kind) {
            (Sheet::Flat(axis, sign), Kind::Box(half)) => {
                let [a, b] = others(axis, dimensions);
                let (mut place, mut normal) = ([0.0; 3], [0.0; 3]);
                place[axis] = sign * half[axis];
                place[a] = u;
                place[b] = high;
                normal[axis] = sign;
                (place, normal, 1.0)
            }
            (Sheet::Side, Kind::Cylinder { radius, .. }) => {
                let (sine, cosine) = u.sin_cos();
                let place = [radius * cosine, radius * sine, high];
                (place, [cosine, sine, 0.0], *radius)
            }
            (Sheet::End(sign), Kind::Cylinder { half, .. }) => {
                let (sine, cosine) = v.sin_cos();
                let place = [u * cosine, u * sine, sign * half];
                (place, [0.0, 0.0, sign], u)
            }
            (Sheet::Side | Sheet::Globe, Kind::Ellipsoid(e)) => {
                let (sine, cosine) = u.sin_cos();
                let across = (1.0 - high * high).max(0.0).sqrt();
                let spot = e.spot([across * cosine, across * sine, high]);
                (spot.place, spot.normal, spot.area)
            }
            (Sheet::Globe, Kind::Ball(radius)) => {
                let (sine, cosine) = u.sin_cos();
                let across = (1.0 - v * v).max(0.0).sqrt();
                let normal = [across * cosine, across * sine, v];
                (normal.map(|n| radius * n), normal, radius * radius)
            }
            (Sheet::Facet(t), Kind::Mesh(mesh)) => {
                let [a, b, c] = mesh.corners(t);
                let (ab, bc) = (difference(b, a), difference(c, b));
                let twice = cross(ab, bc);
                let place = along(along(a, u, ab), u * v, bc);
                (place, direction(twice), u * length(twice))
            }
            // The plane of a half space holds z in a plane scene: its line is along the other axis.
            _ => ([u, high, 0.0], [0.0, 0.0, 1.0], 1.0),
        }
    }

    /// Place, outward normal of the primitive, and area over that of the parameters.
    pub(crate) fn at(
        &self,
        kind: &Kind,
        frame: &Frame,
        parameters: [f64; 2],
        dimensions: usize,
    ) -> (Vector, Vector, f64) {
        let (place, normal, area) = self.own(kind, parameters, dimensions);
        (frame.place(place), frame.turn(normal), area)
    }

    /// Whether the ends of the range of a parameter meet: an angle.
    pub(crate) fn closed(&self, parameter: usize) -> bool {
        match self.sheet {
            Sheet::Side | Sheet::Globe => parameter == 0,
            Sheet::End(_) => parameter == 1,
            Sheet::Flat(..) | Sheet::Plane | Sheet::Facet(_) => false,
        }
    }

    /// Middle, outward normal of the primitive, and area of the part between two corners.
    pub(crate) fn part(
        &self,
        kind: &Kind,
        frame: &Frame,
        [u, v]: [[f64; 2]; 2],
        dimensions: usize,
    ) -> (Vector, Vector, f64) {
        let middle = [0.5 * (u[0] + u[1]), 0.5 * (v[0] + v[1])];
        let (_, normal, density) = self.at(kind, frame, middle, dimensions);
        let area = density * (u[1] - u[0]) * (v[1] - v[0]);
        let mut heavy = middle;
        if let Sheet::End(_) | Sheet::Facet(_) = self.sheet {
            // Radius of the middle of a ring's sector, or of a strip that narrows towards a corner.
            heavy[0] = 2.0 / 3.0 * (u[0] * u[0] + u[0] * u[1] + u[1] * u[1]) / (u[0] + u[1]);
        }
        let (place, ..) = self.at(kind, frame, heavy, dimensions);
        (place, normal, area)
    }
}
