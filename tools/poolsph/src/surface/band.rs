//! Normals, levels and areas in the band of particles along the surface.

use kernels::CubicSpline;
use rayon::prelude::*;
use shapes::frame::{difference, dot, squared};

use super::area::Polygon;
use super::columns::{Columns, Stood};
use super::edges::Open;
use super::{Cloud, tangents};
use crate::faces::Turn;
use crate::patch::Patch;
use crate::sweep::summed;

/// A particle deeper than this many spacings is not of the band.
const BAND: f64 = 1.75;
/// A particle deeper than this many spacings below the surface owns nothing of it.
const OWNERS: f64 = 1.25;
/// Half the edge of the largest polygon, in spacings.
const PATCH: f64 = 0.95;
/// Times that normals are averaged over neighbours.
const TURNS: usize = 4;
/// Times that levels are averaged over neighbours.
const LEVELS: usize = 4;
/// Upward part of the normal from which the area seen from above is a share of the plane.
const FLAT: f64 = 0.85;
/// Upward part of the normal up to which it is not.
const STEEP: f64 = 0.7;
/// Rows per unit of parallel work.
const GRAIN: usize = 128;

/// What the mean of the levels around a particle keeps from turn to turn.
#[derive(Debug, Clone, Copy)]
struct Mean {
    /// Weight of the particle itself.
    own: f32,
    /// Sum of weight times rise of the surface from the particle to each neighbour.
    risen: f32,
    /// Sum of all weights.
    total: f32,
}

/// The band, with buffers that are kept from step to step.
#[derive(Debug, Clone, Default)]
pub(super) struct Band {
    /// Its particles, by number in the cloud, ascending.
    rows: Vec<u32>,
    /// Which particles of the cloud these are.
    within: Vec<bool>,
    /// V W of the pairs of each row; for levels, times |grad C| of the neighbour, and only in the band.
    weights: Vec<Vec<f32>>,
    /// grad C of all particles of the cloud \[1/m\], and a zero.
    gradients: Vec<[f32; 4]>,
    turned: Vec<[f32; 4]>,
    means: Vec<Mean>,
    /// Depth of all particles of the cloud \[m\].
    depths: Vec<f32>,
    levelled: Vec<f32>,
    areas: Vec<f64>,
    /// Open sides of all particles of the cloud.
    open: Vec<Open>,
    /// Sides of a cell of the lattice along x and y \[m\].
    cell: [f64; 2],
    columns: Columns,
}

impl Band {
    /// A band of particles that a lattice of such cells, by their sides along x and y \[m\], has filled bodies with.
    pub(super) fn of(cell: [f64; 2]) -> Self {
        Self {
            cell,
            ..Self::default()
        }
    }

    /// Completes the coloured `patches` of a cloud, but of those that `rest`: nothing around them has moved, and their patches are what
    /// they were.
    pub(super) fn complete(
        &mut self,
        cloud: &Cloud<'_>,
        kernel: CubicSpline<3>,
        spacing: f64,
        patches: &mut Vec<Patch>,
        rest: impl Fn(usize) -> bool + Sync,
    ) {
        let volume = spacing * spacing * spacing;
        let own = volume * kernel.value(0.0);
        self.collect(patches, spacing, &rest);
        self.reflect(cloud, patches);
        self.weigh(cloud, kernel, volume);
        for _ in 0..TURNS {
            self.turn(cloud, own as f32);
        }
        self.trust(cloud, own, patches);
        for _ in 0..LEVELS {
            self.level(cloud);
        }
        for &k in &self.rows {
            patches[k as usize].depth = f64::from(self.depths[k as usize]);
        }
        reflect(cloud, patches);
        self.measure(|band, k| band.owned(cloud, patches, spacing, k));
        for (&k, area) in self.rows.iter().zip(&self.areas) {
            patches[k as usize].area = *area;
        }
        reflect(cloud, patches);
        self.measure(|band, k| band.seen(cloud, patches, spacing, k));
        for (&k, area) in self.rows.iter().zip(&self.areas) {
            patches[k as usize].seen = *area;
        }
        self.find_edges(cloud, spacing, patches, &rest);
        for &k in &self.rows {
            let (open, patch) = (self.open[k as usize], &mut patches[k as usize]);
            // At a sharp lower edge the normal of the last particle of a lattice looks down, though nothing lies above it.
            let claim = open.claim(self.cell[0] * self.cell[1]);
            (patch.claim, patch.sides) = (claim.unwrap_or(patch.seen), open.bits());
        }
        reflect(cloud, patches);
        // What rests beside them and what stands beyond a face see their parts of the columns there.
        let all = (0..cloud.places.len()).filter(|k| self.within[*k]);
        self.rows.clear();
        self.rows.extend(all.map(|k| k as u32));
        let stood = Stood {
            places: cloud.places,
            open: &self.open,
            cell: self.cell,
            spacing,
        };
        self.columns.settle(&self.rows, &stood, patches);
    }

