//! Heat conduction between particles (Komen 2019, first term of eq. 4.10).
//!
//! ```text
//! m dh_a/dt = V sum_b 2 delta / (lambda N) k_ab (T_b - T_a) W_ab,    k_ab = 2 k_a k_b / (k_a + k_b)
//! ```
//!
//! 1. lambda N = sum r^2 W (eqs. 3.96, 3.97) is that of the full lattice for every particle. What
//!    a gains b then loses to the last bit, so energy is kept to round-off; a sum cut off by the
//!    surface lets nothing through it, and a flat face completed by mirror images conducts along
//!    itself as the inside does. With each particle's own lambda N neither would hold. Free faces without a name
//!    are completed for metal that rests from the start on ([`crate::rest`]).
//! 2. The 1/rho of eq. 3.98 belongs to the equation of motion alone. The mean of the
//!    conductivities is the harmonic one, exact for layers in series; eq. 4.10 has the arithmetic.
//! 3. Pairs at rest keep their rows ([`crate::rest`]) and may be taken together every few steps;
//!    pairs with a moving particle are taken in every step, from [`crate::near`].
//! 4. A pair at rest exchanges heat only if its temperatures differ by more than the tolerance, so
//!    a particle without such a pair can be passed over: the result is the same to the last bit
//!    as if every particle were visited. The tolerance itself costs at most its own size per
//!    spacing of distance.
//! 5. An open face (section 4.3, eq. 4.12) continues the plate: opposite to each neighbour b from
//!    which the way on leads out of the plate stands an image of temperature 2 T_a - T_b.
//!
//! Explicit in time; with every step divided so that
//! dt <= rho sum(r^2 W) / (6 (k/c)_max sum W), no particle leaves the range of its neighbours.

mod exchanged;
mod flowing;
mod walls;

use std::ops::Range;

use neighbours::ROWS;
use particles::{Matter, POSITION};
use rayon::prelude::*;
use run::Fault;
use run::property::Curve;
use steps::{Figure, Limit};

use self::exchanged::Exchanged;
use self::walls::Walls;
use crate::heat::bounds::{moments, outside};
use crate::heat::held::Held;
use crate::heat::ledger::Sum;
use crate::heat::open::Open;
use crate::heat::parameters::Parameters;
use crate::heat::substances::Substances;
use crate::rest::{Plane, Rest};
use crate::stage::{Stage, StageError};
use crate::state::{ENTHALPY, State, TEMPERATURE, WALL, marked};

/// What an exchange of particles at rest reads of them.
#[derive(Clone, Copy)]
struct Columns<'a> {
    places: &'a [[f64; 3]],
    enthalpies: &'a [f64],
    marks: &'a [bool],
}

/// Heat conduction as a stage.
pub struct Conduction {
    made: Substances,
    metal: Matter,
    /// 6 V / sum r^2 W of the lattice \[m3 m/m2\].
    scale: f64,
    limit: f64,
    interval: u64,
    tolerance: f64,
    rest: Rest,
    open: Open,
    held: Vec<Held>,
    /// T \[K\] and 1/k \[m K/W\], the latter infinite for insulating walls.
    thermal: Vec<[f64; 2]>,
    awake: Vec<bool>,
    visited: Vec<u32>,
    exchanged: Vec<Exchanged>,
    saved: Option<Vec<f64>>,
    substeps: u64,
    /// The same of what flows.
    flowing: u64,
    out_open: Sum,
    out_held: Sum,
    /// Faces of the flow that hold a temperature.
    walls: Option<Walls>,
}

impl Conduction {
    /// Conduction in the metal of a scene.
    ///
    /// # Errors
    /// A fault at the key that is wrong.
    pub fn new(parameters: &Parameters, made: Substances, metal: Matter) -> Result<Self, Fault> {
        let (mirrors, open) = parameters.planes();
        let both = |plane: &&Plane| mirrors.contains(plane);
        if open.iter().find(both).is_some() {
            return Err(Fault::at(
                "/faces",
                "a face is named both under mirror and under open",
            ));
        }
        Ok(Self {
            scale: 6.0 * metal.volume() / moments(metal).0,
            limit: made.limit(metal),
            interval: u64::from(parameters.rest_interval_steps.max(1)),
            tolerance: parameters.exchange_tolerance_k,
            rest: Rest::new(metal, mirrors, &open),
            open: Open::new(open, metal.spacing, parameters),
            held: Vec::new(),
            thermal: Vec::new(),
            awake: Vec::new(),
            visited: Vec::new(),
            exchanged: Vec::new(),
            saved: None,
            substeps: 1,
            flowing: 1,
            out_open: Sum::default(),
            out_held: Sum::default(),
            walls: None,
            made,
            metal,
        })
    }

