//! The parts of the faces of primitives that are the surface of a body.
//!
//! Each face is divided into elements; an element that the surface of the composed body crosses is divided further, so
//! that areas are right to a small part of an element.

use crate::body::{Body, Primitive};
use crate::face::{Face, Sheet, faces};
use crate::frame::{Vector, along, dot};

/// Elements of a face per spacing, in a plane and in space.
const PER_SPACING: [f64; 2] = [8.0, 3.0];
/// How often an element at an edge of the surface is halved, in a plane and in space.
const HALVINGS: [usize; 2] = [24, 5];

/// A piece of surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Piece {
    /// Number of the face.
    pub face: usize,
    /// Middle \[m\].
    pub place: Vector,
    /// Out of the body.
    pub normal: Vector,
    /// Area \[m2\]; length \[m\] in a plane scene.
    pub area: f64,
}

/// Name of a face: the primitive's name before the label, if it has one.
fn label(primitive: &Primitive, label: &str) -> String {
    match &primitive.name {
        Some(name) => format!("{name}.{label}"),
        None => label.to_owned(),
    }
}

/// Names of all faces of a body; equal names are one face.
#[must_use]
pub fn names(body: &Body, dimensions: usize) -> Vec<String> {
    let mut all: Vec<String> = Vec::new();
    for primitive in &body.primitives {
        for face in faces(primitive, dimensions, 1.0) {
            let name = label(primitive, face.label);
            if !all.contains(&name) {
                all.push(name);
            }
        }
    }
    all
}

/// The surface of a body in pieces of about a third of the spacing \[m\].
#[must_use]
pub fn pieces(body: &Body, dimensions: usize, spacing: f64) -> Vec<Piece> {
    let names = names(body, dimensions);
    let [low, high] = body.bounds();
    let spread = (0..dimensions)
        .map(|k| high[k] - low[k])
        .fold(0.0, f64::hypot);
    let far = (0..dimensions)
        .map(|k| high[k].abs().max(low[k].abs()))
        .fold(0.0, f64::max);
    let mut found = Vec::new();
    for (number, primitive) in body.primitives.iter().enumerate() {
        let away = (0..dimensions)
            .map(|k| primitive.frame.origin[k].abs())
            .fold(0.0, f64::max);
        for face in faces(primitive, dimensions, spread + far + away) {
            let name = label(primitive, face.label);
            let surface = Surface {
                body,
                number,
                face: &face,
                id: names.iter().position(|n| *n == name).unwrap_or_default(),
                dimensions,
                spacing,
            };
            surface.divide(&mut found);
        }
    }
    found
}

/// One face of a body under division.
struct Surface<'a> {
    body: &'a Body,
    number: usize,
    face: &'a Face,
    id: usize,
    dimensions: usize,
    spacing: f64,
}

