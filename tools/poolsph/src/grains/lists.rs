//! Who may touch whom: lists that last while nobody has moved far.
//!
//! A list holds pairs of grains that are nearer than touching plus a skin, each for the grain of the lower row, by the row of the
//! other. It depends on places alone, and where those were when it was made is a column: a run that is taken up makes
//! the same list again.
//!
//! Rows are in the order of cells ([`super::order`]), and [`ROWS`] of them make a chunk: some eight grains along each side. A
//! chunk holds its inner pairs first, both of whose grains are its own, and then those with a grain of a later chunk.

use std::ops::Range;

use contact::{Grain, History};
use neighbours::Grid;
use rayon::prelude::*;
use shapes::frame::{Vector, difference, squared};

use super::again::Again;
use super::depth::{CELL, Depth};
use super::memory::Memory;

/// Rows of a chunk, the unit of parallel work.
pub const ROWS: usize = 512;
/// Chunks that a thread takes at once at most: those that are awake, or are listed again, lie together.
pub const AT_ONCE: usize = 4;
/// Skin over the least radius. Wider lists last longer and cost more in each step.
const SKIN: f64 = 0.4;
/// Part of the skin up to which a grain that has moved keeps the place at which it is listed.
const KEPT: f64 = 0.125;

/// Two grains that may touch.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Pair {
    /// Row of the other grain.
    pub other: u32,
    /// Row of the lower grain within its chunk.
    pub own: u16,
    /// What the pair does.
    pub state: Touch,
}

impl Pair {
    /// Whether it touches.
    #[inline]
    #[must_use]
    pub fn touches(&self) -> bool {
        self.state == Touch::Touching
    }
}

/// What a pair does.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Touch {
    /// It is apart.
    Apart,
    /// It touches.
    Touching,
    /// It has just parted, and something is still to be made good.
    Parting,
}

/// What a contact does to the grain of the higher row, to be taken away from its force and added to its moment.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Push {
    /// Force on the grain of the lower row \[N\].
    pub force: Vector,
    /// Moment on the grain of the higher row \[N m\].
    pub moment: Vector,
}

/// A pair whose higher row is one of a chunk, and whose lower row is not.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Incoming {
    /// The higher row within its chunk.
    pub row: u32,
    /// Chunk of the lower row.
    pub chunk: u32,
    /// Number among the outgoing pairs there.
    pub number: u32,
}

/// Pairs of [`ROWS`] consecutive rows.
#[derive(Debug, Clone, Default)]
pub struct Chunk {
    /// Pairs whose lower row is one of these, by rows; those whose other row is too come first.
    pub pairs: Vec<Pair>,
    /// How many come first.
    pub inner: usize,
    /// The spring across each pair.
    pub histories: Vec<History>,
    /// Springs of rolling; none where nothing resists rolling.
    pub rolled: Vec<Vector>,
    /// What the outgoing pairs do, those that are not inner.
    pub outgoing: Vec<Push>,
    /// Pairs of other chunks that end in this one.
    pub incoming: Vec<Incoming>,
    /// Greatest overlap \[m\].
    pub deepest: f64,
    /// Cells of its rows that share a pair with others, by cells.
    pub cells: Vec<[u32; 2]>,
    /// What of it is reckoned where some sleep: in all steps but the last of a step of the run, and in the last.
    pub parts: [Part; 2],
}

/// What of a chunk is reckoned where grains sleep.
#[derive(Debug, Clone, Default)]
pub struct Part {
    /// Whether the forces of all its rows stay as they are.
    pub kept: bool,
    /// Places of the pairs that are reckoned.
    pub pairs: Vec<u32>,
    /// Numbers of the incoming pairs that end in rows whose forces do not stay.
    pub incoming: Vec<u32>,
}

impl Part {
    /// Whether nothing is reckoned.
    #[must_use]
    pub fn rests(&self) -> bool {
        self.kept && self.pairs.is_empty()
    }

    fn find(&mut self, chunk: (&[Pair], &[Incoming]), rows: Range<usize>, depth: Depth<'_>) {
        let (pairs, incoming) = chunk;
        let first = rows.start;
        self.kept = rows.step_by(CELL).all(|row| depth.kept(row));
        self.pairs.clear();
        let moves =
            |(_, pair): &(u32, &Pair)| !depth.still(first + pair.own as usize, pair.other as usize);
        let places = (0..).zip(pairs).filter(moves);
        self.pairs.extend(places.map(|(place, _)| place));
        self.incoming.clear();
        if !self.kept {
            let ends = (0..).zip(incoming);
            let ends = ends.filter(|(_, incoming)| !depth.kept(first + incoming.row as usize));
            self.incoming.extend(ends.map(|(number, _)| number));
        }
    }
}

