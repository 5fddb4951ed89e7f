//! Convex bodies that planes leave of a cube about an origin.

use shapes::frame::cross;

use super::vector::{along, difference, dot, length};

/// A face: corners in order about the way out of the body, and what is beyond it.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Side {
    /// The point whose part is beyond; none beyond the surface and the cube.
    pub(super) beyond: Option<u32>,
    corners: Vec<[f64; 3]>,
}

impl Side {
    /// The way out of the body, as long as the face is large: the sum of the triangles from the first corner.
    fn across(&self) -> [f64; 3] {
        let first = self.corners.first().copied().unwrap_or_default();
        let mut sum = [0.0; 3];
        for pair in self.corners.windows(2) {
            let (a, b) = (difference(&pair[0], &first), difference(&pair[1], &first));
            sum = along(&sum, 0.5, &cross(a, b));
        }
        sum
    }

    /// Area \[m2\].
    pub(super) fn area(&self) -> f64 {
        length(&self.across())
    }
}

/// A convex body.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Polyhedron {
    sides: Vec<Side>,
}

impl Polyhedron {
    /// A cube of half an edge \[m\].
    pub(super) fn cube(half: f64) -> Self {
        let side = |k: usize, way: f64| {
            let corner = |(u, v): (f64, f64)| {
                let mut x = [0.0; 3];
                (x[k], x[(k + 1) % 3], x[(k + 2) % 3]) = (way * half, u * half, v * half);
                x
            };
            let mut corners = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)].map(corner);
            if way < 0.0 {
                corners.reverse();
            }
            Side {
                beyond: None,
                corners: corners.to_vec(),
            }
        };
        let sides = (0..3).flat_map(|k| [side(k, 1.0), side(k, -1.0)]);
        Self {
            sides: sides.collect(),
        }
    }

    /// Leaves what has `way . x <= end`; the new side has `beyond` behind it.
    pub(super) fn cut(&mut self, beyond: Option<u32>, way: &[f64; 3], end: f64) {
        let above = |x: &[f64; 3]| dot(way, x) - end;
        let corners = || self.sides.iter().flat_map(|s| &s.corners);
        if corners().all(|x| above(x) <= 0.0) {
            return;
        }
        let mut rim = Vec::new();
        for side in &mut self.sides {
            let (old, mut left) = (std::mem::take(&mut side.corners), Vec::new());
            for (k, a) in old.iter().enumerate() {
                let b = &old[(k + 1) % old.len()];
                let (u, v) = (above(a), above(b));
                if u <= 0.0 {
                    left.push(*a);
                }
                if (u <= 0.0) != (v <= 0.0) {
                    let met = along(a, u / (u - v), &difference(b, a));
                    left.push(met);
                    rim.push(met);
                }
            }
            side.corners = left;
        }
        self.sides.retain(|s| s.corners.len() > 2);
        self.sides.push(Side {
            beyond,
            corners: around(rim, way),
        });
    }

    /// Its sides.
    pub(super) fn faces(&self) -> impl Iterator<Item = &Side> {
        self.sides.iter()
    }

    /// Square of the distance of the farthest corner \[m2\].
    pub(super) fn farthest(&self) -> f64 {
        let corners = self.sides.iter().flat_map(|s| &s.corners);
        corners.map(|x| dot(x, x)).fold(0.0, f64::max)
    }

    /// Volume \[m3\]: cones from the origin, which may be outside.
    pub(super) fn volume(&self) -> f64 {
        let cone = |side: &Side| match side.corners.first() {
            Some(corner) => dot(&side.across(), corner) / 3.0,
            None => 0.0,
        };
        self.sides.iter().map(cone).sum()
    }
}

/// Corners of a convex polygon across `way`, in order about their middle.
fn around(mut corners: Vec<[f64; 3]>, way: &[f64; 3]) -> Vec<[f64; 3]> {
    let share = (corners.len().max(1) as f64).recip();
    let middle = corners.iter().fold([0.0; 3], |m, x| along(&m, share, x));
    let far = |x: &[f64; 3]| dot(&difference(x, &middle), &difference(x, &middle));
    let start = corners.iter().max_by(|a, b| far(a).total_cmp(&far(b)));
    let first = start.map_or([0.0; 3], |x| difference(x, &middle));
    let second = cross(*way, first);
    let whole = (length(way) * length(&first)).max(f64::MIN_POSITIVE);
    let angle = |x: &[f64; 3]| {
        let d = difference(x, &middle);
        (dot(&d, &second) / whole).atan2(dot(&d, &first) / length(&first).max(f64::MIN_POSITIVE))
    };
    corners.sort_by(|a, b| angle(a).total_cmp(&angle(b)));
    corners
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn planes_leave_the_volumes_and_faces_that_geometry_says() {
        let mut body = Polyhedron::cube(1.0);
        assert!((body.volume() - 8.0).abs() < 1e-12);
        body.cut(Some(7), &[2.0, 0.0, 0.0], 1.0);
        assert!((body.volume() - 6.0).abs() < 1e-12);
        // A corner as far as 1.5 from the origin along each axis: a tetrahedron of three edges of 0.5 and 1 is cut off.
        body.cut(Some(8), &[1.0, 1.0, 1.0], 2.0);
        assert!(
            (body.volume() - (6.0 - 0.125 / 6.0)).abs() < 1e-12,
            "{}",
            body.volume()
        );
        let areas: Vec<f64> = body
            .faces()
            .filter(|s| s.beyond.is_some())
            .map(Side::area)
            .collect();
        assert!((areas[0] - (4.0 - 0.125)).abs() < 1e-12);
        assert!((areas[1] - 0.125 * 3.0_f64.sqrt()).abs() < 1e-12);
        // A plane that leaves the origin outside.
        let mut beside = Polyhedron::cube(1.0);
        beside.cut(None, &[0.0, 1.0, 0.0], -0.5);
        assert!((beside.volume() - 2.0).abs() < 1e-12, "{}", beside.volume());
        beside.cut(None, &[0.0, 1.0, 0.0], -2.0);
        assert!(beside.volume().abs() < 1e-12 && beside.farthest() < 1e-12);
        // What passes it by changes nothing.
        let before = body.clone();
        body.cut(None, &[1.0, 1.0, 0.0], 5.0);
        assert_eq!(body, before);
    }
}
