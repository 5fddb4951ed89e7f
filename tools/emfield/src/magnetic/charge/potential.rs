//! Charges on the surfaces of conductors, and the potential that they make within.
//!
//! A changing field drives charges to the surfaces of conductors until no current leaves them. With
//! the Coulomb gauge `div A = 0` (Matsuzawa 2017, eq. 2.69) the conservation of charge, `div J = 0` with
//! `J = -sigma (dA/dt + grad V)` (2.65, 2.66), reads
//!
//! - within a conductor: `lap V = 0`;
//! - on its surface, where `J.n = 0`: `n.grad V = -n.dA/dt`;
//! - between conductors a and b: `sigma_a n.grad_a V - sigma_b n.grad_b V = (sigma_b - sigma_a) n.dA/dt`;
//! - on a wall: as on a surface, nothing passes.
//!
//! V is sought at the points of conductors alone, by stencils of each of them alone. Each body, with all
//! that it touches, has V up to a constant; its mean is zero. Unknown is `phi`, of which V is the rate:
//! `V = j w phi` in a sinusoidal steady state.
//!
//! V is harmonic and as smooth as the body is wide, however thin the skin: its polynomials are those of places, not of
//! offsets that follow a surface which bends. What its gradient errs comes many times enlarged into the currents, since
//! `dA/dt` and `grad V` all but cancel in a thin skin.

use std::ops::Range;

use wls::{Cloud, Condition, Error, Metric, Row, Rules, Search, Stencils, Wants};

use crate::stencils::region::{Kind, Region};
use crate::stencils::sides::Form;

/// No unknown.
const NONE: u32 = u32::MAX;

/// Which points have rows, and from where.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Part {
    /// Those within conductors.
    Within,
    /// Those on interfaces, from the inner side, and on walls.
    Inner,
    /// Those on interfaces from the outer side.
    Outer,
}

/// Stencils that keep to one conductor.
struct Conducting<'a> {
    region: &'a Region<3>,
    conductivity: &'a [f64],
    part: Part,
}

impl Conducting<'_> {
    /// The conductor in which row `i` is made, if there is one.
    fn medium(&self, i: usize) -> Option<u16> {
        let found = match (self.region.kinds[i], self.part) {
            (Kind::Inside(m), Part::Within) => m,
            (Kind::Wall { medium, .. }, Part::Inner) => medium,
            (Kind::Interface(face), Part::Inner) => self.region.faces[face as usize].inner,
            (Kind::Interface(face), Part::Outer) => self.region.faces[face as usize].outer,
            _ => return None,
        };
        (self.conductivity[found as usize] > 0.0).then_some(found)
    }
}

impl Rules<3> for Conducting<'_> {
    fn wanted(&self, i: usize) -> bool {
        self.medium(i).is_some()
    }

    fn allowed(&self, i: usize, j: usize) -> bool {
        self.medium(i).is_some_and(|m| self.region.touches(j, m))
    }

    /// `lap V = 0` holds on the surface too.
    fn conditions(&self, i: usize, conditions: &mut Vec<Condition<3>>) {
        if self.part != Part::Within {
            let at = self.region.places[i];
            conditions.push(Condition::Laplacian { at });
        }
    }
}

/// A side of a point.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Side {
    /// That in which the point is counted; on an interface the inner one.
    Inner,
    /// On an interface the outer one.
    Outer,
}

/// The unknowns of the potential, and its stencils.
#[derive(Debug, Clone)]
pub struct Charge {
    /// Points of the unknowns: those of one body after those of another, rising.
    pub points: Vec<u32>,
    /// Unknowns of each body, with all that it touches.
    pub bodies: Vec<Range<usize>>,
    unknown: Vec<u32>,
    within: Stencils<3>,
    inner: Stencils<3>,
    outer: Stencils<3>,
}

impl Charge {
    /// Finds the conductors and makes their stencils.
    ///
    /// # Errors
    /// Where points are alone, coincide or lie in a plane.
    pub fn new(region: &Region<3>, conductivity: &[f64], form: &Form) -> Result<Self, Error> {
        let straight = region.metrics.iter().map(|metric| metric.straight());
        let metrics: Vec<Metric<3>> = straight.collect();
        let cloud = Cloud {
            points: &region.places,
            metrics: &metrics,
        };
        let search = Search::new(cloud)?;
        let form = form.for_potentials();
        let make = |part: Part| {
            let rules = Conducting {
                region,
                conductivity,
                part,
            };
            let wants = Wants {
                gradient: true,
                laplacian: part == Part::Within,
                ..Wants::default()
            };
            Stencils::build(&search, &form.plan::<3>(wants), &rules)
        };
        let (within, inner, outer) = (make(Part::Within)?, make(Part::Inner)?, make(Part::Outer)?);
        let (points, bodies) = bodies([&within, &inner, &outer]);
        let mut unknown = vec![NONE; region.len()];
        for (p, i) in points.iter().enumerate() {
            unknown[*i as usize] = p as u32;
        }
        Ok(Self {
            points,
            bodies,
            unknown,
            within,
            inner,
            outer,
        })
    }

