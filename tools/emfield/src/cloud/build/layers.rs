//! Layers of points along the normals of a surface (Matsuzawa 2017, eq. 2.70: `d_n = beta d_(n-1)`).

use shapes::frame::{Vector, along, difference, dot};

use super::surface::Seed;
use crate::cloud::layout::Layout;
use crate::cloud::occupied::Occupied;
use crate::cloud::points::Layers;

/// Points nearer than this part of the local spacing, across and along the surface, are too close.
pub(crate) const TOO_CLOSE: f64 = 0.6;
/// Reach of the patch of a surface point over its spacing.
const PATCH: f64 = 0.9;
/// Part of a gap's width from its side that belongs to the points across it: both sides overlap.
const OVER: f64 = 0.6;

/// Thickness of the layers of one side, from the surface outward \[m\].
pub(crate) fn thicknesses(layers: &Layers, spacing: f64, count: Option<usize>) -> Vec<f64> {
    let first = layers.first_m.unwrap_or(spacing).min(spacing);
    let mut all = Vec::new();
    let mut next = first;
    loop {
        let done = match count {
            Some(count) => all.len() >= count,
            None => all.len() >= 2 && next >= spacing || all.len() >= 200,
        };
        if done {
            return all;
        }
        all.push(next.min(spacing));
        next *= layers.growth;
    }
}

/// A narrow gap before a point of a surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Gap {
    /// How far it is across, along the normal of the surface \[m\].
    pub(crate) width: f64,
    /// Unit normal of the surface beyond, back into the gap.
    pub(crate) back: Vector,
}

/// A surface point with the points along its normal, inside and outside.
#[derive(Debug, Clone)]
pub(crate) struct Column {
    pub(crate) seed: Seed,
    /// Number of the surface point.
    pub(crate) point: u32,
    /// Number among the feet of the cloud.
    pub(crate) foot: u32,
    /// The body, or `None` for the wall of the domain.
    pub(crate) solid: Option<usize>,
    /// Media inside and outside.
    pub(crate) media: [u16; 2],
    /// Numbers and distances of its points inside and outside.
    pub(crate) side: [Vec<(u32, f64)>; 2],
    /// Narrow gaps inside and outside, in place of layers.
    pub(crate) gap: [Option<Gap>; 2],
}

impl Column {
    /// A column without points but that of the surface.
    pub(crate) fn bare(seed: Seed, point: u32, solid: Option<usize>, media: [u16; 2]) -> Self {
        Self {
            seed,
            point,
            foot: 0,
            solid,
            media,
            side: [Vec::new(), Vec::new()],
            gap: [None; 2],
        }
    }

    /// Unit vector away from the surface on one side.
    pub(crate) fn way(&self, side: usize) -> Vector {
        let sign = if side == 0 { -1.0 } else { 1.0 };
        self.seed.normal.map(|n| sign * n)
    }

    /// How far its points reach \[m\].
    pub(crate) fn height(&self, side: usize) -> f64 {
        self.side[side].last().map_or(0.0, |last| last.1)
    }

    /// Thickness of its last layer \[m\]; 0 without layers.
    pub(crate) fn last(&self, side: usize) -> f64 {
        match self.side[side].as_slice() {
            [] => 0.0,
            [only] => only.1,
            [.., before, last] => last.1 - before.1,
        }
    }

    /// How areas change with the distance from the surface, over the area on it.
    pub(crate) fn widening(&self, side: usize, away: f64) -> f64 {
        let signed = if side == 0 { -away } else { away };
        self.seed.curvature.widening(signed)
    }
}

/// A point of a layer.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Layered {
    pub(crate) place: Vector,
    pub(crate) normal: Vector,
    pub(crate) medium: u16,
    pub(crate) across: f64,
    pub(crate) along: f64,
    /// Where its column stands, among those of the cloud.
    pub(crate) foot: u32,
}

/// What layers grow in.
pub(crate) struct Ground<'a> {
    pub(crate) layout: &'a Layout,
    /// Points placed so far, with their metric: normal, spacing across and along.
    pub(crate) occupied: &'a mut Occupied,
    pub(crate) dimensions: usize,
    /// Number of the first point that will be added.
    pub(crate) first: u32,
}

