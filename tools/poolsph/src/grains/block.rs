//! Contacts side by side: their numbers in columns, so that one instruction reckons several.

use contact::{Grain, History, Meeting, Reply};
use shapes::frame::Vector;

use super::lists::Chunk;
use super::resistance::Resistance;

/// Contacts of a block.
pub const LANES: usize = 32;

/// One number of each contact.
type Lane = [f64; LANES];

/// The grains on one side of the contacts.
#[derive(Debug, Clone)]
struct Side {
    position: [Lane; 3],
    velocity: [Lane; 3],
    spin: [Lane; 3],
    radius: Lane,
    mass: Lane,
}

/// Contacts that go on touching.
#[derive(Debug, Clone)]
pub struct Block {
    filled: usize,
    sides: [Side; 2],
    stretch: [Lane; 3],
    stiffness: Lane,
    rolled: [Lane; 3],
    overlap: Lane,
    force: [Lane; 3],
    moment: [Lane; 3],
    moment_on_b: [Lane; 3],
}

const NONE: Lane = [0.0; LANES];
const SIDE: Side = Side {
    position: [NONE; 3],
    velocity: [NONE; 3],
    spin: [NONE; 3],
    radius: NONE,
    mass: NONE,
};

impl Default for Block {
    fn default() -> Self {
        Self {
            filled: 0,
            sides: [SIDE; 2],
            stretch: [NONE; 3],
            stiffness: NONE,
            rolled: [NONE; 3],
            overlap: NONE,
            force: [NONE; 3],
            moment: [NONE; 3],
            moment_on_b: [NONE; 3],
        }
    }
}

#[inline(always)]
fn put(lanes: &mut [Lane; 3], lane: usize, vector: Vector) {
    for k in 0..3 {
        lanes[k][lane] = vector[k];
    }
}

#[inline(always)]
fn get(lanes: &[Lane; 3], lane: usize) -> Vector {
    [lanes[0][lane], lanes[1][lane], lanes[2][lane]]
}

impl Side {
    #[inline(always)]
    fn put(&mut self, lane: usize, grain: &Grain) {
        put(&mut self.position, lane, grain.position);
        put(&mut self.velocity, lane, grain.velocity);
        put(&mut self.spin, lane, grain.spin);
        self.radius[lane] = grain.radius;
        self.mass[lane] = grain.mass;
    }

    #[inline(always)]
    fn get(&self, lane: usize) -> Grain {
        Grain {
            position: get(&self.position, lane),
            velocity: get(&self.velocity, lane),
            spin: get(&self.spin, lane),
            radius: self.radius[lane],
            mass: self.mass[lane],
        }
    }
}

impl Block {
    /// Takes the contacts at `places` of a chunk whose first row is `first`, as many as there is room for.
    #[inline(always)]
    pub fn gather(&mut self, grains: &[Grain], first: usize, chunk: &Chunk, places: &[u32]) {
        self.filled = places.len().min(LANES);
        for (lane, place) in places.iter().take(LANES).enumerate() {
            let place = *place as usize;
            let pair = chunk.pairs[place];
            self.sides[0].put(lane, &grains[first + pair.own as usize]);
            self.sides[1].put(lane, &grains[pair.other as usize]);
            let history = chunk.histories[place];
            put(&mut self.stretch, lane, history.stretch);
            self.stiffness[lane] = history.stiffness;
            if let Some(rolled) = chunk.rolled.get(place) {
                put(&mut self.rolled, lane, *rolled);
            }
        }
    }

    /// Reckons all contacts: a loop without branches, to be compiled for the vectors of the processor.
    #[inline(always)]
    pub(super) fn reckon(&mut self, resistance: &impl Resistance, step: f64) {
        let resistance = *resistance;
        for lane in 0..self.filled.min(LANES) {
            let meeting = Meeting::overlapping(&self.sides[0].get(lane), &self.sides[1].get(lane));
            let mut history = History {
                stretch: get(&self.stretch, lane),
                stiffness: self.stiffness[lane],
            };
            let mut rolled = get(&self.rolled, lane);
            let done = resistance.reply(&meeting, (&mut history, &mut rolled), step);
            put(&mut self.stretch, lane, history.stretch);
            self.stiffness[lane] = history.stiffness;
            put(&mut self.rolled, lane, rolled);
            self.overlap[lane] = meeting.overlap;
            put(&mut self.force, lane, done.force);
            put(&mut self.moment, lane, done.moment);
            put(&mut self.moment_on_b, lane, done.moment_on_b);
        }
    }

    /// What a contact does.
    #[inline(always)]
    pub fn reply(&self, lane: usize) -> Reply {
        Reply {
            force: get(&self.force, lane),
            friction: [0.0; 3],
            moment: get(&self.moment, lane),
            moment_on_b: get(&self.moment_on_b, lane),
            push: 0.0,
        }
    }

    /// Gives a contact back to its place what it remembers.
    #[inline(always)]
    pub fn keep(&self, lane: usize, chunk: &mut Chunk, place: usize) {
        chunk.histories[place] = History {
            stretch: get(&self.stretch, lane),
            stiffness: self.stiffness[lane],
        };
        if let Some(rolled) = chunk.rolled.get_mut(place) {
            *rolled = get(&self.rolled, lane);
        }
        chunk.deepest = chunk.deepest.max(self.overlap[lane]);
    }
}
