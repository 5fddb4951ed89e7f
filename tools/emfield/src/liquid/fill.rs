//! Points that fill a shape: on its surface and inside, evenly.

use neighbours::Tree;
use rayon::prelude::*;
use shapes::Body;

use super::vector::{across, along, difference, direction, dot, length, spatial};
use crate::cloud;

/// Distance of neighbours of closest packing over the edge of the cube that each point has, in space.
const CUBES: f64 = 1.122_462_048_309_373;
/// The same for triangles and squares.
const SQUARES: f64 = 1.074_569_931_823_542;
/// Rounds in which points push each other apart.
const ROUNDS: usize = 60;
/// Points push each other within so many spacings.
pub(super) const REACH: f64 = 1.6;
/// Part of a spacing that two points at one place move apart in a round.
const PUSH: f64 = 0.25;
/// Points inside keep this many spacings off the surface.
const DEPTH: f64 = 0.45;

/// Points of a shape.
#[derive(Debug, Clone, PartialEq)]
pub struct Filled<const D: usize> {
    /// Places \[m\]; those on the surface come first.
    pub position: Vec<[f64; D]>,
    /// Unit normals of those on the surface, out of the body.
    pub normal: Vec<[f64; D]>,
}

/// Fills a body with points at about `spacing` \[m\], one for each cube (square) of that edge.
#[must_use]
pub fn fill<const D: usize>(body: &Body, spacing: f64) -> Filled<D> {
    let seeds = cloud::seeds(body, D, spacing, spacing, &|_| spacing);
    let surface = seeds.len();
    let mut position: Vec<[f64; D]> = seeds.iter().map(|s| flat(&s.place)).collect();
    let lattice = lattice::<D>(body.bounds(), spacing);
    let inside = lattice.filter(|x| body.distance(spatial(x)) < -DEPTH * spacing);
    position.extend(inside);
    for _ in 0..ROUNDS {
        let push = pushes(&position, position.len(), spacing);
        position = (0..position.len())
            .into_par_iter()
            .map(|i| {
                let x = &position[i];
                if i < surface {
                    settled(body, x, &push[i], spacing)
                } else {
                    kept(body, &along(x, 1.0, &push[i]), spacing)
                }
            })
            .collect();
    }
    let normal = position[..surface]
        .iter()
        .map(|x| normal(body, x, spacing))
        .collect();
    Filled { position, normal }
}

fn flat<const D: usize>(x: &[f64; 3]) -> [f64; D] {
    std::array::from_fn(|k| x[k])
}

fn normal<const D: usize>(body: &Body, x: &[f64; D], spacing: f64) -> [f64; D] {
    direction(&flat(&body.normal(spatial(x), 1e-3 * spacing)))
}

/// A surface point pushed along the surface.
fn settled<const D: usize>(body: &Body, x: &[f64; D], push: &[f64; D], spacing: f64) -> [f64; D] {
    let n = normal(body, x, spacing);
    let mut place = along(x, 1.0, &across(push, &n));
    for _ in 0..3 {
        let n = normal(body, &place, spacing);
        place = along(&place, -body.distance(spatial(&place)), &n);
    }
    place
}

/// A point inside that keeps off the surface.
fn kept<const D: usize>(body: &Body, x: &[f64; D], spacing: f64) -> [f64; D] {
    let above = body.distance(spatial(x)) + DEPTH * spacing;
    if above > 0.0 {
        along(x, -above, &normal(body, x, spacing))
    } else {
        *x
    }
}

/// How far neighbours push each of the first `own` points \[m\]: each by `PUSH (1 - r/R)^2` of a spacing.
pub(super) fn pushes<const D: usize>(
    points: &[[f64; D]],
    own: usize,
    spacing: f64,
) -> Vec<[f64; D]> {
    let crowd = Crowd::new(points, spacing);
    let each = (0..own).into_par_iter();
    each.map(|i| crowd.push(&points[i])).collect()
}

/// Points among which places are looked at.
pub(super) struct Crowd<'a, const D: usize> {
    points: &'a [[f64; D]],
    tree: Tree,
    spacing: f64,
}

impl<'a, const D: usize> Crowd<'a, D> {
    pub(super) fn new(points: &'a [[f64; D]], spacing: f64) -> Self {
        let places: Vec<[f64; 3]> = points.iter().map(spatial).collect();
        Self {
            points,
            tree: Tree::new(&places),
            spacing,
        }
    }

    /// How far a place is pushed by the points around it \[m\].
    pub(super) fn push(&self, place: &[f64; D]) -> [f64; D] {
        let radius = REACH * self.spacing;
        let mut push = [0.0; D];
        self.tree.within(spatial(place), radius, |j, _| {
            let d = difference(place, &self.points[j]);
            let far = length(&d);
            if far > 0.0 {
                let near = 1.0 - far / radius;
                push = along(&push, PUSH * self.spacing * near * near / far, &d);
            }
        });
        push
    }

    /// The point nearest to a place, and how far it is \[m\].
    pub(super) fn nearest(&self, place: &[f64; D]) -> Option<(usize, f64)> {
        let nearest = self.tree.nearest(spatial(place))?;
        Some((nearest, length(&difference(place, &self.points[nearest]))))
    }

    /// Visits points nearer than so many spacings.
    pub(super) fn near(&self, place: &[f64; D], reach: f64, mut visit: impl FnMut(usize)) {
        let radius = reach * self.spacing;
        self.tree.within(spatial(place), radius, |j, _| visit(j));
    }
}

/// Closest packing: face-centred cubes in space, triangles in a plane.
fn lattice<const D: usize>(bounds: [[f64; 3]; 2], spacing: f64) -> impl Iterator<Item = [f64; D]> {
    let root = |x: f64| x.sqrt();
    let axes: [[f64; D]; D] = std::array::from_fn(|k| {
        let edge = if D == 3 { CUBES } else { SQUARES } * spacing;
        let cube = [
            [1.0, 0.0, 0.0],
            [0.5, 0.5 * root(3.0), 0.0],
            [0.5, root(3.0) / 6.0, root(2.0 / 3.0)],
        ];
        std::array::from_fn(|a| edge * cube[k][a])
    });
    let middle: [f64; D] = std::array::from_fn(|k| 0.5 * (bounds[0][k] + bounds[1][k]));
    let half: f64 = (0..D)
        .map(|k| 0.5 * (bounds[1][k] - bounds[0][k]))
        .fold(0.0, f64::max);
    // A cube of half edge `half` lies within so many steps of skewed axes.
    let steps = (2.5 * half / spacing).ceil() as i64 + 1;
    let side = 2 * steps + 1;
    let total = side.pow(D as u32);
    (0..total).filter_map(move |number| {
        let mut rest = number;
        let mut place = middle;
        for axis in &axes {
            let step = rest % side - steps;
            rest /= side;
            // Off the middle, so that no point lies on a plane of symmetry by chance alone.
            place = along(&place, step as f64 + 0.25, axis);
        }
        let near = (0..D).all(|k| (place[k] - middle[k]).abs() <= half);
        near.then_some(place)
    })
}

/// The least distance of two points over the spacing.
#[must_use]
pub fn closest<const D: usize>(points: &[[f64; D]], spacing: f64) -> f64 {
    let places: Vec<[f64; 3]> = points.iter().map(spatial).collect();
    let tree = Tree::new(&places);
    let mut least = f64::INFINITY;
    for (i, x) in points.iter().enumerate() {
        tree.within(places[i], 1.5 * spacing, |j, _| {
            if j != i {
                let d = difference(x, &points[j]);
                least = least.min(dot(&d, &d).sqrt());
            }
        });
    }
    least / spacing
}
