//! The sheath rule: gas close to an electrode conducts as the gas just beyond (Komen 2019, section
//! 5.2.3 and fig. 5.12), since the cold layer on a metal is no barrier to the current in truth.

use crate::grid::{FaceIndex, Grid};
use crate::material::{GAS, Law, Material};

/// What the cells off a face of an electrode hold of its sheath.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Held {
    /// The sheath, and gas beyond it.
    Whole,
    /// Nothing: the middle of the first cell lies beyond the sheath.
    Thin,
    /// No gas beyond it: metal or the edge of the domain is nearer.
    Thick,
}

/// Gas close to electrodes, and where each of its cells takes its conductivity from.
#[derive(Debug, Clone, PartialEq)]
pub struct Sheath {
    /// Whether a material has a sheath, by material.
    has: Vec<bool>,
    /// Depth of the sheath \[m\].
    depth: f64,
    /// For each cell the cell whose conductivity it takes; itself mostly, `[nr nz]`.
    pub from: Vec<usize>,
    /// Every face of its electrodes to gas, and what cells hold there.
    pub faces: Vec<(FaceIndex, Held)>,
    /// Whether it keeps the electrons of that cell in place of its conductivity.
    keeps_electrons: bool,
}

/// Temperature \[K\] at which gas with the mass fraction `iron` of iron holds `wanted` electrons \[1/m3\]: the lowest
/// such, linear between the nodes of the table, or that of the most electrons. Where atoms of one kind are used up and the
/// next do not ionise yet, electrons become fewer as gas grows hotter, and the lowest temperature jumps by thousands of
/// kelvins, which keeps an iteration from its end: electrons count as growing at least as the temperature does.
fn temperature_of(density: &Law, wanted: f64, iron: f64) -> Option<f64> {
    let nodes = match density {
        Law::Table(table) => table.nodes(),
        Law::Mixed(mixed) => mixed.table.rows()[0].nodes(),
        Law::Constant(_) | Law::Formula(_) => return None,
    };
    let at: Vec<f64> = nodes
        .iter()
        .map(|t| density.within(0.0, 0.0, *t, iron))
        .collect();
    let wanted = at.iter().copied().fold(0.0, f64::max).min(wanted);
    let mut low = at[0];
    if wanted <= low {
        return nodes.first().copied();
    }
    for (pair, own) in nodes.windows(2).zip(&at[1..]) {
        let high = own.max(low * pair[1] / pair[0]);
        if high >= wanted {
            let part = ((wanted - low) / (high - low)).clamp(0.0, 1.0);
            return Some(pair[0] + part * (pair[1] - pair[0]));
        }
        low = high;
    }
    nodes.last().copied()
}

/// Conductivity \[S/m\] of `gas` with the mass fraction `iron` that holds as many electrons as it does at
/// `beyond`, a temperature \[K\] and a mass fraction (Komen 2019, fig. 5.12).
fn of_equal_electrons(gas: &Material, beyond: [f64; 2], iron: f64) -> Option<f64> {
    let density = gas.electron_density.as_ref()?;
    let electrons = density.within(0.0, 0.0, beyond[0], beyond[1]);
    let t = temperature_of(density, electrons, iron)?;
    let conductivity = gas.electric_conductivity.as_ref()?;
    Some(conductivity.within(0.0, 0.0, t, iron))
}

impl Sheath {
    /// The sheath of the materials that `has`.
    #[must_use]
    pub fn new(grid: &Grid, material: &[usize], has: Vec<bool>, depth: f64) -> Self {
        let mut sheath = Self {
            has,
            depth,
            from: Vec::new(),
            faces: Vec::new(),
            keeps_electrons: false,
        };
        sheath.renew(grid, material);
        sheath
    }

    /// The same sheath with the electrons of the gas beyond in place of its conductivity.
    #[must_use]
    pub fn keeping_electrons(mut self) -> Self {
        self.keeps_electrons = true;
        self
    }

