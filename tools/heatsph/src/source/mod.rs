//! Heat sources in the volume.
//!
//! A point gets the mean of the source over its cell, not its value at the point, so that a source narrower than the
//! spacing brings its whole power wherever it lies: `W_i = V_i <Q>_i`. Cells are the places nearest to a point; where
//! their volumes are not those of the points (irregular clouds), all positive heat and all negative heat are scaled to
//! the integrals over the body. A source that is the same everywhere needs no cells.
//!
//! One that moves, or depends on temperature, is integrated at every evaluation. Temperature is linear within a cell,
//! with the slope that the neighbours of its point give, so that a zone of temperatures that is narrower than the spacing
//! has its power too.

pub mod cubature;

use rayon::prelude::*;
use run::property::{Curve, OutOfRange};
use shapes::Body;
use shapes::frame::{Vector, difference, dot};

use crate::cloud::Cloud;
use cubature::{Mean, Piece, When, ends};

/// Temperatures of points and how they change within cells.
#[derive(Debug, Clone, Copy)]
pub struct Warmth<'a> {
    /// Of each point \[K\].
    pub temperature: &'a [f64],
    /// In each cell: slope \[K/m\], least and greatest temperature \[K\]; none where temperature does not matter.
    pub cells: &'a [(Vector, [f64; 2])],
    /// \[s\].
    pub time: f64,
}

impl Warmth<'_> {
    /// When and how warm it is in the cell of point `i` about `x`.
    fn of(&self, i: usize, x: Vector) -> When {
        let even = When::even(self.time, self.temperature[i]);
        match self.cells.get(i) {
            None => even,
            Some((slope, within)) => When {
                slope: *slope,
                about: x,
                within: *within,
                ..even
            },
        }
    }
}

/// What is told of a source whose peaks are not found.
pub const HIDDEN: &str =
    "a source or flux is too narrow to be found within its cells: its power is not all there";
/// Points that one task gathers.
const ROWS: usize = 64;
/// Boxes along the spacing of an irregular cloud.
const FINE: f64 = 2.0;
/// Part of a temperature over which a derivative is taken.
const STEP: f64 = 1e-6;

/// A heat source.
#[derive(Debug, Clone, PartialEq)]
pub struct Source {
    curve: Curve,
    /// First box of each point.
    begin: Vec<u32>,
    /// Boxes that make up the cells, and the part of each that lies in the body.
    boxes: Vec<(Piece, f64)>,
    /// The box that holds the body.
    body: [Vector; 2],
    /// Whether it depends on place: its integrals over cells then make up that over the body.
    somewhere: bool,
    /// Heat of each point, if it is always the same \[W\], and whether it was resolved.
    still: Option<(Vec<f64>, bool)>,
}

impl Source {
    /// The source of a curve \[W/m3\] in the cells of a cloud whose points have the given volumes \[m3\].
    ///
    /// # Errors
    /// Where the curve has no value.
    pub fn new(
        curve: Curve,
        cloud: &Cloud,
        volume: &[f64],
        body: &Body,
    ) -> Result<Self, OutOfRange> {
        let mut source = Self {
            curve,
            begin: Vec::new(),
            boxes: Vec::new(),
            body: body.bounds(),
            somewhere: false,
            still: None,
        };
        let still = !source.depends_on("T") && !source.depends_on("t");
        let place = ["x", "y", "z", "r"];
        source.somewhere = place.iter().any(|name| source.depends_on(name));
        if source.somewhere || source.depends_on("T") {
            let mut cells = lattice(cloud, body).unwrap_or_else(|| nearest(cloud, body));
            cells.sort_by_key(|(point, ..)| *point);
            let mut rest = cells.as_slice();
            source.begin.push(0);
            for i in 0..cloud.position.len() {
                let own = rest.partition_point(|(point, ..)| *point as usize <= i);
                rest = &rest[own..];
                source.begin.push(source.begin[i] + own as u32);
            }
            source.boxes = cells
                .into_iter()
                .map(|(_, piece, part)| (piece, part))
                .collect();
        }
        if still {
            let cold = vec![0.0; cloud.position.len()];
            let mut heat = Vec::new();
            let cold = Warmth {
                temperature: &cold,
                cells: &[],
                time: 0.0,
            };
            let resolved = source.heat(cloud, volume, cold, &mut heat)?;
            source.still = Some((heat, resolved));
        }
        Ok(source)
    }

    /// The source at a place \[W/m3\].
    #[must_use]
    pub fn curve(&self) -> &Curve {
        &self.curve
    }

