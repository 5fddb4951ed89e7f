//! How crowded grains are: the contacts that each has and how they lie, and the least slack that they leave.
//!
//! What is listed and apart bears nothing, and what sleeps does not swing: in a contact with a sleeper only the one that is awake
//! does, as at a wall. Contacts are counted anew every few steps, for what has begun to touch since then is hardly pressed.

use contact::Grain;
use rayon::prelude::*;
use shapes::frame::{Vector, along, difference, dot, length};

use super::Motion;
use super::bounds::{Load, Setting, Slack};
use super::depth::{CELL, Depth};
use super::lists::{AT_ONCE, Chunk, Lists, Pair, ROWS};
use super::metal::Metal;
use super::sleep::depth;
use super::walls::Walls;

/// Steps of the grains from one count to the next.
pub(super) const STEPS: u64 = 16;

/// Contacts around a grain.
#[derive(Debug, Clone, Copy, Default)]
struct Around {
    number: f64,
    /// Sum of n.
    sum: Vector,
    /// Sum of n n: xx, yy, zz, yz, zx, xy.
    square: [f64; 6],
}

impl Around {
    fn add(&mut self, [x, y, z]: Vector) {
        self.number += 1.0;
        self.sum = along(self.sum, 1.0, [x, y, z]);
        let squares = [x * x, y * y, z * z, y * z, z * x, x * y];
        for (sum, square) in self.square.iter_mut().zip(squares) {
            *sum += square;
        }
    }

    /// All of the step for a grain with one contact, half of it in a crowd.
    fn lead(&self) -> f64 {
        if self.number > 1.0 { 0.5 } else { 1.0 }
    }

    /// What the grain bears; s of [`super::bounds`].
    fn load(&self, mass: f64, c: f64) -> Load {
        let n = self.number;
        let r = (n - least_eigenvalue(self.square).max(0.0)) / c;
        let joint = 0.5 * (n + r) + (0.5 * (n - r)).hypot(length(self.sum) / c.sqrt());
        Load {
            number: n / mass,
            joint: joint / mass,
        }
    }
}

/// The least eigenvalue of a symmetric matrix xx, yy, zz, yz, zx, xy, by its angle (Smith 1961).
fn least_eigenvalue([xx, yy, zz, yz, zx, xy]: [f64; 6]) -> f64 {
    let mean = (xx + yy + zz) / 3.0;
    let [a, b, c] = [xx - mean, yy - mean, zz - mean];
    let off = yz * yz + zx * zx + xy * xy;
    let p = ((a * a + b * b + c * c + 2.0 * off) / 6.0).sqrt();
    if p <= f64::EPSILON * mean.abs() {
        return mean;
    }
    let half = 0.5 * (a * b * c + 2.0 * yz * zx * xy - a * yz * yz - b * zx * zx - c * xy * xy);
    let angle = (half / (p * p * p)).clamp(-1.0, 1.0).acos() / 3.0;
    mean + 2.0 * p * (angle + std::f64::consts::TAU / 3.0).cos()
}

/// What grains and particles of metal bear.
#[derive(Debug, Clone, Default)]
pub(super) struct Crowd {
    around: Vec<Around>,
    /// By rows, as how much of a step velocities are led on.
    loads: Vec<Load>,
    leads: Vec<f64>,
    /// Contacts by particles of metal.
    on_metal: Vec<f64>,
}

/// A contact as its step is bounded.
#[derive(Debug, Clone, Copy)]
struct Loaded {
    /// Effective mass \[kg\].
    mass: f64,
    /// What its grains bear together.
    load: Load,
    /// The greater of the leads of its grains.
    lead: f64,
}

impl Loaded {
    /// Both grains of a contact.
    fn with(self, other: Self) -> Self {
        Self {
            mass: self.mass * other.mass / (self.mass + other.mass),
            load: self.load + other.load,
            lead: self.lead.max(other.lead),
        }
    }
}

/// Grains as they are seen here: themselves, how deeply they sleep, and what bounds their steps.
#[derive(Clone, Copy)]
struct Seen<'a> {
    grains: &'a [Grain],
    depth: Depth<'a>,
    setting: &'a Setting,
    zeta: f64,
}

