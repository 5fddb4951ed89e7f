//! What the cells of points store.
//!
//! A cell that an interface crosses holds parts of several materials, and a point may stand for what another one
//! conducts to far better. Between two linked points what is stored belongs to the one to which it has the
//! shorter way, as a resistance: up to the middle of the link's resistance, not of its length. In one material
//! the two are the same. A good conductor's heat then does not hang on a poor one, nor does it cross a contact,
//! and the flux at an interface between points is of second order.

use rayon::prelude::*;
use run::property::{Arguments, Curve, OutOfRange};

use super::Materials;
use super::holds::Holds;
use crate::cloud::Cloud;
use crate::operator::Links;
use crate::system::storage::Storage;
use shapes::Body;
use shapes::frame::{Vector, along, difference, dot, length};

/// Samples along an edge of a cell that an interface crosses, in a plane and in space.
const SAMPLES: [usize; 2] = [8, 4];

/// Most of its own part that a cell gives to others.
const MOST: f64 = 0.4;

/// How much of its function of temperature a material's part of a cell holds (capacity \[J/(m3 K)\] where there is
/// none), and its heat \[J/m3\].
type Part = (f64, f64);

/// What the cells store at the start.
#[derive(Debug, Clone, PartialEq)]
pub struct Cells {
    /// What each holds \[J\] (per metre of depth in a plane scene).
    pub storage: Storage,
    /// Temperature at which each holds the heat of its parts \[K\].
    pub temperature: Vec<f64>,
}

impl Cells {
    /// Cells at the temperatures of their points, with the heat that their parts have above these.
    fn of(storage: Storage, mut temperature: Vec<f64>, surplus: &[f64]) -> Self {
        for (i, (t, surplus)) in temperature.iter_mut().zip(surplus).enumerate() {
            match &storage {
                Storage::Fixed(capacity) => *t += surplus / capacity[i],
                Storage::Varies(content) if *surplus != 0.0 => {
                    *t = content.temperature(i, content.at(i, *t).1 + surplus, *t);
                }
                Storage::Varies(_) => {}
            }
        }
        Self {
            storage,
            temperature,
        }
    }
}

/// A cloud with its links and the body that it fills.
#[derive(Debug, Clone, Copy)]
pub struct Ground<'a> {
    /// Points.
    pub cloud: &'a Cloud,
    /// Links.
    pub links: &'a Links,
    /// The body.
    pub body: &'a Body,
}

/// A link across an interface.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Way {
    to: usize,
    /// Material at its other end.
    material: usize,
    /// Twice the volume between its ends, as seen along the normal of the interface \[m3\].
    weight: f64,
    /// Volume on the own side of the interface to which the other end has the shorter way \[m3\].
    own: f64,
    /// Part of what lies behind the interface within the own cell to which it has so.
    foreign: f64,
}

/// Where half of the resistance of a link is left behind, as a part of its length, for an interface at `near`
/// between conductivities `k` and a resistance there over the length.
fn middle(near: f64, k: [f64; 2], contact: f64) -> f64 {
    let (here, there) = (near / k[0], (1.0 - near) / k[1]);
    let half = 0.5 * (here + contact + there);
    if half <= here {
        half * k[0]
    } else if half <= here + contact {
        near
    } else {
        1.0 - half * k[1]
    }
}

/// The places nearer to a point than to any other.
#[derive(Debug, Clone, PartialEq)]
struct Cell {
    centre: Vector,
    /// Edge of the cell on a plain lattice \[m\].
    edge: f64,
    /// Edges of the cube about the centre that holds the cell.
    edges: usize,
    /// Middles of the ways to its neighbours and unit vectors that lead there; none where the cube itself is the
    /// cell.
    walls: Vec<(Vector, Vector)>,
}

