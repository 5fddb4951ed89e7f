//! Metal beside grains: particles of metal that grains touch, and what both do to each other.
//!
//! ```text
//! F_a = sum over b of F_ab,      F_b = - sum over a of F_ab              (Komen 2019, eqs 3.104 to 3.118; 5.31)
//! J_b = integral of F_b over the step of the metal,    f_b = J_b / (dt V)   is what the flow is given (eq. 5.32)
//! ```
//!
//! A particle of metal is a sphere of its spacing. What rests gives way to nothing; what flows is a free mass of its own during the steps
//! of the grains, so that a contact is that of two bodies and as stable as among grains, and then the flow takes the
//! impulse and its pressure passes it on. Where the metal was at the end of the grains' steps is forgotten: it goes where
//! the flow carries it. The force of a step's beginning is that of the last step's end, on both sides, so that what
//! grains lose metal gets to the last bit that sums keep, whatever the metal has done in between. Metal has no
//! spin: the moment of a rub goes to the grain alone.

use contact::Normal;
use neighbours::{Grid, Halo};
use rayon::prelude::*;
use shapes::frame::{Vector, along, difference};
use steps::Figure;

use super::depth::Reckoned;
use super::law::Laws;
use super::memory::Memory;
use super::metal_heat::{Contacts, Exchange};
use super::metal_pair::{Body, Pair};
use super::near::AT_LEAST;
use crate::state::State;

/// Skin of the list over the least radius.
const SKIN: f64 = 0.25;

/// The exchange of heat, and the contacts that take part in it.
pub(super) type Exchanged<'a> = (&'a mut Exchange, Contacts<'a>);

/// The metal that grains touch.
#[derive(Debug, Clone)]
pub struct Metal {
    friction: Option<f64>,
    pub(super) radius: f64,
    pub(super) skin: f64,
    /// Radius of the largest grain \[m\].
    pub(super) widest: f64,
    /// By index.
    pub(super) bodies: Vec<Body>,
    /// By rows of grains, then by bodies.
    pub(super) pairs: Vec<Pair>,
    /// Contacts and forces that outlive a list: those of a checkpoint.
    pub(super) memories: Vec<Memory>,
    pub(super) forces: Vec<(u32, Vector)>,
    /// Contacts that stay as they are, with the force on the metal \[N\].
    pub(super) aside: Vec<(Memory, Vector)>,
    /// Rows of the grains that are looked at, by rows whether they are, and what flows near them.
    pub(super) rows: Vec<u32>,
    pub(super) seen: Vec<bool>,
    pub(super) flowing: Option<Halo>,
    /// Where bodies and grains were when they were listed \[m\].
    pub(super) listed: [Vec<Vector>; 2],
    /// Sum of the farthest ways of the steps since then \[m\].
    pub(super) gone: f64,
    pub(super) grid: Option<Grid>,
    pub(super) places: Vec<Vector>,
    pub(super) near: Vec<bool>,
    /// Force of the grains on metal at rest and in flow, along z \[N\].
    pub(super) borne: [f64; 2],
    /// Heat between both, if both have heat.
    pub(super) heat: Option<Exchange>,
}

impl Metal {
    /// Metal of the spacing `spacing` \[m\] beside grains whose radii go from `least` to `widest` \[m\]; `friction` if it is another.
    #[must_use]
    pub fn new(spacing: f64, [least, widest]: [f64; 2], friction: Option<f64>) -> Self {
        let radius = 0.5 * spacing;
        Self {
            friction,
            radius,
            skin: SKIN * least.min(radius),
            widest,
            bodies: Vec::new(),
            pairs: Vec::new(),
            memories: Vec::new(),
            forces: Vec::new(),
            aside: Vec::new(),
            rows: Vec::new(),
            seen: Vec::new(),
            flowing: None,
            listed: [Vec::new(), Vec::new()],
            gone: 0.0,
            grid: None,
            places: Vec::new(),
            near: Vec::new(),
            borne: [0.0; 2],
            heat: None,
        }
    }

    /// With heat between both.
    #[must_use]
    pub fn heated(self, heat: Option<Exchange>) -> Self {
        Self { heat, ..self }
    }

