//! Contacts of grains: each is reckoned once, for both of its grains.
//!
//! A chunk goes over its pairs. Those that go on touching are many and alike: they wait until there are [`LANES`] of them, which
//! are reckoned at a time. Those that begin or end are reckoned at once. What a contact does to the grain of the other row is taken
//! at once where it is a row of the same chunk, and fetched by the other chunk afterwards where it is not. So every grain
//! adds in an order that hangs on the list alone, not on threads.

use contact::{Contact, Grain, History, Meeting, Normal, Reply};
use rayon::prelude::*;
use shapes::frame::{Vector, difference, dot};

use super::block::{Block, LANES};
use super::depth::{CELL, Depth, Reckoned};
use super::law::Laws;
use super::lists::{AT_ONCE, Chunk, Incoming, Lists, Push, ROWS, Touch};
use super::resistance::{Resistance, Sliding, SlidingAndRolling};

/// Forces \[N\] and moments \[N m\] of the contacts of all grains with each other after a step of `step` \[s\], but of those that stay as
/// they are by `depth`.
pub fn act<N: Normal + Copy + Sync>(
    lists: &mut Lists,
    seen: Reckoned<'_>,
    laws: Laws<'_, N>,
    step: f64,
    [force, moment]: [&mut [Vector]; 2],
) {
    let Reckoned { grains, depth } = seen;
    let Laws { contact, rolling } = laws;
    let sums = force.par_chunks_mut(ROWS).zip(moment.par_chunks_mut(ROWS));
    let chunks = lists.chunks.par_iter_mut().zip(sums).enumerate();
    let chunks = chunks.with_max_len(AT_ONCE);
    chunks.for_each(|(c, (chunk, (force, moment)))| {
        if depth.part().is_some_and(|part| chunk.parts[part].rests()) {
            return;
        }
        let work = Work {
            grains,
            depth,
            contact,
            first: c * ROWS,
            step,
        };
        let sums = [force, moment];
        let arch = pulp::Arch::new();
        match rolling {
            None => arch.dispatch(Wide(work, chunk, sums, Sliding(*contact))),
            Some(rolling) => {
                arch.dispatch(Wide(
                    work,
                    chunk,
                    sums,
                    SlidingAndRolling(*contact, rolling),
                ));
            }
        }
    });
    fetch(lists, depth, [force, moment]);
}

/// Adds what pairs of other chunks do to the grains of each.
fn fetch(lists: &Lists, depth: Depth<'_>, [force, moment]: [&mut [Vector]; 2]) {
    let sums = force.par_chunks_mut(ROWS).zip(moment.par_chunks_mut(ROWS));
    let chunks = lists.chunks.par_iter().zip(sums).with_max_len(AT_ONCE);
    chunks.for_each(|(chunk, (force, moment))| {
        let mut add = |incoming: &Incoming| {
            let row = incoming.row as usize;
            let from = &lists.chunks[incoming.chunk as usize];
            let push = from.outgoing[incoming.number as usize];
            for k in 0..3 {
                force[row][k] -= push.force[k];
                moment[row][k] += push.moment[k];
            }
        };
        match depth.part() {
            None => chunk.incoming.iter().for_each(add),
            Some(part) => {
                let ends = chunk.parts[part].incoming.iter();
                ends.for_each(|number| add(&chunk.incoming[*number as usize]));
            }
        }
    });
}

/// A chunk, its sums and what resists, to be reckoned in the widest vectors that the machine has. No operation is fused or
/// reordered for it.
struct Wide<'a, N, R>(Work<'a, N>, &'a mut Chunk, [&'a mut [Vector]; 2], R);

impl<N: Normal, R: Resistance> pulp::NullaryFnOnce for Wide<'_, N, R> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let Self(work, chunk, sums, resistance) = self;
        let Some(part) = work.depth.part() else {
            chunk.outgoing.fill(Push::default());
            let places = 0..chunk.pairs.len();
            return work.each(places, chunk, sums, &resistance);
        };
        let awake = std::mem::take(&mut chunk.parts[part].pairs);
        let places = awake.iter().map(|place| *place as usize);
        for place in places.clone().rev().take_while(|p| *p >= chunk.inner) {
            chunk.outgoing[place - chunk.inner] = Push::default();
        }
        work.each(places, chunk, sums, &resistance);
        chunk.parts[part].pairs = awake;
    }
}

/// What the contacts of a chunk are reckoned from.
struct Work<'a, N> {
    grains: &'a [Grain],
    depth: Depth<'a>,
    contact: &'a Contact<N>,
    first: usize,
    step: f64,
}

/// Contacts of a chunk that go on and wait to be reckoned together.
#[derive(Default)]
struct Waiting {
    block: Block,
    places: [u32; LANES],
    number: usize,
}

