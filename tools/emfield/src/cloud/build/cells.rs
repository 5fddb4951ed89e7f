//! How much of a conductor each point stands for.
//!
//! Beside a surface that has layers, cells are columns between the middles of layers; their volume follows from area
//! and curvature of the surface. Elsewhere a fine lattice of samples is shared out to the nearest points.

use std::f64::consts::{PI, TAU};

use rayon::prelude::*;
use shapes::Kind;
use shapes::frame::{Vector, along, difference, direction, length};

use super::layers::{Column, Standing};
use crate::cloud::layout::{Layout, Wall};
use crate::cloud::occupied::Occupied;
use crate::cloud::{Cell, Class, Cloud};

/// Samples per spacing along an axis, in two and three dimensions.
const SAMPLES: [f64; 2] = [8.0, 4.0];

/// Fills the cells of the media that points have shares of.
pub(crate) fn fill(shares: &[bool], layout: &Layout, columns: &[Column], cloud: &mut Cloud) {
    if shares.is_empty() {
        return;
    }
    let mut cells = vec![Cell::default(); cloud.len()];
    for medium in (0..shares.len()).filter(|m| shares[*m]) {
        Conductor::new(layout, columns, medium as u16).share_out(cloud, &mut cells);
    }
    cloud.cells = cells;
}

/// Volume of the samples of a row, and those beyond columns: nearest point, volume, place.
type Row = (f64, Vec<(u32, f64, Vector)>);

/// A medium that conducts.
struct Conductor<'a> {
    layout: &'a Layout,
    medium: u16,
    columns: &'a [Column],
    standing: Vec<(Option<usize>, Standing<'a>)>,
}

impl<'a> Conductor<'a> {
    fn new(layout: &'a Layout, columns: &'a [Column], medium: u16) -> Self {
        let standing = columns
            .chunk_by(|a, b| a.solid == b.solid)
            .map(|group| {
                let spacing = group.iter().fold(0.0, |s: f64, c| s.max(c.seed.spacing));
                (group[0].solid, Standing::new(group, spacing))
            })
            .collect();
        Self {
            layout,
            medium,
            columns,
            standing,
        }
    }

    fn share_out(&self, cloud: &Cloud, cells: &mut [Cell]) {
        for column in self.columns {
            for side in 0..2 {
                if column.media[side] == self.medium && !column.side[side].is_empty() {
                    self.column(cloud, column, side, cells);
                }
            }
        }
        let (mut set, mut owners, mut spacing) =
            (Occupied::new(self.step() * 4.0), Vec::new(), 0.0);
        for i in 0..cloud.len() {
            if owns(cloud.class[i], self.medium) {
                set.push(cloud.position[i]);
                owners.push(i);
                spacing = cloud.spacing[i].max(spacing);
            }
        }
        if owners.is_empty() {
            return;
        }
        let planes = self.rows(&set, spacing);
        let round = self.square(self.step());
        let mut whole = 0.0;
        for (plane, found) in planes {
            whole += plane;
            for (k, volume, x) in found {
                let owner = owners[k as usize];
                let middle = self.middle(x, &round);
                cells[owner].add(volume, difference(middle, cloud.position[owner]), round);
            }
        }
        if !self.smooth() {
            self.settle(whole, &owners, cells);
        }
    }

    /// Samples by row: the volume of all, and number of the nearest point, volume and place of those beyond columns.
    fn rows(&self, set: &Occupied, spacing: f64) -> Vec<Row> {
        let step = self.step();
        let (origin, counts) = self.samples(step);
        (0..counts[1] * counts[2])
            .into_par_iter()
            .map(|row| {
                let (j, k) = (row % counts[1], row / counts[1]);
                let place = |i: usize| -> Vector {
                    let n = [i, j, k];
                    std::array::from_fn(|a| {
                        if a < self.layout.dimensions {
                            origin[a] + (n[a] as f64 + 0.5) * step
                        } else {
                            0.0
                        }
                    })
                };
                let mut whole = 0.0;
                let found = (0..counts[0]).filter_map(|i| {
                    let x = place(i);
                    let volume = self.weight(x, step);
                    whole += volume;
                    let volume = volume * self.beyond_columns(x, volume, step);
                    if volume <= 0.0 {
                        return None;
                    }
                    // Most samples of a lattice are nearer than this to one of its points.
                    let mut radius = 0.6 * spacing;
                    loop {
                        match set.nearest(x, radius) {
                            Some(k) => return Some((k, volume, x)),
                            None => radius *= 1.7,
                        }
                    }
                });
                let found = found.collect();
                (whole, found)
            })
            .collect()
    }

