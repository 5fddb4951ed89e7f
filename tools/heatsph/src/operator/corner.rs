//! Cells of a lattice in the corners of a body.
//!
//! On a lattice the links within a square of four points are its sides and its diagonals, and both are right for
//! linear fields. A point in a corner is different from all others: its diagonal brings `d2T/dxdy` in by its whole
//! weight, over a quarter of a cell, an error that does not fall with the spacing. Where both faces are insulated or
//! held there is no such derivative; where both cool by convection there is, and the sides alone are right: what they
//! miss of it is what the patches of surface miss, which take the heat at the temperature of the corner. So squares,
//! and cubes along edges, in the corner of two faces pass heat along their sides, with the weights of their diagonals.

use krylov::Pattern;

use crate::cloud::Cloud;
use shapes::frame::{Vector, along, difference, dot};

/// Cosine of two faces above which they are one.
const ALONG: f64 = 0.5;

/// Lays the diagonals in the corners of a lattice along the sides.
pub(super) fn straighten(cloud: &Cloud, pattern: &Pattern, weight: &mut [f64]) {
    let mut corners = Corners {
        cloud,
        pattern,
        weight,
    };
    let mut patches: Vec<_> = cloud.patches.iter().map(|p| (p.point, p.normal)).collect();
    patches.sort_by_key(|(point, _)| *point);
    for own in patches.chunk_by(|a, b| a.0 == b.0) {
        for (n, (point, first)) in own.iter().enumerate() {
            for (_, second) in &own[n + 1..] {
                if dot(*first, *second).abs() < ALONG {
                    corners.edge(*point as usize, [*first, *second]);
                }
            }
        }
    }
}

struct Corners<'a> {
    cloud: &'a Cloud,
    pattern: &'a Pattern,
    weight: &'a mut [f64],
}

impl Corners<'_> {
    /// The square inside the corner of two faces at a point, and the cube on it along the edge.
    fn edge(&mut self, point: usize, normals: [Vector; 2]) {
        let step = -self.cloud.spacing[point];
        let [x, y] = normals.map(|n| n.map(|c| step * c));
        let Some(square) = self.square(point, [x, y]) else {
            return;
        };
        self.flatten(&[square]);
        let [a, b] = normals;
        let z = shapes::frame::cross(a, b).map(|c| step * c);
        let above = self.linked(point, z).and_then(|up| self.square(up, [x, y]));
        if let (3, Some(above)) = (self.cloud.dimensions, above) {
            self.flatten(&[square, above]);
        }
    }

    /// The points at a place and at steps `x`, `y` and both from it.
    fn square(&self, point: usize, [x, y]: [Vector; 2]) -> Option<[usize; 4]> {
        let both = along(x, 1.0, y);
        Some([
            point,
            self.linked(point, x)?,
            self.linked(point, both)?,
            self.linked(point, y)?,
        ])
    }

    /// The point that is linked with another at a displacement.
    fn linked(&self, point: usize, step: Vector) -> Option<usize> {
        let place = along(self.cloud.position[point], 1.0, step);
        let least = 1e-6 * self.cloud.spacing[point];
        let mut ends = self.pattern.columns()[self.pattern.row(point)].iter();
        let there = |j: &&u32| {
            let away = difference(self.cloud.position[**j as usize], place);
            dot(away, away) < least * least
        };
        ends.find(there).map(|j| *j as usize)
    }

    /// Takes the diagonals of a square, or the diagonals through the middle of a cube between two squares, and gives
    /// their weight to the sides.
    fn flatten(&mut self, squares: &[[usize; 4]]) {
        let last = squares[squares.len() - 1];
        let diagonals: Vec<[usize; 2]> = if squares.len() == 1 {
            vec![[last[0], last[2]], [last[1], last[3]]]
        } else {
            (0..4).map(|k| [squares[0][k], last[(k + 2) % 4]]).collect()
        };
        let mut taken = f64::INFINITY;
        for [a, b] in &diagonals {
            taken = taken.min(self.link(*a, *b).map_or(0.0, |link| self.weight[link]));
        }
        if taken <= 0.0 {
            return;
        }
        let around = |square: &[usize; 4]| [0, 1, 2, 3].map(|k| [square[k], square[(k + 1) % 4]]);
        let mut sides: Vec<[usize; 2]> = squares.iter().flat_map(around).collect();
        if squares.len() > 1 {
            sides.extend((0..4).map(|k| [squares[0][k], last[k]]));
        }
        let changes = diagonals.iter().map(|d| (d, -taken));
        for ([a, b], change) in changes.chain(sides.iter().map(|s| (s, taken))) {
            for link in [self.link(*a, *b), self.link(*b, *a)].into_iter().flatten() {
                self.weight[link] += change;
            }
        }
    }

    fn link(&self, a: usize, b: usize) -> Option<usize> {
        let mut row = self.pattern.row(a);
        row.find(|k| self.pattern.columns()[*k] as usize == b)
    }
}