    /// Conductivity of cell `k`, where `before` is that of all cells by their own temperatures
    /// \[S/m\]; `state` tells temperature and mass fraction of iron.
    #[must_use]
    pub fn conductivity(
        &self,
        gas: &Material,
        before: &[f64],
        state: impl Fn(usize) -> [f64; 2],
        k: usize,
    ) -> f64 {
        let from = self.from[k];
        if from == k {
            return before[k];
        }
        let kept = self
            .keeps_electrons
            .then(|| of_equal_electrons(gas, state(from), state(k)[1]));
        kept.flatten().unwrap_or(before[from]).max(before[k])
    }

    /// Takes the cells of `material` anew: those within the depth, straight off the surface, follow
    /// the first cell beyond.
    pub fn renew(&mut self, grid: &Grid, material: &[usize]) {
        self.from = (0..grid.len()).collect();
        self.faces.clear();
        for k in (0..grid.len()).filter(|k| self.has[material[*k]]) {
            for (face, cells) in lines(grid, k) {
                let held = line(cells, material, self.depth, &mut self.from);
                self.faces.extend(held.map(|held| (face, held)));
            }
        }
    }

    /// Depth \[m\].
    #[must_use]
    pub fn depth(&self) -> f64 {
        self.depth
    }
}

/// Cells along a line, with their widths \[m\].
type Cells<'a> = Box<dyn Iterator<Item = (usize, f64)> + 'a>;