    /// Whether columns fit together: the surface has neither edges nor crossings.
    fn smooth(&self) -> bool {
        let bodies = self.layout.solids.iter().map(|s| &s.body);
        let own = (self.medium as usize).checked_sub(1);
        let single = |body: &shapes::Body| match body.single().map(|p| &p.kind) {
            Some(Kind::Ball(_)) => true,
            Some(Kind::Cylinder { half, .. }) => half.is_infinite(),
            _ => false,
        };
        match own {
            Some(own) => single(&self.layout.solids[own].body),
            None => bodies.into_iter().all(single) && matches!(self.layout.wall, Wall::Ball { .. }),
        }
    }

    /// Scales all shares to the volume that the samples have together: columns overlap at edges that look inward.
    fn settle(&self, whole: f64, owners: &[usize], cells: &mut [Cell]) {
        let found: f64 = owners.iter().map(|i| cells[*i].volume).sum();
        if found <= 0.0 || whole <= 0.0 {
            return;
        }
        for i in owners {
            cells[*i].scale(whole / found);
        }
    }

    /// The cells of a column on one side.
    fn column(&self, cloud: &Cloud, column: &Column, side: usize, cells: &mut [Cell]) {
        let points = &column.side[side];
        let mut add = |owner: u32, between: [f64; 2]| {
            let owner = owner as usize;
            self.slab(
                column,
                side,
                between,
                cloud.position[owner],
                &mut cells[owner],
            );
        };
        let mut low = 0.0;
        let mut owner = match side {
            0 => Some(column.point),
            _ => None,
        };
        for (k, (point, away)) in points.iter().enumerate() {
            let before = if k == 0 { 0.0 } else { points[k - 1].1 };
            let middle = 0.5 * (before + away);
            if let Some(owner) = owner {
                add(owner, [low, middle]);
                low = middle;
            }
            owner = Some(*point);
        }
        if let Some(owner) = owner {
            add(owner, [low, column.height(side)]);
        }
    }

    /// The part of a column between two distances from the surface, by Simpson's rule: round patches in space.
    fn slab(
        &self,
        column: &Column,
        side: usize,
        [low, high]: [f64; 2],
        point: Vector,
        cell: &mut Cell,
    ) {
        const WEIGHTS: [f64; 5] = [1.0 / 12.0, 4.0 / 12.0, 2.0 / 12.0, 4.0 / 12.0, 1.0 / 12.0];
        let seed = &column.seed;
        let d = self.layout.dimensions;
        // The middle of a curved patch lies below its surface point.
        let sag = if d == 3 {
            0.5 * seed.curvature.sum() * seed.area / (4.0 * PI)
        } else {
            seed.curvature.sum() * seed.area * seed.area / 24.0
        };
        for (k, weight) in WEIGHTS.iter().enumerate() {
            let away = low + (high - low) * 0.25 * k as f64;
            let signed = if side == 0 { -away } else { away };
            let flat = 1.0 + signed * seed.curvature.sum() / (d - 1) as f64;
            let place = along(seed.place, signed - sag * flat, seed.normal);
            let area = seed.area * column.widening(side, away);
            let mut volume = weight * (high - low) * area;
            if self.layout.axisymmetric() {
                volume *= TAU * place[0].max(0.0);
            }
            // Mean square of the distance from the middle, along the surface.
            let square = if d == 3 {
                area / (4.0 * PI)
            } else {
                area * area / 12.0
            };
            let own = self.flat(seed.normal, square);
            cell.add(volume, difference(self.middle(place, &own), point), own);
        }
    }

    /// The middle of the volume of a piece: a full turn holds more of it outside than inside.
    fn middle(&self, mut place: Vector, own: &[Vector; 3]) -> Vector {
        if self.layout.axisymmetric() && place[0] > 0.0 {
            place[0] += own[0][0] / place[0];
        }
        place
    }

    /// Second moments of a sample of unit volume about its middle.
    fn square(&self, step: f64) -> [Vector; 3] {
        std::array::from_fn(|a| {
            std::array::from_fn(|b| {
                if a == b && a < self.layout.dimensions {
                    step * step / 12.0
                } else {
                    0.0
                }
            })
        })
    }

