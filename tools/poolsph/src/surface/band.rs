//! Normals, levels and areas in the band of particles along the surface.

use kernels::CubicSpline;
use rayon::prelude::*;

use super::Patch;
use super::area::Polygon;
use super::columns::Columns;
use super::{Cloud, tangents};
use crate::near::{dot, minus, squared};
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

/// Neighbours of a member.
#[derive(Debug, Clone, Default)]
struct Links {
    /// Their numbers among the members.
    to: Vec<u32>,
    /// V W of the pairs; for levels, times |grad C| of the neighbour, and only in the band.
    weight: Vec<f32>,
}

/// What the mean of the levels around a member keeps from turn to turn.
#[derive(Debug, Clone, Copy)]
struct Mean {
    /// Weight of the member itself.
    own: f32,
    /// Sum of weight times rise of the surface from the member to each neighbour.
    risen: f32,
    /// Sum of all weights.
    total: f32,
}

/// The band, with buffers that are kept from step to step.
#[derive(Debug, Clone, Default)]
pub(super) struct Band {
    /// Numbers in the cloud; the first `width` are of the band, the others deeper.
    members: Vec<u32>,
    width: usize,
    /// Number among the members, by number in the cloud.
    slots: Vec<u32>,
    links: Vec<Links>,
    patches: Vec<Patch>,
    next: Vec<Patch>,
    /// grad C of the members \[1/m\], and a zero.
    gradients: Vec<[f32; 4]>,
    turned: Vec<[f32; 4]>,
    means: Vec<Mean>,
    depths: Vec<f32>,
    levelled: Vec<f32>,
    columns: Columns,
}

const NONE: u32 = u32::MAX;

impl Band {
    /// Completes the `coloured` patches of a cloud.
    pub(super) fn complete(
        &mut self,
        cloud: &Cloud<'_>,
        kernel: CubicSpline<3>,
        spacing: f64,
        coloured: &mut [Patch],
    ) {
        self.collect(cloud, coloured, spacing);
        let volume = spacing * spacing * spacing;
        let own = volume * kernel.value(0.0);
        self.link(cloud, kernel, volume);
        for _ in 0..TURNS {
            self.turn(own);
        }
        self.trust(cloud, own);
        for _ in 0..LEVELS {
            self.level();
        }
        self.each(|band, k| Patch {
            area: band.owned(cloud, spacing, k),
            ..band.patches[k]
        });
        self.each(|band, k| Patch {
            seen: band.seen(cloud, spacing, k),
            ..band.patches[k]
        });
        let members = &self.members;
        let place = |k: usize| cloud.places[members[k] as usize];
        let patches = &mut self.patches[..self.width];
        self.columns.settle(place, spacing, patches);
        let members = self.members.iter().zip(&self.patches);
        for (&k, patch) in members.take(self.width) {
            coloured[k as usize] = *patch;
        }
    }

    fn each(&mut self, make: impl Fn(&Self, usize) -> Patch + Sync) {
        let mut next = std::mem::take(&mut self.next);
        (0..self.width)
            .into_par_iter()
            .with_min_len(GRAIN)
            .map(|k| make(self, k))
            .collect_into_vec(&mut next);
        self.patches[..self.width].copy_from_slice(&next);
        self.next = next;
    }

    /// Members of the band, then the deeper particles that they touch.
    fn collect(&mut self, cloud: &Cloud<'_>, coloured: &[Patch], spacing: f64) {
        self.members.clear();
        self.slots.clear();
        self.slots.resize(coloured.len(), NONE);
        for (k, patch) in coloured.iter().enumerate() {
            if patch.depth <= BAND * spacing {
                self.slots[k] = self.members.len() as u32;
                self.members.push(k as u32);
            }
        }
        self.width = self.members.len();
        for k in 0..self.width {
            for &b in cloud.row(self.members[k] as usize) {
                if self.slots[b as usize] == NONE {
                    self.slots[b as usize] = self.members.len() as u32;
                    self.members.push(b);
                }
            }
        }
        self.patches.clear();
        self.patches
            .extend(self.members.iter().map(|k| coloured[*k as usize]));
        self.gradients.clear();
        self.gradients.extend(self.patches.iter().map(|patch| {
            let [x, y, z] = patch.gradient.map(|x| x as f32);
            [x, y, z, 0.0]
        }));
        if self.links.len() < self.width {
            self.links.resize(self.width, Links::default());
        }
    }

    fn link(&mut self, cloud: &Cloud<'_>, kernel: CubicSpline<3>, volume: f64) {
        let (members, slots) = (&self.members[..self.width], &self.slots);
        let rows = self.links.par_iter_mut().zip(members).with_min_len(GRAIN);
        rows.for_each(|(links, &k)| {
            let row = cloud.row(k as usize);
            links.to.clear();
            links.to.extend(row.iter().map(|&b| slots[b as usize]));
            links.weight.clear();
            links.weight.extend(row.iter().map(|&b| {
                let dx = minus(cloud.places[b as usize], cloud.places[k as usize]);
                (volume * kernel.value(squared(dx).sqrt())) as f32
            }));
        });
    }

