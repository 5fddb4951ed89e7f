//! What a droplet may land on.

use neighbours::Grid;
use particles::POSITION;

use crate::state::{PHASE, State, phase};

/// All that does not fly.
pub(super) struct Ground {
    grid: Grid,
    reach: f64,
}

impl Ground {
    /// All that does not fly, up to `reach` \[m\] below the lowest of `flying`; `None` without either.
    pub(super) fn below(state: &State, flying: &[usize], reach: f64) -> Option<Self> {
        let (places, phases) = (state.metal.column(&POSITION), state.metal.column(&PHASE));
        let heights = flying.iter().map(|a| places[*a][2]);
        let lowest = heights.reduce(f64::min)?;
        let high =
            |(x, phase): &(&[f64; 3], &u8)| **phase != phase::FLYING && x[2] > lowest - reach;
        let places = places.iter().zip(phases).filter(high);
        let places: Vec<[f64; 3]> = places.map(|(x, _)| *x).collect();
        if places.is_empty() {
            return None;
        }
        let mut grid = Grid::new(reach);
        grid.bin(&places);
        Some(Self { grid, reach })
    }

    /// Whether the droplet, lifted by `lift` \[m\], is within reach.
    pub(super) fn touches(&self, state: &State, droplet: &[usize], lift: f64) -> bool {
        let places = state.metal.column(&POSITION);
        droplet.iter().any(|a| {
            let [x, y, z] = places[*a];
            self.grid.any_within([x, y, z + lift], self.reach)
        })
    }

    /// The least lift of at most `fall` \[m\], to a thousandth of it, that ends the touch.
    pub(super) fn back(&self, state: &State, droplet: &[usize], fall: f64) -> f64 {
        let (mut inside, mut clear) = (0.0, fall);
        while clear - inside > 1e-3 * fall {
            let middle = 0.5 * (inside + clear);
            if self.touches(state, droplet, middle) {
                inside = middle;
            } else {
                clear = middle;
            }
        }
        clear
    }
}