    /// Where the metal ends, as seen from above.
    fn find_edges(
        &mut self,
        cloud: &Cloud<'_>,
        spacing: f64,
        patches: &[Patch],
        rest: impl Fn(usize) -> bool + Sync,
    ) {
        let own = cloud.places.len() - cloud.images.len();
        let within = &self.within;
        (0..own)
            .into_par_iter()
            .with_min_len(GRAIN)
            .map(|k| {
                if rest(k) {
                    Open::of_bits(patches[k].sides)
                } else if within[k] {
                    Open::of(cloud, k, spacing)
                } else {
                    Open::default()
                }
            })
            .collect_into_vec(&mut self.open);
        let images = cloud.images;
        images.complete(&mut self.open, |open, _, turn| open.turned(turn));
    }

    /// The particles of the band that do not rest, and what all have to begin with.
    fn collect(&mut self, patches: &[Patch], spacing: f64, rest: impl Fn(usize) -> bool) {
        self.rows.clear();
        self.within.clear();
        self.gradients.clear();
        self.depths.clear();
        for (k, patch) in patches.iter().enumerate() {
            let within = patch.depth <= BAND * spacing;
            if within && !rest(k) {
                self.rows.push(k as u32);
            }
            self.within.push(within);
            let [x, y, z] = patch.gradient.map(|x| x as f32);
            self.gradients.push([x, y, z, 0.0]);
            self.depths.push(patch.depth as f32);
        }
        if self.weights.len() < self.rows.len() {
            self.weights.resize(self.rows.len(), Vec::new());
        }
    }

    /// Gives images what their originals have.
    fn reflect(&mut self, cloud: &Cloud<'_>, patches: &mut Vec<Patch>) {
        reflect(cloud, patches);
        let images = cloud.images;
        images.complete(&mut self.within, |within, _, _| within);
        images.complete(&mut self.depths, |depth, _, _| depth);
        images.complete(&mut self.gradients, turned);
    }

    fn weigh(&mut self, cloud: &Cloud<'_>, kernel: CubicSpline<3>, volume: f64) {
        let rows = self.weights.par_iter_mut().zip(&self.rows);
        rows.with_min_len(GRAIN).for_each(|(weights, &k)| {
            weights.clear();
            weights.extend(cloud.row(k as usize).iter().map(|&b| {
                let dx = difference(cloud.places[b as usize], cloud.places[k as usize]);
                (volume * kernel.value(squared(dx).sqrt())) as f32
            }));
        });
    }

    /// Averages grad C. The sum is not divided by that of the weights, so that particles with many
    /// neighbours on the surface count most.
    fn turn(&mut self, cloud: &Cloud<'_>, own: f32) {
        let gradients = &self.gradients;
        let rows = self.rows.par_iter().zip(&self.weights);
        rows.with_min_len(GRAIN)
            .map(|(&k, weights)| {
                let sum = summed(cloud.row(k as usize), weights, gradients);
                let gradient = gradients[k as usize];
                std::array::from_fn(|i| own * gradient[i] + sum[i])
            })
            .collect_into_vec(&mut self.turned);
        for (&k, turned) in self.rows.iter().zip(&self.turned) {
            self.gradients[k as usize] = *turned;
        }
        cloud.images.complete(&mut self.gradients, self::turned);
    }

    /// Normals from grad C, and what the means of the levels keep. Trust is in what has much of a
    /// gradient. The mean of both normals makes the step from one particle to the next exact on a
    /// plane and on a sphere, so that averaging does not flatten curves.
    fn trust(&mut self, cloud: &Cloud<'_>, own: f64, patches: &mut Vec<Patch>) {
        for &k in &self.rows {
            let patch = &mut patches[k as usize];
            let [x, y, z, _] = self.gradients[k as usize].map(f64::from);
            let length = squared([x, y, z]).sqrt();
            patch.gradient = [x, y, z];
            if length > 0.0 {
                patch.normal = patch.gradient.map(|x| -x / length);
            }
        }
        reflect(cloud, patches);
        let (patches, within) = (&*patches, &self.within);
        let rows = self.rows.par_iter().zip(&mut self.weights);
        rows.with_min_len(GRAIN)
            .map(|(&k, weights)| {
                let (at, to) = (&patches[k as usize], cloud.places[k as usize]);
                let own = own * squared(at.gradient).sqrt();
                let (mut risen, mut total) = (0.0, own);
                for (&b, weight) in cloud.row(k as usize).iter().zip(weights) {
                    let b = b as usize;
                    if !within[b] {
                        *weight = 0.0;
                        continue;
                    }
                    let other = &patches[b];
                    let dx = difference(cloud.places[b], to);
                    *weight *= squared(other.gradient).sqrt() as f32;
                    let rise = 0.5 * (dot(at.normal, dx) + dot(other.normal, dx));
                    risen += f64::from(*weight) * rise;
                    total += f64::from(*weight);
                }
                let [own, risen, total] = [own, risen, total].map(|x| x as f32);
                Mean { own, risen, total }
            })
            .collect_into_vec(&mut self.means);
    }