impl Cell {
    fn about(ground: Ground<'_>, i: usize) -> Self {
        let (cloud, pattern) = (ground.cloud, &ground.links.pattern);
        let centre = cloud.position[i];
        let wall = |link: usize| {
            let d = difference(cloud.position[pattern.columns()[link] as usize], centre);
            (along(centre, 0.5, d), d.map(|x| x / length(d)))
        };
        let mut walls = Vec::new();
        if !cloud.lattice {
            walls.extend(pattern.row(i).map(wall));
            // The nearest ones shut out most.
            walls.sort_by(|(a, _), (b, _)| {
                let [a, b] = [a, b].map(|middle| length(difference(*middle, centre)));
                a.total_cmp(&b)
            });
        }
        Self {
            centre,
            edge: cloud.spacing[i],
            edges: if cloud.lattice { 1 } else { 2 },
            walls,
        }
    }

    /// Distance of a place from the cell, negative inside, exact next to a wall; some distance above `far` is told of
    /// a place that is farther away than that.
    fn distance(&self, place: Vector, far: f64) -> f64 {
        let mut greatest = f64::NEG_INFINITY;
        for (middle, normal) in &self.walls {
            greatest = greatest.max(dot(*normal, difference(place, *middle)));
            if greatest > far {
                break;
            }
        }
        greatest
    }
}

impl Materials {
    /// The cells of a cloud at the temperature `initial`.
    ///
    /// # Errors
    /// Where a property has no value, or one that is not positive.
    pub fn cells(&self, ground: Ground<'_>, initial: &Curve) -> Result<Cells, OutOfRange> {
        let (cloud, volume) = (ground.cloud, &ground.links.volume);
        let start = |x: Vector| initial.value(&Arguments::at(x, 0.0));
        let mut holds = Holds::new(self, &cloud.position)?;
        let mut temperature = Vec::with_capacity(volume.len());
        // Heat above that at the temperature of the point itself.
        let mut surplus = vec![0.0; volume.len()];
        for x in &cloud.position {
            temperature.push(start(*x)?);
        }
        let crossed = |i: usize| {
            let crossed = self.crossed(cloud.position[i], cloud.spacing[i]);
            crossed.then(|| self.parts(&Cell::about(ground, i), ground.body, start))
        };
        let crossed: Vec<_> = (0..volume.len()).into_par_iter().map(crossed).collect();
        for (i, parts) in crossed.into_iter().enumerate() {
            let own = self.at(cloud.position[i]);
            let Some(parts) = parts else {
                let stored = self.stored(own, cloud.position[i])? * volume[i];
                let function = holds.function(own, i)?;
                holds.add(i, function, stored);
                continue;
            };
            let parts = parts?;
            let ways = self.ways(ground, i, own, temperature[i])?;
            for (material, (stored, heat)) in parts.into_iter().enumerate() {
                if stored <= 0.0 {
                    continue;
                }
                let function = holds.function(material, i)?;
                let mut give = |j: usize, stored: f64, heat: f64| {
                    holds.add(j, function, stored * volume[i]);
                    surplus[j] += holds.surplus(function, stored, heat, temperature[j]) * volume[i];
                };
                if material == own {
                    // What of the own part lies beyond the middle of a way, at most a good part of it.
                    let away: f64 = ways.iter().map(|way| way.own).sum::<f64>() / volume[i];
                    let scale = (MOST / away.max(MOST)) / volume[i];
                    for way in &ways {
                        give(way.to, scale * way.own * stored, scale * way.own * heat);
                    }
                    let kept = 1.0 - away.min(MOST);
                    give(i, kept * stored, kept * heat);
                    continue;
                }
                let there = ways.iter().filter(|way| way.material == material);
                let whole: f64 = there.clone().map(|way| way.weight).sum();
                let mut kept = 1.0;
                for way in there {
                    let share = way.weight / whole * way.foreign;
                    kept -= share;
                    give(way.to, share * stored, share * heat);
                }
                give(i, kept * stored, kept * heat);
            }
        }
        Ok(Cells::of(holds.storage(), temperature, &surplus))
    }

