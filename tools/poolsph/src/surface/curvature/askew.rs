//! Colours beside faces that the surface meets at another angle than a right one.
//!
//! Images stand as mirrors have them, and the colour that they make is that of a surface which meets the face at a right angle. Here
//! neighbours beyond the face stand where the metal would go on at its contact angle (see [`crate::faces`]), sheared along the surface:
//!
//! ```text
//! x' = mirror of x + 2 s cot(theta) t      t along the face and -grad C      s distance of x from the face
//! ```

use neighbours::Grid;
use rayon::prelude::*;
use shapes::frame::{along, difference, squared};

use crate::faces::TiltedFace;
use crate::near::Near;

/// Part of grad C that lies along a face, from which on it tells a direction there.
const TELLS: f64 = 0.05;

/// What lies beside such faces, with its scratch.
#[derive(Debug, Clone)]
pub(super) struct Askew {
    support: f64,
    /// Numbers and places of all that have a mirror image within a support.
    beside: Vec<u32>,
    places: Vec<[f64; 3]>,
    grid: Grid,
    changed: Vec<(usize, f64, [f64; 3])>,
}

impl Askew {
    /// With kernels of this support \[m\].
    pub(super) fn new(support: f64) -> Self {
        Self {
            support,
            beside: Vec::new(),
            places: Vec::new(),
            grid: Grid::new(support),
            changed: Vec::new(),
        }
    }

    /// Puts right the sums of W \[1/m3\] and grad W \[1/m4\] of the particles beside such faces.
    pub(super) fn correct(&mut self, near: &Near, number: &mut [f64], gradient: &mut [[f64; 3]]) {
        for face in near.images().tilted_faces() {
            self.gather(near, face);
            let members = (0..near.len()).into_par_iter();
            let seen = members.filter(|a| face.distance(near.position[*a]) < self.support);
            let changed = seen.filter_map(|a| {
                let tangent = self.tangent(face, gradient[a])?;
                let (number, gradient) = self.sums(near, face, a, tangent);
                Some((a, number, gradient))
            });
            self.changed = changed.collect();
            for (a, more, slope) in &self.changed {
                number[*a] += more;
                gradient[*a] = along(gradient[*a], 1.0, *slope);
            }
        }
    }

    /// Finds who stands beside a face, images beyond others included.
    fn gather(&mut self, near: &Near, face: &TiltedFace) {
        let images = near.images();
        let through = |b: usize| images.turn(b).is_some_and(|turn| turn.mirrors(face.axis));
        let all = near.position.iter().enumerate();
        let beside = all.filter(|(b, x)| face.distance(**x) < self.support && !through(*b));
        self.beside.clear();
        self.places.clear();
        for (b, x) in beside {
            self.beside.push(b as u32);
            self.places.push(*x);
        }
        self.grid.bin(&self.places);
    }

    /// t from grad W; none where that has no direction along the face.
    fn tangent(&self, face: &TiltedFace, gradient: [f64; 3]) -> Option<[f64; 3]> {
        let mut tangent = gradient.map(|g| -g);
        tangent[face.axis] = 0.0;
        let (size, all) = (squared(tangent).sqrt(), squared(gradient).sqrt());
        (size > TELLS * all).then(|| tangent.map(|x| x / size))
    }

    /// What particle `a` has of sheared images, less what it has of mirror images.
    fn sums(&self, near: &Near, face: &TiltedFace, a: usize, tangent: [f64; 3]) -> (f64, [f64; 3]) {
        let (images, kernel, place) = (near.images(), &near.kernel, near.position[a]);
        let (mut number, mut gradient) = (0.0, [0.0; 3]);
        let mut add = |sign: f64, other: [f64; 3]| {
            let way = difference(place, other);
            let sample = kernel.sample(squared(way).sqrt());
            number += sign * sample.value;
            gradient = along(gradient, sign * sample.slope, way);
        };
        for &b in near.lists.row(a) {
            let b = b as usize;
            if images.turn(b).is_some_and(|turn| turn.mirrors(face.axis)) {
                add(-1.0, near.position[b]);
            }
        }
        // All whose image may be within the support: half as far from the face as the farthest of them, give or take.
        let half = 0.5 * (self.support - face.distance(place));
        let mut middle = along(place, -2.0 * face.cot * half, tangent);
        middle[face.axis] = face.plane + half.copysign(place[face.axis] - face.plane);
        let reach = half.hypot(self.support + 2.0 * half * face.cot.abs());
        self.grid.runs(middle, reach, |run| {
            for x in &self.grid.sorted()[run] {
                let mut other = along(*x, 2.0 * face.cot * face.distance(*x), tangent);
                other[face.axis] = 2.0 * face.plane - x[face.axis];
                add(1.0, other);
            }
        });
        (number, gradient)
    }

    /// Bytes held.
    pub(super) fn bytes(&self) -> usize {
        (4 + 24 + 28) * self.places.capacity() + 40 * self.changed.capacity()
    }
}