    /// Second moments of a flat patch of unit area about its middle.
    fn flat(&self, normal: Vector, square: f64) -> [Vector; 3] {
        std::array::from_fn(|a| {
            std::array::from_fn(|b| {
                let one = f64::from(u8::from(a == b && a < self.layout.dimensions));
                square * (one - normal[a] * normal[b])
            })
        })
    }

    fn step(&self) -> f64 {
        let spacing = match self.medium {
            0 => self.layout.spacing,
            m => self.layout.solids[m as usize - 1].spacing,
        };
        spacing / SAMPLES[self.layout.dimensions - 2]
    }

    /// First corner and numbers of the samples.
    fn samples(&self, step: f64) -> (Vector, [usize; 3]) {
        let d = self.layout.dimensions;
        let (mut low, mut high) = match &self.layout.wall {
            Wall::Box { low, high, .. } => (*low, *high),
            Wall::Ball { centre, radius } => {
                (centre.map(|c| c - radius), centre.map(|c| c + radius))
            }
        };
        if self.layout.axisymmetric() {
            low[0] = low[0].max(0.0);
        }
        if self.medium > 0 {
            let bounds = self.layout.solids[self.medium as usize - 1].body.bounds();
            for k in 0..d {
                low[k] = low[k].max(bounds[0][k]);
                high[k] = high[k].min(bounds[1][k]);
            }
        }
        let counts = std::array::from_fn(|k| {
            if k < d {
                ((high[k] - low[k]) / step).ceil().max(1.0) as usize
            } else {
                1
            }
        });
        (low, counts)
    }

    /// The part of a sample that lies above the last points of columns.
    fn beyond_columns(&self, x: Vector, volume: f64, step: f64) -> f64 {
        let mut part = 1.0;
        if volume > 0.0 {
            for (solid, standing) in &self.standing {
                part *= self.above(x, *solid, standing, step);
            }
        }
        part
    }

    /// Volume of a sample: the part of its cell that lies in the medium.
    fn weight(&self, x: Vector, step: f64) -> f64 {
        let mut part = match self.medium {
            0 => (0.5 + self.edge(x) / step).min(1.0),
            _ => (0.5 + self.layout.depth(x) / step).min(1.0),
        };
        if part <= 0.0 {
            return 0.0;
        }
        // A sample that the surface cuts is judged by the distance of the surface.
        let own = self.medium as usize;
        if own > 0 {
            part *= (0.5 - self.layout.solids[own - 1].body.distance(x) / step).clamp(0.0, 1.0);
            let earlier = self.layout.solids[..own - 1].iter();
            for solid in earlier {
                part *= (0.5 + solid.body.distance(x) / step).clamp(0.0, 1.0);
            }
        }
        let mut volume = part * step.powi(self.layout.dimensions as i32);
        if self.layout.axisymmetric() {
            volume *= TAU * x[0];
        }
        volume
    }

    /// Distance to the wall and to all bodies, positive in the surroundings \[m\].
    fn edge(&self, x: Vector) -> f64 {
        let solids = self.layout.solids.iter().map(|s| s.body.distance(x));
        solids.fold(self.layout.depth(x), f64::min)
    }

    /// The part of a sample that is not within the columns of a surface.
    fn above(&self, x: Vector, solid: Option<usize>, standing: &Standing<'_>, step: f64) -> f64 {
        let (d, normal) = match (solid, &self.layout.wall) {
            (Some(k), _) => {
                let solid = &self.layout.solids[k];
                let d = solid.body.distance(x);
                if d.abs() > solid.reach[usize::from(d > 0.0)] + step {
                    return 1.0;
                }
                (d, solid.body.normal(x, 1e-4 * solid.spacing))
            }
            (None, Wall::Ball { centre, radius }) => {
                let away = difference(x, *centre);
                if length(away) < 1e-9 * radius {
                    return 1.0;
                }
                (length(away) - radius, direction(away))
            }
            (None, Wall::Box { .. }) => return 1.0,
        };
        let Some(column) = standing.below(x, d, normal) else {
            return 1.0;
        };
        let side = usize::from(column.media[0] != self.medium);
        if column.media[side] != self.medium || column.side[side].is_empty() {
            return 1.0;
        }
        let away = if side == 0 { -d } else { d };
        (0.5 + (away - column.height(side)) / step).clamp(0.0, 1.0)
    }
}

/// Whether a point takes a share of a medium.
fn owns(class: Class, medium: u16) -> bool {
    match class {
        Class::Inside(m) | Class::Outer { medium: m, .. } => m == medium,
        Class::Interface { inner, .. } => inner == medium,
    }
}