/// The four lines off cell `k`: the face where each begins, and its cells.
fn lines(grid: &Grid, k: usize) -> [(FaceIndex, Cells<'_>); 4] {
    let (i, j) = (k % grid.nr, k / grid.nr);
    let axial = move |n: usize| (grid.cell(i, n), grid.dz[n]);
    let radial = move |n: usize| (grid.cell(n, j), grid.dr[n]);
    let [below, above] = [j, j + 1].map(|face| FaceIndex::Axial(grid.axial_face(i, face)));
    let [inner, outer] = [i, i + 1].map(|face| FaceIndex::Radial(grid.radial_face(face, j)));
    [
        (above, Box::new((j + 1..grid.nz).map(axial))),
        (below, Box::new((0..j).rev().map(axial))),
        (outer, Box::new((i + 1..grid.nr).map(radial))),
        (inner, Box::new((0..i).rev().map(radial))),
    ]
}

/// Takes the cells along one straight line off the surface; nothing where it begins in no gas.
fn line(
    cells: impl Iterator<Item = (usize, f64)>,
    material: &[usize],
    depth: f64,
    from: &mut [usize],
) -> Option<Held> {
    let mut reached = 0.0;
    let mut thin = Vec::new();
    for (cell, width) in cells {
        if material[cell] != GAS {
            break;
        }
        // A cell belongs to the sheath if its centre does.
        if reached + 0.5 * width > depth {
            let held = if thin.is_empty() {
                Held::Thin
            } else {
                Held::Whole
            };
            for k in thin {
                from[k] = cell;
            }
            return Some(held);
        }
        thin.push(cell);
        reached += width;
    }
    (!thin.is_empty()).then_some(Held::Thick)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mixture::{Mixed, Molar};
    use props::{Surface, Table};
    use std::sync::Arc;

    /// Gas whose electrons grow with temperature and iron up to 10,000 K, and then become fewer, and that
    /// conducts as `sigma(x, T)` says.
    fn gas(sigma: impl Fn(f64, f64) -> f64) -> Material {
        gas_with(|x, t| (1.0 + 3.0 * x) * 1e19 * t.min(2e4 - t), sigma)
    }

    /// Gas whose electrons are `electrons(x, T)`.
    fn gas_with(electrons: impl Fn(f64, f64) -> f64, sigma: impl Fn(f64, f64) -> f64) -> Material {
        let t = vec![300.0, 5000.0, 10_000.0, 20_000.0];
        let law = |value: &dyn Fn(f64, f64) -> f64| {
            let row = |x: f64| {
                let values = t.iter().map(|t| value(x, *t)).collect();
                Table::new(t.clone(), values).unwrap()
            };
            let table = Surface::new(vec![0.0, 1.0], vec![row(0.0), row(1.0)]).unwrap();
            Some(Law::Mixed(Mixed {
                table: Arc::new(table),
                molar: Molar {
                    gas: 0.05,
                    iron: 0.05,
                },
            }))
        };
        Material {
            electron_density: law(&electrons),
            electric_conductivity: law(&sigma),
            ..Material::default()
        }
    }

    #[test]
    fn iron_reaches_the_same_electrons_at_a_lower_temperature() {
        let gas = gas(|_, t| t);
        // Four times the electrons at each temperature: a quarter of the temperature.
        let found = of_equal_electrons(&gas, [8000.0, 0.0], 1.0).unwrap();
        assert!((found - 2000.0).abs() < 1e-9, "{found}");
        // Gas of the same composition conducts alike, on the rising side.
        let same = of_equal_electrons(&gas, [4000.0, 0.3], 0.3).unwrap();
        assert!((same - 4000.0).abs() < 1e-9, "{same}");
        // More electrons than there can be: as near as it comes.
        let most = of_equal_electrons(&gas, [10_000.0, 1.0], 0.0).unwrap();
        assert!((most - 10_000.0).abs() < 1e-9, "{most}");
    }

    #[test]
    fn more_electrons_than_grow_with_the_temperature_are_found_without_a_jump() {
        // From 10,000 to 20,000 K they grow by a tenth: 5 % more would be 5000 K hotter.
        let slow = gas_with(|x, t| (1.0 + 3.0 * x) * t.min(9e3 + 0.1 * t), |_, t| t);
        let density = slow.electron_density.as_ref().unwrap();
        for (wanted, t) in [
            (9.5e3, 9.5e3),
            (1e4, 1e4),
            (1.01e4, 1.01e4),
            (1.05e4, 1.05e4),
        ] {
            let found = temperature_of(density, wanted, 0.0).unwrap();
            assert!((found - t).abs() < 1e-6, "{wanted} {found}");
        }
    }

    #[test]
    fn conductivity_follows_the_iron_of_the_cell_itself() {
        let gas = gas(|x, t| t * (1.0 + x));
        let grid = Grid::new(vec![0.0, 1.0], (0..=4).map(f64::from).collect());
        let material = [1, GAS, GAS, GAS];
        let sheath = Sheath::new(&grid, &material, vec![false, true], 0.6);
        let state = |k: usize| [[300.0, 0.0], [600.0, 1.0], [8000.0, 0.0], [9000.0, 0.0]][k];
        let before = [1e6, 1.0, 8000.0, 9000.0];
        let of = |sheath: &Sheath, k| sheath.conductivity(&gas, &before, state, k);
        assert!((of(&sheath, 1) - 8000.0).abs() < 1e-9);
        let sheath = sheath.keeping_electrons();
        assert!((of(&sheath, 1) - 4000.0).abs() < 1e-9);
        assert!((of(&sheath, 2) - 8000.0).abs() < 1e-9);
    }

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

    #[test]
    fn a_sheath_that_no_cell_holds_or_that_fills_the_gap_is_found() {
        // Metal, four cells of gas, metal, along the axis.
        let grid = Grid::new(vec![0.0, 1.0], (0..=6).map(f64::from).collect());
        let material = [1, GAS, GAS, GAS, GAS, 1];
        let of = |depth: f64| {
            let sheath = Sheath::new(&grid, &material, vec![false, true], depth);
            sheath
                .faces
                .iter()
                .map(|(_, held)| *held)
                .collect::<Vec<_>>()
        };
        assert_eq!(of(0.4), [Held::Thin; 2]);
        assert_eq!(of(1.0), [Held::Whole; 2]);
        assert_eq!(of(5.0), [Held::Thick; 2]);
    }
}
