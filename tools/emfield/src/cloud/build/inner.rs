//! Points beside surfaces and between them: layers, lattices, random shifts.

use rayon::prelude::*;
use shapes::frame::{Vector, along, difference, direction, length};

use super::Builder;
use super::layers::{Column, Ground, Layered, Standing, thicknesses};
use crate::cloud::lattice::{self, Node};
use crate::cloud::layout::Wall;
use crate::cloud::points::{Arrangement, Layers, Points};
use crate::cloud::{Class, Foot, Metric, jitter};

/// Spacing across over spacing along the surface from which a layer counts as round.
const ROUND: f64 = 0.85;
/// Layers so many times as wide as thin are thin ones, and those by more than which a surface leaves its tangent plane
/// within a spacing.
const THIN: f64 = 8.0;
/// Nodes of lattices keep this part of the spacing away from other points.
const APART: f64 = 0.65;

impl Builder {
    /// Layers along all surfaces.
    pub(crate) fn layers(
        &mut self,
        columns: &mut [Column],
        plans: &[[Vec<f64>; 2]],
        walls: Option<&Layers>,
    ) {
        let before = self.cloud.len();
        for (number, column) in columns.iter_mut().enumerate() {
            column.foot = number as u32;
            self.cloud.feet.push(Foot {
                place: column.seed.place,
                curvature: column.seed.curvature,
                thin: false,
            });
        }
        self.find_gaps(columns, plans);
        for group in columns.chunk_by_mut(|a, b| a.solid == b.solid) {
            let (spacing, plan) = match group[0].solid {
                Some(k) => (self.layout.solids[k].spacing, plans[k].clone()),
                None => {
                    let spacing = group[0].seed.spacing;
                    let inside = walls.map(|l| thicknesses(l, spacing, l.inside));
                    (spacing, [inside.unwrap_or_default(), Vec::new()])
                }
            };
            for (side, thicknesses) in plan.iter().enumerate() {
                let mut ground = Ground {
                    layout: &self.layout,
                    dimensions: self.layout.dimensions,
                    occupied: &mut self.occupied,
                    first: self.cloud.len() as u32,
                };
                for point in ground.grow(group, side, thicknesses, spacing) {
                    self.layered(&point);
                }
            }
            for column in group.iter() {
                let first = plan[0].first().or(plan[1].first()).copied();
                let scale = column.seed.spacing / spacing;
                let across = first.map_or(column.seed.spacing, |t| t * scale.min(1.0));
                let wide = column.seed.spacing;
                let bow = column.seed.curvature.bow(wide);
                self.cloud.feet[column.foot as usize].thin = across < bow.max(wide / THIN);
                self.cloud.metric[column.point as usize] = metric(
                    column.seed.normal,
                    [across, column.seed.spacing],
                    column.foot,
                );
            }
        }
        self.gaps(columns);
        self.cloud.counts.layers = self.cloud.len() - before;
        self.widest = self.sizes.iter().copied().fold(0.0, f64::max);
    }

    pub(crate) fn layered(&mut self, point: &Layered) {
        let metric = metric(point.normal, [point.across, point.along], point.foot);
        let spacing = if metric == Metric::Round {
            (point.across * point.along).sqrt()
        } else {
            point.along
        };
        self.sizes.push(spacing);
        self.push(point.place, spacing, Class::Inside(point.medium), metric);
    }

