//! Who may touch whom, of grains and metal: a list made afresh at each step of the metal, and again where someone has strayed.
//!
//! It holds all pairs that are nearer than touching plus a skin, by the rows of the grains and then by the metal. It depends
//! on places alone; contacts that touch and forces that act go along by the numbers of both.

use contact::Grain;
use neighbours::{Grid, Halo};
use particles::POSITION;
use rayon::prelude::*;
use shapes::frame::{Vector, along, difference, dot};

use super::depth::kept;
use super::memory::Memory;
use super::metal::Metal;
use super::metal_pair::{Body, Pair};
use super::near::Near;
use crate::near::Role;
use crate::state::{PHASE, State, phase};

/// Metal is looked for so many skins, and so many times the way of the fastest within a step, beyond what may touch.
const AHEAD: f64 = 2.0;
/// Particles of metal that a thread looks around at once.
const BODIES: usize = 128;
/// Part of a sum of ways that rounding may take.
const ROUNDED: f64 = 1e-6;

impl Metal {
    /// Chooses the grains that are looked at: all, or those whose forces do not stay as they are by `depth` and those
    /// that metal may flow against.
    pub fn see(&mut self, state: &State, grains: &[Grain], depth: &[u8], all: bool) {
        self.seen.clear();
        self.seen.resize(grains.len(), true);
        if !(all || depth.is_empty()) {
            let near = &state.near;
            self.places.clear();
            let flows = near.role.iter().zip(&near.position);
            let flows = flows.filter(|(role, _)| **role == Role::Liquid);
            self.places.extend(flows.map(|(_, x)| *x));
            let reach = 2.0 * (self.widest + self.radius);
            let halo = self.flowing.get_or_insert_with(|| Halo::new(reach));
            halo.mark(&self.places);
            let halo = &*halo;
            let seen = self.seen.par_iter_mut().with_min_len(4096).enumerate();
            seen.for_each(|(row, seen)| {
                *seen = !kept(depth, row) || halo.may_touch(grains[row].position);
            });
        }
        let rows = (0..).zip(&self.seen).filter(|(_, seen)| **seen);
        self.rows.clear();
        self.rows.extend(rows.map(|(row, _)| row));
    }

    /// Puts the contacts of grains aside that stay as they are by `depth`, and what they do to metal at rest.
    pub fn put_aside(&mut self, depth: &[u8]) {
        if depth.is_empty() {
            return;
        }
        for body in &mut self.bodies {
            body.force = [0.0; 3];
        }
        let (bodies, aside) = (&mut self.bodies, &mut self.aside);
        self.pairs.retain(|pair| {
            let body = &mut bodies[pair.body as usize];
            let force = pair.near.reply.map_or([0.0; 3], |reply| reply.force);
            if kept(depth, pair.near.row as usize) {
                let memory = pair.near.memory(body.id);
                aside.extend(memory.map(|memory| (memory, force.map(|f| -f))));
                return false;
            }
            body.force = difference(body.force, force);
            true
        });
    }

    /// Takes the metal near the grains that are looked at, which are no faster than `fastest` \[m/s\], for a step of `dt` \[s\].
    pub fn take(&mut self, state: &State, grains: &[Grain], fastest: f64, dt: f64) {
        self.remember();
        self.bring_back();
        let speed = fastest + state.near.fastest_squared().sqrt();
        let ahead = AHEAD * (self.skin + dt * speed);
        // Metal no number away is near: the flow tells of it.
        let reach = self.widest + self.radius + ahead.min(self.widest + self.radius);
        self.places.clear();
        let places = self.rows.iter().map(|row| grains[*row as usize].position);
        self.places.extend(places);
        let grid = self
            .grid
            .get_or_insert_with(|| Grid::new(2.0 * (self.widest + self.radius)));
        grid.bin(&self.places);
        let grid = &*grid;
        let (places, phases) = (state.metal.column(&POSITION), state.metal.column(&PHASE));
        let all = places.par_iter().zip(phases);
        all.with_min_len(1024)
            .map(|(x, phase)| *phase != phase::FLYING && grid.any_within(*x, reach))
            .collect_into_vec(&mut self.near);
        for (id, _) in &self.forces {
            self.near[*id as usize] = true;
        }
        self.bodies.clear();
        let near = self.near.iter().enumerate().filter(|(_, near)| **near);
        let mass = state.metal.matter.mass();
        self.bodies.extend(near.map(|(id, _)| {
            let member = state.near.member(id);
            let moving = member.filter(|m| state.near.role[*m] == Role::Liquid);
            let velocity = moving.map_or([0.0; 3], |m| state.near.velocity[m]);
            Body {
                id: id as u32,
                member: moving.map(|m| m as u32),
                grain: Grain {
                    position: places[id],
                    velocity,
                    spin: [0.0; 3],
                    radius: self.radius,
                    mass,
                },
                force: [0.0; 3],
                before: [0.0; 3],
                impulse: [0.0; 3],
            }
        }));
        for (id, force) in self.forces.drain(..) {
            if let Ok(place) = self.bodies.binary_search_by_key(&id, |body| body.id) {
                self.bodies[place].force = force;
            }
        }
    }

