//! The curvature of the free surface, from the particles that lie along it.
//!
//! 1. Every particle at the surface tells a place on it and the normal there: the colour and its gradient tell how far the surface is
//!    ([`depth`](super)), and the gradient, averaged once over neighbours, where it is. Of a face with the curvature kappa the smoothed
//!    colour is one half at `sigma^2 kappa/2` below it, where sigma^2 is the kernel's second moment along an axis; the curvature is taken back from there
//!    to the face.
//! 2. At each of them places and normals within three smoothing lengths are fitted ([`shape`]).
//! 3. Means and fit take a part of every wave of the surface, and a mean of the curvature tells which: it is given back.
//! 4. Single particles and drops of a few know no more of a shape than their size: they have the greatest curvature 2/d.
//!    No curvature is larger in size, and those that would be are counted.
//!
//! Solid metal counts as metal, so that a pool's surface goes on over its edge, but for what is bare and so cold that the edge
//! freezes there (`Near::dry`). Beyond faces the surface goes on at its contact angle
//! (`askew`).

mod askew;
mod quadric;

use kernels::CubicSpline;
use neighbours::{Grid, Lists, ROWS};
use particles::Matter;
use particles::sweep::wide;
use rayon::prelude::*;
use shapes::frame::{along, difference, squared};

use self::askew::Askew;
pub use self::quadric::{Sample, Shape, shape};
use super::depth::Depth;
use crate::faces::Images;
use crate::near::{Near, Role};

/// Distance up to which places are fitted, in smoothing lengths.
const REACH: f64 = 3.0;
/// h |grad C| from which on a particle tells something of the surface, and from which on it is believed: the outermost layer of a
/// lattice has 0.49.
const STEEP: [f64; 2] = [0.25, 0.40];
/// Greatest depth of a particle that tells of the surface, in spacings.
const DEEPEST: f64 = 1.0;
/// Second moment of the cubic spline along an axis, in h^2.
const MOMENT: f64 = 0.3;
/// c of the sharpening: what the kernel's means and the fit take of a wave k, 0.83 (k h)^2, over what the mean takes,
/// (k reach)^2/16.
const SHARPENED: f64 = 1.5;
/// Most that it gives back, in 1/d: at a tip the mean of steep sides is no measure.
const GIVEN: f64 = 0.3;
/// Colour below which a particle without a shape is one of a few: at the corner of a cube it is 0.61, in a film of one layer 0.70.
const SINGLE: f64 = 0.6;
/// Greatest curvature, in 1/d.
const SHARPEST: f64 = 2.0;

/// The curvature with its scratch.
#[derive(Debug, Clone)]
pub struct Curvature {
    /// kappa at the liquid particles of the surface \[1/m\], `[m]`; none elsewhere.
    pub mean: Vec<Option<f64>>,
    /// Places at which the fit wanted more than the greatest curvature, or knew too little.
    pub bounded: usize,
    depth: Depth,
    volume: f64,
    spacing: f64,
    smoothing_length: f64,
    /// grad C of members and images, and its average \[1/m\].
    gradient: Vec<[f64; 3]>,
    turned: Vec<[f64; 3]>,
    /// What stands beside faces of other contact angles than right ones, and the sums of W then; none without such faces.
    askew: Option<Askew>,
    number: Vec<f64>,
    /// How little the liquid wets each member and image, and the parts of the sums of W and grad W that dry metal has; empty
    /// without any.
    dryness: Vec<f64>,
    /// Whether only a part of the liquid is looked at.
    parted: bool,
    dry: Vec<[f64; 4]>,
    /// Members that tell of the surface.
    members: Vec<u32>,
    places: Vec<[f64; 3]>,
    samples: Vec<Sample>,
    images: Images,
    grid: Grid,
    lists: Lists,
    found: Vec<Option<Shape>>,
    sharpened: Vec<Option<Shape>>,
}

impl Curvature {
    /// The curvature of surfaces of `metal`.
    #[must_use]
    pub fn new(metal: Matter) -> Self {
        Self {
            mean: Vec::new(),
            bounded: 0,
            depth: Depth::new(CubicSpline::new(metal.smoothing_length)),
            volume: metal.volume(),
            spacing: metal.spacing,
            smoothing_length: metal.smoothing_length,
            gradient: Vec::new(),
            turned: Vec::new(),
            askew: None,
            number: Vec::new(),
            dryness: Vec::new(),
            parted: false,
            dry: Vec::new(),
            members: Vec::new(),
            places: Vec::new(),
            samples: Vec::new(),
            images: Images::default(),
            grid: Grid::new(REACH * metal.smoothing_length),
            lists: Lists::new(),
            found: Vec::new(),
            sharpened: Vec::new(),
        }
    }

    /// Finds the curvature at all liquid particles along the surface.
    pub fn measure(&mut self, near: &Near) {
        self.parted = false;
        self.dryness.clone_from(&near.dry);
        if !self.dryness.is_empty() {
            near.complete(&mut self.dryness, |dry, _, _| dry);
        }
        self.find(near);
    }

