//! Which points of a solid each particle of water meets.

use kernels::Kernel;
use neighbours::Grid;
use particles::{POSITION, Rows};

use super::skin::Skin;
use crate::state::State;

/// A solid as the water around it sees it.
pub struct Sight<K> {
    /// Number of the set of water.
    pub water: usize,
    /// The solid.
    pub skin: Skin,
    /// Kernel of the mean smoothing length.
    pub kernel: K,
    grid: Grid,
    points: Grid,
    /// The points of the skin that each particle of water meets; none where the solid is out of sight.
    pub rows: Rows,
}

impl<K: Kernel> Sight<K> {
    /// Of a solid by the water of a set, with a kernel of the mean smoothing length.
    #[must_use]
    pub fn new(water: usize, skin: Skin, kernel: K) -> Self {
        let reach = kernel.support();
        Self {
            water,
            skin,
            kernel,
            grid: Grid::new(reach),
            points: Grid::new(reach),
            rows: Rows::new(),
        }
    }

    /// Finds who meets whom.
    pub fn look(&mut self, state: &State) {
        let water = state.sets[self.water].column(&POSITION);
        let reach = self.kernel.support();
        self.grid.bin(water);
        let grid = &self.grid;
        self.skin.look(&state.sets[self.skin.set], reach, |x, r| {
            grid.any_within(x, r)
        });
        let places: Vec<[f64; 3]> = self.skin.points.iter().map(|p| p.x).collect();
        self.points.bin(&places);
        if places.is_empty() {
            self.rows.between(&[], &self.points, reach);
        } else {
            self.rows.between(water, &self.points, reach);
        }
    }
}
