//! Radiation that flux takes up behind the wall of its cavity that it falls on.
//!
//! The wall is lit as the shining cells are seen from it (see [`radiation`]). What falls on a face is taken up
//! on the straight way inward from it by the law of Beer and Lambert: between the depths x and x + dx
//!
//! ```text
//! q (exp(-x / l) - exp(-(x + dx) / l))
//! ```
//!
//! of q, l being the length of absorption; what is left where the bed ends stays in its last cell. Grains scatter light
//! and shine on each other, so that l is some grains long whatever they are made of. Neglected: what the wall shines back.

use crate::grid::{FaceIndex, Grid};
use crate::heat::{Contact, contacts, radiation};

/// Part of all that the cells of `own` take up that each cell does; nothing where nothing shines or is lit.
#[must_use]
pub fn shares(
    grid: &Grid,
    material: &[usize],
    own: usize,
    length: f64,
    emission: &[f64],
) -> Vec<f64> {
    let walls = contacts(grid, material, |m| (m == own).then_some(0));
    let all: Vec<&Contact> = walls.iter().collect();
    let flux = radiation::absorbed(grid, &all, emission, 1.0);
    let total: f64 = flux.iter().zip(&walls).map(|(q, wall)| q * wall.area).sum();
    if total <= 0.0 {
        return Vec::new();
    }
    let mut shares = vec![0.0; grid.len()];
    for (q, wall) in flux.iter().zip(&walls) {
        let part = q * wall.area / total;
        let mut rest = part;
        let mut last = wall.metal;
        for (k, depth) in inward(grid, wall).take_while(|(k, _)| material[*k] == own) {
            let behind = part * (-depth / length).exp();
            shares[k] += rest - behind;
            (rest, last) = (behind, k);
        }
        shares[last] += rest;
    }
    shares
}

/// The cells behind a face, the nearest first, and how deep each reaches.
fn inward<'a>(grid: &'a Grid, wall: &Contact) -> impl Iterator<Item = (usize, f64)> + 'a {
    let (i, j) = (wall.metal % grid.nr, wall.metal / grid.nr);
    let radial = matches!(wall.face, FaceIndex::Radial(_));
    let (first, widths) = if radial { (i, &grid.dr) } else { (j, &grid.dz) };
    let outward = wall.normal[usize::from(!radial)] < 0.0;
    let count = if outward {
        widths.len() - first
    } else {
        first + 1
    };
    let mut depth = 0.0;
    (0..count).map(move |n| {
        let at = if outward { first + n } else { first - n };
        depth += widths[at];
        let k = if radial {
            grid.cell(at, j)
        } else {
            grid.cell(i, at)
        };
        (k, depth)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grid::{Spacing, faces};
    use crate::material::GAS;

    /// A cavity of radius 1 and height 1 in flux (1) over a plate (2), which shines in its middle.
    fn cavity() -> (Grid, Vec<usize>, Vec<f64>) {
        let even = Spacing::uniform(0.1);
        let grid = Grid::new(faces(&[0.0, 4.0], &even), faces(&[-0.2, 3.0], &even));
        let kind = |k: usize| match (grid.rc[k % grid.nr], grid.zc[k / grid.nr]) {
            (_, z) if z < 0.0 => 2,
            (r, z) if r < 1.0 && z < 1.0 => GAS,
            _ => 1,
        };
        let material = (0..grid.len()).map(kind).collect();
        let mut emission = vec![0.0; grid.len()];
        emission[grid.cell(2, 7)] = 40.0;
        (grid, material, emission)
    }

    #[test]
    fn all_of_it_is_taken_up_by_the_bed_and_nothing_beside_it() {
        let (grid, material, emission) = cavity();
        for length in [1e-3, 0.3, 50.0] {
            let shares = shares(&grid, &material, 1, length, &emission);
            assert!((shares.iter().sum::<f64>() - 1.0).abs() < 1e-12);
            let own = shares.iter().zip(&material).filter(|(s, _)| **s > 0.0);
            assert!(own.into_iter().all(|(_, m)| *m == 1));
        }
    }

    #[test]
    fn it_falls_by_e_in_a_length() {
        let (grid, material, emission) = cavity();
        let shares = shares(&grid, &material, 1, 0.5, &emission);
        // Beside the wall, in a row that no light of the roof comes to.
        let at = |i: usize| shares[grid.cell(i, 4)];
        for i in 11..30 {
            assert!((at(i + 5) / at(i) - (-1.0_f64).exp()).abs() < 1e-9, "{i}");
        }
        // Upward from the roof too.
        let up = |j: usize| shares[grid.cell(3, j)];
        assert!((up(20) / up(15) - (-1.0_f64).exp()).abs() < 1e-9);
    }

    #[test]
    fn opaque_flux_takes_it_up_at_its_wall() {
        let (grid, material, emission) = cavity();
        let shares = shares(&grid, &material, 1, 1e-6, &emission);
        for (k, share) in shares.iter().enumerate() {
            let (i, j) = (k % grid.nr, k / grid.nr);
            let wall = (i == 10 && (2..12).contains(&j)) || (j == 12 && i < 10);
            assert_eq!(*share > 0.0, wall, "{i} {j}");
        }
    }

    #[test]
    fn without_light_there_is_nothing_to_share() {
        let (grid, material, emission) = cavity();
        assert!(shares(&grid, &material, 1, 0.5, &vec![0.0; emission.len()]).is_empty());
        let filled = vec![1; grid.len()];
        assert!(shares(&grid, &filled, 1, 0.5, &emission).is_empty());
    }
}