    /// Finds the curvature of the `part` of particles and images, as if there were nothing else.
    pub fn measure_part(&mut self, near: &Near, part: &[bool]) {
        self.dryness.clear();
        let other = part.iter().map(|part| f64::from(u8::from(!*part)));
        self.dryness.extend(other);
        self.parted = true;
        self.find(near);
    }

    fn find(&mut self, near: &Near) {
        if self.askew.is_none() && !near.images().tilted_faces().is_empty() {
            self.askew = Some(Askew::new(2.0 * self.smoothing_length));
        }
        self.turn(near);
        self.sample(near);
        self.search(near);
        self.fit();
        self.sharpen();
        self.scatter(near);
    }

    /// grad C, averaged over the neighbours; its sum is not divided by that of the weights, so that what is steep counts
    /// most.
    fn turn(&mut self, near: &Near) {
        let volume = self.volume;
        self.gradient.clear();
        self.gradient.extend_from_slice(&near.gradient);
        if self.askew.is_some() || !self.dryness.is_empty() {
            self.number.clone_from(&near.number);
        }
        if let Some(askew) = &mut self.askew {
            askew.correct(near, &mut self.number, &mut self.gradient);
        }
        if !self.dryness.is_empty() {
            self.bare(near);
        }
        for gradient in &mut self.gradient {
            *gradient = gradient.map(|x| volume * x);
        }
        if self.parted {
            self.forget_free(near);
        }
        near.complete(&mut self.gradient, |gradient, _, turn| {
            let size = squared(gradient).sqrt();
            if turn.tilts() && size > 0.0 {
                let outward = turn.facing(gradient.map(|x| -x / size));
                return outward.map(|x| -x * size);
            }
            turn.vector(gradient)
        });
        let (gradient, own) = (&self.gradient, near.kernel.value(0.0));
        self.turned.resize(near.len(), [0.0; 3]);
        let least = STEEP[0] / self.smoothing_length;
        near.each_row(
            &mut self.turned,
            #[inline(always)]
            |a, row, out| {
                *out = [0.0; 3];
                // Deeper ones tell nothing of the surface.
                if squared(gradient[a]) > least * least {
                    let start = gradient[a].map(|x| volume * own * x);
                    let values = row.values();
                    *out = values.fold(start, |sum, (b, w)| along(sum, volume * w, gradient[b]));
                }
            },
        );
    }

    /// What faces neither liquid nor wall is no face to the other liquid: the free surface, and the back of a wall.
    fn forget_free(&mut self, near: &Near) {
        let least = STEEP[0] / (self.volume * self.smoothing_length);
        for (gradient, all) in self.gradient.iter_mut().zip(&near.gradient) {
            if squared(*all).sqrt() > least {
                *gradient = [0.0; 3];
            }
        }
    }

    /// Takes what the liquid does not wet out of the sums of W and grad W: to its surface that is no metal.
    fn bare(&mut self, near: &Near) {
        let dryness = &self.dryness;
        self.dry.resize(near.len(), [0.0; 4]);
        near.each_row(
            &mut self.dry,
            #[inline(always)]
            |a, row, sums| {
                *sums = [0.0; 4];
                let values = row.values().zip(row.slope);
                for ((b, value), slope) in values.filter(|((b, _), _)| dryness[*b] > 0.0) {
                    let way = difference(near.position[a], near.position[b]);
                    let (part, slope) = (dryness[b], f64::from(*slope));
                    let [x, y, z] = way.map(|x| slope * x);
                    let more = [value, x, y, z];
                    *sums = std::array::from_fn(|i| sums[i] + part * more[i]);
                }
            },
        );
        let rows = self.number.iter_mut().zip(&mut self.gradient);
        for ((number, gradient), [value, x, y, z]) in rows.zip(&self.dry) {
            *number -= value;
            *gradient = difference(*gradient, [*x, *y, *z]);
        }
    }

    /// What the particles along the surface tell of it.
    fn sample(&mut self, near: &Near) {
        let [from, to] = STEEP;
        let own = near.kernel.value(0.0);
        self.members.clear();
        self.places.clear();
        self.samples.clear();
        let number = if self.askew.is_some() || !self.dryness.is_empty() {
            &self.number
        } else {
            &near.number
        };
        for (a, number) in number[..near.len()].iter().enumerate() {
            let (slope, turned) = (squared(self.gradient[a]).sqrt(), self.turned[a]);
            let steep = slope * self.smoothing_length;
            let size = squared(turned).sqrt();
            let wetted = 1.0 - self.dryness.get(a).copied().unwrap_or(0.0);
            if near.role[a] == Role::Backing || steep <= from || size <= 0.0 || wetted <= 0.0 {
                continue;
            }
            let colour = self.volume * number.max(own);
            let depth = self.depth.at(colour, slope);
            if depth > DEEPEST * self.spacing {
                continue;
            }
            let normal = turned.map(|x| -x / size);
            let place = along(near.position[a], depth, normal);
            self.members.push(a as u32);
            self.places.push(place);
            self.samples.push(Sample {
                place,
                normal,
                trust: wetted * ((steep - from) / (to - from)).min(1.0),
            });
        }
    }