    /// The exchange of heat, and the contacts that take part in it; none without heat.
    pub(super) fn exchange(&mut self) -> Option<Exchanged<'_>> {
        let (pairs, bodies) = (&*self.pairs, &*self.bodies);
        let contacts = Contacts { pairs, bodies };
        self.heat.as_mut().map(|heat| (heat, contacts))
    }

    /// Adds the rows of the grains beside metal that flows, which may not sleep.
    pub fn stirred(&self, rows: &mut Vec<u32>) {
        let flows = |pair: &&Pair| self.bodies[pair.body as usize].member.is_some();
        rows.extend(self.pairs.iter().filter(flows).map(|pair| pair.near.row));
    }

    /// x += dt u + dt^2/2 a, u += dt a of what moves.
    pub fn predict(&mut self, step: f64) {
        for body in self.bodies.iter_mut().filter(|body| body.member.is_some()) {
            let gained = body.force.map(|f| step * f / body.grain.mass);
            let grain = &mut body.grain;
            for ((x, u), gained) in (grain.position.iter_mut().zip(&mut grain.velocity)).zip(gained)
            {
                *x += step * (*u + 0.5 * gained);
                *u += gained;
            }
        }
    }

    /// Reckons all contacts after a step of `step` \[s\], and adds them to the force \[N\] and the moment \[N m\] of the grains; gives the
    /// greatest overlap \[m\].
    pub fn act<N: Normal + Copy + Sync>(
        &mut self,
        seen: Reckoned<'_>,
        laws: Laws<'_, N>,
        step: f64,
        [force, moment]: [&mut [Vector]; 2],
    ) -> f64 {
        let Reckoned { grains, depth } = seen;
        let Laws { contact, rolling } = laws;
        let mut own = *contact;
        if let Some(coefficient) = self.friction {
            own.friction = Some(contact::Friction { coefficient });
        }
        let bodies = &self.bodies;
        let pairs = self.pairs.par_iter_mut().with_min_len(AT_LEAST);
        pairs.for_each(|pair| {
            if depth.always().kept(pair.near.row as usize) {
                return;
            }
            let (grain, body) = (&grains[pair.near.row as usize], &bodies[pair.body as usize]);
            if let Some(meeting) = body.meeting(grain) {
                pair.near.meet(meeting, &own, rolling, step);
            }
        });
        for body in &mut self.bodies {
            (body.before, body.force) = (body.force, [0.0; 3]);
        }
        let mut deepest = 0.0_f64;
        for pair in &self.pairs {
            deepest = deepest.max(pair.near.overlap);
            if let Some(reply) = pair.near.reply {
                let (row, body) = (pair.near.row as usize, &mut self.bodies[pair.body as usize]);
                if !depth.kept(row) {
                    force[row] = along(force[row], 1.0, reply.force);
                    moment[row] = along(moment[row], 1.0, reply.moment);
                }
                body.force = difference(body.force, reply.force);
            }
        }
        deepest
    }

    /// u += dt/2 (a' - a) of what moves, J += dt/2 (F + F').
    pub fn correct(&mut self, step: f64) {
        for body in &mut self.bodies {
            for k in 0..3 {
                let (old, new) = (body.before[k], body.force[k]);
                body.impulse[k] += 0.5 * step * (old + new);
                if body.member.is_some() {
                    body.grain.velocity[k] += 0.5 * step * (new - old) / body.grain.mass;
                }
            }
        }
    }

    /// Gives the flow the impulses of a step of `dt` \[s\].
    pub fn give(&mut self, state: &mut State, dt: f64) {
        let scale = 1.0 / (dt * state.metal.matter.volume());
        let still = self.aside.iter().map(|(_, force)| force[2]);
        self.borne = [still.sum(), 0.0];
        for body in &self.bodies {
            let moves = usize::from(body.member.is_some());
            self.borne[moves] += body.impulse[2] / dt;
            if let Some(member) = body.member {
                let force = &mut state.near.force[member as usize];
                *force = along(*force, scale, body.impulse);
            }
        }
    }

    /// Whether none of it flows.
    #[must_use]
    pub fn rests(&self) -> bool {
        self.bodies.iter().all(|body| body.member.is_none())
    }

    /// Gives contacts the new rows of their grains: `rows` has that of each old row, none where a grain leaves.
    pub fn renumber(&mut self, rows: &[Option<u32>]) {
        let follow = |row: &mut u32| rows[*row as usize].map(|new| *row = new).is_some();
        self.pairs.retain_mut(|pair| follow(&mut pair.near.row));
        self.memories.retain_mut(|memory| follow(&mut memory.row));
        self.aside.retain_mut(|(memory, _)| follow(&mut memory.row));
        self.rows.retain_mut(follow);
    }

    /// Numbers of the last step.
    pub fn figures(&self) -> Vec<Figure> {
        let figure = |name, unit, value| Figure { name, unit, value };
        let [rests, flows] = self.borne;
        let mut figures = vec![
            figure("grain_force_on_solid", "N", rests),
            figure("grain_force_on_liquid", "N", flows),
        ];
        let heat = self.heat.as_ref();
        figures.extend(heat.map(|heat| figure("energy_in_grains_j", "J", heat.given())));
        figures
    }

    /// What a checkpoint keeps of it, its number of numbers last.
    #[must_use]
    pub fn append(&self) -> Vec<f64> {
        let mut saved = self.save();
        saved.push(saved.len() as f64);
        saved
    }

    /// Takes back what [`Metal::append`] added to `saved`; gives the rest.
    pub fn detach<'a>(&mut self, saved: &'a [f64]) -> &'a [f64] {
        let Some((number, before)) = saved.split_last() else {
            return saved;
        };
        let (rest, own) = before.split_at(before.len().saturating_sub(*number as usize));
        self.restore(own);
        rest
    }

    /// Contacts, forces and heat, as numbers.
    fn save(&self) -> Vec<f64> {
        let mut kept = self.clone();
        kept.remember();
        let mut saved = vec![
            kept.memories.len() as f64,
            kept.forces.len() as f64,
            kept.aside.len() as f64,
        ];
        saved.extend(kept.memories.iter().flat_map(Memory::save));
        for (memory, force) in &kept.aside {
            saved.extend(memory.save());
            saved.extend(force);
        }
        let forces = kept.forces.iter();
        saved.extend(forces.flat_map(|(id, [x, y, z])| [f64::from(*id), *x, *y, *z]));
        saved.extend(self.heat.iter().flat_map(Exchange::save));
        saved
    }

    /// Takes back what [`Metal::save`] gave.
    fn restore(&mut self, saved: &[f64]) {
        let Some(([memories, forces, aside], rest)) = saved.split_first_chunk() else {
            return;
        };
        let numbers = [
            9 * *memories as usize,
            12 * *aside as usize,
            4 * *forces as usize,
        ];
        if rest.len() < numbers.iter().sum() {
            return;
        }
        let (all, rest) = rest.split_at(numbers[0]);
        let (aside, rest) = rest.split_at(numbers[1]);
        let (acting, rest) = rest.split_at(numbers[2]);
        let all = all.as_chunks::<9>().0.iter();
        self.memories = all.map(|saved| Memory::restored(*saved)).collect();
        let aside = aside.as_chunks::<12>().0.iter();
        self.aside = aside
            .filter_map(|saved| {
                let (memory, force) = saved.split_first_chunk::<9>()?;
                let [x, y, z] = *force else { return None };
                Some((Memory::restored(*memory), [x, y, z]))
            })
            .collect();
        let acting = acting.as_chunks::<4>().0.iter();
        self.forces = acting
            .map(|[id, x, y, z]| (*id as u32, [*x, *y, *z]))
            .collect();
        if let Some(heat) = &mut self.heat {
            heat.restore(rest);
        }
    }

    /// Bytes held.
    #[must_use]
    pub fn bytes(&self) -> usize {
        let listed: usize = self.listed.iter().map(Vec::capacity).sum();
        size_of::<Body>() * self.bodies.capacity()
            + size_of::<Pair>() * self.pairs.capacity()
            + 24 * (listed + self.places.capacity())
            + size_of::<(Memory, Vector)>() * self.aside.capacity()
            + self.near.capacity()
    }
}