impl Ground<'_> {
    /// Grows one side of all columns of a surface, layer by layer.
    pub(crate) fn grow(
        &mut self,
        columns: &mut [Column],
        side: usize,
        thicknesses: &[f64],
        spacing: f64,
    ) -> Vec<Layered> {
        let mut added: Vec<Layered> = Vec::new();
        let mut away = 0.0;
        let mut growing: Vec<bool> = columns.iter().map(|c| c.gap[side].is_none()).collect();
        for (k, thickness) in thicknesses.iter().enumerate() {
            away += thickness;
            let next = thicknesses.get(k + 1).unwrap_or(thickness);
            for (column, grows) in columns.iter_mut().zip(&mut growing) {
                let scale = (column.seed.spacing / spacing).min(1.0);
                let grown = (*grows)
                    .then(|| self.point(column, side, scale * away, scale * thickness))
                    .flatten();
                let Some(mut point) = grown else {
                    *grows = false;
                    continue;
                };
                point.across = 0.5 * scale * (thickness + next);
                let number = self.first + added.len() as u32;
                column.side[side].push((number, scale * away));
                self.occupied.push(point.place);
                added.push(point);
            }
        }
        self.first += added.len() as u32;
        added
    }

    /// The next point of a column, unless it would leave its medium, pass the middle between two surfaces or come too
    /// close to another point.
    fn point(&self, column: &Column, side: usize, away: f64, thickness: f64) -> Option<Layered> {
        let normal = column.seed.normal;
        let signed = if side == 0 { -away } else { away };
        let place = along(column.seed.place, signed, normal);
        let medium = column.media[side];
        let room = self.layout.depth(place);
        let limit = match column.solid {
            Some(_) => 0.5 * thickness,
            None => 0.9 * away,
        };
        if room < limit || self.layout.medium(place) != medium {
            return None;
        }
        if self.layout.axisymmetric() && place[0] < 0.3 * column.seed.spacing {
            return None;
        }
        let (nearest, _) = self.layout.nearest(place);
        let free = if column.solid.is_some() {
            0.9 * away
        } else {
            0.5 * thickness
        };
        if nearest.abs() < free {
            return None;
        }
        let wide = column
            .widening(side, away)
            .powf(1.0 / (self.dimensions - 1) as f64);
        let flat = column.seed.spacing;
        let crowded = self
            .occupied
            .any(place, TOO_CLOSE * flat, |_, offset, square| {
                let up = dot(offset, normal);
                let level = (square - up * up).max(0.0);
                (up / thickness).powi(2) + level / (flat * flat) < TOO_CLOSE * TOO_CLOSE
            });
        (!crowded).then_some(Layered {
            place,
            normal,
            medium,
            across: thickness,
            along: flat * wide.max(TOO_CLOSE),
            foot: column.foot,
        })
    }
}

/// Columns of one surface, found by the place of their surface points.
pub(crate) struct Standing<'a> {
    pub(crate) columns: &'a [Column],
    pub(crate) set: Occupied,
    pub(crate) spacing: f64,
}

impl<'a> Standing<'a> {
    pub(crate) fn new(columns: &'a [Column], spacing: f64) -> Self {
        let mut set = Occupied::new(1.2 * spacing);
        for column in columns {
            set.push(column.seed.place);
        }
        Self {
            columns,
            set,
            spacing,
        }
    }

    /// The column whose surface point is nearest to the foot of a place at signed distance `d`.
    pub(crate) fn below(&self, x: Vector, d: f64, normal: Vector) -> Option<&'a Column> {
        let foot = along(x, -d, normal);
        let near = self.set.nearest(foot, 1.2 * self.spacing)?;
        Some(&self.columns[near as usize])
    }

    /// Whether a place belongs to the layers: over the patch of a column, below its last point or hardly above it.
    pub(crate) fn holds(&self, x: Vector, d: f64, normal: Vector, dimensions: usize) -> bool {
        let Some(column) = self.below(x, d, normal) else {
            return false;
        };
        let side = usize::from(d > 0.0);
        let seed = &column.seed;
        let height = match (&column.gap[side], column.last(side)) {
            (Some(gap), _) => OVER * gap.width,
            (None, 0.0) => TOO_CLOSE * seed.spacing,
            (None, last) => column.height(side) + 0.55 * last,
        };
        let away = difference(x, seed.place);
        let up = dot(away, seed.normal);
        let level = (dot(away, away) - up * up).max(0.0).sqrt();
        let wide = column
            .widening(side, d.abs())
            .powf(1.0 / (dimensions - 1) as f64);
        d.abs() < height && level < PATCH * seed.spacing * wide.max(TOO_CLOSE)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn layers_grow_to_the_spacing_of_the_surface() {
        let layers = Layers {
            first_m: Some(0.04),
            ..Layers::default()
        };
        let all = thicknesses(&layers, 0.25, None);
        assert!((all[1] / all[0] - 1.15).abs() < 1e-12);
        assert_eq!(all.len(), 14);
        assert!(all.iter().all(|t| *t <= 0.25));
        assert_eq!(thicknesses(&layers, 0.25, Some(3)).len(), 3);
        assert_eq!(thicknesses(&Layers::default(), 1.0, None), [1.0, 1.0]);
    }
}
