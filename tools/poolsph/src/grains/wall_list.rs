//! Who may touch a wall, listed anew as grains stray.

use contact::Grain;
use rayon::prelude::*;
use shapes::frame::{Vector, difference, length};

use super::lists::{AT_ONCE, ROWS};
use super::memory::Memory;
use super::near::Near;
use super::walls::{Wall, Walls};

impl Walls {
    /// Lists the grains within `skin` \[m\] of each wall; `memories`, by walls and rows, go along. Chunks of grains that are `still` are not looked at where the wall is far from them.
    pub fn list(&mut self, grains: &[Grain], still: &[bool], skin: f64, memories: &[Memory]) {
        for (w, wall) in self.walls.iter_mut().enumerate() {
            wall.listed = wall.moved;
            wall.near.clear();
            if let Some(pressed) = &mut wall.pressed {
                pressed.rows.clear();
            }
            wall.far.resize(grains.len().div_ceil(ROWS), None);
            let distances = wall.distances(grains, still);
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
    /// Distances of grains by chunks \[m\]; none of those that are `still` and too far to be listed.
    fn distances(&self, grains: &[Grain], still: &[bool]) -> Vec<Option<Vec<f64>>> {
        let chunks = grains.par_chunks(ROWS).enumerate();
        let looked = chunks.map(|(c, chunk)| {
            let still = still.get(c).copied().unwrap_or(false);
            let away = |g: &Grain| self.face.distance(difference(g.position, self.moved));
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
