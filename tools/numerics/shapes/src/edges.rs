//! How far a body that is composed of others is from a place beside it, and in which direction: beside edges and corners too.
//!
//! What is cut out of primitives is where all of `f_i(y) <= 0`, with `f_i` the signed distances of those or of what is outside of
//! them. The greatest `f_i(x)` is the distance of a place x that faces one of them, and too little where it faces an edge.
//! There
//!
//! ```text
//! y = argmin |y - x|   while f_i(y) <= 0           the distance is |y - x|, its direction that of x - y
//! ```
//!
//! is found by steps in which each `f_i` is a plane beside the last y, whose nearest place is x less multiples of the normals that
//! push only (Hildreth 1957).

use crate::body::{Body, Primitive, Tree};
use crate::frame::{Vector, along, difference, dot, length};

/// The most primitives that meet at a place.
const MOST: usize = 8;

/// Steps, and sweeps over the multiples in each, at most.
const STEPS: usize = 60;
const SWEEPS: usize = 30;

/// Height of a place over its distance at which it lies on a face.
const ON: f64 = 1e-6;

/// Change of the place over its distance that is none.
const CLOSE: f64 = 1e-9;

/// Primitives within which a place has to be, or outside of which.
#[derive(Default)]
struct Parts {
    number: usize,
    list: [(usize, bool); MOST],
    /// Whether there are more.
    full: bool,
}

impl Parts {
    fn push(&mut self, part: (usize, bool)) {
        match self.list.get_mut(self.number) {
            Some(place) => {
                *place = part;
                self.number += 1;
            }
            None => self.full = true,
        }
    }
}

impl Body {
    /// Distance \[m\] of a place outside and the direction away from the nearest place of the body, on edges and corners too; inside,
    /// and beside a primitive alone, what [`Body::distance`] and [`Body::normal`] give with `step` \[m\].
    ///
    /// ```
    /// use shapes::Body;
    /// let shape = r#"{"difference": [{"half_space": {"point_m": [0, 0, 0], "normal": [0, 0, 1]}},
    ///                                {"cylinder": {"centre_m": [0, 0, 0], "radius_m": 10, "length_m": 99}}]}"#;
    /// let floor = Body::new(&serde_json::from_str(shape)?, 3);
    /// let (distance, normal) = floor.away([7.0, 0.0, 4.0], 1e-4);
    /// assert!((distance - 5.0).abs() < 1e-9 && (normal[0] + 0.6).abs() < 1e-9);
    /// assert_eq!(floor.distance([7.0, 0.0, 4.0]), 4.0);
    /// # Ok::<(), serde_json::Error>(())
    /// ```
    #[must_use]
    pub fn away(&self, x: Vector, step: f64) -> (f64, Vector) {
        let face = (self.distance(x), self.normal(x, step));
        if face.0 <= 0.0 || self.single().is_some() {
            return face;
        }
        // Where that is right, its place lies on the body.
        let touched = along(x, -face.0, face.1);
        if self.distance(touched) <= ON * face.0 {
            return face;
        }
        let Some(y) = self.nearest(x, step) else {
            return face;
        };
        let way = difference(x, y);
        let far = length(way);
        (far, way.map(|d| d / far))
    }

    /// The nearest place to `x` outside, where more than one primitive keeps it away; none if one does, or if it is not found.
    fn nearest(&self, x: Vector, step: f64) -> Option<Vector> {
        let mut parts = Parts::default();
        self.gather(&self.tree, x, false, &mut parts);
        let list = &parts.list[..parts.number];
        let signed = |(k, outside): (usize, bool), y: Vector| {
            let distance = self.primitives[k].distance(y);
            if outside { -distance } else { distance }
        };
        let slope = |(k, outside): (usize, bool), y: Vector| {
            let slope = slope(&self.primitives[k], y, step);
            if outside { slope.map(|n| -n) } else { slope }
        };
        let (mut y, mut pushes) = (x, [0.0; MOST]);
        for _ in 0..STEPS {
            let (mut normals, mut ends) = ([[0.0; 3]; MOST], [0.0; MOST]);
            for ((part, normal), end) in list.iter().zip(&mut normals).zip(&mut ends) {
                *normal = slope(*part, y);
                *end = dot(*normal, y) - signed(*part, y);
            }
            let before = y;
            y = push(x, &normals[..list.len()], &ends, &mut pushes);
            if length(difference(y, before)) <= CLOSE * length(difference(y, x)) {
                let pushing = pushes.iter().filter(|push| **push > 0.0).count();
                return (!parts.full && pushing > 1).then_some(y);
            }
        }
        None
    }

    /// Gathers the primitives that bound a composition beside a place, or what is outside of it.
    fn gather(&self, tree: &Tree, x: Vector, outside: bool, parts: &mut Parts) {
        let nearest = |trees: &'_ [Tree], sign: f64| {
            let distances = trees.iter().map(|t| sign * self.of(t, x));
            let least = |a: (usize, f64), b: (usize, f64)| if b.1 < a.1 { b } else { a };
            distances.enumerate().reduce(least)
        };
        match (tree, outside) {
            (Tree::Leaf(k), _) => parts.push((*k, outside)),
            (Tree::All(trees), false) | (Tree::Any(trees), true) => {
                for tree in trees {
                    self.gather(tree, x, outside, parts);
                }
            }
            (Tree::Any(trees) | Tree::All(trees), _) => {
                let sign = if outside { -1.0 } else { 1.0 };
                if let Some((k, _)) = nearest(trees, sign) {
                    self.gather(&trees[k], x, outside, parts);
                }
            }
            (Tree::First(trees), false) => {
                self.gather(&trees[0], x, false, parts);
                for tree in &trees[1..] {
                    self.gather(tree, x, true, parts);
                }
            }
            (Tree::First(trees), true) => {
                let first = -self.of(&trees[0], x);
                match nearest(&trees[1..], 1.0).filter(|(_, distance)| *distance < first) {
                    Some((k, _)) => self.gather(&trees[1 + k], x, false, parts),
                    None => self.gather(&trees[0], x, true, parts),
                }
            }
        }
    }
}

