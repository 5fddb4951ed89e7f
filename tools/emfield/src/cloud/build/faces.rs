//! Points on the surfaces of bodies, also where these touch: a face that two bodies share has one set of points, and
//! at the seams of their other faces points keep the distance that they keep at an edge.

use run::Fault;
use shapes::frame::{Vector, along, dot};

use super::Builder;
use super::layers::Column;
use super::surface::{self, Seed};
use crate::cloud::{Class, Metric, SurfacePoint};

/// Least spacing of points on a surface over that of the scene, where another body is near.
const LEAST: f64 = 1.0 / 8.0;
/// Distance over spacing within which another body's surface counts as the same.
const SAME: f64 = 1e-4;
/// Two surfaces are those of a gap where the cosine of the angle of their normals is beyond this: one that goes on where
/// another ends has 0.
const GAP: f64 = 0.25;
/// And face each other across it beyond this.
const FACING: f64 = 0.5;
/// How far along a surface a crossing is sought, over the spacing, and with how many steps.
const REACH: f64 = 4.0;
const NEWTON: usize = 6;
/// Least distance over spacing of points of two bodies at a seam.
const SEAM: f64 = 0.65;

impl Builder {
    /// Points on the surfaces of bodies.
    pub(crate) fn surfaces(&mut self) -> Result<Vec<Column>, Vec<Fault>> {
        let mut columns: Vec<Column> = Vec::new();
        let mut faults = Vec::new();
        for k in 0..self.layout.solids.len() {
            let before = columns.len();
            let mut crowded = Vec::new();
            for seed in self.seeds(k) {
                let Some(media) = self.parts(&seed, k) else {
                    continue;
                };
                if self.at_seam(&seed, k, &columns[..before]) {
                    crowded.push((seed, media));
                    continue;
                }
                let point = self.interface(&seed, media);
                columns.push(Column::bare(seed, point, Some(k), media));
            }
            self.give(&crowded, &mut columns[before..]);
            if columns.len() == before && self.layout.leaves_out(k) {
                let what = "no part of the body's surface lies in the domain";
                faults.push(Fault::at(&format!("/bodies/{k}/shape"), what));
            }
        }
        self.cloud.counts.interface = self.cloud.len();
        if faults.is_empty() {
            Ok(columns)
        } else {
            Err(faults)
        }
    }

    /// Points on the surface of a body, nearer to each other where the surface of another body faces it, or one with finer
    /// points is beside it.
    fn seeds(&self, k: usize) -> Vec<Seed> {
        let solid = &self.layout.solids[k];
        let step = SAME * solid.spacing;
        let local = |x: Vector| {
            let mut gap = f64::INFINITY;
            for (number, other) in self.layout.solids.iter().enumerate() {
                let away = other.body.distance(x).abs();
                // A body that touches is no gap: its surface is the same.
                if number == k
                    || away < 1e-6 * solid.spacing
                    || away >= gap.min(2.0 * solid.spacing)
                {
                    continue;
                }
                // Nor is one whose surface goes on where this one ends, or passes through it.
                let cosine = dot(solid.body.normal(x, step), other.body.normal(x, step));
                if cosine.abs() > GAP && !self.cross(x, k, number) {
                    gap = gap.min(away);
                }
            }
            let across = (0.5 * gap).clamp(LEAST * solid.spacing, solid.spacing);
            across.min(self.layout.beside(x, k))
        };
        let coarse = surface::seeds(
            &solid.body,
            self.layout.dimensions,
            solid.spacing,
            solid.spacing,
            &|_| solid.spacing,
        );
        let least = coarse
            .iter()
            .fold(solid.spacing, |least, seed| least.min(local(seed.place)));
        if least < 0.999 * solid.spacing {
            let least = least.min(LEAST * solid.spacing);
            self.on_axis(surface::seeds(
                &solid.body,
                self.layout.dimensions,
                solid.spacing,
                least,
                &local,
            ))
        } else {
            self.on_axis(coarse)
        }
    }

    /// Points that lie on an axis but for rounding lie on it.
    pub(crate) fn on_axis(&self, mut seeds: Vec<Seed>) -> Vec<Seed> {
        for seed in seeds.iter_mut().filter(|_| self.layout.axisymmetric()) {
            if seed.place[0].abs() < 1e-6 * seed.spacing {
                seed.place[0] = 0.0;
            }
        }
        seeds
    }