    /// Whether it depends on the variable of that name.
    #[must_use]
    pub fn depends_on(&self, name: &str) -> bool {
        self.curve.depends_on(name)
    }

    /// Bytes held.
    #[must_use]
    pub fn bytes(&self) -> u64 {
        (size_of::<(Piece, f64)>() * self.boxes.len() + 4 * self.begin.len()) as u64
    }

    /// Heat of every point \[W\]; tells whether its peaks were resolved.
    ///
    /// # Errors
    /// Where the curve has no value.
    pub fn heat(
        &self,
        cloud: &Cloud,
        volume: &[f64],
        warmth: Warmth<'_>,
        heat: &mut Vec<f64>,
    ) -> Result<bool, OutOfRange> {
        if let Some((still, resolved)) = &self.still {
            heat.clone_from(still);
            return Ok(*resolved);
        }
        let greatest = self.greatest(warmth);
        let each = |i: usize| {
            let x = cloud.position[i];
            self.cell(i, x, warmth.of(i, x), greatest)
        };
        let points = (0..volume.len()).into_par_iter().with_min_len(ROWS);
        let cells: Vec<_> = points.map(each).collect::<Result<_, _>>()?;
        // What is the same everywhere heats the volume of the points, of which cells are parts.
        let sizes = || {
            cells
                .iter()
                .zip(volume)
                .map(|((_, size), v)| size.unwrap_or(*v))
        };
        let parts = if self.somewhere {
            1.0
        } else {
            volume.iter().sum::<f64>() / sizes().sum::<f64>()
        };
        // Integrals over the cells, and what the volumes of the points make of them.
        let mut sums = [(0.0, 0.0); 2];
        for (((mean, _), size), v) in cells.iter().zip(sizes()).zip(volume) {
            for (sum, mean) in sums.iter_mut().zip([mean.above, mean.below]) {
                *sum = (sum.0 + mean * (parts * size), sum.1 + mean * v);
            }
        }
        let [more, less] = sums.map(|(cells, points)| {
            if points.abs() > 0.0 {
                cells / points
            } else {
                1.0
            }
        });
        heat.clear();
        let of = |((mean, _), v): (&(Mean, Option<f64>), &f64)| {
            (more * mean.above + less * mean.below) * v
        };
        heat.extend(cells.iter().zip(volume).map(of));
        Ok(cells.iter().all(|(mean, _)| mean.resolved))
    }

    /// Greatest magnitude that it can have anywhere in the body.
    fn greatest(&self, warmth: Warmth<'_>) -> f64 {
        let none = [f64::INFINITY, f64::NEG_INFINITY];
        let wider = |[low, high]: [f64; 2], t: &f64| [low.min(*t), high.max(*t)];
        let warm = warmth.temperature.iter().fold(none, wider);
        let [from, to] = ends(self.body, warmth.time, warm);
        self.curve.bounds(&from, &to).most()
    }

    /// Derivative of every point's heat by its temperature \[W/K\].
    ///
    /// # Errors
    /// Where the curve has no value.
    pub fn slopes(
        &self,
        cloud: &Cloud,
        volume: &[f64],
        warmth: Warmth<'_>,
    ) -> Result<Vec<f64>, OutOfRange> {
        let greatest = self.greatest(warmth);
        let each = |i: usize| {
            let (x, t) = (cloud.position[i], warmth.temperature[i]);
            let step = STEP * t.abs().max(1e-3);
            let when = warmth.of(i, x);
            let at = |by: f64| self.cell(i, x, when.shifted(by), greatest);
            let [more, less] = [at(step)?.0, at(-step)?.0].map(|mean| mean.above + mean.below);
            Ok((more - less) / (2.0 * step) * volume[i])
        };
        let points = (0..volume.len()).into_par_iter().with_min_len(ROWS);
        points.map(each).collect()
    }

    /// Mean over the cell of point `i`, and the cell's volume if it is known \[m3\].
    fn cell(
        &self,
        i: usize,
        x: Vector,
        when: When,
        greatest: f64,
    ) -> Result<(Mean, Option<f64>), OutOfRange> {
        let own = match self.begin.get(i..i + 2) {
            Some(&[from, to]) => &self.boxes[from as usize..to as usize],
            _ => &[],
        };
        let mut sum = Mean {
            above: 0.0,
            below: 0.0,
            resolved: true,
        };
        let mut whole = 0.0;
        for (piece, part) in own {
            let mean = piece.mean(&self.curve, when, greatest)?;
            let size = part * volume(piece);
            whole += size;
            sum.above += size * mean.above;
            sum.below += size * mean.below;
            sum.resolved &= mean.resolved;
        }
        if whole <= 0.0 {
            let value =
                self.curve
                    .value(&crate::material::arguments(x, when.temperature, when.time))?;
            sum.above = value.max(0.0);
            sum.below = value.min(0.0);
            return Ok((sum, (!self.begin.is_empty()).then_some(0.0)));
        }
        sum.above /= whole;
        sum.below /= whole;
        Ok((sum, Some(whole)))
    }
}