    /// The ways from point `i` of material `own` across an interface.
    fn ways(
        &self,
        ground: Ground<'_>,
        i: usize,
        own: usize,
        temperature: f64,
    ) -> Result<Vec<Way>, OutOfRange> {
        let position = &ground.cloud.position;
        let pattern = &ground.links.pattern;
        let mut ways = Vec::new();
        for link in pattern.row(i) {
            let to = pattern.columns()[link] as usize;
            let material = self.at(position[to]);
            let Some(region) = self.region(own.min(material)) else {
                continue;
            };
            let d = difference(position[to], position[i]);
            let normal = region.normal(position[i], 1e-3 * length(d));
            let along_normal = dot(normal, d);
            let weight = ground.links.weight[link] * along_normal * along_normal;
            if material == own || weight <= 0.0 {
                continue;
            }
            let distances = [i, to].map(|k| region.distance(position[k]).abs());
            let near = distances[0] / (distances[0] + distances[1]).max(f64::MIN_POSITIVE);
            let k = [
                self.conductivity(own, position[i], temperature)?,
                self.conductivity(material, position[to], temperature)?,
            ];
            let contact = self.contact(own, material) / along_normal.abs();
            let middle = middle(near, k, contact);
            let half = near.min(0.5);
            ways.push(Way {
                to,
                material,
                weight,
                own: weight * (half - middle).max(0.0),
                foreign: if near < 0.5 {
                    1.0 - ((middle - near) / (0.5 - near)).clamp(0.0, 1.0)
                } else {
                    1.0
                },
            });
        }
        Ok(ways)
    }

    /// The part of each material in a cell, as far as that is inside the body.
    fn parts(
        &self,
        cell: &Cell,
        body: &Body,
        value: impl Fn(Vector) -> Result<f64, OutOfRange>,
    ) -> Result<Vec<Part>, OutOfRange> {
        let x = cell.centre;
        let each = cell.edges * SAMPLES[self.dimensions - 2];
        let size = cell.edges as f64 * cell.edge / each as f64;
        let offset = |i: usize| (i as f64 + 0.5) * size - 0.5 * each as f64 * size;
        let covered = |distance: f64| (0.5 - distance / size).clamp(0.0, 1.0);
        let deep = if self.dimensions == 3 { each } else { 1 };
        let mut parts = vec![(0.0, 0.0); self.len()];
        let mut whole = 0.0;
        for number in 0..each * each * deep {
            let (i, j, k) = (number % each, number / each % each, number / (each * each));
            let z = if deep > 1 { offset(k) } else { 0.0 };
            let place = [x[0] + offset(i), x[1] + offset(j), x[2] + z];
            let within = covered(cell.distance(place, size));
            if within <= 0.0 {
                continue;
            }
            let mut left = covered(body.distance(place)) * within;
            whole += left;
            for (material, sum) in parts.iter_mut().enumerate() {
                if left <= 0.0 {
                    break;
                }
                let (part, own) = match self.region(material) {
                    Some(region) if material + 1 < self.len() => {
                        let distance = region.distance(place);
                        let part = left * covered(distance);
                        if part <= 0.0 {
                            continue;
                        }
                        (part, inside(region, place, distance, size))
                    }
                    _ => (left, self.beyond(place, size)),
                };
                let stored = part * self.stored(material, own)?;
                let heat = self.specific(material, value(own)?);
                *sum = (sum.0 + stored, sum.1 + stored * heat);
                left -= part;
            }
        }
        if whole > 0.0 {
            let mean = |(stored, heat): Part| (stored / whole, heat / whole);
            return Ok(parts.into_iter().map(mean).collect());
        }
        let own = self.at(x);
        let stored = self.stored(own, x)?;
        parts[own] = (stored, stored * self.specific(own, value(x)?));
        Ok(parts)
    }

    /// A place by `place` that is in no region, if there is one near.
    fn beyond(&self, place: Vector, size: f64) -> Vector {
        let regions = (0..self.len() - 1).filter_map(|material| self.region(material));
        let Some(region) = regions.into_iter().find(|region| region.holds(place)) else {
            return place;
        };
        let depth = -region.distance(place);
        if depth < size {
            along(
                place,
                depth + 1e-6 * size,
                region.normal(place, 1e-3 * size),
            )
        } else {
            place
        }
    }
}

/// The place itself if it is inside the region, else the nearest inside, if that is near.
fn inside(region: &Body, place: Vector, distance: f64, size: f64) -> Vector {
    if distance > 0.0 && distance < size {
        along(
            place,
            -distance - 1e-6 * size,
            region.normal(place, 1e-3 * size),
        )
    } else {
        place
    }
}