    /// Prescribes the temperature of particles; `temperature` may depend on x, y, z and t.
    pub fn hold(&mut self, particles: Range<usize>, temperature: Curve) {
        self.held.push(Held {
            particles,
            temperature,
        });
    }

    /// Metal that begins on a lattice whose spacings along the axes are `cell` \[m\].
    #[must_use]
    pub fn of_cells(mut self, cell: [f64; 3]) -> Self {
        self.rest = self.rest.of_cells(cell, moments(self.metal).0);
        self
    }

    /// Takes account of walls in the planes of faces, which hold a temperature.
    #[must_use]
    pub fn beside_walls(mut self, walls: bool) -> Self {
        self.walls = walls.then(Walls::default);
        self
    }

    /// The largest step of the explicit scheme \[s\].
    #[must_use]
    pub fn limit(&self) -> f64 {
        self.limit
    }

    /// Takes in new particles, changed rows, and temperatures that others have changed.
    fn refresh(&mut self, state: &State) {
        if let Some(saved) = self.saved.take() {
            self.rest.restore(state, &saved);
        }
        self.rest.update(state);
        self.thermal.resize(state.len(), [f64::NAN, f64::INFINITY]);
        self.awake.resize(state.len(), true);
        for &a in self.rest.changed() {
            self.awake[a as usize] = true;
        }
        let (temperatures, wall) = (state.metal.column(&TEMPERATURE), state.metal.column(&WALL));
        let marks = Substances::marks(&state.metal);
        for (a, (&now, seen)) in temperatures.iter().zip(&mut self.thermal).enumerate() {
            // NaN, a particle not seen before, differs as well.
            if seen[0].to_bits() != now.to_bits() {
                seen[0] = now;
                self.awake[a] = true;
                if !marked(wall, a) {
                    seen[1] = 1.0 / self.made.at(marks, a).caloric.conductivity(now);
                }
            }
        }
        for held in &self.held {
            for a in held.particles.clone() {
                let own = &self.made.at(marks, a).caloric;
                self.thermal[a][1] = 1.0 / own.conductivity(temperatures[a]);
            }
        }
    }

    /// Exchanges heat between resting particles over `dt`.
    fn exchange_at_rest(&mut self, state: &mut State, dt: f64) -> Result<(), StageError> {
        self.visited.clear();
        let awake =
            (self.awake.iter().enumerate()).filter(|(a, awake)| **awake && self.rest.holds(*a));
        self.visited.extend(awake.map(|(a, _)| a as u32));
        let mut exchanged = std::mem::take(&mut self.exchanged);
        let metal = Columns {
            places: state.metal.column(&POSITION),
            enthalpies: state.metal.column(&ENTHALPY),
            marks: Substances::marks(&state.metal),
        };
        let visited = self.visited.par_iter().with_min_len(ROWS);
        visited
            .map(|&a| self.at_rest(metal, a as usize, dt))
            .collect_into_vec(&mut exchanged);
        let sleepers = self.sleepers(&exchanged);
        let asleep = sleepers.iter();
        exchanged.extend(asleep.map(|&a| self.at_rest(metal, a as usize, dt)));
        self.visited.extend(sleepers);
        for one in &exchanged {
            self.awake[one.a as usize] = one.busy;
            self.out_open.add(one.out);
        }
        let stored = self.store(state, &exchanged);
        self.exchanged = exchanged;
        stored
    }

    /// Particles passed over so far that a neighbour has grown too different from.
    fn sleepers(&self, exchanged: &[Exchanged]) -> Vec<u32> {
        let mut sleepers = Vec::new();
        for one in exchanged.iter().filter(|one| one.wakes) {
            let temperature = self.thermal[one.a as usize][0];
            let links = self.rest.row(one.a as usize).iter();
            let asleep = links.filter(|link| {
                let difference = self.thermal[link.to as usize][0] - temperature;
                !self.awake[link.to as usize] && difference.abs() > self.tolerance
            });
            sleepers.extend(asleep.map(|link| link.to));
        }
        sleepers.sort_unstable();
        sleepers.dedup();
        sleepers
    }

    fn at_rest(&self, metal: Columns<'_>, a: usize, dt: f64) -> Exchanged {
        let [temperature, resistivity] = self.thermal[a];
        let (mut gain, mut busy, mut wakes) = (0.0, false, false);
        for link in self.rest.row(a) {
            let b = link.to as usize;
            let [other, resists] = self.thermal[b];
            let difference = other - temperature;
            if difference.abs() > self.tolerance {
                busy = true;
                wakes |= !self.awake[b];
                gain += link.weight * 2.0 / (resistivity + resists) * difference;
            }
        }
        let own = self.made.at(metal.marks, a);
        let lost = if busy {
            let row = self.rest.row(a);
            self.open
                .lost(metal.places, &self.thermal, row, a, &own.caloric)
        } else {
            0.0
        };
        let enthalpy = metal.enthalpies[a] + self.scale * dt * (gain - lost) / own.mass;
        Exchanged {
            a: a as u32,
            enthalpy,
            temperature: own.caloric.temperature(enthalpy),
            out: self.scale * dt * lost,
            busy,
            wakes,
        }
    }

