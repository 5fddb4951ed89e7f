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
//! to it. C is 1 where there is metal below; at an edge it falls to 0 within a column, where the
//! planes of the surface end.

use std::collections::HashMap;

use super::Patch;

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
    /// Height of the particle \[m\].
    height: f64,
    /// w; without v until the heights of all are known.
    weight: f64,
}

/// Columns wherever there are particles, with buffers that are kept from step to step.
#[derive(Debug, Clone, Default)]
pub(super) struct Columns {
    /// First column of each tile.
    tiles: HashMap<[i64; 2], u32>,
    columns: Vec<Column>,
    shares: Vec<Share>,
    /// End of the shares of each particle.
    ends: Vec<u32>,
}

impl Columns {
    /// Shares the plan among patches that know what they see of the sky among their neighbours.
    pub(super) fn settle(
        &mut self,
        places: impl Iterator<Item = [f64; 3]>,
        spacing: f64,
        patches: &mut [Patch],
    ) {
        self.tiles.clear();
        self.columns.clear();
        self.shares.clear();
        self.ends.clear();
        for (place, patch) in places.zip(&*patches) {
            self.stand(place, patch, spacing);
            self.ends.push(self.shares.len() as u32);
        }
        for share in &mut self.shares {
            let column = &mut self.columns[share.column as usize];
            let below = (column.top - share.height) / spacing;
            share.weight *= ((HIDDEN - below) / (HIDDEN - IN_VIEW)).clamp(0.0, 1.0);
            column.weight += share.weight;
        }
        let size = (spacing / FINE).powi(2);
        let mut from = 0;
        for (patch, end) in patches.iter_mut().zip(&self.ends) {
            let shares = self.shares[from..*end as usize].iter();
            from = *end as usize;
            let parts = shares.filter(|share| share.weight > 0.0).map(|share| {
                let column = &self.columns[share.column as usize];
                size * column.cover * share.weight / column.weight
            });
            patch.seen = parts.sum();
        }
    }

    /// Enters a particle in all columns within R.
    fn stand(&mut self, [x, y, z]: [f64; 3], patch: &Patch, spacing: f64) {
        let (edge, reach) = (spacing / FINE, REACH * spacing);
        let range = |at: f64| {
            let first = ((at - reach) / edge - 0.5).ceil() as i64;
            first..=((at + reach) / edge - 0.5).floor() as i64
        };
        let mut tile = None;
        for j in range(y) {
            let dy = (j as f64 + 0.5) * edge - y;
            for i in range(x) {
                let dx = (i as f64 + 0.5) * edge - x;
                let rest = reach * reach - dx * dx - dy * dy;
                if rest <= 0.0 {
                    continue;
                }
                let key = [i.div_euclid(EDGE), j.div_euclid(EDGE)];
                let first = match tile {
                    Some((known, first)) if known == key => first,
                    _ => self.tile(key),
                };
                tile = Some((key, first));
                let within = i.rem_euclid(EDGE) + EDGE * j.rem_euclid(EDGE);
                let at = first + within as u32;
                let column = &mut self.columns[at as usize];
                let beyond = (patch.normal[0] * dx + patch.normal[1] * dy - patch.depth) / edge;
                column.cover = column.cover.max((0.5 - beyond).clamp(0.0, 1.0));
                if patch.seen > 0.0 {
                    column.top = column.top.max(z);
                    let near = rest / (reach * reach);
                    self.shares.push(Share {
                        column: at,
                        height: z,
                        weight: patch.seen * near * near,
                    });
                }
            }
        }
    }

    /// First column of a tile, which is empty when first asked for.
    fn tile(&mut self, key: [i64; 2]) -> u32 {
        let next = self.columns.len();
        let first = *self.tiles.entry(key).or_insert(next as u32);
        if first as usize == next {
            self.columns.resize(next + SIZE, EMPTY);
        }
        first
    }
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
                    seen,
                    depth: 0.5,
                    ..Patch::default()
                };
                ([at(i), at(j), z], patch)
            })
            .collect()
    }

    fn settled(bodies: &[([f64; 3], Patch)]) -> Vec<f64> {
        let mut patches: Vec<Patch> = bodies.iter().map(|body| body.1).collect();
        let places = bodies.iter().map(|body| body.0);
        Columns::default().settle(places, 1.0, &mut patches);
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