    /// Places around each other, those beyond faces included.
    fn search(&mut self, near: &Near) {
        let reach = REACH * self.smoothing_length;
        let points = self.samples.len();
        (self.images).place_beside(near.images(), reach, &mut self.places);
        self.images.complete(&mut self.samples, |sample, _, turn| {
            let (place, normal) = turn.surface(sample.place, sample.normal);
            Sample {
                place,
                normal,
                ..sample
            }
        });
        for (place, sample) in self.places.iter_mut().zip(&self.samples).skip(points) {
            *place = sample.place;
        }
        self.grid.bin(&self.places);
        let (members, role) = (&self.members, &near.role);
        let liquid = |k: usize| role[members[k] as usize] == Role::Liquid;
        let search = self.grid.search(&self.places[..points], reach);
        self.lists.build(search, liquid, |_, _| true);
    }

    /// Shapes at all places of liquid particles.
    fn fit(&mut self) {
        let reach = REACH * self.smoothing_length;
        let most = SHARPEST / self.spacing;
        let (samples, lists) = (&self.samples, &self.lists);
        each(
            self.members.len(),
            &mut self.found,
            #[inline(always)]
            |k| {
                let around = lists.row(k).iter().map(|b| &samples[*b as usize]);
                let mut shape = shape(&samples[k], around, reach)?;
                shape.curvature = shape.curvature.clamp(-most, most);
                Some(shape)
            },
        );
    }

    /// kappa + c (kappa - S kappa) with the mean S over the places around, weighted as in the fit.
    fn sharpen(&mut self) {
        let reach = REACH * self.smoothing_length;
        let most = GIVEN / self.spacing;
        let (samples, lists, images) = (&self.samples, &self.lists, &self.images);
        let found = &self.found;
        each(
            found.len(),
            &mut self.sharpened,
            #[inline(always)]
            |k| {
                let mut shape = found[k]?;
                let (mut sum, mut weight) = (0.0, 0.0);
                let row = lists.row(k).iter().map(|b| *b as usize);
                for b in std::iter::once(k).chain(row) {
                    if let Some(other) = found[images.original(b)] {
                        let part = samples[k].weight(&samples[b], reach);
                        sum += part * other.curvature;
                        weight += part;
                    }
                }
                if weight > 0.0 {
                    let taken = SHARPENED * (shape.curvature - sum / weight);
                    shape.curvature += taken.clamp(-most, most);
                }
                Some(shape)
            },
        );
    }

    /// Brings the curvatures to the particles.
    fn scatter(&mut self, near: &Near) {
        let most = SHARPEST / self.spacing;
        let inward = 0.5 * MOMENT * self.smoothing_length * self.smoothing_length;
        self.mean.clear();
        self.mean.resize(near.len(), None);
        self.bounded = 0;
        for (k, (a, shape)) in self.members.iter().zip(&self.sharpened).enumerate() {
            let a = *a as usize;
            if near.role[a] != Role::Liquid {
                continue;
            }
            let curvature = match shape {
                Some(shape) => shape.curvature * (1.0 - inward * shape.squares).max(0.5),
                None if self.samples[k].trust > 0.5 => f64::INFINITY,
                None => continue,
            };
            self.bounded += usize::from(curvature.abs() >= most);
            self.mean[a] = Some(curvature.clamp(-most, most));
        }
        let own = near.kernel.value(0.0);
        for (a, mean) in self.mean.iter_mut().enumerate() {
            let colour = self.volume * near.number[a].max(own);
            if near.role[a] == Role::Liquid && mean.is_none() && colour < SINGLE {
                *mean = Some(most);
                self.bounded += 1;
            }
        }
    }

    /// Bytes held.
    #[must_use]
    pub fn bytes(&self) -> usize {
        (2 * 24 + 16) * self.gradient.capacity()
            + (size_of::<Sample>() + 24 + 4 + 32) * self.samples.capacity()
            + self.lists.bytes()
            + 8 * self.number.capacity()
            + 8 * self.dryness.capacity()
            + 32 * self.dry.capacity()
            + self.askew.as_ref().map_or(0, Askew::bytes)
    }
}

/// The shapes that `of` finds at `n` places.
fn each(n: usize, shapes: &mut Vec<Option<Shape>>, of: impl Fn(usize) -> Option<Shape> + Sync) {
    shapes.clear();
    shapes.resize(n, None);
    let parts = shapes.par_chunks_mut(ROWS / 4).enumerate();
    parts.for_each(|(part, shapes)| {
        wide(
            #[inline(always)]
            || {
                for (k, shape) in shapes.iter_mut().enumerate() {
                    *shape = of(part * (ROWS / 4) + k);
                }
            },
        );
    });
}

#[cfg(test)]
mod tests;
