//! The order of rows: along a curve through cells that keeps near what is near (Morton 1966).
//!
//! What a grain touches is then in the same chunk, or in the next but few, and in the fast memory of the processor.

use contact::Grain;

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
