//! What holds or loads the faces of a solid: pieces of its true surface, each with the particle next to it.

use neighbours::Grid;
use shapes::surface::{Piece, names, pieces};

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
    /// Where the middle of the piece is at rest \[m\].
    pub place: [f64; 3],
    /// Force at full load \[N\], in the plane \[N/m\].
    pub force: [f64; 3],
    /// Time in which it rises to that \[s\]; 0 where it is there from the start.
    pub rise: f64,
}

impl Load {
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
    (within, dimensions): (Option<&shapes::Body>, usize),
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
    (traction, rise): (impl Fn([f64; 3]) -> [f64; 3], f64),
) -> Vec<Load> {
    let load = |(particle, piece): &(usize, Piece)| {
        let (own, rest) = (
            lattice.own(piece.place),
            lattice.own(lattice.places[*particle]),
        );
        Load {
            particle: *particle,
            offset: std::array::from_fn(|k| own[k] - rest[k]),
            place: piece.place,
            force: traction(piece.normal).map(|t| t * piece.area),
            rise,
        }
    };
    pieces.iter().map(load).collect()
}