/// Where pairs are looked for.
struct Search<'a> {
    grains: &'a [Grain],
    /// Where they are listed \[m\].
    places: &'a [Vector],
    grid: &'a Grid,
    /// Beyond touching \[m\].
    skin: f64,
    /// Radius of the largest grain \[m\].
    widest: f64,
}

impl Chunk {
    /// Place of an incoming pair among the pairs of this chunk, which it comes from.
    #[inline]
    #[must_use]
    pub fn place(&self, incoming: Incoming) -> usize {
        self.inner + incoming.number as usize
    }

    fn list(&mut self, first: usize, search: &Search<'_>) {
        let Search {
            grains,
            places,
            grid,
            skin,
            widest,
        } = *search;
        self.pairs.clear();
        let end = (first + ROWS).min(grains.len());
        let mut outgoing: Vec<Pair> = Vec::new();
        for a in first..end {
            let (own, place) = (&grains[a], places[a]);
            let starts = (self.pairs.len(), outgoing.len());
            let reach = own.radius + widest + skin;
            let far = own.radius + skin;
            grid.runs(place, reach, |run| {
                for (at, b) in grid.sorted()[run.clone()].iter().zip(&grid.order()[run]) {
                    if (*b as usize) > a {
                        let within = far + grains[*b as usize].radius;
                        if squared(difference(place, *at)) < within * within {
                            let pair = Pair {
                                other: *b,
                                own: (a - first) as u16,
                                state: Touch::Apart,
                            };
                            if (*b as usize) < end {
                                self.pairs.push(pair);
                            } else {
                                outgoing.push(pair);
                            }
                        }
                    }
                }
            });
            self.pairs[starts.0..].sort_unstable_by_key(|pair| pair.other);
            outgoing[starts.1..].sort_unstable_by_key(|pair| pair.other);
        }
        self.inner = self.pairs.len();
        self.pairs.append(&mut outgoing);
        self.cells.clear();
        let cells = self.pairs.iter().map(|pair| {
            let (a, b) = (first + pair.own as usize, pair.other as usize);
            [(a / CELL) as u32, (b / CELL) as u32]
        });
        self.cells.extend(cells.filter(|[a, b]| a != b));
        self.cells.sort_unstable();
        self.cells.dedup();
        let number = self.pairs.len();
        self.histories.clear();
        self.histories.resize(number, History::default());
        self.outgoing.resize(number - self.inner, Push::default());
    }

    /// Gives the pairs what they remember: `memories` are those of the rows from `first` on.
    fn remember(&mut self, first: usize, memories: &[Memory]) {
        for memory in memories {
            let own = (memory.row as usize - first) as u16;
            let inner = (memory.other as usize) < first + ROWS;
            let (start, part) = if inner {
                (0, &self.pairs[..self.inner])
            } else {
                (self.inner, &self.pairs[self.inner..])
            };
            let found = part.binary_search_by_key(&(own, memory.other), |p| (p.own, p.other));
            // What has parted beyond the skin within a step is forgotten.
            let Ok(place) = found.map(|place| start + place) else {
                continue;
            };
            self.pairs[place].state = Touch::Touching;
            self.histories[place] = memory.history;
            if let Some(rolled) = self.rolled.get_mut(place) {
                *rolled = memory.rolled;
            }
        }
    }
}

/// All pairs.
#[derive(Debug, Clone)]
pub struct Lists {
    grid: Option<Grid>,
    /// By chunks of rows.
    pub chunks: Vec<Chunk>,
    rows: usize,
    /// Chunks that need not be listed again.
    pub again: Again,
    rolls: bool,
}

impl Lists {
    /// No lists; `rolls` where contacts have springs of rolling.
    #[must_use]
    pub fn new(rolls: bool) -> Self {
        Self {
            grid: None,
            chunks: Vec::new(),
            rows: 0,
            again: Again::default(),
            rolls,
        }
    }

    /// Width of the skin \[m\] for a least radius.
    #[must_use]
    pub fn skin(least_radius: f64) -> f64 {
        SKIN * least_radius
    }

