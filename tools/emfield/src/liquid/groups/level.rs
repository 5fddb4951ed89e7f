//! How far a place lies above a surface that is known by its points.
//!
//! Beside each point stands the sphere that touches the surface there, of curvature b. A place at d from the point lies
//!
//! ```text
//! 2 f/(1 + sqrt(1 + 2 b f)),     f = n . d + b d . d/2
//! ```
//!
//! above it. The height above the surface is the mean over the points about the nearest one, the nearest the most.

use neighbours::Tree;

use crate::liquid::surface::{Patch, SIDE};
use crate::liquid::vector::{along, difference, direction, dot, length};

/// Spacings within which points count.
const REACH: f64 = 1.8;
/// Steps of difference quotients, in spacings.
const STEP: f64 = 0.1;
/// Sheets whose normals have less than this cosine may face each other.
const FACING: f64 = 0.3;
/// Least radius of the spheres, in spacings.
const ROUND: f64 = 1.0;
/// Rounds of Newton's method.
const ROUNDS: usize = 5;
/// Square of a slope that is none.
const FLAT: f64 = 0.01;
/// Spacings from the zero that count as on it.
const NEAR: f64 = 0.01;

/// A surface of points.
pub(super) struct Level<'a> {
    points: &'a [[f64; 3]],
    patches: &'a [Patch<3>],
    tree: Tree,
    spacing: f64,
}

impl<'a> Level<'a> {
    pub(super) fn new(points: &'a [[f64; 3]], patches: &'a [Patch<3>], spacing: f64) -> Self {
        Self {
            points,
            patches,
            tree: Tree::new(points),
            spacing,
        }
    }

    /// The nearest point of the surface.
    pub(super) fn nearest(&self, place: &[f64; 3]) -> Option<usize> {
        self.tree.nearest(*place)
    }

    /// Height above the surface \[m\], less than zero in the liquid.
    pub(super) fn height(&self, place: &[f64; 3]) -> f64 {
        self.nearest(place)
            .map_or(f64::INFINITY, |nearest| self.height_by(place, nearest))
    }

    /// Height above the sheet of the surface that a point is of.
    pub(super) fn height_by(&self, place: &[f64; 3], nearest: usize) -> f64 {
        let away = length(&difference(place, &self.points[nearest]));
        let reach = away + REACH * self.spacing;
        let side = &self.patches[nearest].normal;
        let (mut sum, mut weights) = (0.0, 0.0);
        self.tree.within(*place, reach, |j, _| {
            let patch = &self.patches[j];
            if dot(&patch.normal, side) <= SIDE {
                return;
            }
            let d = difference(place, &self.points[j]);
            let weight = wls::quartic((length(&d) - away).max(0.0) / (reach - away));
            sum += weight * self.above(patch, &d);
            weights += weight;
        });
        sum / weights
    }

    /// The point of the surface nearest to a place that faces point `i` across gas, nearer than `reach` \[m\].
    pub(super) fn facing(&self, place: &[f64; 3], i: usize, reach: f64) -> Option<usize> {
        let (x, n) = (&self.points[i], &self.patches[i].normal);
        let mut found: Option<[f64; 2]> = None;
        self.tree.within(*place, reach, |j, _| {
            let m = &self.patches[j].normal;
            let way = difference(&self.points[j], x);
            let faces = dot(n, m) < FACING && dot(&way, n) > 0.0 && dot(&way, m) < 0.0;
            let far = length(&difference(&self.points[j], place));
            // Equal ones by their numbers: trees have no order.
            let key = [far, j as f64];
            if faces && found.is_none_or(|best| key < best) {
                found = Some(key);
            }
        });
        found.map(|[_, j]| j as usize)
    }

    /// Height above the surface once sheets that face each other within `width` \[m\] have closed.
    pub(super) fn closed(&self, place: &[f64; 3], width: f64) -> f64 {
        let Some(nearest) = self.nearest(place) else {
            return f64::INFINITY;
        };
        let own = self.height_by(place, nearest);
        let facing = self.facing(place, nearest, width + self.spacing);
        let other = facing.map(|j| self.height_by(place, j));
        // Gas above one sheet is not liquid beneath another.
        match other.filter(|other| own < 0.0 || *other > 0.0) {
            Some(other) => either(own, other, width),
            None => own,
        }
    }

    /// Height of a place at `d` from a point above the sphere that touches it there.
    fn above(&self, patch: &Patch<3>, d: &[f64; 3]) -> f64 {
        let most = (ROUND * self.spacing).recip();
        let bow = (0.5 * patch.curvature).clamp(-most, most);
        let f = dot(&patch.normal, d) + 0.5 * bow * dot(d, d);
        2.0 * f / (1.0 + (1.0 + 2.0 * bow * f).max(0.0).sqrt())
    }
}

/// Where a height is zero.
pub(super) struct Rim<H> {
    pub(super) height: H,
    pub(super) spacing: f64,
}

impl<H: Fn(&[f64; 3]) -> f64> Rim<H> {
    /// The slope of the height at a place.
    fn slope(&self, place: &[f64; 3]) -> [f64; 3] {
        let step = STEP * self.spacing;
        std::array::from_fn(|k| {
            let mut ends = [*place; 2];
            ends[0][k] += step;
            ends[1][k] -= step;
            let [ahead, behind] = ends.map(|x| (self.height)(&x));
            (ahead - behind) / (2.0 * step)
        })
    }

    /// Unit normal, out of the liquid.
    pub(super) fn normal(&self, place: &[f64; 3]) -> [f64; 3] {
        direction(&self.slope(place))
    }

    /// A place moved onto the zero nearest to it, in some rounds of Newton's; none where it gets no nearer than a hundredth of
    /// a spacing.
    pub(super) fn nearest(&self, mut place: [f64; 3]) -> Option<[f64; 3]> {
        for _ in 0..ROUNDS {
            let slope = self.slope(&place);
            let steep = dot(&slope, &slope);
            if steep < FLAT {
                return None;
            }
            place = along(&place, -(self.height)(&place) / steep, &slope);
        }
        let left = (self.height)(&place).abs();
        (left < NEAR * self.spacing).then_some(place)
    }
}

/// The lesser of two heights, rounded off where they differ by less than `width` \[m\].
pub(super) fn either(a: f64, b: f64, width: f64) -> f64 {
    let near = (width - (a - b).abs()).max(0.0);
    a.min(b) - 0.25 * near * near / width
}

/// The greater of two heights, rounded off likewise.
pub(super) fn both(a: f64, b: f64, width: f64) -> f64 {
    -either(-a, -b, width)
}