    /// Averages the level of the surface.
    fn level(&mut self, cloud: &Cloud<'_>) {
        let depths = &self.depths;
        let rows = self.rows.par_iter().zip(&self.weights).zip(&self.means);
        rows.with_min_len(GRAIN)
            .map(|((&k, weights), mean)| {
                let depth = depths[k as usize];
                if mean.total <= 0.0 {
                    return depth;
                }
                let start = mean.own * depth + mean.risen;
                let row = cloud.row(k as usize).iter().zip(weights);
                row.fold(start, |sum, (&b, w)| sum + w * depths[b as usize]) / mean.total
            })
            .collect_into_vec(&mut self.levelled);
        for (&k, level) in self.rows.iter().zip(&self.levelled) {
            self.depths[k as usize] = *level;
        }
        cloud.images.complete(&mut self.depths, |depth, _, _| depth);
    }

    /// An area for each particle of the band.
    fn measure(&mut self, area: impl Fn(&Self, usize) -> f64 + Sync) {
        let mut areas = std::mem::take(&mut self.areas);
        (self.rows.par_iter().with_min_len(GRAIN))
            .map(|&k| area(self, k as usize))
            .collect_into_vec(&mut areas);
        self.areas = areas;
    }

    /// Area that the band's particle `k` owns: what the planes toward its neighbours leave of its
    /// plane. A plane lies halfway between two particles; where their levels disagree by e, both
    /// move it by half of the mean rise times e, so that on a plane the areas fit together exactly
    /// as those of a power diagram do, however wrong the levels are.
    fn owned(&self, cloud: &Cloud<'_>, patches: &[Patch], spacing: f64, k: usize) -> f64 {
        let own = &patches[k];
        if own.depth > OWNERS * spacing || squared(own.normal) <= 0.0 {
            return 0.0;
        }
        let (u, v) = tangents(own.normal);
        let mut polygon = Polygon::square(PATCH * spacing);
        for &b in cloud.row(k) {
            let b = b as usize;
            let to = difference(cloud.places[b], cloud.places[k]);
            let rise = dot(to, own.normal);
            let mut offset = 0.5 * squared(to) - own.depth * rise;
            let other = &patches[b];
            let mean = if self.within[b] {
                0.5 * (rise + dot(to, other.normal))
            } else {
                rise
            };
            offset += 0.5 * mean * (own.depth - other.depth - mean);
            polygon.cut([dot(to, u), dot(to, v)], offset);
            if polygon.is_empty() {
                return 0.0;
            }
        }
        polygon.area()
    }

    /// Area of particle `k` as seen from above, as far as its neighbours tell.
    ///
    /// Where the surface is not steep, a power diagram of the places in the horizontal plane,
    /// weighted by the height of the surface above each: it leaves neither gap nor overlap. At
    /// edges, the area times the normal.
    fn seen(&self, cloud: &Cloud<'_>, patches: &[Patch], spacing: f64, k: usize) -> f64 {
        let own = &patches[k];
        let up = own.normal[2];
        let slant = own.area * up.max(0.0);
        let part = ((up - STEEP) / (FLAT - STEEP)).clamp(0.0, 1.0);
        if part <= 0.0 || own.area <= 0.0 {
            return slant;
        }
        let height = own.depth / up;
        let mut polygon = Polygon::square(PATCH * spacing);
        for &b in cloud.row(k) {
            let b = b as usize;
            let other = &patches[b];
            if self.within[b] && other.area > 0.0 && other.normal[2] > 0.5 * STEEP {
                let [x, y, _] = difference(cloud.places[b], cloud.places[k]);
                let above = other.depth / other.normal[2];
                let lift = above * above - height * height;
                polygon.cut([x, y], 0.5 * (x * x + y * y + lift));
                if polygon.is_empty() {
                    return (1.0 - part) * slant;
                }
            }
        }
        part * polygon.area() + (1.0 - part) * slant
    }
}

/// Gives images the patches of their originals.
fn reflect(cloud: &Cloud<'_>, patches: &mut Vec<Patch>) {
    let of = |patch: Patch, _: usize, turn: &Turn| patch.turned(turn);
    cloud.images.complete(patches, of);
}

/// A gradient at an image.
fn turned([x, y, z, pad]: [f32; 4], _: usize, turn: &Turn) -> [f32; 4] {
    let [x, y, z] = turn.vector([x, y, z].map(f64::from)).map(|x| x as f32);
    [x, y, z, pad]
}
