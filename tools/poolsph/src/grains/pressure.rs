//! Pressure of a wall on the grains beside it: the cavity of an arc.
//!
//! The surface is divided into pieces, and each presses with p A n on the grain that is nearest to it outside, if there is one within two
//! diameters. Pieces beyond a mirror are those of the other half. So the sum is the pressure times the area that is borne, whatever grains bear it.

use contact::Grain;
use neighbours::Grid;
use rayon::prelude::*;
use shapes::frame::{Vector, along, difference, dot};
use shapes::surface::{Piece, pieces};
use shapes::{Body, Shape};

use super::Mirrors;
use super::depth::Depth;

/// Size of a piece over the least radius; pieces are a third of what is asked for.
const SIZE: f64 = 3.0;
/// A grain bears a piece that is nearer to its centre than this times the largest radius.
const REACH: f64 = 4.0;
/// Grains bear that are nearer to the surface than this times the largest radius.
const NEAR: f64 = 3.0;

/// A surface under pressure.
#[derive(Debug, Clone)]
pub struct Pressed {
    /// p \[Pa\].
    pressure: f64,
    pieces: Vec<Piece>,
    reach: f64,
    /// Rows of the grains near the surface.
    pub rows: Vec<u32>,
    /// How near they are \[m\].
    pub near: f64,
    grid: Grid,
    places: Vec<Vector>,
    /// Row of the grain that bears each piece.
    bearers: Vec<Option<u32>>,
    mirrors: Mirrors,
}

impl Pressed {
    /// The surface of a shape under `pressure` \[Pa\], among grains whose radii go from `least` to `widest` \[m\], and before `mirrors`.
    #[must_use]
    pub fn new(shape: &Shape, pressure: f64, [least, widest]: [f64; 2], mirrors: &Mirrors) -> Self {
        let reach = REACH * widest;
        Self {
            pressure,
            pieces: pieces(&Body::new(shape, 3), 3, SIZE * least),
            reach,
            rows: Vec::new(),
            near: NEAR * widest,
            grid: Grid::new(reach),
            places: Vec::new(),
            bearers: Vec::new(),
            mirrors: mirrors.clone(),
        }
    }

    /// Finds who bears each piece; the wall has moved by `moved` \[m\].
    pub fn spread(&mut self, grains: &[Grain], moved: Vector) {
        let rows = &self.rows;
        self.places.clear();
        self.places
            .extend(rows.iter().map(|row| grains[*row as usize].position));
        if rows.is_empty() {
            self.bearers.clear();
            return;
        }
        self.grid.bin(&self.places);
        let (grid, reach, mirrors) = (&self.grid, self.reach, &self.mirrors);
        let bearer = |piece: &Piece| {
            let place = along(piece.place, 1.0, moved);
            if mirrors.hide(place) {
                return None;
            }
            let mut nearest: Option<(f64, u32)> = None;
            grid.runs(place, reach, |run| {
                for (at, k) in grid.sorted()[run.clone()].iter().zip(&grid.order()[run]) {
                    let way = difference(*at, place);
                    let (far, row) = (dot(way, way), rows[*k as usize]);
                    let nearer = nearest.is_none_or(|best| (far, row) < best);
                    let outside = dot(way, piece.normal) > 0.0;
                    if outside && far < reach * reach && nearer {
                        nearest = Some((far, row));
                    }
                }
            });
            nearest.map(|(_, row)| row)
        };
        let pieces = self.pieces.par_iter().with_min_len(256);
        pieces.map(bearer).collect_into_vec(&mut self.bearers);
    }

    /// Each piece, and the row of the grain that bears it.
    pub fn pieces(&self) -> impl Iterator<Item = (&Piece, Option<u32>)> {
        self.pieces.iter().zip(self.bearers.iter().copied())
    }

    /// Adds the force of each piece \[N\] to who bears it, but where forces stay by `depth`.
    pub fn add(&self, force: &mut [Vector], depth: Depth<'_>) {
        for (piece, bearer) in self.pieces.iter().zip(&self.bearers) {
            let row = bearer.map(|row| row as usize);
            if let Some(row) = row.filter(|row| !depth.kept(*row)) {
                force[row] = along(force[row], self.pressure * piece.area, piece.normal);
            }
        }
    }
}