    /// Lists the pairs of `grains` at the `places` \[m\] whose radii go from `least` to `widest` \[m\], but in chunks whose pairs stay;
    /// `memories` of the others, by rows, go along.
    pub fn list(
        &mut self,
        grains: &[Grain],
        places: &[Vector],
        [least, widest]: [f64; 2],
        memories: &[Memory],
    ) {
        let skin = Self::skin(least);
        let edge = 2.0 * widest + skin;
        let grid = self.grid.get_or_insert_with(|| Grid::new(edge));
        grid.bin(places);
        let count = grains.len().div_ceil(ROWS);
        self.chunks.resize_with(count, Chunk::default);
        let rolls = self.rolls;
        let search = Search {
            grains,
            places,
            grid,
            skin,
            widest,
        };
        let chunks = self.chunks.par_iter_mut().with_max_len(AT_ONCE).enumerate();
        let listed = chunks.filter(|(c, _)| !self.again.stays(*c));
        listed.for_each(|(c, chunk)| {
            let first = c * ROWS;
            chunk.list(first, &search);
            chunk.rolled.clear();
            if rolls {
                chunk.rolled.resize(chunk.pairs.len(), [0.0; 3]);
            }
            let from = |row: usize| memories.partition_point(|m| (m.row as usize) < row);
            chunk.remember(first, &memories[from(first)..from(first + ROWS)]);
        });
        self.rows = grains.len();
        self.turn_round();
    }

    /// Finds for each chunk the pairs of others that end in it.
    fn turn_round(&mut self) {
        for chunk in &mut self.chunks {
            chunk.incoming.clear();
        }
        for c in 0..self.chunks.len() {
            let inner = self.chunks[c].inner;
            for place in inner..self.chunks[c].pairs.len() {
                let other = self.chunks[c].pairs[place].other as usize;
                self.chunks[other / ROWS].incoming.push(Incoming {
                    row: (other % ROWS) as u32,
                    chunk: c as u32,
                    number: (place - inner) as u32,
                });
            }
        }
    }

    /// Brings the places at which `grains` are `listed` \[m\], whose radii go from `least` to `widest` \[m\], to where those are that have
    /// gone farther than a part of the skin, and marks the chunks whose pairs stay.
    pub fn mark_again(
        &mut self,
        grains: &[Grain],
        listed: &mut [Vector],
        [least, widest]: [f64; 2],
    ) {
        let skin = Self::skin(least);
        let within = [KEPT * skin, 2.0 * widest + skin];
        self.again.find(grains, listed, ROWS, within);
    }

    /// Finds what of each chunk is reckoned where cells sleep by `depth`.
    pub fn rest(&mut self, depth: &[u8]) {
        let rows = self.rows;
        let chunks = self.chunks.par_iter_mut().with_max_len(AT_ONCE).enumerate();
        chunks.for_each(|(c, chunk)| {
            if depth.is_empty() {
                chunk.parts = Default::default();
                return;
            }
            let own = c * ROWS..rows.min((c + 1) * ROWS);
            let all = (&chunk.pairs[..], &chunk.incoming[..]);
            for (part, depth) in chunk.parts.iter_mut().zip(Depth::both(depth)) {
                part.find(all, own.clone(), depth);
            }
        });
    }

    /// Contacts that touch, by the chunks of their lower rows; those of chunks whose pairs stay if `all` are wanted.
    pub fn memories(&self, memories: &mut Vec<Memory>, all: bool) {
        memories.clear();
        let chunks = self.chunks.iter().enumerate();
        for (c, chunk) in chunks.filter(|(c, _)| all || !self.again.stays(*c)) {
            let touching = chunk.pairs.iter().enumerate();
            let touching = touching.filter(|(_, pair)| pair.state == Touch::Touching);
            memories.extend(touching.map(|(place, pair)| Memory {
                row: (c * ROWS) as u32 + u32::from(pair.own),
                other: pair.other,
                history: chunk.histories[place],
                rolled: chunk.rolled.get(place).copied().unwrap_or_default(),
            }));
        }
    }

    /// Pairs that touch.
    #[must_use]
    pub fn touching(&self) -> usize {
        let pairs = self.chunks.iter().flat_map(|chunk| &chunk.pairs);
        pairs.filter(|pair| pair.state == Touch::Touching).count()
    }

    /// Bytes held.
    #[must_use]
    pub fn bytes(&self) -> usize {
        let chunk = |c: &Chunk| {
            size_of::<Pair>() * c.pairs.capacity()
                + size_of::<History>() * c.histories.capacity()
                + size_of::<Vector>() * c.rolled.capacity()
                + size_of::<Push>() * c.outgoing.capacity()
                + size_of::<Incoming>() * c.incoming.capacity()
        };
        self.chunks.iter().map(chunk).sum()
    }
}