impl Surface<'_> {
    fn divide(&self, found: &mut Vec<Piece>) {
        let size = self.spacing / PER_SPACING[self.dimensions - 2];
        let parts = |k: usize| ((self.face.lengths[k] / size).ceil() as usize).max(1);
        let (nu, nv) = (parts(0), if self.dimensions == 3 { parts(1) } else { 1 });
        for i in 0..nu {
            for j in 0..nv {
                self.refine([self.cut(0, i, nu), self.cut(1, j, nv)], 0, found);
            }
        }
    }

    /// Part `i` of `n` of the range of a parameter, all as long on the surface: heights of a ball lie at even angles.
    fn cut(&self, parameter: usize, i: usize, n: usize) -> [f64; 2] {
        let [a, b] = self.face.range[parameter];
        let globe = self.face.sheet == Sheet::Globe && parameter == 1;
        let at = |i: usize| {
            let share = i as f64 / n as f64;
            let share = if globe {
                0.5 - 0.5 * (std::f64::consts::PI * share).cos()
            } else {
                share
            };
            a + (b - a) * share
        };
        [at(i), at(i + 1)]
    }

    /// Takes a part whole, leaves it, or halves it where the surface has an edge.
    fn refine(&self, part: [[f64; 2]; 2], depth: usize, found: &mut Vec<Piece>) {
        let [u, v] = part;
        let middle = self.kept(part);
        let narrow = |[a, b]: [f64; 2], t: f64| {
            let at = a + t * (b - a);
            [at, at]
        };
        let mixed = depth < HALVINGS[self.dimensions - 2] && {
            let ends = [1e-6, 1.0 - 1e-6];
            let across: &[f64] = if self.dimensions == 3 { &ends } else { &[0.5] };
            ends.iter().any(|s| {
                across
                    .iter()
                    .any(|t| self.kept([narrow(u, *s), narrow(v, *t)]) != middle)
            })
        };
        if mixed {
            let halves = |[a, b]: [f64; 2]| [[a, 0.5 * (a + b)], [0.5 * (a + b), b]];
            for u in halves(u) {
                if self.dimensions == 3 {
                    for v in halves(v) {
                        self.refine([u, v], depth + 1, found);
                    }
                } else {
                    self.refine([u, v], depth + 1, found);
                }
            }
        } else if middle {
            found.push(self.piece(part));
        }
    }

    fn piece(&self, part: [[f64; 2]; 2]) -> Piece {
        let primitive = &self.body.primitives[self.number];
        let (place, normal, area) =
            self.face
                .part(&primitive.kind, &primitive.frame, part, self.dimensions);
        Piece {
            face: self.id,
            place,
            normal: if primitive.cut {
                normal.map(|n| -n)
            } else {
                normal
            },
            area,
        }
    }

    /// Whether the middle of a part lies on the surface of the body, and on no earlier primitive's same face.
    fn kept(&self, part: [[f64; 2]; 2]) -> bool {
        let step = 1e-5 * self.spacing;
        let piece = self.piece(part);
        let (inner, outer) = (
            along(piece.place, -step, piece.normal),
            along(piece.place, step, piece.normal),
        );
        let surface = self.body.distance(inner) < 0.0 && self.body.distance(outer) > 0.0;
        surface
            && !self.body.primitives[..self.number].iter().any(|earlier| {
                let sign = if earlier.cut { -1.0 } else { 1.0 };
                sign * earlier.distance(inner) < -0.5 * step
                    && sign * earlier.distance(outer) > 0.5 * step
            })
    }
}

/// Sum of area times normal: zero over a closed surface.
#[must_use]
pub fn closure(pieces: &[Piece]) -> Vector {
    pieces
        .iter()
        .fold([0.0; 3], |sum, p| along(sum, p.area, p.normal))
}

