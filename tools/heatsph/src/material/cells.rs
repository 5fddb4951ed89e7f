//! What the cells of points store.
//!
//! A cell that an interface crosses holds parts of several materials. Its own part stays with its point. A part of
//! another material lies between the point, beyond the interface, and the points of its own material with which
//! the point is linked; it is shared between them as they conduct to it, so that a good conductor's heat does not
//! hang on a poor one, nor cross a contact.

use run::property::{Arguments, Curve, OutOfRange};

use super::Materials;
use crate::body::Body;
use crate::body::frame::{Vector, along};
use crate::cloud::Cloud;
use crate::operator::Links;

/// Samples along an edge of a cell that an interface crosses, in a plane and in space.
const SAMPLES: [usize; 2] = [8, 4];

/// Capacity of a material's part of a cell \[J/(m3 K)\], and its heat \[J/m3\].
type Part = (f64, f64);

/// What the cells store at the start.
#[derive(Debug, Clone, PartialEq)]
pub struct Cells {
    /// Heat capacity of each \[J/K\] (per metre of depth in a plane scene).
    pub capacity: Vec<f64>,
    /// Temperature at which each holds the heat of its parts \[K\].
    pub temperature: Vec<f64>,
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

impl Materials {
    /// The cells of a cloud at the temperature `initial`.
    ///
    /// # Errors
    /// Where a property has no value, or one that is not positive.
    pub fn cells(&self, ground: Ground<'_>, initial: &Curve) -> Result<Cells, OutOfRange> {
        let (cloud, volume) = (ground.cloud, &ground.links.volume);
        let start = |x: Vector| initial.value(&Arguments::at(x, 0.0));
        let mut capacity = vec![0.0; volume.len()];
        let mut temperature = Vec::with_capacity(volume.len());
        // Heat above that at the temperature of the point itself.
        let mut surplus = vec![0.0; volume.len()];
        for x in &cloud.position {
            temperature.push(start(*x)?);
        }
        for i in 0..volume.len() {
            let (x, edge) = (cloud.position[i], cloud.spacing[i]);
            let own = self.at(x);
            if !self.crossed(x, edge) {
                capacity[i] += self.stored(own, x)? * volume[i];
                continue;
            }
            let parts = self.parts((x, edge), ground.body, start)?;
            for (material, (stored, heat)) in parts.into_iter().enumerate() {
                if stored <= 0.0 {
                    continue;
                }
                let shares = if material == own {
                    vec![(i, 1.0)]
                } else {
                    self.shares(ground, (i, own), material, temperature[i])?
                };
                for (j, share) in shares {
                    capacity[j] += share * stored * volume[i];
                    surplus[j] += share * (heat - stored * temperature[j]) * volume[i];
                }
            }
        }
        for ((t, surplus), capacity) in temperature.iter_mut().zip(&surplus).zip(&capacity) {
            *t += surplus / capacity;
        }
        Ok(Cells {
            capacity,
            temperature,
        })
    }

    /// The points that share a part of `material` in the cell of point `i` of material `own`.
    fn shares(
        &self,
        ground: Ground<'_>,
        (i, own): (usize, usize),
        material: usize,
        temperature: f64,
    ) -> Result<Vec<(usize, f64)>, OutOfRange> {
        let position = &ground.cloud.position;
        let pattern = &ground.links.pattern;
        let near: Vec<(usize, f64)> = pattern
            .row(i)
            .map(|k| (pattern.columns()[k] as usize, ground.links.weight[k]))
            .filter(|(j, weight)| *weight > 0.0 && self.at(position[*j]) == material)
            .collect();
        let whole: f64 = near.iter().map(|(_, weight)| weight).sum();
        if near.is_empty() {
            return Ok(vec![(i, 1.0)]);
        }
        // Ways from the interface to the point and to those of the part's own material, as resistances.
        let k = self.conductivity(own, position[i], temperature)?;
        let here = self.distance((own, material), position[i]) / k + self.contact(own, material);
        let mut there = 0.0;
        for (j, weight) in &near {
            let k = self.conductivity(material, position[*j], temperature)?;
            there += weight / whole * self.distance((own, material), position[*j]) / k;
        }
        let left = there / (here + there).max(f64::MIN_POSITIVE);
        let mut shares = vec![(i, left)];
        shares.extend(
            near.iter()
                .map(|(j, weight)| (*j, (1.0 - left) * weight / whole)),
        );
        Ok(shares)
    }

    /// Distance of a place from the interface of two materials \[m\].
    fn distance(&self, (a, b): (usize, usize), x: Vector) -> f64 {
        self.region(a.min(b))
            .map_or(0.0, |region| region.distance(x).abs())
    }

    /// The part of each material in a cube about `x`, as far as that is inside the body.
    fn parts(
        &self,
        (x, edge): (Vector, f64),
        body: &Body,
        value: impl Fn(Vector) -> Result<f64, OutOfRange>,
    ) -> Result<Vec<Part>, OutOfRange> {
        let each = SAMPLES[self.dimensions - 2];
        let size = edge / each as f64;
        let offset = |i: usize| (i as f64 + 0.5) * size - 0.5 * edge;
        let covered = |distance: f64| (0.5 - distance / size).clamp(0.0, 1.0);
        let deep = if self.dimensions == 3 { each } else { 1 };
        let mut parts = vec![(0.0, 0.0); self.len()];
        let mut whole = 0.0;
        for number in 0..each * each * deep {
            let (i, j, k) = (number % each, number / each % each, number / (each * each));
            let z = if deep > 1 { offset(k) } else { 0.0 };
            let place = [x[0] + offset(i), x[1] + offset(j), x[2] + z];
            let mut left = covered(body.distance(place));
            whole += left;
            for (material, sum) in parts.iter_mut().enumerate() {
                let (part, own) = match self.region(material) {
                    Some(region) if material + 1 < self.len() => {
                        let distance = region.distance(place);
                        (
                            left * covered(distance),
                            inside(region, place, (distance, size)),
                        )
                    }
                    _ => (left, self.beyond(place, size)),
                };
                if part > 0.0 {
                    let stored = part * self.stored(material, own)?;
                    *sum = (sum.0 + stored, sum.1 + stored * value(own)?);
                }
                left -= part;
            }
        }
        if whole > 0.0 {
            let mean = |(stored, heat): Part| (stored / whole, heat / whole);
            return Ok(parts.into_iter().map(mean).collect());
        }
        let own = self.at(x);
        let stored = self.stored(own, x)?;
        parts[own] = (stored, stored * value(x)?);
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
fn inside(region: &Body, place: Vector, (distance, size): (f64, f64)) -> Vector {
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
