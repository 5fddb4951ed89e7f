//! Contact of solids that are not, or no longer, one piece: other bodies, fragments, broken particles, plain walls.
//!
//! Two particles that come nearer than the mean of their spacings push each other, and never pull:
//!
//! ```text
//! f = max(0, k delta - c u_n),   delta = (d_a + d_b)/2 - r,   c = 2 zeta sqrt(k m),   m = m_a m_b/(m_a + m_b)
//! ```
//!
//! k is the stiffness of a cell under compression, M V/d^2. At a plain wall delta = d/2 - s. Different bodies that cannot break
//! touch by the balls of `balls`: `(d_a + d_b)/2` is the sum of their radii, k is weighted. Neighbours at rest of one
//! unbroken piece are no contact: what holds them keeps them apart. A particle that broke bears compression alone
//! (Shinohara et al. 2004, section 2.3): it is one of these. Within a body two touch at their distance at rest where that
//! is less: on disturbed lattices, and where cells are no cubes.

use neighbours::Grid;
use particles::{POSITION, Rows, sweep};
use shapes::Body;
use shapes::frame::distance;
use steps::Limit;

use super::balls::{Across, Ball, balls};
use crate::matter::solid::elastic::REST;
use crate::matter::solid::fracture::BROKEN;
use crate::stage::{Course, Entry, Figure, Stage, StageError};
use crate::state::{ACCELERATION, MASS, State, VELOCITY};

/// Neighbours at rest are nearer than so many cells.
const JOINED: f64 = 1.6;
/// Part of the time of a swing in contact that a step may take.
const SWING: f64 = 0.2;
/// Part of a spacing that a particle may go in a step.
const WAY: f64 = 0.1;

/// A solid that takes part.
#[derive(Debug, Clone)]
pub struct Party {
    /// Number of its set.
    pub set: usize,
    /// d \[m\].
    pub spacing: f64,
    /// k \[N/m\].
    pub stiffness: f64,
    /// How deep each particle lies below the surface at rest \[m\]; none of a body that can break.
    pub depths: Vec<f64>,
}

/// What a contact knows of a particle.
#[derive(Debug, Clone, Copy)]
struct Seen {
    x: [f64; 3],
    u: [f64; 3],
    rest: [f64; 3],
    mass: f64,
    party: u32,
    broken: bool,
    ball: Ball,
}

/// The stage.
pub struct Contact {
    parties: Vec<Party>,
    walls: Vec<(String, Body)>,
    /// zeta.
    damping: f64,
    /// The balls of each party; none where all are alike.
    balls: Vec<Vec<Ball>>,
    grid: Grid,
    rows: Rows,
    across: Across,
    seen: Vec<Seen>,
    forces: Vec<[f64; 3]>,
    stored: f64,
    /// Force of all walls on the solids and what damping takes.
    course: Course<4>,
    entry: Entry,
}

impl Contact {
    /// The stage of solids and plain walls.
    #[must_use]
    pub fn new(parties: Vec<Party>, walls: Vec<(String, Body)>, damping: f64) -> Self {
        let reach = parties.iter().fold(0.0_f64, |most, p| most.max(p.spacing));
        let each = parties.iter().map(|p| balls(&p.depths, p.spacing));
        let balls: Vec<Vec<Ball>> = each.collect();
        let counted = balls.iter().flatten().filter(|ball| ball.weight > 0.0);
        let widest = counted.fold(0.5 * reach, |most, ball| most.max(ball.radius));
        Self {
            across: Across::new(widest),
            balls,
            grid: Grid::new(reach),
            rows: Rows::new(),
            seen: Vec::new(),
            forces: vec![[0.0; 3]; walls.len()],
            stored: 0.0,
            course: Course::default(),
            entry: Entry::default(),
            parties,
            walls,
            damping,
        }
    }

    fn look(&mut self, state: &State) {
        self.seen.clear();
        for (number, party) in self.parties.iter().enumerate() {
            let set = &state.sets[party.set];
            let (position, velocity) = (set.column(&POSITION), set.column(&VELOCITY));
            let (rest, mass, broken) = (set.column(&REST), set.column(&MASS), set.column(&BROKEN));
            let alike = Ball {
                radius: 0.5 * party.spacing,
                weight: 1.0,
            };
            let balls = &self.balls[number];
            self.seen.extend((0..set.len()).map(|a| Seen {
                x: position[a],
                u: velocity[a],
                rest: rest[a],
                mass: mass[a],
                party: number as u32,
                broken: broken.get(a).is_some_and(|b| *b > 0),
                ball: balls.get(a).copied().unwrap_or(alike),
            }));
        }
        let places: Vec<[f64; 3]> = self.seen.iter().map(|s| s.x).collect();
        let reach = self
            .parties
            .iter()
            .fold(0.0_f64, |most, p| most.max(p.spacing));
        self.grid.bin(&places);
        self.rows.within(&places, &self.grid, reach);
        let seen = &self.seen;
        self.across.find(seen.len(), self.parties.len(), |a| {
            (seen[a].x, seen[a].party as usize, seen[a].ball.weight)
        });
    }

