//! Who may touch whom: lists that last while nobody has moved far.
//!
//! A list holds pairs of grains that are nearer than touching plus a skin, each for the grain of the lower row, by the row of the
//! other. It depends on places alone, and where those were when it was made is a column: a run that is taken up makes
//! the same list again.

use contact::{Grain, History};
use neighbours::Grid;
use rayon::prelude::*;
use shapes::frame::Vector;

use super::bounds::Slack;

/// Rows of a chunk, the unit of parallel work.
pub const ROWS: usize = 256;
/// Skin over the least radius. Wider lists last longer and cost more in each step.
const SKIN: f64 = 0.25;

/// A pair and what its contact remembers.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pair {
    /// Row of the other grain.
    pub other: u32,
    /// Row of the lower grain within its chunk.
    own: u8,
    /// What it does.
    pub state: Touch,
    /// The spring across the contact.
    pub history: History,
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

/// What a contact does.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Action {
    /// Force on the grain of the lower row \[N\].
    pub force: Vector,
    /// Moment on it \[N m\].
    pub moment: Vector,
    /// Moment on the other \[N m\].
    pub moment_on_other: Vector,
}

/// A contact that is remembered beyond its list.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Memory {
    /// Row of a grain.
    pub row: u32,
    /// Row of a higher one, or the number of a wall.
    pub other: u32,
    /// The spring across.
    pub history: History,
    /// The spring of rolling \[m\].
    pub rolled: Vector,
}

impl Memory {
    /// As numbers.
    #[must_use]
    pub fn save(&self) -> [f64; 9] {
        let ([x, y, z], [p, q, r]) = (self.history.stretch, self.rolled);
        let rows = [f64::from(self.row), f64::from(self.other)];
        [rows[0], rows[1], x, y, z, self.history.stiffness, p, q, r]
    }

    /// From the numbers of [`Memory::save`].
    #[must_use]
    pub fn restored([row, other, x, y, z, stiffness, p, q, r]: [f64; 9]) -> Self {
        Self {
            row: row as u32,
            other: other as u32,
            history: History {
                stretch: [x, y, z],
                stiffness,
            },
            rolled: [p, q, r],
        }
    }
}

/// Pairs of [`ROWS`] consecutive rows.
#[derive(Debug, Clone, Default)]
pub struct Chunk {
    /// Ends of the rows within `pairs`.
    ends: Vec<u32>,
    /// Pairs whose lower row is one of these.
    pub pairs: Vec<Pair>,
    /// Springs of rolling; none where nothing resists rolling.
    pub rolled: Vec<Vector>,
    /// What each pair does.
    pub actions: Vec<Action>,
    /// Ends of the rows within `incoming`.
    incoming_ends: Vec<u32>,
    /// Chunk and place of the pairs whose higher row is one of these.
    incoming: Vec<[u32; 2]>,
    /// Greatest overlap \[m\].
    pub deepest: f64,
}

impl Chunk {
    /// Places of the pairs of the row with number `k` of the chunk.
    #[inline]
    #[must_use]
    pub fn row(&self, k: usize) -> std::ops::Range<usize> {
        range(&self.ends, k)
    }

    /// Rows.
    #[must_use]
    pub fn rows(&self) -> usize {
        self.ends.len()
    }

    /// Chunk and place of the pairs in which the row with number `k` is the higher one.
    #[inline]
    #[must_use]
    pub fn incoming(&self, k: usize) -> &[[u32; 2]] {
        &self.incoming[range(&self.incoming_ends, k)]
    }

    fn list(&mut self, first: usize, (grains, grid): (&[Grain], &Grid), skin: (f64, f64)) {
        let (skin, widest) = skin;
        self.ends.clear();
        self.pairs.clear();
        let end = (first + ROWS).min(grains.len());
        for (a, own) in grains.iter().enumerate().take(end).skip(first) {
            let start = self.pairs.len();
            let reach = own.radius + widest + skin;
            grid.runs(own.position, reach, |run| {
                for (at, b) in grid.sorted()[run.clone()].iter().zip(&grid.order()[run]) {
                    let far = own.radius + skin;
                    if (*b as usize) > a {
                        let within = far + grains[*b as usize].radius;
                        if squared(own.position, *at) < within * within {
                            self.pairs.push(Pair {
                                other: *b,
                                own: (a - first) as u8,
                                state: Touch::Apart,
                                history: History::default(),
                            });
                        }
                    }
                }
            });
            self.pairs[start..].sort_unstable_by_key(|pair| pair.other);
            self.ends.push(self.pairs.len() as u32);
        }
        self.actions.resize(self.pairs.len(), Action::default());
    }
}