    /// Averages grad C. The sum is not divided by that of the weights, so that particles with many
    /// neighbours on the surface count most.
    fn turn(&mut self, own: f64) {
        let (gradients, links) = (&self.gradients, &self.links);
        let own = own as f32;
        gradients[..self.width]
            .par_iter()
            .zip(links)
            .with_min_len(GRAIN)
            .map(|(gradient, links)| {
                let sum = summed(&links.to, &links.weight, gradients);
                std::array::from_fn(|i| own * gradient[i] + sum[i])
            })
            .collect_into_vec(&mut self.turned);
        self.gradients[..self.width].copy_from_slice(&self.turned);
    }

    /// Normals from grad C, and what the means of the levels keep. Trust is in what has much of a
    /// gradient. The mean of both normals makes the step from one particle to the next exact on a
    /// plane and on a sphere, so that averaging does not flatten curves.
    fn trust(&mut self, cloud: &Cloud<'_>, own: f64) {
        for (patch, gradient) in self.patches.iter_mut().zip(&self.gradients[..self.width]) {
            let [x, y, z, _] = gradient.map(f64::from);
            let length = squared([x, y, z]).sqrt();
            patch.gradient = [x, y, z];
            if length > 0.0 {
                patch.normal = patch.gradient.map(|x| -x / length);
            }
        }
        let (members, patches, width) = (&self.members, &self.patches, self.width);
        self.links[..width]
            .par_iter_mut()
            .enumerate()
            .with_min_len(GRAIN)
            .map(|(k, links)| {
                let (at, to) = (&patches[k], cloud.places[members[k] as usize]);
                let own = own * squared(at.gradient).sqrt();
                let (mut risen, mut total) = (0.0, own);
                for (&link, weight) in links.to.iter().zip(&mut links.weight) {
                    let link = link as usize;
                    if link >= width {
                        *weight = 0.0;
                        continue;
                    }
                    let other = &patches[link];
                    let dx = minus(cloud.places[members[link] as usize], to);
                    *weight *= squared(other.gradient).sqrt() as f32;
                    let rise = 0.5 * (dot(at.normal, dx) + dot(other.normal, dx));
                    risen += f64::from(*weight) * rise;
                    total += f64::from(*weight);
                }
                let [own, risen, total] = [own, risen, total].map(|x| x as f32);
                Mean { own, risen, total }
            })
            .collect_into_vec(&mut self.means);
        self.depths.clear();
        self.depths
            .extend(self.patches.iter().map(|patch| patch.depth as f32));
    }

    /// Averages the level of the surface.
    fn level(&mut self) {
        let (depths, links) = (&self.depths, &self.links);
        depths[..self.width]
            .par_iter()
            .zip(links)
            .zip(&self.means)
            .with_min_len(GRAIN)
            .map(|((depth, links), mean)| {
                if mean.total <= 0.0 {
                    return *depth;
                }
                let start = mean.own * depth + mean.risen;
                let row = links.to.iter().zip(&links.weight);
                row.fold(start, |sum, (&b, w)| sum + w * depths[b as usize]) / mean.total
            })
            .collect_into_vec(&mut self.levelled);
        self.depths[..self.width].copy_from_slice(&self.levelled);
        for (patch, depth) in self.patches.iter_mut().zip(&self.levelled) {
            patch.depth = f64::from(*depth);
        }
    }

    /// Area that the band's particle `k` owns: what the planes toward its neighbours leave of its
    /// plane. A plane lies halfway between two particles; where their levels disagree by e, both
    /// move it by half of the mean rise times e, so that on a plane the areas fit together exactly
    /// as those of a power diagram do, however wrong the levels are.
    fn owned(&self, cloud: &Cloud<'_>, spacing: f64, k: usize) -> f64 {
        let own = &self.patches[k];
        if own.depth > OWNERS * spacing || squared(own.normal) <= 0.0 {
            return 0.0;
        }
        let (u, v) = tangents(own.normal);
        let at = self.members[k] as usize;
        let mut polygon = Polygon::square(PATCH * spacing);
        for &b in cloud.row(at) {
            let to = minus(cloud.places[b as usize], cloud.places[at]);
            let rise = dot(to, own.normal);
            let mut offset = 0.5 * squared(to) - own.depth * rise;
            let slot = self.slots[b as usize] as usize;
            let other = &self.patches[slot];
            let mean = if slot < self.width {
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

    /// Area of member `k` as seen from above, as far as its neighbours tell.
    ///
    /// Where the surface is not steep, a power diagram of the places in the horizontal plane,
    /// weighted by the height of the surface above each: it leaves neither gap nor overlap. At
    /// edges, the area times the normal.
    fn seen(&self, cloud: &Cloud<'_>, spacing: f64, k: usize) -> f64 {
        let own = &self.patches[k];
        let up = own.normal[2];
        let slant = own.area * up.max(0.0);
        let part = ((up - STEEP) / (FLAT - STEEP)).clamp(0.0, 1.0);
        if part <= 0.0 || own.area <= 0.0 {
            return slant;
        }
        let at = self.members[k] as usize;
        let height = own.depth / up;
        let mut polygon = Polygon::square(PATCH * spacing);
        for &b in cloud.row(at) {
            let slot = self.slots[b as usize] as usize;
            let other = &self.patches[slot];
            if slot < self.width && other.area > 0.0 && other.normal[2] > 0.5 * STEEP {
                let [x, y, _] = minus(cloud.places[b as usize], cloud.places[at]);
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