    /// Number of unknowns.
    #[must_use]
    pub fn len(&self) -> usize {
        self.points.len()
    }

    /// No unknowns at all.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.points.is_empty()
    }

    /// The unknown of point `i`.
    #[must_use]
    pub fn unknown(&self, i: usize) -> Option<usize> {
        let found = self.unknown[i];
        (found != NONE).then_some(found as usize)
    }

    /// The stencils that hold at point `i` on a side, if it conducts there.
    fn stencils(&self, i: usize, side: Side) -> Option<&Stencils<3>> {
        let all: &[&Stencils<3>] = match side {
            Side::Inner => &[&self.within, &self.inner],
            Side::Outer => &[&self.outer],
        };
        all.iter().find(|s| s.order(i) > 0).copied()
    }

    /// Weights of the gradient at point `i` on a side, over the unknowns; nothing where it does not
    /// conduct.
    pub fn gradient(&self, i: usize, side: Side) -> impl Iterator<Item = (usize, [f64; 3])> + '_ {
        let stencils = self.stencils(i, side);
        let rows: [Option<Row<'_>>; 3] =
            std::array::from_fn(|axis| stencils.map(|s| s.derivative(i, axis)));
        let count = rows[0].map_or(0, |row| row.neighbours.len());
        (0..count).filter_map(move |k| {
            let [Some(x), Some(y), Some(z)] = rows else {
                return None;
            };
            let weight = [x, y, z].map(|row| row.factor * row.weights[k]);
            Some((self.unknown[x.neighbours[k] as usize] as usize, weight))
        })
    }

    /// What stands before `A_k` of the point in the row of unknown `p`, whose right side is that times
    /// `-A_s`: the normal of the surface, and between conductors as much as they differ.
    #[must_use]
    pub fn leaving(&self, p: usize, region: &Region<3>, conductivity: &[f64]) -> [f64; 3] {
        let i = self.points[p] as usize;
        match region.kinds[i] {
            Kind::Inside(_) => [0.0; 3],
            Kind::Wall { .. } => region.wall_normals[i],
            Kind::Interface(face) => {
                let face = &region.faces[face as usize];
                let [a, b] = [face.inner, face.outer].map(|m| conductivity[m as usize]);
                face.normal.map(|n| n * (a - b) / (a + b))
            }
        }
    }

    /// Weights of the row of unknown `p` over the unknowns.
    pub fn row(
        &self,
        p: usize,
        region: &Region<3>,
        conductivity: &[f64],
        row: &mut Vec<(u32, f64)>,
    ) {
        let i = self.points[p] as usize;
        let mut slope = |side: Side, normal: [f64; 3], share: f64| {
            for (q, w) in self.gradient(i, side) {
                let along = (0..3).map(|k| w[k] * normal[k]).sum::<f64>();
                row.push((q as u32, share * along));
            }
        };
        match region.kinds[i] {
            Kind::Inside(_) => {
                let plain = self.within.laplacian(i).iter();
                row.extend(plain.map(|(j, w)| (self.unknown[j], w)));
            }
            Kind::Wall { .. } => slope(Side::Inner, region.wall_normals[i], 1.0),
            Kind::Interface(face) => {
                let face = &region.faces[face as usize];
                let [a, b] = [face.inner, face.outer].map(|m| conductivity[m as usize]);
                slope(Side::Inner, face.normal, a / (a + b));
                slope(Side::Outer, face.normal, -b / (a + b));
            }
        }
    }
}

/// The points of all rows, those of one body after those of another; and where each body stands.
fn bodies(all: [&Stencils<3>; 3]) -> (Vec<u32>, Vec<Range<usize>>) {
    let count = all[0].rows();
    let mut root: Vec<u32> = (0..count as u32).collect();
    let rows = |i: usize| all.into_iter().filter(move |s| s.order(i) > 0);
    for i in 0..count {
        for &j in rows(i).flat_map(|s| s.neighbours(i)) {
            let [a, b] = [i as u32, j].map(|p| find(&mut root, p));
            root[a.max(b) as usize] = a.min(b);
        }
    }
    let mut points: Vec<u32> = (0..count as u32)
        .filter(|i| rows(*i as usize).next().is_some())
        .collect();
    points.sort_by_key(|i| find(&mut root, *i));
    let ends: Vec<usize> = (1..=points.len())
        .filter(|k| {
            let here = find(&mut root, points[k - 1]);
            points
                .get(*k)
                .is_none_or(|next| find(&mut root, *next) != here)
        })
        .collect();
    let starts = std::iter::once(0).chain(ends.iter().copied());
    let ranges = starts.zip(&ends).map(|(a, b)| a..*b).collect();
    (points, ranges)
}

/// The first of all points that hang together with `p`.
fn find(root: &mut [u32], mut p: u32) -> u32 {
    while root[p as usize] != p {
        root[p as usize] = root[root[p as usize] as usize];
        p = root[p as usize];
    }
    p
}
