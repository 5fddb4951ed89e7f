//! Granular flux around the arc: it takes up radiation, and boils into the cavity (Komen 2019,
//! section 5.2.3).
//!
//! A cell of the bed is gas once it is hotter than the boiling point of slag and lies open to the
//! cavity; it is slag again once it is colder, or cut off. A cell that has changed to and fro changes
//! again only some way beyond the boiling point, so that the front comes to rest.

use crate::grid::Grid;
use crate::material::GAS;

/// How much farther beyond the boiling point a cell has to be for each change before \[K\].
const RELUCTANCE_K: f64 = 20.0;

/// A bed of granular flux.
#[derive(Debug, Clone, PartialEq)]
pub struct Granular {
    /// Material of flux and slag.
    pub material: usize,
    /// Melting point of the flux \[K\].
    pub melting: f64,
    /// Boiling point of the slag \[K\].
    pub boiling: f64,
    /// Part of all radiation of the gas that flux and slag take up.
    pub absorbed: Option<f64>,
    /// Length within which they take it up from the wall of the cavity inward \[m\]; none: evenly by volume.
    pub length: Option<f64>,
    /// Half of the melting range of flux whose slag is clear \[K\]: as it melts it conducts heat tens of times as well, by
    /// radiation. None: slag is not clear.
    pub melts_within: Option<f64>,
    /// Cells of the bed, boiled or not.
    pub cells: Vec<usize>,
    /// How often each of them has changed.
    pub(crate) changes: Vec<u8>,
}

impl Granular {
    /// A bed that fills `cells`, with its melting and boiling points \[K\].
    #[must_use]
    pub fn new(
        material: usize,
        [melting, boiling]: [f64; 2],
        absorbed: Option<f64>,
        cells: Vec<usize>,
    ) -> Self {
        Self {
            material,
            melting,
            boiling,
            absorbed,
            length: None,
            melts_within: None,
            changes: vec![0; cells.len()],
            cells,
        }
    }

    /// Turns slag to gas and back by `temperature` \[K\]; returns how many cells changed.
    pub fn boil(&mut self, grid: &Grid, temperature: &[f64], material: &mut [usize]) -> usize {
        let mut hot = vec![false; grid.len()];
        let mut bed = vec![false; grid.len()];
        for (k, changes) in self.cells.iter().zip(&self.changes) {
            let is_gas = material[*k] == GAS;
            let slack = RELUCTANCE_K * f64::from(changes.saturating_sub(1));
            let beyond = if is_gas { -slack } else { slack };
            hot[*k] = temperature[*k] > self.boiling + beyond;
            bed[*k] = true;
        }
        let open = reach(
            grid,
            |k| {
                if bed[k] { hot[k] } else { material[k] == GAS }
            },
            |k| !bed[k] && material[k] == GAS,
        );
        let mut changed = 0;
        for (k, changes) in self.cells.iter().zip(&mut self.changes) {
            let now = if open[*k] { GAS } else { self.material };
            if material[*k] != now {
                material[*k] = now;
                *changes = changes.saturating_add(1);
                changed += 1;
            }
        }
        changed
    }

    /// Heat that each cell takes up of all the radiation `shine` \[W\]: by its part of `shares`, or evenly by volume
    /// where those are empty.
    pub fn take_up(
        &self,
        grid: &Grid,
        material: &[usize],
        shine: f64,
        shares: &[f64],
        mut give: impl FnMut(usize, f64),
    ) -> f64 {
        let Some(part) = self.absorbed else {
            return 0.0;
        };
        if !shares.is_empty() {
            let lit = self.cells.iter().filter(|k| shares[**k] > 0.0);
            lit.for_each(|k| give(*k, part * shine * shares[*k]));
            return part * shine;
        }
        let volume = |k: usize| grid.volume(k % grid.nr, k / grid.nr);
        let solid = || self.cells.iter().filter(|k| material[**k] == self.material);
        let all: f64 = solid().map(|k| volume(*k)).sum();
        if all <= 0.0 {
            return 0.0;
        }
        for k in solid() {
            give(*k, part * shine * volume(*k) / all);
        }
        part * shine
    }
}

/// Cells that `passes` and that are joined to a `start` by faces of such cells.
fn reach(grid: &Grid, passes: impl Fn(usize) -> bool, start: impl Fn(usize) -> bool) -> Vec<bool> {
    let mut open = vec![false; grid.len()];
    let mut next: Vec<usize> = (0..grid.len()).filter(|k| start(*k)).collect();
    next.iter().for_each(|k| open[*k] = true);
    while let Some(k) = next.pop() {
        for n in grid.beside(k) {
            if !open[n] && passes(n) {
                open[n] = true;
                next.push(n);
            }
        }
    }
    open
}

#[cfg(test)]
mod tests {
    use super::*;

    /// One row of ten cells, the first two of which are gas for good.
    fn row() -> (Grid, Vec<usize>, Granular) {
        let grid = Grid::new((0..=10).map(f64::from).collect(), vec![0.0, 1.0]);
        let material = (0..10).map(|k| usize::from(k > 1)).collect();
        let bed = Granular::new(1, [2800.0, 3100.0], Some(0.8), (2..10).collect());
        (grid, material, bed)
    }

    #[test]
    fn what_boils_must_lie_open_to_the_cavity() {
        let (grid, mut material, mut bed) = row();
        let mut t = vec![3000.0; 10];
        t[2] = 3200.0;
        t[3] = 3101.0;
        t[5] = 4000.0;
        assert_eq!(bed.boil(&grid, &t, &mut material), 2);
        assert_eq!(material, [0, 0, 0, 0, 1, 1, 1, 1, 1, 1]);
        // The way back: cell 3 is cut off by cell 2.
        t[2] = 3000.0;
        assert_eq!(bed.boil(&grid, &t, &mut material), 2);
        assert_eq!(material[2..4], [1, 1]);
    }

    #[test]
    fn a_cell_that_flickers_comes_to_rest() {
        let (grid, mut material, mut bed) = row();
        let mut t = vec![300.0; 10];
        let mut changes = 0;
        for n in 0..100 {
            t[2] = if n % 2 == 0 { 3130.0 } else { 3070.0 };
            changes += bed.boil(&grid, &t, &mut material);
        }
        assert!(changes < 6, "{changes}");
    }

    #[test]
    fn radiation_is_shared_out_by_volume() {
        let (grid, material, bed) = row();
        let mut given = [0.0; 10];
        let all = bed.take_up(&grid, &material, 100.0, &[], |k, q| given[k] = q);
        assert!((all - 80.0).abs() < 1e-12);
        assert!((given.iter().sum::<f64>() - 80.0).abs() < 1e-12);
        assert!(given[1].abs() < 1e-15);
        // Rings of equal width: volumes go as 2 i + 1.
        assert!((given[9] / given[2] - 19.0 / 5.0).abs() < 1e-12);
    }
}
