//! Area as seen from above: what falls on the metal is taken once, and whole.
//!
//! Where the surface is even, the areas that particles see of the sky among their neighbours, s,
//! already add up. Where it is torn they do not: two walls face each other, a floor lies below an
//! overhang. So the plan is divided into square columns of the edge e, and each is shared anew:
//!
//! ```text
//! seen_a = sum over the columns of e^2 C w_a / sum of w_b,    w_a = s_a (1 - rho_a^2/R^2)^2 v(t_a)
//! ```
//!
//! rho is the distance from the axis of the column, in the plan, and t how far the particle lies below
//! the highest one there; v(t) is 1, and falls to 0 for what is hidden. The shares of a column add up
//! to it. C is 1 where there is metal below; at an edge it falls to 0 within a column, half a spacing beyond the last particles
//! (`edges`), elsewhere where the planes of the surface end.
//!
//! Columns stand in square tiles, which do not know of each other and are worked on side by side.

use std::collections::HashMap;
use std::ops::RangeInclusive;

use rayon::prelude::*;

use super::edges::Open;
use crate::patch::Patch;

/// Columns per spacing.
const FINE: f64 = 3.0;
/// R in spacings: more than half of the diagonal of a cell of the lattice.
const REACH: f64 = 1.0;
/// A particle not deeper than this below the highest one is in view, in spacings.
const IN_VIEW: f64 = 1.0;
/// A particle deeper than this below the highest one is hidden, in spacings.
const HIDDEN: f64 = 1.75;
/// Columns along the edge of a tile.
const EDGE: i64 = 16;
/// Columns of a tile.
const SIZE: usize = (EDGE * EDGE) as usize;

/// Where particles stand.
pub(super) struct Stood<'a> {
    /// Places \[m\].
    pub(super) places: &'a [[f64; 3]],
    /// Open sides.
    pub(super) open: &'a [Open],
    /// Sides of a cell of the lattice along x and y \[m\].
    pub(super) cell: [f64; 2],
    /// d \[m\].
    pub(super) spacing: f64,
}

/// What is known of a column.
#[derive(Debug, Clone, Copy)]
struct Column {
    /// Height of the highest particle \[m\].
    top: f64,
    /// C.
    cover: f64,
    /// Sum of the w.
    weight: f64,
}

const EMPTY: Column = Column {
    top: f64::NEG_INFINITY,
    cover: 0.0,
    weight: 0.0,
};

/// A particle in one of its columns.
#[derive(Debug, Clone, Copy)]
struct Share {
    column: u32,
    /// w; without v until the heights of all are known.
    weight: f64,
}

/// Columns side by side, and the particles that stand in them.
#[derive(Debug, Clone, Default)]
struct Tile {
    /// Place in the plan, in tiles.
    key: [i64; 2],
    members: Vec<u32>,
    columns: Vec<Column>,
    shares: Vec<Share>,
    /// End of the shares of each member.
    ends: Vec<u32>,
    /// Part of `seen` that each member has here \[m2\].
    seen: Vec<f64>,
}

/// Columns wherever there are particles, with buffers that are kept from step to step.
#[derive(Debug, Clone, Default)]
pub(super) struct Columns {
    /// The tiles in use, by place.
    places: HashMap<[i64; 2], u32>,
    tiles: Vec<Tile>,
}

impl Columns {
    /// Shares the plan among the `rows` of `patches`, which know what they see of the sky among
    /// their neighbours.
    pub(super) fn settle(&mut self, rows: &[u32], stood: &Stood<'_>, patches: &mut [Patch]) {
        let (places, spacing) = (stood.places, stood.spacing);
        self.places.clear();
        for &k in rows {
            self.enter(k, places[k as usize], spacing);
        }
        let tiles = &mut self.tiles[..self.places.len()];
        let known = &*patches;
        tiles
            .par_iter_mut()
            .for_each(|tile| tile.share(stood, known));
        for &k in rows {
            patches[k as usize].seen = 0.0;
        }
        for tile in tiles {
            for (&k, seen) in tile.members.iter().zip(&tile.seen) {
                patches[k as usize].seen += seen;
            }
        }
    }

    /// Makes particle `k` a member of all tiles within R.
    fn enter(&mut self, k: u32, [x, y, _]: [f64; 3], spacing: f64) {
        let tiles = |at| {
            let (first, last) = columns(at, spacing).into_inner();
            first.div_euclid(EDGE)..=last.div_euclid(EDGE)
        };
        for j in tiles(y) {
            for i in tiles(x) {
                let next = self.places.len();
                let at = *self.places.entry([i, j]).or_insert(next as u32) as usize;
                if at == self.tiles.len() {
                    self.tiles.push(Tile::default());
                }
                let tile = &mut self.tiles[at];
                if at == next {
                    tile.key = [i, j];
                    tile.members.clear();
                }
                tile.members.push(k);
            }
        }
    }
}