    /// The media that a surface point parts, if it parts any, lies in the domain and is its body's to place.
    fn parts(&self, seed: &Seed, k: usize) -> Option<[u16; 2]> {
        let step = SAME * seed.spacing;
        let sides = [-step, step].map(|s| self.layout.medium(along(seed.place, s, seed.normal)));
        let own = k as u16 + 1;
        let shared = sides[0] == sides[1] || sides[0] != own;
        let outside = self.layout.depth(seed.place) < 0.3 * seed.spacing
            || self.layout.axisymmetric() && seed.place[0] < 0.0;
        let near = 0.1 * seed.spacing;
        let taken = self.occupied.any(seed.place, near, |_, _, _| true);
        (!shared && !outside && !taken && !self.others_face(seed, k, sides[1])).then_some(sides)
    }

    /// Whether the point lies on a face that the body around it places: of two the one with the finer points, or the
    /// first.
    fn others_face(&self, seed: &Seed, k: usize, around: u16) -> bool {
        let Some(other) = (around as usize).checked_sub(1) else {
            return false;
        };
        let [own, others] = [k, other].map(|k| self.layout.solids[k].spacing);
        let step = SAME * seed.spacing;
        let same = self.layout.solids[other].body.distance(seed.place).abs() < step;
        same && (others, other) < (own, k)
    }

    /// Whether a surface point crowds those of other bodies at a seam; across a gap points may be near.
    fn at_seam(&self, seed: &Seed, k: usize, others: &[Column]) -> bool {
        let near = SEAM * seed.spacing;
        self.occupied.any(seed.place, near, |other, _, square| {
            let Some(column) = others.get(other as usize) else {
                return false;
            };
            let near = SEAM * seed.spacing.min(column.seed.spacing);
            square < near * near
                && (dot(column.seed.normal, seed.normal) > -FACING
                    || column
                        .solid
                        .is_some_and(|other| self.cross(seed.place, k, other)))
        })
    }

    /// Whether the surface of another body passes through that of body `k` near a place on it: Newton's method along the
    /// surface finds the crossing, while the least distance of a gap stays.
    pub(crate) fn cross(&self, mut x: Vector, k: usize, other: usize) -> bool {
        let [own, other] = [k, other].map(|k| &self.layout.solids[k].body);
        let spacing = self.layout.solids[k].spacing;
        let step = SAME * spacing;
        for _ in 0..NEWTON {
            let away = other.distance(x);
            if away.abs() < 1e-9 * spacing {
                return true;
            }
            let (n, m) = (own.normal(x, step), other.normal(x, step));
            let level = along(m, -dot(m, n), n);
            let square = dot(level, level);
            if away.abs() > REACH * spacing * square.sqrt() {
                return false;
            }
            x = along(x, -away / square, level);
            x = along(x, -own.distance(x), own.normal(x, step));
        }
        false
    }

    /// Gives the area of points that are not placed to the nearest of the same face.
    fn give(&mut self, crowded: &[(Seed, [u16; 2])], columns: &mut [Column]) {
        for (seed, media) in crowded {
            let square = |column: &Column| {
                let away = shapes::frame::difference(column.seed.place, seed.place);
                dot(away, away)
            };
            let same = columns.iter_mut().filter(|column| {
                column.media == *media && dot(column.seed.normal, seed.normal) > FACING
            });
            if let Some(nearest) = same.min_by(|a, b| square(a).total_cmp(&square(b))) {
                nearest.seed.area += seed.area;
                self.cloud.surface[nearest.point as usize].area += seed.area;
            }
        }
    }

    fn interface(&mut self, seed: &Seed, [inner, outer]: [u16; 2]) -> u32 {
        self.occupied.push(seed.place);
        self.sizes.push(seed.spacing);
        let class = Class::Interface { inner, outer };
        let point = self.push(seed.place, seed.spacing, class, Metric::Round);
        self.cloud.surface.push(SurfacePoint {
            point,
            inner,
            outer,
            normal: seed.normal,
            area: seed.area,
        });
        point
    }
}
