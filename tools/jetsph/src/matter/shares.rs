//! What cells at a surface that cuts them have of the body.
//!
//! A lattice fills a body by whole cells, and a face that it does not stand along is a flight of steps. Each particle has
//! the volume that the body truly has around it,
//!
//! ```text
//! s_a = |body in its cell, and in cells without a particle that are nearest to it| / |cell|
//! ```
//!
//! its mass and the energy of its cell are s_a times those of a whole one, by the strain in the middle of what it has: the
//! body has its true volume and the moments of it, and the steps are of higher order.

use std::collections::{BTreeMap, BTreeSet};

use neighbours::Grid;
use rayon::prelude::*;
use shapes::Body;

use super::lattice::Lattice;

/// Points along each axis with which a cell is measured, in the plane and in space.
const POINTS: [usize; 2] = [32, 10];
/// A cell without a particle has its next one within so many cells.
const REACH: f64 = 2.0;
/// All cells are whole that differ by less.
const WHOLE: f64 = 1e-12;

/// Number of a cell along the axes of the lattice.
type Index = [i64; 3];

/// What the particles of a body have of it; nothing where all cells are whole.
#[derive(Debug, Clone, Default)]
pub struct Shares {
    /// s_a.
    pub part: Vec<f64>,
    /// Middle of it, seen from the particle along the axes of the lattice \[cells\].
    pub middle: Vec<[f64; 3]>,
}

/// The shares of all particles; none where all cells are whole.
#[must_use]
pub fn shares(body: &Body, lattice: &Lattice, dimensions: usize) -> Shares {
    if lattice.fits {
        return Shares::default();
    }
    let own: Vec<Index> = lattice
        .places
        .iter()
        .map(|x| index(lattice, *x, dimensions))
        .collect();
    let taken: BTreeMap<Index, u32> = own.iter().copied().zip(0..).collect();
    let cut = cut(body, lattice, &own, &taken, dimensions);
    let mut grid = Grid::new(REACH * 2.0 * half(lattice, dimensions));
    grid.bin(&lattice.places);
    let measured: Vec<BTreeMap<u32, [f64; 4]>> = cut
        .par_iter()
        .map(|at| {
            measure(
                body,
                lattice,
                &grid,
                taken.get(at).copied(),
                *at,
                dimensions,
            )
        })
        .collect();
    let n = lattice.places.len();
    let mut shares = Shares {
        part: vec![1.0; n],
        middle: vec![[0.0; 3]; n],
    };
    for at in &cut {
        if let Some(a) = taken.get(at) {
            shares.part[*a as usize] = 0.0;
        }
    }
    for (a, [part, moments @ ..]) in measured.into_iter().flatten() {
        shares.part[a as usize] += part;
        (0..3).for_each(|k| shares.middle[a as usize][k] += moments[k]);
    }
    if shares.part.iter().all(|s| (s - 1.0).abs() < WHOLE) {
        return Shares::default();
    }
    for (middle, part) in shares.middle.iter_mut().zip(&shares.part) {
        middle
            .iter_mut()
            .for_each(|x| *x /= part.max(f64::MIN_POSITIVE));
    }
    shares
}

/// Half of the diagonal of a cell \[m\].
fn half(lattice: &Lattice, dimensions: usize) -> f64 {
    let sides = lattice.cell[..dimensions].iter();
    0.5 * sides.fold(0.0, |r: f64, c| r.hypot(*c))
}

/// Cells that the surface may cut: they lie beside one without a particle, or near the surface.
fn cut(
    body: &Body,
    lattice: &Lattice,
    own: &[Index],
    taken: &BTreeMap<Index, u32>,
    dimensions: usize,
) -> Vec<Index> {
    let near = -2.0 * half(lattice, dimensions);
    let mut cut = BTreeSet::new();
    for (place, at) in lattice.places.iter().zip(own) {
        let free: Vec<Index> = around(*at, dimensions)
            .filter(|c| !taken.contains_key(c))
            .collect();
        if !free.is_empty() || body.distance(*place) > near {
            cut.insert(*at);
            cut.extend(free);
        }
    }
    cut.into_iter().collect()
}

/// The cell of a place.
fn index(lattice: &Lattice, place: [f64; 3], dimensions: usize) -> Index {
    let own = lattice.own(place);
    [0, 1, 2].map(|k| {
        if k < dimensions {
            (own[k] / lattice.cell[k]).floor() as i64
        } else {
            0
        }
    })
}

/// The cells around one, and itself.
fn around(at: Index, dimensions: usize) -> impl Iterator<Item = Index> {
    let depth = if dimensions == 3 { -1..=1 } else { 0..=0 };
    depth.flat_map(move |k| {
        (-1..=1).flat_map(move |j| (-1..=1).map(move |i| [at[0] + i, at[1] + j, at[2] + k]))
    })
}