#[inline]
fn range(ends: &[u32], k: usize) -> std::ops::Range<usize> {
    let start = if k == 0 { 0 } else { ends[k - 1] };
    start as usize..ends[k] as usize
}

#[inline]
fn squared(a: Vector, b: Vector) -> f64 {
    let d = [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
    d[0] * d[0] + d[1] * d[1] + d[2] * d[2]
}

/// All pairs.
#[derive(Debug, Clone)]
pub struct Lists {
    grid: Option<Grid>,
    places: Vec<Vector>,
    /// By chunks of rows.
    pub chunks: Vec<Chunk>,
    /// Contacts of each row, those that are still apart among them.
    pub contacts: Vec<u32>,
    rolls: bool,
}

impl Lists {
    /// No lists; `rolls` where contacts have springs of rolling.
    #[must_use]
    pub fn new(rolls: bool) -> Self {
        Self {
            grid: None,
            places: Vec::new(),
            chunks: Vec::new(),
            contacts: Vec::new(),
            rolls,
        }
    }

    /// Width of the skin \[m\] for a least radius.
    #[must_use]
    pub fn skin(least_radius: f64) -> f64 {
        SKIN * least_radius
    }

    /// Lists the pairs of `grains` whose radii go from `least` to `widest` \[m\]; `memories`, by rows, go along.
    pub fn list(&mut self, grains: &[Grain], [least, widest]: [f64; 2], memories: &[Memory]) {
        let skin = Self::skin(least);
        let edge = 2.0 * widest + skin;
        self.places.clear();
        self.places.extend(grains.iter().map(|g| g.position));
        let grid = self.grid.get_or_insert_with(|| Grid::new(edge));
        grid.bin(&self.places);
        let count = grains.len().div_ceil(ROWS);
        self.chunks.resize_with(count, Chunk::default);
        let (grid, rolls) = (&*grid, self.rolls);
        let chunks = self.chunks.par_iter_mut().enumerate();
        chunks.for_each(|(c, chunk)| {
            chunk.list(c * ROWS, (grains, grid), (skin, widest));
            chunk.rolled.clear();
            if rolls {
                chunk.rolled.resize(chunk.pairs.len(), [0.0; 3]);
            }
            remember(chunk, c * ROWS, memories);
        });
        self.turn_round(grains.len());
    }

    /// Finds for each row the pairs in which it is the higher one, by the lower.
    fn turn_round(&mut self, rows: usize) {
        self.contacts.clear();
        self.contacts.resize(rows, 0);
        for chunk in &self.chunks {
            for pair in &chunk.pairs {
                self.contacts[pair.other as usize] += 1;
            }
        }
        let chunks = self.chunks.iter_mut().enumerate();
        for (c, chunk) in chunks {
            let mut end = 0;
            chunk.incoming_ends.clear();
            for k in 0..chunk.ends.len() {
                // The start for now: filling moves it to the end.
                chunk.incoming_ends.push(end);
                end += self.contacts[c * ROWS + k];
            }
            chunk.incoming.clear();
            chunk.incoming.resize(end as usize, [0; 2]);
        }
        for c in 0..self.chunks.len() {
            for k in 0..self.chunks[c].ends.len() {
                let row = self.chunks[c].row(k);
                self.contacts[c * ROWS + k] += row.len() as u32;
                for place in row {
                    let other = self.chunks[c].pairs[place].other as usize;
                    let to = &mut self.chunks[other / ROWS];
                    let next = &mut to.incoming_ends[other % ROWS];
                    to.incoming[*next as usize] = [c as u32, place as u32];
                    *next += 1;
                }
            }
        }
    }

    /// Row of the lower grain of a pair by its chunk and place.
    #[inline]
    #[must_use]
    pub fn lower(&self, chunk: usize, place: usize) -> usize {
        chunk * ROWS + self.chunks[chunk].pairs[place].own as usize
    }

    /// Contacts that touch, by rows.
    pub fn memories(&self, memories: &mut Vec<Memory>) {
        memories.clear();
        for (c, chunk) in self.chunks.iter().enumerate() {
            for k in 0..chunk.rows() {
                let row = (c * ROWS + k) as u32;
                memories.extend(chunk.row(k).filter_map(|place| {
                    let pair = &chunk.pairs[place];
                    (pair.state == Touch::Touching).then(|| Memory {
                        row,
                        other: pair.other,
                        history: pair.history,
                        rolled: chunk.rolled.get(place).copied().unwrap_or_default(),
                    })
                }));
            }
        }
    }

    /// Least slack of all pairs; `walls` tells how many walls a row may touch.
    #[must_use]
    pub fn slack(&self, grains: &[Grain], walls: &[u32], (zeta, c): (f64, f64)) -> Option<Slack> {
        let number = |a: usize| f64::from(self.contacts[a] + walls.get(a).copied().unwrap_or(0));
        let of = |(place, chunk): (usize, &Chunk)| {
            let rows = (0..chunk.rows()).flat_map(|k| {
                let a = place * ROWS + k;
                let own = number(a) / grains[a].mass;
                let pairs = chunk.pairs[chunk.row(k)].iter();
                pairs.map(move |pair| {
                    let b = pair.other as usize;
                    let (m, n) = (grains[a].mass, grains[b].mass);
                    Slack::of(m * n / (m + n), own + number(b) / n, zeta, c)
                })
            });
            rows.reduce(Slack::least)
        };
        let chunks = self.chunks.par_iter().enumerate();
        chunks.filter_map(of).reduce_with(Slack::least)
    }

    /// Bytes held.
    #[must_use]
    pub fn bytes(&self) -> usize {
        let chunk = |c: &Chunk| {
            size_of::<Pair>() * c.pairs.capacity()
                + 24 * c.rolled.capacity()
                + size_of::<Action>() * c.actions.capacity()
                + 8 * c.incoming.capacity()
                + 8 * c.ends.capacity()
        };
        self.chunks.iter().map(chunk).sum::<usize>() + 28 * self.places.capacity()
    }
}

/// Gives contacts between grains, and those at walls, the rows that are left where some grains leave.
pub fn renumber([between, at_walls]: &mut [Vec<Memory>; 2], leaves: &[bool]) {
    let mut next = 0;
    let each = leaves.iter().map(|leaves| {
        next += u32::from(!leaves);
        (!leaves).then(|| next - 1)
    });
    let rows: Vec<Option<u32>> = each.collect();
    let row = |row: u32| rows[row as usize];
    between.retain_mut(|m| match (row(m.row), row(m.other)) {
        (Some(a), Some(b)) => {
            (m.row, m.other) = (a, b);
            true
        }
        _ => false,
    });
    at_walls.retain_mut(|m| row(m.row).map(|a| m.row = a).is_some());
}

/// Gives the pairs of a chunk what they remember.
fn remember(chunk: &mut Chunk, first: usize, memories: &[Memory]) {
    let mut at = memories.partition_point(|m| (m.row as usize) < first);
    for k in 0..chunk.rows() {
        let row = chunk.row(k);
        while let Some(memory) = memories.get(at).filter(|m| m.row as usize == first + k) {
            at += 1;
            let found = chunk.pairs[row.clone()].binary_search_by_key(&memory.other, |p| p.other);
            // What has parted beyond the skin within a step is forgotten.
            let Ok(place) = found.map(|place| row.start + place) else {
                continue;
            };
            let pair = &mut chunk.pairs[place];
            (pair.state, pair.history) = (Touch::Touching, memory.history);
            if let Some(rolled) = chunk.rolled.get_mut(place) {
                *rolled = memory.rolled;
            }
        }
    }
}