    /// Whether two particles of a body belong to one unbroken piece, side by side at a distance at rest \[m\].
    fn joined(&self, a: &Seen, b: &Seen, apart: f64) -> bool {
        let whole = !a.broken && !b.broken;
        whole && apart < JOINED * self.parties[a.party as usize].spacing
    }

    /// Force \[N\] along the normal, energy stored \[J\] and power lost \[W\] at an overlap \[m\] and a speed apart \[m/s\].
    fn push(&self, stiffness: f64, mass: f64, overlap: f64, apart: f64) -> [f64; 3] {
        let spring = stiffness * overlap;
        let damper = 2.0 * self.damping * (stiffness * mass).sqrt();
        let force = (spring - damper * apart).max(0.0);
        [force, 0.5 * spring * overlap, (spring - force) * apart]
    }

    /// Force \[N\], energy and loss of one particle by its pairs within its body; of the last two it has half.
    fn pairs(&self, a: usize) -> [f64; 5] {
        let own = &self.seen[a];
        let party = &self.parties[own.party as usize];
        let mut sum = [0.0; 5];
        for other in self.rows.row(a).iter().map(|b| &self.seen[*b as usize]) {
            if own.party != other.party {
                continue;
            }
            let apart = distance(own.rest, other.rest);
            if !self.joined(own, other, apart) {
                // What stood nearer before it broke touches no sooner: nothing may push where nothing is strained.
                let push = self.pair(own, other, party.spacing.min(apart), party.stiffness);
                (0..5).for_each(|k| sum[k] += push[k]);
            }
        }
        sum
    }

    /// The same by its pairs with other bodies; `number` is that among those who may touch.
    fn across(&self, number: usize) -> [f64; 5] {
        let own = &self.seen[self.across.who[number] as usize];
        let k = self.parties[own.party as usize].stiffness;
        let mut sum = [0.0; 5];
        for b in self.across.rows.row(number) {
            let other = &self.seen[self.across.who[*b as usize] as usize];
            if own.party != other.party {
                let theirs = self.parties[other.party as usize].stiffness;
                let stiffness =
                    own.ball.weight * other.ball.weight * 2.0 * k * theirs / (k + theirs);
                let push = self.pair(own, other, own.ball.radius + other.ball.radius, stiffness);
                (0..5).for_each(|k| sum[k] += push[k]);
            }
        }
        sum
    }

    /// The same by a pair that touches at a distance `touch` \[m\].
    fn pair(&self, own: &Seen, other: &Seen, touch: f64, stiffness: f64) -> [f64; 5] {
        let dx = [0, 1, 2].map(|k| own.x[k] - other.x[k]);
        let r = (dx[0] * dx[0] + dx[1] * dx[1] + dx[2] * dx[2]).sqrt();
        let overlap = touch - r;
        if overlap <= 0.0 || r <= 0.0 {
            return [0.0; 5];
        }
        let apart = (0..3).map(|k| (own.u[k] - other.u[k]) * dx[k]).sum::<f64>() / r;
        let mass = own.mass * other.mass / (own.mass + other.mass);
        let [force, stored, lost] = self.push(stiffness, mass, overlap, apart);
        let [x, y, z] = dx.map(|dx| force * dx / r);
        [x, y, z, 0.5 * stored, 0.5 * lost]
    }

    /// Which particles are broken, as last seen.
    fn flags(&self) -> Vec<bool> {
        self.seen.iter().map(|s| s.broken).collect()
    }

    /// Force, energy and loss by pairs that each particle gains because some broke, if any did.
    fn jump(&mut self, before: &[bool]) -> Option<Vec<[f64; 5]>> {
        let now = self.flags();
        if before.len() != now.len() || before == now {
            return None;
        }
        let mut gained = vec![[0.0; 5]; self.seen.len()];
        sweep::fill(&mut gained, |a| self.pairs(a));
        let mark = |seen: &mut [Seen], flags: &[bool]| {
            seen.iter_mut().zip(flags).for_each(|(s, b)| s.broken = *b);
        };
        mark(&mut self.seen, before);
        sweep::change(&mut gained, |a, sum| {
            let before = self.pairs(a);
            (0..5).for_each(|k| sum[k] -= before[k]);
        });
        mark(&mut self.seen, &now);
        Some(gained)
    }

    /// Books the energy that contacts gain because particles broke \[J\]: what breaking costs is less by that.
    fn book(&mut self, gained: &[[f64; 5]]) {
        let [stored] = sweep::sum(gained.len(), |a| [gained[a][3]]);
        self.entry.spent -= stored;
        self.stored += stored;
    }

    /// Adds forces \[N\] to the accelerations of all parties.
    fn accelerate(&self, state: &mut State, forces: &[[f64; 5]]) {
        let mut first = 0;
        for party in &self.parties {
            let set = &mut state.sets[party.set];
            let mut acceleration = set.take(&ACCELERATION);
            let mass = set.column(&MASS);
            sweep::change(&mut acceleration, |a, own| {
                (0..3).for_each(|k| own[k] += forces[first + a][k] / mass[a]);
            });
            first += mass.len();
            set.put(&ACCELERATION, acceleration);
        }
    }