impl<N: Normal> Work<'_, N> {
    #[inline(always)]
    fn each(
        &self,
        places: impl Iterator<Item = usize>,
        chunk: &mut Chunk,
        [force, moment]: [&mut [Vector]; 2],
        resistance: &impl Resistance,
    ) {
        let cells = force.chunks_mut(CELL).zip(moment.chunks_mut(CELL));
        for (cell, (force, moment)) in cells.enumerate() {
            if !self.depth.kept(self.first + cell * CELL) {
                force.fill([0.0; 3]);
                moment.fill([0.0; 3]);
            }
        }
        chunk.deepest = 0.0;
        let mut waiting = Waiting::default();
        for place in places {
            let pair = chunk.pairs[place];
            let (a, b) = (self.first + pair.own as usize, pair.other as usize);
            let touches = self.touch(a, b);
            let goes_on = touches & (pair.state == Touch::Touching);
            let stays_away = !touches & (pair.state == Touch::Apart);
            // Written each time and counted where it goes on: no branch to be guessed wrong.
            waiting.places[waiting.number] = place as u32;
            waiting.number += usize::from(goes_on);
            if !(goes_on | stays_away)
                && let Some(done) = self.turn(chunk, place, resistance)
            {
                self.add(chunk, place, [force, moment], &done);
            }
            if waiting.number == LANES {
                self.go_on(&mut waiting, chunk, [force, moment], resistance);
            }
        }
        self.go_on(&mut waiting, chunk, [force, moment], resistance);
    }

    /// Contacts that go on, side by side.
    #[inline(always)]
    fn go_on(
        &self,
        waiting: &mut Waiting,
        chunk: &mut Chunk,
        sums: [&mut [Vector]; 2],
        resistance: &impl Resistance,
    ) {
        let [force, moment] = sums;
        let (block, places) = (&mut waiting.block, &waiting.places[..waiting.number]);
        block.gather(self.grains, self.first, chunk, places);
        block.reckon(resistance, self.step);
        for (lane, place) in places.iter().enumerate() {
            let place = *place as usize;
            block.keep(lane, chunk, place);
            self.add(chunk, place, [force, moment], &block.reply(lane));
        }
        waiting.number = 0;
    }

    /// Whether two grains touch.
    #[inline(always)]
    fn touch(&self, a: usize, b: usize) -> bool {
        let (a, b) = (&self.grains[a], &self.grains[b]);
        let apart = difference(a.position, b.position);
        let (squared, reach) = (dot(apart, apart), a.radius + b.radius);
        (squared < reach * reach) & (squared > f64::MIN_POSITIVE)
    }

    /// The first or the last that a contact does.
    #[cold]
    fn turn(&self, chunk: &mut Chunk, place: usize, resistance: &impl Resistance) -> Option<Reply> {
        let pair = &mut chunk.pairs[place];
        let a = &self.grains[self.first + pair.own as usize];
        let b = &self.grains[pair.other as usize];
        let mut still = [0.0; 3];
        let rolled = chunk.rolled.get_mut(place).unwrap_or(&mut still);
        let history = &mut chunk.histories[place];
        if let Some(meeting) = Meeting::of(a, b) {
            chunk.deepest = chunk.deepest.max(meeting.overlap);
            let (meeting, step) = meeting.begun(self.step);
            pair.state = Touch::Touching;
            return Some(resistance.reply(&meeting, (history, rolled), step));
        }
        let pulls = pair.state == Touch::Touching && self.contact.normal.pulls_at_the_end();
        (*history, *rolled) = (History::default(), [0.0; 3]);
        pair.state = Touch::Apart;
        let parted = if pulls { Meeting::parted(a, b) } else { None };
        let meeting = parted?.ended(self.step);
        pair.state = Touch::Parting;
        let push = self.contact.normal.push(&meeting);
        Some(Reply {
            force: meeting.normal.map(|n| push * n),
            friction: [0.0; 3],
            moment: [0.0; 3],
            moment_on_b: [0.0; 3],
            push,
        })
    }

    /// Adds what a contact does to both of its grains.
    #[inline(always)]
    fn add(
        &self,
        chunk: &mut Chunk,
        place: usize,
        [force, moment]: [&mut [Vector]; 2],
        done: &Reply,
    ) {
        let pair = chunk.pairs[place];
        let a = pair.own as usize;
        if !self.depth.kept(self.first + a) {
            for k in 0..3 {
                force[a][k] += done.force[k];
                moment[a][k] += done.moment[k];
            }
        }
        if place < chunk.inner {
            let b = pair.other as usize - self.first;
            if self.depth.kept(self.first + b) {
                return;
            }
            for k in 0..3 {
                force[b][k] -= done.force[k];
                moment[b][k] += done.moment_on_b[k];
            }
        } else {
            chunk.outgoing[place - chunk.inner] = Push {
                force: done.force,
                moment: done.moment_on_b,
            };
        }
    }
}
