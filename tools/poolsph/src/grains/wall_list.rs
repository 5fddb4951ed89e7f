//! Who may touch a wall, listed anew as grains stray.

use contact::Grain;
use rayon::prelude::*;
use shapes::frame::{Vector, difference, length};

use super::lists::{AT_ONCE, ROWS};
use super::memory::Memory;
use super::near::Near;
use super::walls::{Wall, Walls};

/// Where grains are listed.
#[derive(Clone, Copy)]
pub struct Places<'a> {
    /// \[m\], by rows.
    pub listed: &'a [Vector],
    /// By chunks of rows, whether these are as they were when neighbours were listed before; none where nothing is known.
    pub still: &'a [bool],
    /// How far beyond touching a wall is listed \[m\].
    pub skin: f64,
}

impl Walls {
    /// Lists the grains within the skin \[m\] of each wall, at their places \[m\]; `memories`, by walls and rows, go along. Chunks whose places are
    /// still the same are not looked at where the wall is far from them.
    pub fn list(&mut self, grains: &[Grain], places: Places<'_>, memories: &[Memory]) {
        let Places { skin, .. } = places;
        for (w, wall) in self.walls.iter_mut().enumerate() {
            wall.listed = wall.moved;
            wall.near.clear();
            if let Some(pressed) = &mut wall.pressed {
                pressed.rows.clear();
            }
            wall.far.resize(grains.len().div_ceil(ROWS), None);
            let distances = wall.distances(grains.len(), places);
            for ((c, chunk), distances) in grains.chunks(ROWS).enumerate().zip(distances) {
                let Some(distances) = distances else { continue };
                let (mut nearest, mut odd) = (f64::INFINITY, false);
                for ((own, grain), distance) in chunk.iter().enumerate().zip(distances) {
                    let row = (c * ROWS + own) as u32;
                    nearest = nearest.min(distance - grain.radius - skin);
                    if let Some(pressed) = &mut wall.pressed {
                        nearest = nearest.min(distance - pressed.near);
                        if distance < pressed.near {
                            pressed.rows.push(row);
                        }
                    }
                    if distance < grain.radius + skin {
                        wall.near.push(Near::new(row));
                    }
                    odd |= distance.is_nan();
                }
                wall.far[c] = (!odd).then_some((nearest, wall.moved));
            }
            for memory in memories.iter().filter(|m| m.other as usize == w) {
                if let Ok(at) = wall.near.binary_search_by_key(&memory.row, |n| n.row) {
                    wall.near[at].remember(memory);
                }
            }
            (wall.reckoned, wall.deepest) = (wall.near.len(), 0.0);
        }
    }
}

impl Wall {
    /// Distances of places by chunks \[m\]; none of those that are still the same and too far to be listed.
    fn distances(&self, rows: usize, places: Places<'_>) -> Vec<Option<Vec<f64>>> {
        let chunks = places.listed[..rows].par_chunks(ROWS).enumerate();
        let looked = chunks.map(|(c, chunk)| {
            let still = places.still.get(c).copied().unwrap_or(false);
            let away = |place: &Vector| self.face.distance(difference(*place, self.moved));
            (!(still && self.is_far(c))).then(|| chunk.iter().map(away).collect())
        });
        looked.with_max_len(AT_ONCE).collect()
    }

    /// Whether the grains of a chunk that have not moved since it was looked at are too far to be listed.
    fn is_far(&self, chunk: usize) -> bool {
        let from = |(left, moved): (f64, Vector)| left > length(difference(self.moved, moved));
        self.far[chunk].is_some_and(from)
    }
}
