//! What holds or loads the faces of a solid: pieces of its true surface, each with the particle next to it.

use neighbours::Grid;
use shapes::surface::{Piece, names, pieces};

use super::quadratic::terms;
use crate::matter::lattice::Lattice;

/// A piece of surface has its particle within so many cells.
const REACH: f64 = 1.5;

/// A place on a face that moves as it is told, and is a neighbour of the particles around it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Anchor {
    /// Where it is at rest \[m\].
    pub place: [f64; 3],
    /// Its velocity \[m/s\].
    pub velocity: [f64; 3],
}

/// Traction on a piece of surface, taken by the particle next to it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Load {
    /// The particle.
    pub particle: usize,
    /// The middle of the piece, seen from the particle along the axes of the lattice \[m\].
    pub offset: [f64; 3],
    /// The part of it along the normal of a face that stands along the lattice; nothing of any other.
    pub depth: [f64; 3],
    /// Where the middle of the piece is at rest \[m\].
    pub place: [f64; 3],
    /// Force at full load \[N\], in the plane \[N/m\].
    pub force: [f64; 3],
    /// Time in which it rises to that \[s\]; 0 where it is there from the start.
    pub rise: f64,
}

/// A face stands along the lattice whose normal has this part along an axis.
const ALONG: f64 = 1.0 - 1e-9;

impl Load {
    /// Parts of the derivatives of the particle's deformation that its place has. Those of second order count twice along the normal:
    ///
    /// ```text
    /// x_face = x_n + d/2 dx/dX + d^2/8 d2x/dX2 + d^2/8 d2x/dX2
    /// ```
    ///
    /// The first three are the quadratic; the last is what the slopes of all cells add up to (the integration constraint, Chen et
    /// al. 2001). Without it an even traction bends the first rows.
    #[must_use]
    pub fn parts<const T: usize>(&self) -> [f64; T] {
        let dimensions = if T == 5 { 2 } else { 3 };
        let (place, deep): ([f64; T], [f64; T]) = (terms(self.offset), terms(self.depth));
        std::array::from_fn(|m| place[m] + if m < dimensions { 0.0 } else { deep[m] })
    }

    /// Force at a time \[N\].
    #[must_use]
    pub fn at(&self, time: f64) -> [f64; 3] {
        let part = if time < self.rise {
            time / self.rise
        } else {
            1.0
        };
        self.force.map(|f| part * f)
    }

    /// Rate of the force at a time \[N/s\].
    #[must_use]
    pub fn rate(&self, time: f64) -> [f64; 3] {
        let rate = if time < self.rise {
            1.0 / self.rise
        } else {
            0.0
        };
        self.force.map(|f| rate * f)
    }
}

/// Pieces of the named faces of a body, with the particles next to them.
///
/// # Errors
/// Says which name there is none of, and which there are.
pub fn next_to(
    body: &shapes::Body,
    lattice: &Lattice,
    faces: &[String],
    within: Option<&shapes::Body>,
    dimensions: usize,
) -> Result<Vec<(usize, Piece)>, String> {
    let known = names(body, dimensions);
    if let Some(name) = faces.iter().find(|name| !known.contains(name)) {
        return Err(format!(
            "there is no face \"{name}\"; the body has {}",
            known.join(", ")
        ));
    }
    let largest = lattice.cell[..dimensions]
        .iter()
        .fold(0.0_f64, |a, b| a.max(*b));
    let mut grid = Grid::new(REACH * largest);
    grid.bin(&lattice.places);
    let wanted = |piece: &Piece| {
        faces.contains(&known[piece.face]) && within.is_none_or(|body| body.holds(piece.place))
    };
    let mut found = Vec::new();
    for piece in pieces(body, dimensions, largest).into_iter().filter(wanted) {
        let mut nearest: Option<(f64, u32)> = None;
        grid.runs(piece.place, REACH * largest, |run| {
            for (x, a) in grid.sorted()[run.clone()].iter().zip(&grid.order()[run]) {
                let square: f64 = (0..3).map(|k| (x[k] - piece.place[k]).powi(2)).sum();
                // Of two as near the first, whatever the rounding.
                let nearer = nearest.is_none_or(|(least, b)| {
                    square < least * (1.0 - 1e-9) || (square < least * (1.0 + 1e-9) && *a < b)
                });
                if nearer {
                    nearest = Some((square, *a));
                }
            }
        });
        if let Some((_, a)) = nearest {
            found.push((a as usize, piece));
        }
    }
    Ok(found)
}