/// Parts of a cell that are the body, with their moments about the particle that has them: its own, or the nearest \[cells\].
fn measure(
    body: &Body,
    lattice: &Lattice,
    grid: &Grid,
    own: Option<u32>,
    at: Index,
    dimensions: usize,
) -> BTreeMap<u32, [f64; 4]> {
    let points = POINTS[dimensions - 2];
    let depth = if dimensions == 3 { points } else { 1 };
    let each = 1.0 / (points * points * depth) as f64;
    let mut parts = BTreeMap::new();
    for number in 0..points * points * depth {
        let sub = [
            number % points,
            number / points % points,
            number / (points * points),
        ];
        let offset = [0, 1, 2].map(|k| {
            if k < dimensions {
                (at[k] as f64 + (sub[k] as f64 + 0.5) / points as f64) * lattice.cell[k]
            } else {
                0.0
            }
        });
        let place = lattice.frame.place(offset);
        if body.holds(place)
            && let Some(a) = own.or_else(|| nearest(grid, place))
        {
            let from = lattice.own(lattice.places[a as usize]);
            let sums: &mut [f64; 4] = parts.entry(a).or_default();
            sums[0] += each;
            for k in 0..dimensions {
                sums[k + 1] += each * (offset[k] - from[k]) / lattice.cell[k];
            }
        }
    }
    parts
}

/// The nearest particle; of two as near the first.
fn nearest(grid: &Grid, place: [f64; 3]) -> Option<u32> {
    let mut found: Option<(f64, u32)> = None;
    grid.runs(place, grid.edge(), |run| {
        for (x, a) in grid.sorted()[run.clone()].iter().zip(&grid.order()[run]) {
            let square: f64 = (0..3).map(|k| (x[k] - place[k]).powi(2)).sum();
            let nearer = found.is_none_or(|(least, b)| {
                square < least * (1.0 - 1e-9) || (square < least * (1.0 + 1e-9) && *a < b)
            });
            if nearer {
                found = Some((square, *a));
            }
        }
    });
    found.map(|(_, a)| a)
}

#[cfg(test)]
mod tests {
    use super::super::lattice::Filling;
    use super::*;

    fn filled(text: &str, turned: f64, dimensions: usize) -> (Body, Lattice) {
        let body = Body::new(&serde_json::from_str(text).unwrap(), dimensions);
        let filling = Filling {
            spacing: 0.1,
            turned,
            jitter: 0.0,
            dimensions,
        };
        let lattice = Lattice::fill(&body, &filling).unwrap();
        (body, lattice)
    }

    #[test]
    fn a_body_has_its_volume_and_its_moments() {
        use std::f64::consts::PI;
        let ring = r#"{"difference": [
            {"disc": {"centre_m": [0.03, 0.01], "radius_m": 1}}, {"disc": {"centre_m": [0.03, 0.01], "radius_m": 0.5}}]}"#;
        for turned in [0.0, 0.4] {
            let (body, lattice) = filled(ring, turned, 2);
            let shares = shares(&body, &lattice, 2);
            let area: f64 = 0.01 * shares.part.iter().sum::<f64>();
            let own = lattice.own([0.03, 0.01, 0.0]);
            for (k, own) in own.into_iter().enumerate().take(2) {
                let at = |a: usize| lattice.own(lattice.places[a])[k] + 0.1 * shares.middle[a][k];
                let sum = |power: i32| -> f64 {
                    let all = shares.part.iter().enumerate();
                    all.map(|(a, s)| 0.01 * s * (at(a) - own).powi(power)).sum()
                };
                assert!(sum(1).abs() < 1e-3, "{}", sum(1));
                // About each middle there is some d^2/12 left.
                let exact = 0.25 * PI * (1.0 - 0.5_f64.powi(4));
                let found = sum(2) + 0.01 / 12.0 * area;
                assert!((found / exact - 1.0).abs() < 1e-3, "{found} {exact}");
            }
            // Points of 32 by 32 in some hundred cut cells, alike in eight parts.
            assert!((area / (0.75 * PI) - 1.0).abs() < 5e-4, "{area}");
        }
        let ball = r#"{"sphere": {"centre_m": [0, 0, 0.02], "radius_m": 0.5}}"#;
        let (body, lattice) = filled(ball, 0.0, 3);
        let volume: f64 = 1e-3 * shares(&body, &lattice, 3).part.iter().sum::<f64>();
        assert!((volume / (PI / 6.0) - 1.0).abs() < 1e-3, "{volume}");
    }

    #[test]
    fn what_stands_along_its_lattice_is_whole() {
        let (body, lattice) = filled(r#"{"box": {"min_m": [0, 0], "max_m": [1, 0.5]}}"#, 0.0, 2);
        assert!(shares(&body, &lattice, 2).part.is_empty());
    }
}
