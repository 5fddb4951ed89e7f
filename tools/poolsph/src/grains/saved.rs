//! What a checkpoint keeps of the motion of grains beside their columns: contacts that touch, walls, metal, and sums; and the
//! contacts that one run hands on to the next.

use particles::{POSITION, Set};
use shapes::frame::Vector;

use super::RADIUS;
use super::bounds::Doing;
use super::heat::{Heat, SAVED};
use super::laid::{Laid, Touching, With};
use super::lists::Lists;
use super::memory::Memory;
use super::metal::Metal;
use super::motion::Motion;
use super::sleep::Sleep;
use crate::state::State;

/// Numbers of a checkpoint ahead of the walls.
const HEAD: usize = 8 + SAVED;

impl Motion {
    /// All of it as numbers.
    pub(super) fn saved(&self) -> Vec<f64> {
        let (mut between, mut at_walls) = (Vec::new(), Vec::new());
        self.lists.memories(&mut between, true);
        self.walls.memories(&mut at_walls);
        let Doing {
            deepest, fastest, ..
        } = self.doing;
        let [left, mass] = self.lost;
        let heat = self.heat.as_ref().map_or([0.0; SAVED], Heat::saved);
        let steps = self.steps;
        let mut saved = vec![
            between.len() as f64,
            deepest,
            fastest,
            left,
            mass,
            steps,
            self.quiet,
            self.listings,
        ];
        saved.extend(heat);
        saved.extend(self.walls.save());
        if let Some(sleep) = &self.sleep {
            saved.extend(sleep.save(self.moving.grains.len()));
        }
        self.moving.glued.save(&mut saved);
        let memories = between.iter().chain(&at_walls);
        saved.extend(memories.flat_map(Memory::save));
        if let Some(metal) = &self.metal {
            saved.extend(metal.append());
        }
        saved
    }

    /// With contacts that go on, of the grains in `set`.
    #[must_use]
    pub fn lying(mut self, laid: Option<Laid>, set: &Set) -> Self {
        let (place, radius) = (set.column(&POSITION), set.column(&RADIUS));
        let skin = Lists::skin(self.setting.radii[0]);
        let at_wall = |memory: &Memory| {
            let (row, wall) = (memory.row as usize, memory.other as usize);
            self.walls.reaches(wall, place[row], radius[row] + skin)
        };
        self.laid = laid.map(|laid| laid.kept(at_wall, self.metal.is_some()));
        self
    }

    /// All contacts that touch, of grains with the numbers `ids` by rows.
    pub(super) fn touching(&self, ids: &[u32], state: &State) -> Vec<Touching> {
        let (mut between, mut at_walls) = (Vec::new(), Vec::new());
        self.lists.memories(&mut between, true);
        self.walls.memories(&mut at_walls);
        let on_metal = self.metal.iter().flat_map(Metal::touching);
        let (grains, metal) = (&self.moving.grains, state.metal.column(&POSITION));
        let of = |with: With, memory: Memory| {
            let (row, other) = (memory.row as usize, memory.other as usize);
            let (other, place) = match with {
                With::Grain => (ids[other], grains[other].position),
                With::Wall => (memory.other, grains[row].position),
                With::Metal => (memory.other, metal[other]),
            };
            let row = ids[row];
            Touching {
                with,
                place,
                memory: Memory {
                    row,
                    other,
                    ..memory
                },
            }
        };
        let between = between.into_iter().map(|m| of(With::Grain, m));
        let at_walls = at_walls.into_iter().map(|m| of(With::Wall, m));
        let on_metal = on_metal.map(|m| of(With::Metal, m));
        between.chain(at_walls).chain(on_metal).collect()
    }

    /// Lists neighbours as they were when `saved` was.
    pub(super) fn relist_as_saved(&mut self, saved: &[f64]) {
        let walls = HEAD + self.walls.saved_numbers();
        let (Some(head), Some(places), Some(rest)) = (
            saved.first_chunk::<HEAD>(),
            saved.get(HEAD..walls),
            saved.get(walls..),
        ) else {
            return;
        };
        let [
            pairs,
            deep,
            fast,
            left,
            mass,
            steps,
            quiet,
            listings,
            heat @ ..,
        ] = *head;
        if let Some(own) = &mut self.heat {
            own.take_back(heat);
        }
        let rows = self.moving.grains.len();
        let numbers = self.sleep.as_ref().map_or(0, |_| Sleep::numbers(rows));
        let (slept, rest) = rest.split_at(numbers.min(rest.len()));
        if let Some(sleep) = &mut self.sleep {
            sleep.restore(slept, &mut self.moving);
        }
        let rest = self.moving.glued.restore(rest);
        let memories = rest.as_chunks::<9>().0;
        let split = (pairs as usize).min(memories.len());
        for (to, from) in self
            .memories
            .iter_mut()
            .zip([&memories[..split], &memories[split..]])
        {
            to.clear();
            to.extend(from.iter().map(|saved| Memory::restored(*saved)));
        }
        (self.lost, self.steps) = ([left, mass], steps);
        let moved = self.walls.restore(places);
        let now: Vec<Vector> = self.moving.grains.iter().map(|g| g.position).collect();
        for (grain, listed) in self.moving.grains.iter_mut().zip(&self.moving.listed) {
            grain.position = *listed;
        }
        self.lists.again.all();
        self.list_with_memories();
        for (grain, now) in self.moving.grains.iter_mut().zip(now) {
            grain.position = now;
        }
        self.walls.place(&moved);
        (self.doing.deepest, self.doing.fastest) = (deep, fast);
        (self.quiet, self.listings) = (quiet, listings);
    }
}