/// Direction in which the distance of a primitive rises.
fn slope(primitive: &Primitive, y: Vector, step: f64) -> Vector {
    let rise = |k: usize| {
        let (mut low, mut high) = (y, y);
        low[k] -= step;
        high[k] += step;
        primitive.distance(high) - primitive.distance(low)
    };
    let rises = [rise(0), rise(1), rise(2)];
    let steep = length(rises);
    rises.map(|r| if steep > 0.0 { r / steep } else { 0.0 })
}

/// The place nearest to `x` behind all planes `n y <= end`: x less multiples of the normals, none below zero.
fn push(x: Vector, normals: &[Vector], ends: &[f64], pushes: &mut [f64]) -> Vector {
    let pushed = |pushes: &[f64]| {
        let each = normals.iter().zip(pushes);
        each.fold(x, |y, (n, push)| along(y, -push, *n))
    };
    for _ in 0..SWEEPS {
        for (k, normal) in normals.iter().enumerate() {
            let beyond = dot(*normal, pushed(pushes)) - ends[k];
            pushes[k] = (pushes[k] + beyond).max(0.0);
        }
    }
    pushed(pushes)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn body(text: &str) -> Body {
        Body::new(&serde_json::from_str(text).unwrap(), 3)
    }

    const FLOOR: &str = r#"{"difference": [{"box": {"min_m": [-9, -9, -1], "max_m": [9, 9, 0]}},
                                           {"cylinder": {"centre_m": [0, 0, 0], "radius_m": 4, "length_m": 9}}]}"#;

    #[test]
    fn the_rim_of_a_hole_is_round_to_what_passes_it() {
        let floor = body(FLOOR);
        for degrees in [5.0_f64, 30.0, 45.0, 85.0] {
            let (sine, cosine) = degrees.to_radians().sin_cos();
            let off = 4.0 - 0.5 * cosine;
            let x = [0.6 * off, 0.8 * off, 0.5 * sine];
            let (distance, normal) = floor.away(x, 1e-5);
            assert!((distance - 0.5).abs() < 1e-8, "{degrees}: {distance}");
            let wanted = [-0.6 * cosine, -0.8 * cosine, sine];
            assert!(length(difference(normal, wanted)) < 1e-7, "{degrees}");
        }
    }

    #[test]
    fn beside_a_face_nothing_changes() {
        let floor = body(FLOOR);
        for x in [[6.0, 0.0, 0.3], [0.0, 3.5, -0.4], [5.0, 1.0, -0.2]] {
            let (distance, normal) = floor.away(x, 1e-5);
            assert_eq!(
                (distance, normal),
                (floor.distance(x), floor.normal(x, 1e-5))
            );
        }
    }

    #[test]
    fn edges_and_corners_of_planes_of_any_angle() {
        let wedge = body(
            r#"{"intersection": [{"half_space": {"point_m": [0, 0, 0], "normal": [0, 0, 1]}},
                                 {"half_space": {"point_m": [0, 0, 0], "normal": [0.8660254037844386, 0, -0.5]}}]}"#,
        );
        // Between both normals, which stand 120 degrees apart, the edge is nearest.
        let (distance, normal) = wedge.away([0.3, 7.0, 0.4], 1e-5);
        assert!((distance - 0.5).abs() < 1e-9 && (normal[2] - 0.8).abs() < 1e-9);
        let corner = body(
            r#"{"intersection": [{"half_space": {"point_m": [0, 0, 0], "normal": [1, 0, 0]}},
                                 {"half_space": {"point_m": [0, 0, 0], "normal": [0, 1, 0]}},
                                 {"half_space": {"point_m": [0, 0, 0], "normal": [0, 0, 1]}}]}"#,
        );
        let (distance, _) = corner.away([1.0, 2.0, 2.0], 1e-5);
        assert!((distance - 3.0).abs() < 1e-9);
        assert!((corner.away([1.0, 2.0, -2.0], 1e-5).0 - 5.0_f64.sqrt()).abs() < 1e-9);
    }

    #[test]
    fn what_is_outside_of_a_composition_has_its_edges_within() {
        // A room cut out of a wall: its edges are hollow, so nothing is nearer to them than to a face.
        let room = body(
            r#"{"difference": [{"box": {"min_m": [-9, -9, -9], "max_m": [9, 9, 9]}},
                               {"intersection": [{"half_space": {"point_m": [2, 0, 0], "normal": [1, 0, 0]}},
                                                 {"half_space": {"point_m": [0, 2, 0], "normal": [0, 1, 0]}}]}]}"#,
        );
        let (distance, normal) = room.away([1.5, 1.8, 0.0], 1e-5);
        assert!((distance - 0.2).abs() < 1e-12 && (normal[1] + 1.0).abs() < 1e-9);
    }
}