    /// Nodes of the lattices where there is room for them.
    pub(crate) fn lattices(
        &mut self,
        nodes: &[Node],
        columns: &[Column],
        arrangement: Arrangement,
    ) {
        let standing: Vec<(Option<usize>, Standing<'_>)> = columns
            .chunk_by(|a, b| a.solid == b.solid)
            .map(|group| {
                let spacing = group.iter().fold(0.0, |s: f64, c| s.max(c.seed.spacing));
                (group[0].solid, Standing::new(group, spacing))
            })
            .collect();
        let packed = arrangement == Arrangement::Hexagonal;
        let mut kept: Vec<(Node, u16)> = nodes
            .par_iter()
            .filter(|node| node.face.is_none())
            .filter_map(|node| Some((*node, self.room(node, &standing)?)))
            .filter(|(_, medium)| !packed || *medium == 0)
            .collect();
        for (k, solid) in self.layout.solids.iter().enumerate().filter(|_| packed) {
            let inside =
                lattice::packed(solid.body.bounds(), self.layout.dimensions, solid.spacing);
            kept.par_extend(inside.par_iter().filter_map(|node| {
                let within = self.layout.depth(node.place) > 0.5 * node.spacing
                    && solid.body.distance(node.place) < 0.0
                    && !(self.layout.axisymmetric() && node.place[0] < 0.3 * node.spacing);
                let medium = within.then(|| self.room(node, &standing)).flatten()?;
                (medium == k as u16 + 1).then_some((*node, medium))
            }));
        }
        self.cloud.counts.lattice = kept.len();
        for (node, medium) in kept {
            self.push(
                node.place,
                node.spacing,
                Class::Inside(medium),
                Metric::Round,
            );
        }
    }

    /// The medium of a node that neither lies within layers nor comes too close to a point placed before.
    fn room(&self, node: &Node, standing: &[(Option<usize>, Standing<'_>)]) -> Option<u16> {
        let x = node.place;
        for (solid, columns) in standing {
            let (d, normal) = match (solid, &self.layout.wall) {
                (Some(k), _) => {
                    let solid = &self.layout.solids[*k];
                    let d = solid.body.distance(x);
                    let reach = solid.reach[usize::from(d > 0.0)];
                    if d.abs() > reach + 2.0 * solid.spacing {
                        continue;
                    }
                    (d, solid.body.normal(x, 1e-4 * solid.spacing))
                }
                (None, Wall::Ball { centre, radius }) => {
                    let away = difference(x, *centre);
                    if length(away) < 1e-9 * radius {
                        continue;
                    }
                    (length(away) - radius, direction(away))
                }
                (None, Wall::Box { .. }) => continue,
            };
            if columns.holds(x, d, normal, self.layout.dimensions) {
                return None;
            }
        }
        let near = APART * node.spacing.min(self.widest);
        let crowded = self.occupied.any(x, near, |other, _, square| {
            let own = APART * self.sizes[other as usize].min(node.spacing);
            square < own * own
        });
        (!crowded).then(|| self.layout.medium(x))
    }

    /// Shifts points that lie neither on interfaces nor on walls at random.
    pub(crate) fn shake(&mut self, points: &Points) {
        let jitter = points.jitter;
        if jitter == 0.0 {
            return;
        }
        for i in 0..self.cloud.len() {
            let (Class::Inside(medium), x) = (self.cloud.class[i], self.cloud.position[i]) else {
                continue;
            };
            let draw = |k: u64| jitter * jitter::signed(points.seed, i as u64, k);
            let mut moved = x;
            for (k, c) in moved.iter_mut().enumerate().take(self.layout.dimensions) {
                *c += self.cloud.spacing[i] * draw(k as u64);
            }
            if let Metric::Layered {
                normal,
                across,
                along: flat,
                ..
            } = self.cloud.metric[i]
            {
                let shift = difference(moved, x);
                let up = shapes::frame::dot(shift, normal);
                moved = along(moved, up * (across / flat - 1.0), normal);
            }
            let on_axis = self.layout.axisymmetric() && x[0] == 0.0;
            if on_axis {
                moved[0] = 0.0;
            }
            let far = |x: Vector| self.layout.nearest(x).0.abs().min(self.layout.depth(x));
            let kept = self.layout.medium(moved) == medium && far(moved) > 0.5 * far(x);
            if kept && !(self.layout.axisymmetric() && moved[0] < 0.5 * x[0]) {
                self.cloud.position[i] = moved;
            }
        }
    }
}

fn metric(normal: Vector, [across, along]: [f64; 2], foot: u32) -> Metric {
    if across >= ROUND * along {
        Metric::Round
    } else {
        Metric::Layered {
            normal,
            across,
            along,
            foot,
        }
    }
}
