//! Sides at which the metal ends, as seen from above.
//!
//! A particle is open towards a side where no other stands beyond it: there its share of the plan ends half a spacing away, as its
//! cell of the lattice does. The planes of the surface would reach a tenth of a spacing farther at the edges of a block, round off its
//! corners, and a row of single particles has no plane that ends at all. Where particles have left their lattice, the planes count too:
//! the cells of those that stick out farthest, of all layers, would cover more than there is.

use shapes::frame::{difference, squared};

use super::Cloud;
use crate::faces::Turn;

/// The sides -x, +x, -y, +y.
const SIDES: [[f64; 3]; 4] = [
    [-1.0, 0.0, 0.0],
    [1.0, 0.0, 0.0],
    [0.0, -1.0, 0.0],
    [0.0, 1.0, 0.0],
];
/// A neighbour stands beyond a particle from this many spacings along the side on,
const BEYOND: f64 = 0.5;
/// no farther aside than so many,
const ASIDE: f64 = 0.75;
/// and no higher or deeper than so many.
const UPRIGHT: f64 = 1.5;

/// Neighbours nearer than this many spacings stand along the axes of a lattice that particles have not left,
const FIRST: f64 = 1.25;
/// as near to them as this.
const ALONG: f64 = 0.1;
/// The bit of a particle upon its lattice.
const LAID: u8 = 0b1_0000;
/// The bit of a particle with none straight above it.
const HIGHEST: u8 = 0b10_0000;

/// Open sides of a particle, a bit each, and whether it stands upon its lattice.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(super) struct Open(u8);

impl Open {
    /// As a patch keeps it.
    pub(super) fn of_bits(bits: u8) -> Self {
        Self(bits)
    }

    /// For a patch to keep.
    pub(super) fn bits(self) -> u8 {
        self.0
    }

    /// Those of particle `k` of a cloud.
    pub(super) fn of(cloud: &Cloud<'_>, k: usize, spacing: f64) -> Self {
        let (mut open, mut first, mut askew) = (0b1111, false, false);
        let mut highest = HIGHEST;
        for &b in cloud.row(k) {
            let [x, y, z] =
                difference(cloud.places[b as usize], cloud.places[k]).map(|x| x / spacing);
            if z.abs() > UPRIGHT {
                continue;
            }
            if squared([x, y, z]) < FIRST * FIRST {
                first = true;
                highest &= if z > BEYOND { 0 } else { HIGHEST };
                askew |= [x, y, z].iter().filter(|x| x.abs() < ALONG).count() < 2;
            }
            let ways = [(-x, y), (x, y), (-y, x), (y, x)];
            for (side, (along, aside)) in ways.into_iter().enumerate() {
                if along > BEYOND && aside.abs() <= ASIDE {
                    open &= !(1 << side);
                }
            }
        }
        Self(open | highest | if first && !askew { LAID } else { 0 })
    }

    /// Those of its image.
    pub(super) fn turned(self, turn: &Turn) -> Self {
        let mut open = self.0 & (LAID | HIGHEST);
        for (side, way) in SIDES.iter().enumerate().filter(|(side, _)| self.has(*side)) {
            let to = turn.vector(*way);
            let kept = SIDES.iter().position(|s| s[0] * to[0] + s[1] * to[1] > 0.5);
            open |= 1 << kept.unwrap_or(side);
        }
        Self(open)
    }

    /// What it claims of the plan, of the area of a cell \[m2\]: all of it at the edge of a lattice, where its normal leans outwards
    /// and would leave some to those beside and below it; nothing beneath another there. None where its planes tell.
    pub(super) fn claim(self, cell: f64) -> Option<f64> {
        let on_top = if self.0 & HIGHEST == 0 { 0.0 } else { cell };
        (self.0 & LAID != 0).then_some(on_top)
    }

    fn has(self, side: usize) -> bool {
        self.0 >> side & 1 == 1
    }

    /// Part of a column of the edge `edge` at `dx`, `dy` from the particle \[m\] that lies within half a cell of the sides `cell` towards
    /// the open sides, and, unless this is all that counts, below its `plane`.
    pub(super) fn cover(self, [dx, dy]: [f64; 2], cell: [f64; 2], edge: f64, plane: f64) -> f64 {
        if self.0 & 0b1111 == 0 {
            return plane;
        }
        let within = |side: usize, away: f64| {
            if self.has(side) {
                (0.5 + (0.5 * cell[side / 2] - away) / edge).clamp(0.0, 1.0)
            } else {
                1.0
            }
        };
        let cells = within(0, -dx) * within(1, dx) * within(2, -dy) * within(3, dy);
        if self.0 & LAID == 0 {
            return cells.min(plane);
        }
        cells
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_end_half_a_spacing_beyond_an_open_side() {
        let open = Open(0b0010 | LAID);
        let at = |i: i32| open.cover([0.05 * f64::from(i), 0.9], [1.0; 2], 0.05, 0.0);
        let sum: f64 = (0..40).map(at).sum();
        // From the middle of the first column on.
        assert!((0.05 * (sum - 0.5) - 0.5).abs() < 1e-12, "{sum}");
        let far = |open: Open, away: f64| open.cover([away, 0.0], [1.0; 2], 0.05, 0.25);
        assert!((far(Open::default(), 0.9) - 0.25).abs() < 1e-15);
        assert!((far(open, -0.9) - 1.0).abs() < 1e-15);
        // Off its lattice the plane counts too.
        assert!((far(Open(0b0010), -0.9) - 0.25).abs() < 1e-15);
    }
}