    /// Takes back what is aside of grains that are looked at again.
    fn bring_back(&mut self) {
        let (seen, memories, forces) = (&self.seen, &mut self.memories, &mut self.forces);
        let number = forces.len();
        self.aside.retain(|(memory, force)| {
            let back = seen[memory.row as usize];
            if back {
                memories.push(*memory);
                forces.push((memory.other, *force));
            }
            !back
        });
        if forces.len() > number {
            forces.sort_by_key(|(id, _)| *id);
            forces.dedup_by(|next, first| {
                let same = next.0 == first.0;
                if same {
                    first.1 = along(first.1, 1.0, next.1);
                }
                same
            });
        }
    }

    /// All contacts that touch.
    pub(super) fn touching(&self) -> impl Iterator<Item = Memory> {
        let pairs = self.pairs.iter();
        let pairs = pairs.filter_map(|pair| pair.near.memory(self.bodies[pair.body as usize].id));
        pairs.chain(self.aside.iter().map(|(memory, _)| *memory))
    }

    /// Keeps contacts that touch and forces that act.
    pub(super) fn remember(&mut self) {
        let (pairs, bodies) = (&self.pairs, &self.bodies);
        let touching = pairs
            .iter()
            .filter_map(|pair| pair.near.memory(bodies[pair.body as usize].id));
        self.memories.extend(touching);
        let acting = bodies
            .iter()
            .filter(|body| body.force.iter().any(|f| f.abs() > 0.0));
        self.forces.extend(acting.map(|body| (body.id, body.force)));
        self.pairs.clear();
    }

    /// Lists who may touch whom.
    pub fn list(&mut self, grains: &[Grain]) {
        let bodies = &self.bodies;
        let touching = self.pairs.iter();
        let touching = touching.filter_map(|pair| pair.near.memory(bodies[pair.body as usize].id));
        self.memories.extend(touching);
        self.pairs.clear();
        self.places.clear();
        let places = self.rows.iter().map(|row| grains[*row as usize].position);
        self.places.extend(places);
        let Some(grid) = &mut self.grid else { return };
        grid.bin(&self.places);
        let (grid, rows, widest) = (&*grid, &self.rows, self.widest);
        let own = self.radius + self.skin;
        let bodies = self.bodies.par_chunks(BODIES).enumerate();
        let found: Vec<Vec<Pair>> = bodies
            .map(|(c, bodies)| {
                let mut pairs = Vec::new();
                for (place, body) in (c * BODIES..).zip(bodies) {
                    let at = body.grain.position;
                    grid.runs(at, own + widest, |run| {
                        for (x, k) in grid.sorted()[run.clone()].iter().zip(&grid.order()[run]) {
                            let row = &rows[*k as usize];
                            let way = difference(*x, at);
                            let within = own + grains[*row as usize].radius;
                            if dot(way, way) < within * within {
                                pairs.push(Pair {
                                    near: Near::new(*row),
                                    body: place as u32,
                                });
                            }
                        }
                    });
                }
                pairs
            })
            .collect();
        self.pairs.extend(found.into_iter().flatten());
        self.pairs
            .sort_unstable_by_key(|pair| (pair.near.row, pair.body));
        for memory in self.memories.drain(..) {
            let body = self.bodies.binary_search_by_key(&memory.other, |b| b.id);
            let key = body.map(|body| (memory.row, body as u32));
            let place = key.and_then(|key| {
                let of = |pair: &Pair| (pair.near.row, pair.body);
                self.pairs.binary_search_by_key(&key, of)
            });
            if let Ok(place) = place {
                self.pairs[place].near.remember(&memory);
            }
        }
        let [of_bodies, of_grains] = &mut self.listed;
        of_bodies.clear();
        of_bodies.extend(self.bodies.iter().map(|body| body.grain.position));
        of_grains.clear();
        of_grains.extend_from_slice(&self.places);
        self.gone = 0.0;
    }

    /// Whether someone may touch who is not listed, after a step in which no grain has gone farther than `way` \[m\].
    #[must_use]
    pub fn strayed(&mut self, grains: &[Grain], way: f64) -> bool {
        let [of_bodies, of_grains] = &self.listed;
        let squared = |(now, then): (Vector, &Vector)| {
            let way = difference(now, *then);
            dot(way, way)
        };
        let bodies = self.bodies.iter().map(|body| body.grain.position);
        let far = bodies.zip(of_bodies).map(squared).fold(0.0, f64::max);
        // No grain has gone farther than all of these ways together, and most of them far less.
        self.gone += way;
        if far.sqrt() + self.gone * (1.0 + ROUNDED) <= self.skin {
            return false;
        }
        let rows = self.rows.par_iter().with_min_len(1024);
        let farther = rows.map(|row| grains[*row as usize].position);
        let farther = farther.zip(of_grains).map(squared);
        let farther = farther.reduce(|| 0.0, f64::max);
        far.sqrt() + farther.sqrt() > self.skin
    }
}