    fn store(&self, state: &mut State, exchanged: &[Exchanged]) -> Result<(), StageError> {
        let marks = Substances::marks(&state.metal);
        let own = |one: &Exchanged| &self.made.at(marks, one.a as usize).caloric;
        let beyond = |one: &&Exchanged| !own(one).covers(one.temperature);
        if let Some(one) = exchanged.iter().find(beyond) {
            let a = one.a as usize;
            let place = state.metal.column(&POSITION)[a];
            return Err(outside(state.step, a, place, one.temperature, own(one)));
        }
        let (enthalpies, temperatures) = state.metal.columns_mut((&ENTHALPY, &TEMPERATURE));
        for one in exchanged {
            let a = one.a as usize;
            (enthalpies[a], temperatures[a]) = (one.enthalpy, one.temperature);
        }
        Ok(())
    }
}

impl Stage for Conduction {
    fn name(&self) -> &'static str {
        "conduction"
    }

    fn declare(&self, state: &mut State) {
        state.metal.declare(&TEMPERATURE);
        state.metal.declare(&ENTHALPY);
    }

    fn limit(&self, _state: &State) -> Option<Limit> {
        Some(Limit::dividing("conduction", self.limit))
    }

    fn follows(&self, _: &State) -> f64 {
        // Heat is divided by itself.
        f64::INFINITY
    }

    fn parts(&self) -> u64 {
        self.substeps.max(self.flowing)
    }

    fn advance(&mut self, state: &mut State, dt: f64) -> Result<(), StageError> {
        for held in &self.held {
            held.prescribe(state, &self.made, &mut self.out_held)?;
        }
        // Those at rest wait for a multiple of their interval; a long step may hold several.
        let turns = |step: u64| step.div_ceil(self.interval);
        let due = turns(state.step + state.stride) - turns(state.step);
        let whole = (due * self.interval) as f64 * (dt / state.stride as f64);
        let limit = self.limit;
        // A step at the very limit is whole, whatever its last bit.
        let parts = |dt: f64| (dt / limit - 1e-9).ceil().max(1.0);
        if due > 0 {
            let n = parts(whole);
            self.substeps = n as u64;
            for _ in 0..self.substeps {
                self.refresh(state);
                self.exchange_at_rest(state, whole / n)?;
            }
        }
        let n = parts(dt);
        self.flowing = if state.near.is_empty() { 1 } else { n as u64 };
        for _ in 0..n as u64 {
            if !state.near.is_empty() {
                self.refresh(state);
                self.exchange_in_flow(state, dt / n)?;
            }
        }
        Ok(())
    }

    fn figures(&self) -> Vec<Figure> {
        let figure = |name, unit, value| Figure { name, unit, value };
        let mut figures = vec![
            figure("conducting_particles", "1", self.visited.len() as f64),
            figure("conduction_substeps", "1", self.substeps as f64),
        ];
        if self.open.any() {
            figures.push(figure(
                "energy_out_open_faces_j",
                "J",
                self.out_open.value(),
            ));
        }
        if !self.held.is_empty() {
            figures.push(figure("energy_out_held_j", "J", self.out_held.value()));
        }
        figures.extend(self.walls.iter().flat_map(Walls::figures));
        figures
    }

    fn warnings(&self) -> Vec<String> {
        self.walls.iter().filter_map(Walls::warning).collect()
    }

    fn bytes(&self) -> usize {
        let walls = self.walls.as_ref().map_or(0, Walls::bytes);
        self.rest.bytes() + 21 * self.thermal.len() + walls
    }

    fn save(&self) -> Vec<f64> {
        let mut saved = Vec::from(self.out_open.save());
        saved.extend(self.out_held.save());
        saved.extend(self.walls.iter().flat_map(Walls::save));
        saved.extend(self.rest.save());
        saved
    }

    fn restore(&mut self, saved: &[f64]) {
        self.out_open = Sum::restored(saved);
        self.out_held = Sum::restored(&saved[2.min(saved.len())..]);
        let saved = &saved[4.min(saved.len())..];
        let rest = match &mut self.walls {
            Some(walls) => walls.restore(saved),
            None => saved,
        };
        self.saved = Some(rest.to_vec());
    }
}