/// Volume of an upright box \[m3; m2 in a plane\].
fn volume(piece: &Piece) -> f64 {
    (0..piece.rank).map(|k| 2.0 * piece.half[k][k]).product()
}

fn upright([low, high]: [Vector; 2], rank: usize) -> Piece {
    let mut half = [[0.0; 3]; 3];
    for (k, half) in half.iter_mut().enumerate().take(rank) {
        half[k] = 0.5 * (high[k] - low[k]);
    }
    Piece {
        centre: std::array::from_fn(|k| 0.5 * (low[k] + high[k])),
        half,
        rank,
    }
}

type Own = (u32, Piece, f64);

/// The cells of a plain lattice in an upright box: boxes.
fn lattice(cloud: &Cloud, body: &Body) -> Option<Vec<Own>> {
    if !cloud.lattice {
        return None;
    }
    let [least, most] = body.bounds();
    let cell = |i: usize| {
        let half = 0.5 * cloud.spacing[i];
        let x = cloud.position[i];
        let low = std::array::from_fn(|k| (x[k] - half).max(least[k]));
        let high = std::array::from_fn(|k| (x[k] + half).min(most[k]));
        let piece = upright([low, high], cloud.dimensions);
        // A turned box has other cells, and fills less of the box around it.
        let own = (volume(&piece) / cloud.share[i] - 1.0).abs() < 1e-9;
        own.then_some((i as u32, piece, 1.0))
    };
    (0..cloud.position.len()).map(cell).collect()
}

/// The cells of any cloud: small boxes of the body, each given to the nearest point.
fn nearest(cloud: &Cloud, body: &Body) -> Vec<Own> {
    let rank = cloud.dimensions;
    let least = cloud.spacing.iter().fold(f64::INFINITY, |m, s| m.min(*s));
    let greatest = cloud.spacing.iter().fold(0.0_f64, |m, s| m.max(*s));
    let [low, high] = body.bounds();
    let counts: [usize; 3] = std::array::from_fn(|k| {
        if k < rank {
            (FINE * (high[k] - low[k]) / least).ceil().max(1.0) as usize
        } else {
            1
        }
    });
    let size: Vector = std::array::from_fn(|k| (high[k] - low[k]) / counts[k] as f64);
    let edge = size[..rank].iter().fold(0.0_f64, |m, s| m.max(*s));
    let mut grid = neighbours::Grid::new(greatest);
    grid.bin(&cloud.position);
    let all = counts.iter().product::<usize>();
    let each = |number: usize| {
        let at = [
            number % counts[0],
            number / counts[0] % counts[1],
            number / (counts[0] * counts[1]),
        ];
        let from: Vector = std::array::from_fn(|k| {
            if k < rank {
                low[k] + size[k] * at[k] as f64
            } else {
                0.0
            }
        });
        let to: Vector = std::array::from_fn(|k| if k < rank { from[k] + size[k] } else { 0.0 });
        let piece = upright([from, to], rank);
        let part = (0.5 - body.distance(piece.centre) / edge).clamp(0.0, 1.0);
        let point = (part > 0.0)
            .then(|| next(&grid, piece.centre, greatest))
            .flatten()?;
        Some((point, piece, part))
    };
    (0..all).into_par_iter().filter_map(each).collect()
}

/// The point next to a place.
fn next(grid: &neighbours::Grid, place: Vector, spacing: f64) -> Option<u32> {
    let mut reach = spacing;
    for _ in 0..8 {
        let mut best: Option<(f64, u32)> = None;
        grid.runs(place, reach, |run| {
            for (x, index) in grid.sorted()[run.clone()].iter().zip(&grid.order()[run]) {
                let away = difference(place, *x);
                let square = dot(away, away);
                if square < reach * reach && best.is_none_or(|b| (square, *index) < b) {
                    best = Some((square, *index));
                }
            }
        });
        if let Some((_, index)) = best {
            return Some(index);
        }
        reach *= 2.0;
    }
    None
}

#[cfg(test)]
mod tests;
