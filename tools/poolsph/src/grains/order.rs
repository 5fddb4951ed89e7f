//! The order of rows: along a curve through cells that keeps near what is near (Morton 1966).
//!
//! What a grain touches is then in the same chunk, or in the next but few, and in the fast memory of the processor.

use contact::Grain;
use particles::Set;

use super::Motion;
use super::lists::Lists;
use super::memory::{closed_up, renumber};

/// Bits of a cell along an axis.
const BITS: u32 = 21;

/// The bits of a number, each followed by two zeros.
fn spread(cell: u64) -> u64 {
    (0..BITS).fold(0, |spread, bit| spread | ((cell >> bit) & 1) << (3 * bit))
}

/// Old row of each new one, by cells of `edge` \[m\]; grains of one cell keep their order.
#[must_use]
pub fn by_cells(grains: &[Grain], edge: f64) -> Vec<u32> {
    let mut low = [f64::INFINITY; 3];
    for grain in grains {
        for (low, x) in low.iter_mut().zip(grain.position) {
            *low = low.min(x);
        }
    }
    let key = |grain: &Grain| {
        (0..3).fold(0, |key, axis| {
            // A float cast saturates.
            let cell = ((grain.position[axis] - low[axis]) / edge) as u64;
            key | spread(cell.min((1 << BITS) - 1)) << axis
        })
    };
    let mut order: Vec<(u64, u32)> = (grains.iter().map(key)).zip(0..).collect();
    order.sort_unstable();
    order.iter().map(|(_, row)| *row).collect()
}

/// New row of each old one.
#[must_use]
pub fn inverse(order: &[u32]) -> Vec<Option<u32>> {
    let mut rows = vec![None; order.len()];
    for (new, old) in (0..).zip(order) {
        rows[*old as usize] = Some(new);
    }
    rows
}

impl Motion {
    /// Puts grains that are near each other in rows that are near each other.
    pub(super) fn put_in_order(&mut self, set: &mut Set) {
        let [least, widest] = self.setting.radii;
        let order = by_cells(&self.moving.grains, 2.0 * widest + Lists::skin(least));
        self.remember();
        let rows = inverse(&order);
        self.renumber(&rows);
        self.moving.put_all(set);
        set.arrange(&order);
        self.moving.take(set);
        self.list_with_memories();
        self.listings = 0.0;
    }

    /// Forgets grains outside of the bounds.
    pub(super) fn leave(&mut self, set: &mut Set) {
        let Some(bounds) = self.bounds else { return };
        let outside = |grain: &Grain| !bounds.holds(grain.position);
        if !self.moving.grains.iter().any(outside) {
            return;
        }
        let mut leaves: Vec<bool> = self.moving.grains.iter().map(outside).collect();
        self.moving.glued.leave(&mut leaves);
        for (grain, _) in self
            .moving
            .grains
            .iter()
            .zip(&leaves)
            .filter(|(_, leaves)| **leaves)
        {
            self.lost[0] += 1.0;
            self.lost[1] += grain.mass;
        }
        self.remember();
        let rows = closed_up(&leaves);
        self.renumber(&rows);
        self.moving.put_all(set);
        set.remove(|row| leaves[row]);
        self.moving.take(set);
        self.list_with_memories();
        self.walls.spread(&self.moving.grains);
    }

    /// What is kept by rows follows grains to new ones: `rows` has that of each old row, none where a grain leaves.
    fn renumber(&mut self, rows: &[Option<u32>]) {
        renumber(&mut self.memories, rows);
        if let Some(metal) = &mut self.metal {
            metal.renumber(rows);
        }
        if let Some(sleep) = &mut self.sleep {
            sleep.renumber(rows);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_go_from_cell_to_cell_and_none_is_lost() {
        let grain = |x: f64, y: f64, z: f64| Grain {
            position: [x, y, z],
            velocity: [0.0; 3],
            spin: [0.0; 3],
            radius: 0.5,
            mass: 1.0,
        };
        // Along a line of cells, then the next plane; far away is last.
        let grains = [
            grain(1e9, 0.0, 0.0),
            grain(0.2, 0.0, 1.5),
            grain(1.5, 0.2, 0.0),
            grain(0.0, 1.2, 0.2),
            grain(0.9, 0.9, 0.9),
            grain(0.0, 0.0, 0.0),
        ];
        let order = by_cells(&grains, 1.0);
        assert_eq!(order, [4, 5, 2, 3, 1, 0]);
        let rows = inverse(&order);
        assert_eq!(rows[4], Some(0));
        assert_eq!(rows[0], Some(5));
    }
}
