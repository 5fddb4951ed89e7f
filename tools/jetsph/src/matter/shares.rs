//! What cells at a surface that cuts them have of the body.
//!
//! A lattice fills a body by whole cells, and a face that it does not stand along is a flight of steps. Each particle has
//! the volume that the body truly has around it,
//!
//! ```text
//! s_a = |body in its cell, and in cells without a particle that are nearest to it| / |cell|
//! ```
//!
//! its mass and the energy of its cell are s_a times those of a whole one: the body has its true volume, and the steps
//! are of higher order.

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

/// The share of each particle; none where all cells are whole.
#[must_use]
pub fn shares(body: &Body, lattice: &Lattice, dimensions: usize) -> Vec<f64> {
    if lattice.fits {
        return Vec::new();
    }
    let own: Vec<Index> = lattice
        .places
        .iter()
        .map(|x| index(lattice, *x, dimensions))
        .collect();
    let taken: BTreeMap<Index, u32> = own.iter().copied().zip(0..).collect();
    // Cells that the surface may cut lie beside one without a particle, or near the surface.
    let half = 0.5
        * lattice.cell[..dimensions]
            .iter()
            .fold(0.0, |r: f64, c| r.hypot(*c));
    let mut cut = BTreeSet::new();
    for (place, at) in lattice.places.iter().zip(&own) {
        let free: Vec<Index> = around(*at, dimensions)
            .filter(|c| !taken.contains_key(c))
            .collect();
        if !free.is_empty() || body.distance(*place) > -2.0 * half {
            cut.insert(*at);
            cut.extend(free);
        }
    }
    let mut grid = Grid::new(REACH * 2.0 * half);
    grid.bin(&lattice.places);
    let cut: Vec<Index> = cut.into_iter().collect();
    let measured: Vec<BTreeMap<u32, f64>> = cut
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
    let mut shares = vec![1.0; lattice.places.len()];
    for at in &cut {
        if let Some(a) = taken.get(at) {
            shares[*a as usize] = 0.0;
        }
    }
    for (a, part) in measured.into_iter().flatten() {
        shares[a as usize] += part;
    }
    if shares.iter().all(|s| (s - 1.0).abs() < WHOLE) {
        shares.clear();
    }
    shares
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

/// Parts of a cell that are the body, by the particle that has them: its own, or the nearest.
fn measure(
    body: &Body,
    lattice: &Lattice,
    grid: &Grid,
    own: Option<u32>,
    at: Index,
    dimensions: usize,
) -> BTreeMap<u32, f64> {
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
            *parts.entry(a).or_insert(0.0) += each;
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
    fn a_body_has_its_volume_and_its_moment() {
        use std::f64::consts::PI;
        let ring = r#"{"difference": [
            {"disc": {"centre_m": [0.03, 0.01], "radius_m": 1}}, {"disc": {"centre_m": [0.03, 0.01], "radius_m": 0.5}}]}"#;
        for turned in [0.0, 0.4] {
            let (body, lattice) = filled(ring, turned, 2);
            let shares = shares(&body, &lattice, 2);
            let area: f64 = 0.01 * shares.iter().sum::<f64>();
            // Points of 32 by 32 in some hundred cut cells, alike in eight parts.
            assert!((area / (0.75 * PI) - 1.0).abs() < 5e-4, "{area}");
        }
        let ball = r#"{"sphere": {"centre_m": [0, 0, 0.02], "radius_m": 0.5}}"#;
        let (body, lattice) = filled(ball, 0.0, 3);
        let volume: f64 = 1e-3 * shares(&body, &lattice, 3).iter().sum::<f64>();
        assert!((volume / (PI / 6.0) - 1.0).abs() < 1e-3, "{volume}");
    }

    #[test]
    fn what_stands_along_its_lattice_is_whole() {
        let (body, lattice) = filled(r#"{"box": {"min_m": [0, 0], "max_m": [1, 0.5]}}"#, 0.0, 2);
        assert!(shares(&body, &lattice, 2).is_empty());
    }
}