impl Seen<'_> {
    /// The slack of a contact.
    fn slack(&self, contact: Loaded) -> Slack {
        let Loaded { mass, load, lead } = contact;
        Slack::of(mass, load, lead * self.zeta, self.setting.inertia_factor)
    }

    fn sleeps(&self, row: usize) -> bool {
        self.depth.asleep(row)
    }

    /// Adds the contacts of the grains of a chunk that are awake, those of lower rows first.
    fn meet(self, lists: &Lists, place: usize, around: &mut [Around]) {
        let (chunk, first) = (&lists.chunks[place], place * ROWS);
        for (cell, around) in around.chunks_mut(CELL).enumerate() {
            if !self.sleeps(first + cell * CELL) {
                around.fill(Around::default());
            }
        }
        let part = self
            .depth
            .part()
            .map(|part| &chunk.parts[part].incoming[..]);
        let number = part.map_or(chunk.incoming.len(), <[u32]>::len);
        let ends = (0..number).map(|k| chunk.incoming[part.map_or(k, |part| part[k] as usize)]);
        for end in ends {
            let (from, row) = (&lists.chunks[end.chunk as usize], end.row as usize);
            let pair = from.pairs[from.place(end)];
            if pair.touches() {
                let a = end.chunk as usize * ROWS + pair.own as usize;
                let normal = self.normal(a, self.grains[first + row].position);
                around[row].add(normal.map(|n| -n));
            }
        }
        for (a, b) in touching(place, chunk, self.depth.part()) {
            let normal = self.normal(a, self.grains[b].position);
            around[a - first].add(normal);
            if let Some(other) = around.get_mut(b - first) {
                other.add(normal.map(|n| -n));
            }
        }
    }

    /// Direction from b to a.
    fn normal(&self, a: usize, b: Vector) -> Vector {
        let way = difference(self.grains[a].position, b);
        let far = dot(way, way).sqrt().max(f64::MIN_POSITIVE);
        way.map(|w| w / far)
    }
}

impl Crowd {
    /// How much of a step the velocities of the rows from a first one on are led on to its end, for dashpots and sliders.
    pub(super) fn leads(&self) -> impl Fn(usize, &mut [f64]) + Sync + '_ {
        |first, leads| {
            let counted = self.leads.get(first..).unwrap_or_default();
            for (lead, counted) in leads.iter_mut().zip(counted) {
                *lead = *counted;
            }
        }
    }

    fn count(&mut self, lists: &Lists, walls: &Walls, metal: Option<&Metal>, seen: Seen<'_>) {
        let rows = seen.grains.len();
        self.around.resize(rows, Around::default());
        self.loads.resize(rows, Load::default());
        self.leads.resize(rows, Around::default().lead());
        let chunks = self.around.par_chunks_mut(ROWS).enumerate();
        let chunks = chunks.with_max_len(AT_ONCE);
        chunks.for_each(|(place, around)| seen.meet(lists, place, around));
        walls.touching(seen.grains, seen.depth, |row, normal| {
            self.around[row].add(normal);
        });
        self.on_metal.clear();
        if let Some(metal) = metal {
            self.on_metal.resize(metal.bodies.len(), 0.0);
            for pair in metal.pairs.iter().filter(|pair| pair.near.touching) {
                let (row, body) = (pair.near.row as usize, pair.body as usize);
                let normal = seen.normal(row, metal.bodies[body].grain.position);
                self.around[row].add(normal);
                self.on_metal[body] += 1.0;
            }
        }
        let c = seen.setting.inertia_factor;
        let cells = self
            .loads
            .par_chunks_mut(CELL)
            .zip(self.leads.par_chunks_mut(CELL));
        let cells = cells.zip(self.around.par_chunks(CELL));
        let cells = cells.zip(seen.grains.par_chunks(CELL)).enumerate();
        let awake = cells
            .with_min_len(ROWS / CELL)
            .with_max_len(AT_ONCE * ROWS / CELL)
            .filter(|(cell, _)| !seen.sleeps(cell * CELL));
        awake.for_each(|(_, (((loads, leads), around), grains))| {
            let each = loads.iter_mut().zip(leads).zip(around).zip(grains);
            for (((load, lead), around), grain) in each {
                (*load, *lead) = (around.load(grain.mass, c), around.lead());
            }
        });
    }

    /// A grain at what does not give way.
    fn alone(&self, row: usize, seen: Seen<'_>) -> Loaded {
        Loaded {
            mass: seen.grains[row].mass,
            load: self.loads[row],
            lead: self.leads[row],
        }
    }

    /// The least slack of two grains that touch.
    fn between(&self, lists: &Lists, seen: Seen<'_>) -> Option<Slack> {
        let chunks = lists.chunks.par_iter().with_max_len(AT_ONCE).enumerate();
        let slacks = chunks.filter_map(|(place, chunk)| {
            let pairs = touching(place, chunk, seen.depth.part()).filter_map(|(a, b)| {
                match (seen.sleeps(a), seen.sleeps(b)) {
                    (true, true) => None,
                    (false, true) => Some(self.alone(a, seen)),
                    (true, false) => Some(self.alone(b, seen)),
                    (false, false) => Some(self.alone(a, seen).with(self.alone(b, seen))),
                }
            });
            match seen.setting.alike {
                Some(_) => most_loaded(pairs, seen),
                None => pairs.map(|pair| seen.slack(pair)).reduce(Slack::least),
            }
        });
        slacks.reduce_with(Slack::least)
    }

    /// The least slack at walls.
    fn at_walls(&self, walls: &Walls, seen: Seen<'_>) -> Option<Slack> {
        let rows = walls.rows_touching(seen.depth);
        let slacks = rows.map(|(row, mirror)| {
            let own = self.alone(row, seen);
            seen.slack(if mirror { own.with(own) } else { own })
        });
        slacks.reduce(Slack::least)
    }

    /// The least slack of contacts with metal: what rests or sleeps gives way to nothing, and what flows does not turn.
    fn with_metal(&self, metal: &Metal, seen: Seen<'_>) -> Option<Slack> {
        let pairs = metal.pairs.iter().filter(|pair| pair.near.touching);
        let slacks = pairs.filter_map(|pair| {
            let (row, body) = (pair.near.row as usize, pair.body as usize);
            let own = self.alone(row, seen);
            let (mass, number) = (metal.bodies[body].grain.mass, self.on_metal[body]);
            let number = number / mass;
            let other = Loaded {
                mass,
                load: Load {
                    number,
                    joint: number,
                },
                lead: 1.0,
            };
            match (seen.sleeps(row), metal.bodies[body].member.is_none()) {
                (true, true) => None,
                (false, true) => Some(seen.slack(own)),
                (true, false) => Some(seen.slack(other)),
                (false, false) => Some(seen.slack(own.with(other))),
            }
        });
        slacks.reduce(Slack::least)
    }
}

