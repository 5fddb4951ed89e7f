//! Rows whose supports are equal up to scale: they have the same weights in units of the spacing.

use rayon::prelude::*;

use crate::search::{Aim, Target};
use crate::supports::{Found, Supports};

/// Offsets that differ by less than this part of a spacing are equal.
const EQUAL: f64 = 1e-12;

/// A row and the others that share its weights, by their numbers among the supports.
#[derive(Debug, Clone)]
pub(crate) struct Group {
    pub(crate) first: usize,
    pub(crate) others: Vec<usize>,
}

impl Group {
    pub(crate) fn alone(first: usize) -> Self {
        Self {
            first,
            others: Vec::new(),
        }
    }
}

/// Puts equal supports together. The first of a group is the first in the order of the supports, so
/// that the result does not depend on the threads.
pub(crate) fn groups<const D: usize>(
    supports: &Supports,
    target: &Aim<'_, D>,
    points: &[[f64; D]],
) -> Vec<Group> {
    let mut keys = supports
        .found
        .par_iter()
        .enumerate()
        .filter(|(_, found)| found.free)
        .map(|(k, found)| (found.hash, k))
        .collect::<Vec<_>>();
    keys.par_sort_unstable();
    let runs = keys.chunk_by(|a, b| a.0 == b.0).collect::<Vec<_>>();
    let mut groups = runs
        .par_iter()
        .flat_map_iter(|run| {
            let mut group = Group::alone(run[0].1);
            let mut alone = Vec::new();
            let first = Member::new(supports, group.first, target);
            for &(_, k) in &run[1..] {
                if first.equals(&Member::new(supports, k, target), points) {
                    group.others.push(k);
                } else {
                    alone.push(Group::alone(k));
                }
            }
            std::iter::once(group).chain(alone)
        })
        .collect::<Vec<_>>();
    let bound = supports.found.iter().enumerate();
    groups.extend(bound.filter(|(_, f)| !f.free).map(|(k, _)| Group::alone(k)));
    // Near each other in space, near each other in memory.
    groups.par_sort_unstable_by_key(|group| group.first);
    groups
}

/// A row with its support.
struct Member<'a, const D: usize> {
    target: Target<D>,
    found: &'a Found,
    neighbours: &'a [u32],
}

impl<'a, const D: usize> Member<'a, D> {
    fn new(supports: &'a Supports, k: usize, target: &Aim<'_, D>) -> Self {
        let found = &supports.found[k];
        Self {
            target: target(found.row as usize),
            found,
            neighbours: &supports.neighbours[found.start..][..found.count as usize],
        }
    }

    fn equals(&self, other: &Self, points: &[[f64; D]]) -> bool {
        let near = (self.found.radius - other.found.radius).abs() <= EQUAL * self.found.radius;
        if !near
            || self.found.count != other.found.count
            || self.found.harmonic != other.found.harmonic
            || !self.target.metric.alike(&other.target.metric, EQUAL)
        {
            return false;
        }
        let limit = EQUAL + self.rounding() + other.rounding();
        self.neighbours
            .iter()
            .zip(other.neighbours)
            .all(|(&a, &b)| {
                let (s, t) = (
                    self.offset(points[a as usize]),
                    other.offset(points[b as usize]),
                );
                let own = self.is_own(a) == other.is_own(b);
                own && (0..D).all(|k| (s[k] - t[k]).abs() <= limit)
            })
    }

    fn is_own(&self, j: u32) -> bool {
        self.target.own && self.target.row == j as usize
    }

    fn offset(&self, point: [f64; D]) -> [f64; D] {
        let place = self.target.place;
        self.target
            .metric
            .scaled(std::array::from_fn(|a| point[a] - place[a]))
    }

    /// What rounding of the coordinates makes of an offset.
    fn rounding(&self) -> f64 {
        let size = self
            .target
            .place
            .iter()
            .fold(0.0_f64, |most, x| most.max(x.abs()));
        4.0 * f64::EPSILON * size / self.target.metric.spacing
    }
}
