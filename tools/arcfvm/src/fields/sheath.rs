//! The sheath rule: gas close to an electrode conducts as the gas just beyond (Komen 2019, section
//! 5.2.3 and fig. 5.12), since the cold layer on a metal is no barrier to the current in truth.

use crate::case::GAS;
use crate::grid::Grid;

/// Gas close to electrodes, and where each of its cells takes its conductivity from.
#[derive(Debug, Clone, PartialEq)]
pub struct Sheath {
    /// Whether a material has a sheath, by material.
    has: Vec<bool>,
    /// Depth of the sheath \[m\].
    depth: f64,
    /// For each cell the cell whose conductivity it takes; itself mostly, `[nr nz]`.
    pub from: Vec<usize>,
}

impl Sheath {
    /// The sheath of the materials that `has`.
    #[must_use]
    pub fn new(grid: &Grid, material: &[usize], has: Vec<bool>, depth: f64) -> Self {
        let mut sheath = Self {
            has,
            depth,
            from: Vec::new(),
        };
        sheath.renew(grid, material);
        sheath
    }

    /// Takes the cells of `material` anew: those within the depth, straight off the surface, follow
    /// the first cell beyond.
    pub fn renew(&mut self, grid: &Grid, material: &[usize]) {
        self.from = (0..grid.len()).collect();
        for k in (0..grid.len()).filter(|k| self.has[material[*k]]) {
            let (i, j) = (k % grid.nr, k / grid.nr);
            let up = (j + 1..grid.nz).map(|n| (grid.cell(i, n), grid.dz[n]));
            line(up, material, self.depth, &mut self.from);
            let down = (0..j).rev().map(|n| (grid.cell(i, n), grid.dz[n]));
            line(down, material, self.depth, &mut self.from);
            let out = (i + 1..grid.nr).map(|n| (grid.cell(n, j), grid.dr[n]));
            line(out, material, self.depth, &mut self.from);
            let within = (0..i).rev().map(|n| (grid.cell(n, j), grid.dr[n]));
            line(within, material, self.depth, &mut self.from);
        }
    }
}

/// The cells along one straight line off the surface, with their widths.
fn line(
    cells: impl Iterator<Item = (usize, f64)>,
    material: &[usize],
    depth: f64,
    from: &mut [usize],
) {
    let mut reached = 0.0;
    let mut thin = Vec::new();
    for (cell, width) in cells {
        if material[cell] != GAS {
            return;
        }
        // A cell belongs to the sheath if its centre does.
        if reached + 0.5 * width > depth {
            for k in thin {
                from[k] = cell;
            }
            return;
        }
        thin.push(cell);
        reached += width;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_whose_centre_is_within_the_depth_follow_the_next() {
        let grid = Grid::new(vec![0.0, 1.0, 2.0], (0..=6).map(f64::from).collect());
        let mut material = vec![GAS; grid.len()];
        material[..2].fill(1);
        let sheath = Sheath::new(&grid, &material, vec![false, true], 1.6);
        for i in 0..2 {
            assert_eq!(sheath.from[grid.cell(i, 1)], grid.cell(i, 3));
            assert_eq!(sheath.from[grid.cell(i, 2)], grid.cell(i, 3));
            assert_eq!(sheath.from[grid.cell(i, 3)], grid.cell(i, 3));
        }
    }
}