/// Volume behind a closed surface by Gauss' theorem \[m3; m2 in a plane scene\].
#[must_use]
pub fn enclosed(pieces: &[Piece], dimensions: usize) -> f64 {
    let sum: f64 = pieces.iter().map(|p| p.area * dot(p.normal, p.place)).sum();
    sum / dimensions as f64
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    fn surface(text: &str, dimensions: usize, spacing: f64) -> (Vec<Piece>, Vec<String>) {
        let body = Body::new(&serde_json::from_str(text).unwrap(), dimensions);
        (pieces(&body, dimensions, spacing), names(&body, dimensions))
    }

    fn checked(text: &str, dimensions: usize, area: f64, volume: f64, within: f64) {
        let (found, _) = surface(text, dimensions, 0.1);
        let total: f64 = found.iter().map(|p| p.area).sum();
        assert!(
            (total - area).abs() < within * area,
            "area {total}, not {area}"
        );
        let inside = enclosed(&found, dimensions);
        assert!(
            (inside - volume).abs() < within * volume,
            "volume {inside}, not {volume}"
        );
        let open = closure(&found);
        assert!(
            open.iter().all(|c| c.abs() < within * area),
            "open by {open:?}"
        );
    }

    #[test]
    fn primitives_are_closed() {
        checked(
            r#"{"box": {"min_m": [1, 2], "max_m": [2, 4]}}"#,
            2,
            6.0,
            2.0,
            1e-12,
        );
        checked(
            r#"{"box": {"min_m": [1, 2, 0], "max_m": [2, 4, 3]}}"#,
            3,
            22.0,
            6.0,
            1e-12,
        );
        checked(
            r#"{"disc": {"centre_m": [3, 1], "radius_m": 1}}"#,
            2,
            2.0 * PI,
            PI,
            1e-4,
        );
        let bar =
            r#"{"cylinder": {"centre_m": [1, 0, 2], "axis": "y", "radius_m": 1, "length_m": 2}}"#;
        checked(bar, 3, 6.0 * PI, 2.0 * PI, 1e-3);
        let ball = r#"{"sphere": {"centre_m": [1, 0, 2], "radius_m": 1}}"#;
        checked(ball, 3, 4.0 * PI, 4.0 / 3.0 * PI, 1e-3);
    }

    #[test]
    fn ellipsoids_are_closed() {
        let ellipse = r#"{"turned": {"angle_deg": 20, "shape":
            {"ellipsoid": {"centre_m": [3, 1], "semi_axes_m": [2, 1]}}}}"#;
        checked(ellipse, 2, 9.688_448_220_547_675, 2.0 * PI, 1e-4);
        // Of a spheroid `2 pi a^2 (1 + c/(a e) asin e)`, `e^2 = 1 - a^2/c^2`.
        let needle = r#"{"ellipsoid": {"centre_m": [1, 0, 2], "semi_axes_m": [1, 1, 4]}}"#;
        let e = (15.0_f64 / 16.0).sqrt();
        let area = 2.0 * PI * (1.0 + 4.0 / e * e.asin());
        checked(needle, 3, area, 16.0 / 3.0 * PI, 1e-3);
    }

    #[test]
    fn pieces_of_a_ball_are_fine_at_its_poles_too() {
        let ball = r#"{"sphere": {"centre_m": [0, 0, 0], "radius_m": 1}}"#;
        let (found, _) = surface(ball, 3, 0.1);
        for k in 0..200 {
            let angle = PI * f64::from(k) / 199.0;
            let place = [angle.sin(), 0.0, angle.cos()];
            let away = |p: &Piece| (0..3).map(|a| (p.place[a] - place[a]).powi(2)).sum::<f64>();
            let nearest = found.iter().map(away).fold(f64::INFINITY, f64::min).sqrt();
            assert!(nearest < 0.05, "{nearest} at {angle}");
        }
    }

    #[test]
    fn compositions_are_closed() {
        let holed = r#"{"difference": [{"box": {"min_m": [0, 0], "max_m": [2, 2]}},
            {"disc": {"name": "hole", "centre_m": [1, 1], "radius_m": 0.5}}]}"#;
        checked(holed, 2, 8.0 + PI, 4.0 - 0.25 * PI, 1e-3);
        // Two boxes that share a face and a plane.
        let two = r#"{"union": [{"box": {"min_m": [0, 0], "max_m": [1, 1]}},
            {"box": {"min_m": [0.5, 0], "max_m": [2, 1]}}]}"#;
        checked(two, 2, 6.0, 2.0, 1e-5);
        let quarter = r#"{"intersection": [{"disc": {"centre_m": [0, 0], "radius_m": 1}},
            {"box": {"min_m": [0, 0], "max_m": [2, 2]}}]}"#;
        checked(quarter, 2, 2.0 + 0.5 * PI, 0.25 * PI, 1e-4);
        let lens = r#"{"intersection": [{"sphere": {"centre_m": [0, 0, 0], "radius_m": 1}},
            {"half_space": {"point_m": [0, 0, 0], "normal": [0, 0, 1]}}]}"#;
        checked(lens, 3, 3.0 * PI, 2.0 / 3.0 * PI, 2e-3);
    }

    #[test]
    fn faces_have_names() {
        let (found, names) = surface(
            r#"{"difference": [{"box": {"min_m": [0, 0], "max_m": [2, 2]}},
                {"disc": {"name": "hole", "centre_m": [1, 1], "radius_m": 0.5}}]}"#,
            2,
            0.1,
        );
        assert_eq!(names, ["x-", "x+", "y-", "y+", "hole.rim"]);
        let hole: f64 = found.iter().filter(|p| p.face == 4).map(|p| p.area).sum();
        assert!((hole - PI).abs() < 1e-9);
        let inward = found.iter().filter(|p| p.face == 4);
        for p in inward {
            let radial = [p.place[0] - 1.0, p.place[1] - 1.0, 0.0];
            assert!(dot(p.normal, radial) < 0.0);
        }
    }
}