    /// The same by one wall.
    fn wall(&self, a: usize, body: &Body) -> [f64; 5] {
        let own = &self.seen[a];
        let party = &self.parties[own.party as usize];
        let overlap = 0.5 * party.spacing - body.distance(own.x);
        if overlap <= 0.0 {
            return [0.0; 5];
        }
        let normal = body.normal(own.x, 1e-3 * party.spacing);
        let apart: f64 = (0..3).map(|k| own.u[k] * normal[k]).sum();
        let [force, stored, lost] = self.push(2.0 * party.stiffness, own.mass, overlap, apart);
        let [x, y, z] = normal.map(|n| force * n);
        [x, y, z, stored, lost]
    }
}

impl Stage for Contact {
    fn name(&self) -> &'static str {
        "contact"
    }

    fn limit(&self, state: &State) -> Option<Limit> {
        let each = self.parties.iter().map(|party| {
            let set = &state.sets[party.set];
            let velocity = set.column(&VELOCITY);
            let speed = |a: usize| velocity[a][0].hypot(velocity[a][1]).hypot(velocity[a][2]);
            let speed = sweep::greatest(set.len(), speed).map_or(0.0, |(_, most)| most);
            let mass = set.column(&MASS).first().copied().unwrap_or(1.0);
            let swing = SWING * (mass / party.stiffness).sqrt();
            swing.min(WAY * party.spacing / speed)
        });
        Some(Limit::dividing(
            "contact",
            each.fold(f64::INFINITY, f64::min),
        ))
    }

    fn act(&mut self, state: &mut State, dt: f64) -> Result<(), StageError> {
        let before = self.flags();
        self.look(state);
        // What a step turned inside out broke before its forces.
        if let Some(gained) = self.jump(&before) {
            self.book(&gained);
        }
        let mut found = vec![[0.0; 5]; self.seen.len()];
        sweep::fill(&mut found, |a| self.pairs(a));
        let mut met = vec![[0.0; 5]; self.across.who.len()];
        sweep::fill(&mut met, |number| self.across(number));
        for (a, met) in self.across.who.iter().zip(&met) {
            (0..5).for_each(|k| found[*a as usize][k] += met[k]);
        }
        let mut total = [0.0; 3];
        for (number, (_, body)) in self.walls.iter().enumerate() {
            let mut pushed = vec![[0.0; 5]; self.seen.len()];
            sweep::fill(&mut pushed, |a| self.wall(a, body));
            let [x, y, z, ..] = sweep::sum(pushed.len(), |a| pushed[a]);
            self.forces[number] = [-x, -y, -z];
            (0..3).for_each(|k| total[k] -= self.forces[number][k]);
            sweep::change(&mut found, |a, sum| {
                (0..5).for_each(|k| sum[k] += pushed[a][k])
            });
        }
        let [.., stored, lost] = sweep::sum(found.len(), |a| found[a]);
        self.stored = stored;
        let [x, y, z] = total;
        let [x, y, z, lost] = self.course.over(dt, [x, y, z, lost]);
        let given = self.entry.impulse.iter_mut().zip([x, y, z]);
        given.for_each(|(sum, part)| *sum += part);
        self.entry.spent += lost;
        self.accelerate(state, &found);
        Ok(())
    }

    fn exchange(&mut self, state: &mut State, _: f64) -> Result<(), StageError> {
        // What broke since the last forces is a contact from the next step on.
        let broke = |party: &Party| {
            state.sets[party.set]
                .column(&BROKEN)
                .iter()
                .filter(|b| **b > 0)
                .count()
        };
        let broken: usize = self.parties.iter().map(broke).sum();
        let before = self.flags();
        if broken != before.iter().filter(|b| **b).count() {
            self.look(state);
            if let Some(gained) = self.jump(&before) {
                self.book(&gained);
                self.accelerate(state, &gained);
            }
        }
        Ok(())
    }

    fn entry(&self, _: &State) -> Entry {
        Entry {
            stored: self.stored,
            ..self.entry
        }
    }

    fn figures(&self, state: &State) -> Vec<Figure> {
        let walls = self.walls.iter().zip(&self.forces);
        let each = walls.flat_map(|((name, _), force)| {
            let axes = ["x", "y", "z"].iter().zip(*force).take(state.dimensions);
            axes.map(move |(axis, value)| Figure {
                name: format!("solid_force_on_{name}_{axis}"),
                unit: "N",
                value,
            })
        });
        each.collect()
    }

    fn save(&self) -> Vec<f64> {
        let mut saved = [&self.entry.save()[..], &self.course.last(), &[self.stored]].concat();
        saved.extend(self.forces.as_flattened());
        saved
    }

    fn restore(&mut self, state: &State, saved: &[f64]) {
        self.look(state);
        let rest = self.entry.restore(saved);
        if let [stored, forces @ ..] = self.course.restore(rest) {
            self.stored = *stored;
            self.forces.as_flattened_mut().copy_from_slice(forces);
        }
    }
}

#[cfg(test)]
mod tests;