/// The least slack of contacts whose effective mass is that of two grains alike, or of one: of equal masses the most loaded has the least.
fn most_loaded(contacts: impl Iterator<Item = Loaded>, seen: Seen<'_>) -> Option<Slack> {
    let mut most: [Option<Loaded>; 4] = [None; 4];
    for contact in contacts {
        let alone = usize::from(contact.mass > 0.75 * seen.setting.lightest);
        let led = usize::from(contact.lead > 0.75);
        let greatest = most[2 * alone + led].get_or_insert(contact);
        let (load, of) = (contact.load, &mut greatest.load);
        of.number = of.number.max(load.number);
        of.joint = of.joint.max(load.joint);
    }
    let slacks = most
        .into_iter()
        .flatten()
        .map(|contact| seen.slack(contact));
    slacks.reduce(Slack::least)
}

/// Rows of the pairs of a chunk that touch, in a part of it or in all.
fn touching(
    place: usize,
    chunk: &Chunk,
    part: Option<usize>,
) -> impl Iterator<Item = (usize, usize)> {
    let part = part.map(|part| &chunk.parts[part].pairs[..]);
    let number = part.map_or(chunk.pairs.len(), <[u32]>::len);
    let pairs = (0..number).map(move |k| part.map_or(k, |part| part[k] as usize));
    let touching = pairs.map(|place| chunk.pairs[place]).filter(Pair::touches);
    touching.map(move |pair| (place * ROWS + pair.own as usize, pair.other as usize))
}

impl Motion {
    /// Contacts of a grain with others that touch, in the mean.
    pub(super) fn contacts(&self) -> f64 {
        let grains = self.moving.grains.len().max(1);
        2.0 * self.lists.touching() as f64 / grains as f64
    }

    /// Counts contacts, and finds the least slack that they leave.
    pub(super) fn count_contacts(&mut self) {
        let (lists, walls, metal) = (&self.lists, &self.walls, self.metal.as_ref());
        let seen = Seen {
            grains: &self.moving.grains,
            depth: Depth::of(depth(&self.sleep), false),
            setting: &self.setting,
            zeta: self.zeta,
        };
        self.crowd.count(lists, walls, metal, seen);
        let found = [
            self.crowd.between(lists, seen),
            self.crowd.at_walls(walls, seen),
            metal.and_then(|metal| self.crowd.with_metal(metal, seen)),
        ];
        let alone = self.setting.pair(self.zeta);
        let least = found.into_iter().flatten().fold(alone, Slack::least);
        // Springs of rolling are not among those whose eigenvalue is known.
        let joint = if self.rolling.is_some() {
            0.0
        } else {
            least.joint
        };
        self.doing.slack = Slack { joint, ..least };
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn eigenvalues_are_those_of_known_matrices() {
        let close = |found: f64, told: f64| (found - told).abs() < 1e-12;
        assert!(close(least_eigenvalue([3.0, 1.0, 2.0, 0.0, 0.0, 0.0]), 1.0));
        assert!(close(least_eigenvalue([2.0, 2.0, 2.0, 0.0, 0.0, 0.0]), 2.0));
        // (1, 1, 1) has 3, what is across it 0.
        assert!(close(least_eigenvalue([1.0; 6]), 0.0));
        // 2 + 2 cos(k pi / 4) of a chain of three.
        let chain = [2.0, 2.0, 2.0, 1.0, 0.0, 1.0];
        assert!(close(least_eigenvalue(chain), 2.0 - 2.0_f64.sqrt()));
    }

    #[test]
    fn a_contact_alone_bears_what_a_pair_bears_and_one_in_a_lattice_less() {
        let mut one = Around::default();
        one.add([0.6, 0.0, 0.8]);
        let load = one.load(1.0, 0.4);
        assert!((load.joint - 3.5).abs() < 1e-12, "{load:?}");
        // Six neighbours of a cubic lattice: turning stretches four of them, 4 / c.
        let mut six = Around::default();
        for k in 0..3 {
            for sign in [-1.0, 1.0] {
                let mut normal = [0.0; 3];
                normal[k] = sign;
                six.add(normal);
            }
        }
        let load = six.load(2.0, 0.4);
        assert!((load.joint - 5.0).abs() < 1e-12, "{load:?}");
        assert!((load.number - 3.0).abs() < 1e-12);
    }
}