/// One anchor for each particle next to a face: the middle of its pieces.
#[must_use]
pub fn anchors(pieces: &[(usize, Piece)], velocity: [f64; 3]) -> Vec<Anchor> {
    let mut sorted: Vec<&(usize, Piece)> = pieces.iter().collect();
    sorted.sort_by_key(|(particle, piece)| (*particle, piece.face));
    let same = |a: &&(usize, Piece), b: &&(usize, Piece)| a.0 == b.0 && a.1.face == b.1.face;
    let middle = |of_one: &[&(usize, Piece)]| {
        let area: f64 = of_one.iter().map(|(_, piece)| piece.area).sum();
        let place = std::array::from_fn(|k| {
            let parts = of_one.iter().map(|(_, piece)| piece.area * piece.place[k]);
            parts.sum::<f64>() / area
        });
        Anchor { place, velocity }
    };
    sorted.chunk_by(same).map(middle).collect()
}

/// The loads of a traction \[Pa\], which a normal of the surface gives, on pieces of it; it rises over a time \[s\].
#[must_use]
pub fn loads(
    pieces: &[(usize, Piece)],
    lattice: &Lattice,
    traction: impl Fn([f64; 3]) -> [f64; 3],
    rise: f64,
) -> Vec<Load> {
    let load = |(particle, piece): &(usize, Piece)| {
        let (own, rest) = (
            lattice.own(piece.place),
            lattice.own(lattice.places[*particle]),
        );
        let offset: [f64; 3] = std::array::from_fn(|k| own[k] - rest[k]);
        let ahead = lattice.own([0, 1, 2].map(|k| piece.place[k] + piece.normal[k]));
        let normal: [f64; 3] = std::array::from_fn(|k| ahead[k] - own[k]);
        Load {
            particle: *particle,
            offset,
            depth: [0, 1, 2].map(|k| {
                if normal[k].abs() > ALONG {
                    offset[k]
                } else {
                    0.0
                }
            }),
            place: piece.place,
            force: traction(piece.normal).map(|t| t * piece.area),
            rise,
        }
    };
    pieces.iter().map(load).collect()
}

#[cfg(test)]
mod tests {
    use super::super::links::Links;
    use super::*;

    #[test]
    fn an_even_stress_is_in_balance_with_a_held_and_a_loaded_face() {
        // 7 by 5 cells of unit size, anchors on the left, loads on the right.
        let (columns, rows) = (7, 5);
        let particles = columns * rows;
        let mut places: Vec<[f64; 3]> = (0..particles)
            .map(|i| [(i % columns) as f64, (i / columns) as f64, 0.0])
            .collect();
        places.extend((0..rows).map(|j| [-0.5, j as f64, 0.0]));
        let (links, loose) = Links::<5>::new(&places, particles, [1.0; 3], &[]);
        assert!(loose.is_empty());
        let mut force = vec![0.0; places.len()];
        let mut add = |a: usize, parts: [f64; 5], scale: f64| {
            let row = links.row(a);
            for (b, weight) in row.other.iter().zip(row.weight) {
                let along: f64 = parts.iter().zip(weight).map(|(p, w)| p * w).sum();
                force[*b as usize] += scale * along;
                force[a] -= scale * along;
            }
        };
        for a in 0..particles {
            add(a, [1.0, 0.0, 0.0, 0.0, 0.0], 1.0);
        }
        for j in 0..rows {
            let load = Load {
                particle: j * columns + columns - 1,
                offset: [0.5, 0.0, 0.0],
                depth: [0.5, 0.0, 0.0],
                place: [0.0; 3],
                force: [1.0, 0.0, 0.0],
                rise: 0.0,
            };
            add(load.particle, load.parts(), -1.0);
        }
        for (i, force) in force.iter().enumerate() {
            let expected = if i >= particles {
                -1.0
            } else if i % columns == columns - 1 {
                1.0
            } else {
                0.0
            };
            // Rows of the diagonals share a little; without balance it is 0.5.
            assert!((force - expected).abs() < 0.05, "{i}: {force} {expected}");
        }
    }
}