impl Tile {
    /// What of the columns here each member sees.
    fn share(&mut self, stood: &Stood<'_>, patches: &[Patch]) {
        let (places, spacing) = (stood.places, stood.spacing);
        self.columns.clear();
        self.columns.resize(SIZE, EMPTY);
        self.shares.clear();
        self.ends.clear();
        for m in 0..self.members.len() {
            let k = self.members[m] as usize;
            self.stand(stood, k, &patches[k]);
            self.ends.push(self.shares.len() as u32);
        }
        let mut from = 0;
        for (&k, &end) in self.members.iter().zip(&self.ends) {
            let [_, _, height] = places[k as usize];
            for share in &mut self.shares[from..end as usize] {
                let column = &mut self.columns[share.column as usize];
                let below = (column.top - height) / spacing;
                share.weight *= ((HIDDEN - below) / (HIDDEN - IN_VIEW)).clamp(0.0, 1.0);
                column.weight += share.weight;
            }
            from = end as usize;
        }
        let size = (spacing / FINE).powi(2);
        let mut from = 0;
        self.seen.clear();
        for &end in &self.ends {
            let shares = self.shares[from..end as usize].iter();
            from = end as usize;
            let parts = shares.filter(|share| share.weight > 0.0).map(|share| {
                let column = &self.columns[share.column as usize];
                size * column.cover * share.weight / column.weight
            });
            self.seen.push(parts.sum());
        }
    }

    /// Enters a particle in all columns here within R.
    fn stand(&mut self, stood: &Stood<'_>, k: usize, patch: &Patch) {
        let ([x, y, z], open, spacing) = (stood.places[k], stood.open[k], stood.spacing);
        let (edge, reach) = (spacing / FINE, REACH * spacing);
        let claim = patch.claim;
        let [west, south] = self.key.map(|key| key * EDGE);
        let here = |at, start: i64| {
            let (first, last) = columns(at, spacing).into_inner();
            first.max(start)..=last.min(start + EDGE - 1)
        };
        for j in here(y, south) {
            let dy = (j as f64 + 0.5) * edge - y;
            for i in here(x, west) {
                let dx = (i as f64 + 0.5) * edge - x;
                let rest = reach * reach - dx * dx - dy * dy;
                if rest <= 0.0 {
                    continue;
                }
                let at = (i - west + EDGE * (j - south)) as u32;
                let column = &mut self.columns[at as usize];
                let beyond = patch.normal[0] * dx + patch.normal[1] * dy - patch.depth;
                let plane = (0.5 - beyond / edge).clamp(0.0, 1.0);
                let cover = open.cover([dx, dy], stood.cell, edge, plane);
                column.cover = column.cover.max(cover);
                if claim > 0.0 {
                    column.top = column.top.max(z);
                    let near = rest / (reach * reach);
                    self.shares.push(Share {
                        column: at,
                        weight: claim * near * near,
                    });
                }
            }
        }
    }
}

/// Columns within R of `at` along one axis.
fn columns(at: f64, spacing: f64) -> RangeInclusive<i64> {
    let (edge, reach) = (spacing / FINE, REACH * spacing);
    let first = ((at - reach) / edge - 0.5).ceil() as i64;
    first..=((at + reach) / edge - 0.5).floor() as i64
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Particles of a lattice at the height z, each of which sees `seen` of the sky.
    fn floor(n: i32, z: f64, seen: f64) -> Vec<([f64; 3], Patch)> {
        let at = |k: i32| f64::from(k) + 0.5;
        let cells = (-n..n).flat_map(|i| (-n..n).map(move |j| (i, j)));
        cells
            .map(|(i, j)| {
                let patch = Patch {
                    normal: [0.0, 0.0, 1.0],
                    area: 1.0,
                    claim: seen,
                    depth: 0.5,
                    ..Patch::default()
                };
                ([at(i), at(j), z], patch)
            })
            .collect()
    }

    fn settled(bodies: &[([f64; 3], Patch)]) -> Vec<f64> {
        let mut patches: Vec<Patch> = bodies.iter().map(|body| body.1).collect();
        let places: Vec<[f64; 3]> = bodies.iter().map(|body| body.0).collect();
        let rows: Vec<u32> = (0..places.len() as u32).collect();
        let stood = Stood {
            places: &places,
            open: &vec![Open::default(); places.len()],
            cell: [1.0; 2],
            spacing: 1.0,
        };
        Columns::default().settle(&rows, &stood, &mut patches);
        patches.iter().map(|patch| patch.seen).collect()
    }

    #[test]
    fn an_even_floor_keeps_what_it_sees() {
        let bodies = floor(6, 0.0, 1.0);
        for (body, seen) in bodies.iter().zip(settled(&bodies)) {
            if body.0[0].abs() < 4.0 && body.0[1].abs() < 4.0 {
                assert!((seen - 1.0).abs() < 1e-12, "{seen}");
            }
        }
    }

    #[test]
    fn what_is_claimed_twice_or_not_at_all_is_shared_anew() {
        for claim in [0.3, 1.7] {
            let bodies = floor(6, 0.0, claim);
            for (body, seen) in bodies.iter().zip(settled(&bodies)) {
                if body.0[0].abs() < 4.0 && body.0[1].abs() < 4.0 {
                    assert!((seen - 1.0).abs() < 1e-12, "{seen}");
                }
            }
        }
    }

    #[test]
    fn what_lies_below_an_overhang_takes_nothing() {
        let mut bodies = floor(8, 0.0, 1.0);
        bodies.extend(floor(4, 5.0, 1.0));
        let seen = settled(&bodies);
        for (body, seen) in bodies.iter().zip(&seen) {
            let [x, y, z] = body.0;
            if z < 1.0 && x.abs() < 3.0 && y.abs() < 3.0 {
                assert!(seen.abs() <= 0.0, "{seen}");
            }
        }
        // The lower floor ends eight spacings out, and columns there are whole.
        let even: f64 = settled(&floor(8, 0.0, 1.0)).iter().sum();
        assert!((seen.iter().sum::<f64>() / even - 1.0).abs() < 1e-12);
    }
}
