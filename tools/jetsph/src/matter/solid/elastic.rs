//! The stage of an elastic solid.

use particles::{Column, POSITION, Set, sweep};
use rayon::prelude::*;

use super::body::Body;
use super::cell::{Derivatives, gradient};
use super::law::equivalent_strain;
use super::links::{Links, terms};
use super::sound::fastest;
use super::tensor::Matrix;
use crate::stage::{Entry, Figure, Limit, Stage, StageError};
use crate::state::{ACCELERATION, MASS, State, VELOCITY};

/// Place at rest, along the axes of the lattice \[m\].
pub const REST: Column<[f64; 3]> = Column::new("rest", "m", [0.0; 3]).saved();
/// Cauchy stress \[Pa\].
pub const STRESS: Column<Matrix> = Column::new("stress", "Pa", [[0.0; 3]; 3]).shown();
/// Equivalent strain of the principal strains.
pub const EQUIVALENT_STRAIN: Column<f64> = Column::new("equivalent_strain", "1", 0.0).shown();

/// Part of the limit of stability that a step may take.
const SAFETY: f64 = 0.9;
/// Particles per unit of parallel work.
const GRAIN: usize = 32;

/// An elastic solid: `L` numbers hold a vector, `T` terms a quadratic (2 and 5 in the plane, 4 and 9 in space).
pub struct Elastic<const L: usize, const T: usize> {
    body: Body,
    links: Links<T>,
    /// Places of particles and anchors \[m\].
    places: Vec<[f64; L]>,
    /// Slopes of the energy of each cell.
    answers: Vec<Derivatives<L, T>>,
    /// How many times stiffer the solid is than at rest.
    stiffer: Vec<f64>,
    /// Greatest angular frequency at rest \[rad/s\].
    fastest: f64,
    /// Force on the body at the anchors \[N\], as one sum, and the power of moving ones \[W\].
    held: ([f64; 3], f64),
    entry: Entry,
}

impl<const L: usize, const T: usize> Elastic<L, T> {
    /// The stage of a body whose particles stand at rest in `set`. Gives the particles that too few neighbours hold.
    #[must_use]
    pub fn new(body: Body, set: &Set) -> (Self, Vec<usize>) {
        let mut rest = set.column(&REST).to_vec();
        let n = rest.len();
        rest.extend_from_slice(&body.anchor_rest);
        let (links, loose) = Links::new(&rest, n, body.size);
        let mut stage = Self {
            places: vec![[0.0; L]; n + body.anchors.len()],
            answers: vec![[[0.0; L]; T]; n],
            stiffer: vec![1.0; n],
            fastest: 0.0,
            held: ([0.0; 3], 0.0),
            entry: Entry::default(),
            links,
            body,
        };
        if loose.is_empty() {
            stage.fastest = stage.fastest_at_rest(&rest[..n], set.column(&MASS));
        }
        (stage, loose)
    }

    fn fastest_at_rest(&mut self, rest: &[[f64; 3]], mass: &[f64]) -> f64 {
        let (anchors, loads) = (
            self.body.anchor_rest.clone(),
            std::mem::take(&mut self.body.loads),
        );
        let step = 1e-6 * self.body.size[0];
        let dimensions = if T == 5 { 2 } else { 3 };
        let mut acceleration = vec![[0.0; 3]; rest.len()];
        let found = fastest(rest.len(), (step, dimensions), |motion| {
            let moved = rest.iter().zip(motion);
            let moved = moved.map(|(x, u)| std::array::from_fn(|k| x[k] + u[k]));
            let all: Vec<[f64; 3]> = moved.chain(anchors.iter().copied()).collect();
            self.place(&all);
            self.answer(0.0);
            acceleration.fill([0.0; 3]);
            self.accelerate(&mut acceleration, mass);
            acceleration.clone()
        });
        self.body.loads = loads;
        found
    }

    /// Takes the places of particles and anchors up.
    fn place(&mut self, all: &[[f64; 3]]) {
        for (place, x) in self.places.iter_mut().zip(all) {
            (0..L.min(3)).for_each(|k| place[k] = x[k]);
        }
    }

    /// Takes the places of particles up, and moves the anchors to theirs.
    fn locate(&mut self, position: &[[f64; 3]], time: f64) {
        self.place(position);
        let anchors = self.places[position.len()..].iter_mut();
        for (place, anchor) in anchors.zip(&self.body.anchors) {
            (0..L.min(3)).for_each(|k| place[k] = anchor.place[k] + time * anchor.velocity[k]);
        }
    }

    /// Derivatives of the deformation of cell `a`.
    #[inline(always)]
    fn derivatives(&self, a: usize) -> Derivatives<L, T> {
        let row = self.links.row(a);
        let own = self.places[a];
        let mut sum = [[0.0; L]; T];
        for (b, weight) in row.other.iter().zip(row.weight) {
            let other = self.places[*b as usize];
            let dx: [f64; L] = std::array::from_fn(|k| other[k] - own[k]);
            for (column, w) in sum.iter_mut().zip(weight) {
                (0..L).for_each(|k| column[k] += w * dx[k]);
            }
        }
        sum
    }

    /// Slopes of the energy of all cells, less the work of the loads.
    fn answer(&mut self, load: f64) {
        let mut answers = std::mem::take(&mut self.answers);
        let mut stiffer = std::mem::take(&mut self.stiffer);
        let each = answers
            .par_chunks_mut(GRAIN)
            .zip(stiffer.par_chunks_mut(GRAIN));
        each.enumerate().for_each(|(chunk, (answers, stiffer))| {
            sweep::wide(|| {
                let all = answers.iter_mut().zip(stiffer.iter_mut()).enumerate();
                for (k, (answer, stiffer)) in all {
                    let derivatives = self.derivatives(chunk * GRAIN + k);
                    (*answer, *stiffer) = self.body.cell.answer(&derivatives);
                }
            });
        });
        for force in self.body.loads.iter().filter(|_| load > 0.0) {
            let parts: [f64; T] = terms(force.offset);
            let columns = answers[force.particle].iter_mut().zip(parts);
            columns.for_each(|(column, part)| {
                (0..L.min(3)).for_each(|k| column[k] -= load * force.force[k] * part);
            });
        }
        self.answers = answers;
        self.stiffer = stiffer;
    }

    /// Adds the accelerations of all particles: what their own cell does to them, less what those of the others do.
    fn accelerate(&self, acceleration: &mut [[f64; 3]], mass: &[f64]) {
        let n = self.answers.len();
        let each = acceleration.par_chunks_mut(GRAIN).enumerate();
        each.for_each(|(chunk, acceleration)| {
            sweep::wide(|| {
                for (k, own) in acceleration.iter_mut().enumerate() {
                    let a = chunk * GRAIN + k;
                    let row = self.links.row(a);
                    let mut force = [0.0; L];
                    add(&mut force, &self.answers[a], row.total);
                    let mut others = [0.0; L];
                    for (b, back) in row.other.iter().zip(row.back) {
                        let b = *b as usize;
                        if b < n {
                            add(&mut others, &self.answers[b], back);
                        }
                    }
                    let inverse = 1.0 / mass[a];
                    (0..L.min(3)).for_each(|i| own[i] += inverse * (force[i] - others[i]));
                }
            });
        });
    }

    /// Force on the body at its anchors and their power.
    fn reaction(&self) -> ([f64; 3], f64) {
        let n = self.answers.len();
        if self.body.anchors.is_empty() {
            return ([0.0; 3], 0.0);
        }
        let [x, y, z, power] = sweep::sum(n, |a| {
            let row = self.links.row(a);
            let mut sum = [0.0; 4];
            for (b, weight) in row.other.iter().zip(row.weight) {
                if let Some(anchor) = (*b as usize).checked_sub(n) {
                    let mut force = [0.0; L];
                    add(&mut force, &self.answers[a], weight);
                    let velocity = self.body.anchors[anchor].velocity;
                    (0..L.min(3)).for_each(|k| {
                        sum[k] += force[k];
                        sum[3] += force[k] * velocity[k];
                    });
                }
            }
            sum
        });
        ([x, y, z], power)
    }

    /// Accelerations by the loads and by damping, and the balances of all from outside.
    fn outside(&mut self, state: &mut State, dt: f64) {
        let set = &mut state.sets[self.body.set];
        let mut acceleration = set.take(&ACCELERATION);
        let (mass, velocity) = (set.column(&MASS), set.column(&VELOCITY));
        let mut total = [0.0; 3];
        for load in &self.body.loads {
            let a = load.particle;
            for k in 0..3 {
                acceleration[a][k] += load.force[k] / mass[a];
                total[k] += load.force[k];
            }
        }
        if self.body.damping > 0.0 {
            let rate = self.body.damping;
            sweep::change(&mut acceleration, |a, own| {
                (0..3).for_each(|k| own[k] -= rate * velocity[a][k]);
            });
            let loss = |a: usize| {
                let u = velocity[a];
                let square = u[0] * u[0] + u[1] * u[1] + u[2] * u[2];
                [
                    mass[a] * square,
                    mass[a] * u[0],
                    mass[a] * u[1],
                    mass[a] * u[2],
                ]
            };
            let [lost, x, y, z] = sweep::sum(set.len(), loss);
            self.entry.spent += dt * rate * lost;
            for (sum, part) in self.entry.impulse.iter_mut().zip([x, y, z]) {
                *sum -= dt * rate * part;
            }
        }
        set.put(&ACCELERATION, acceleration);
        let held = self.reaction();
        let before = std::mem::replace(&mut self.held, held);
        self.entry.work += 0.5 * dt * (held.1 + before.1);
        let mean = |k: usize| 0.5 * (held.0[k] + before.0[k]);
        let impulse = self.entry.impulse.iter_mut().zip(total);
        for (k, (sum, load)) in impulse.enumerate() {
            *sum += dt * (mean(k) + load);
        }
    }
}

/// sum += slopes of the energy . weights.
#[inline(always)]
fn add<const L: usize, const T: usize>(
    sum: &mut [f64; L],
    answer: &Derivatives<L, T>,
    weight: &[f64; T],
) {
    for (column, w) in answer.iter().zip(weight) {
        (0..L).for_each(|k| sum[k] += w * column[k]);
    }
}

impl<const L: usize, const T: usize> Stage for Elastic<L, T> {
    fn name(&self) -> &'static str {
        "elastic"
    }

    fn limit(&self, _: &State) -> Option<Limit> {
        let stiffer = sweep::greatest(self.stiffer.len(), |a| self.stiffer[a]);
        let stiffer = stiffer.map_or(1.0, |(_, most)| most.max(1.0));
        Some(Limit {
            seconds: SAFETY * 2.0 / (self.fastest * stiffer.sqrt()),
            name: "elastic_waves",
        })
    }

    fn act(&mut self, state: &mut State, dt: f64) -> Result<(), StageError> {
        let time = state.time + dt;
        let set = &mut state.sets[self.body.set];
        let position = set.take(&POSITION);
        self.locate(&position, time);
        set.put(&POSITION, position);
        let n = set.len();
        self.answer(1.0);
        if let Some((a, _)) =
            sweep::greatest(n, |a| self.stiffer[a]).filter(|(_, most)| most.is_nan())
        {
            let f = gradient(&self.derivatives(a));
            return Err(StageError::Diverged {
                set: set.name().to_owned(),
                particle: a,
                place: set.column(&POSITION)[a],
                quantity: "volume over that at rest [1]",
                what: format!(
                    "is {:.3e}: the solid is turned inside out",
                    super::tensor::determinant(&f)
                ),
            });
        }
        let mut acceleration = set.take(&ACCELERATION);
        self.accelerate(&mut acceleration, set.column(&MASS));
        set.put(&ACCELERATION, acceleration);
        self.outside(state, dt);
        Ok(())
    }

    fn show(&self, state: &mut State) {
        let law = self.body.cell.law;
        let deformation = |a: usize| law.completed(gradient(&self.derivatives(a)));
        let set = &mut state.sets[self.body.set];
        sweep::fill(set.column_mut(&STRESS), |a| law.cauchy(&deformation(a)));
        sweep::fill(set.column_mut(&EQUIVALENT_STRAIN), |a| {
            equivalent_strain(&deformation(a))
        });
    }

    fn declare(&self, state: &mut State) {
        let set = &mut state.sets[self.body.set];
        set.declare(&STRESS);
        set.declare(&EQUIVALENT_STRAIN);
    }

    fn entry(&self, state: &State) -> Entry {
        let n = self.answers.len();
        let stored = sweep::sum(n, |a| [self.body.cell.energy(&self.derivatives(a))])[0];
        // A dead load stores what it can still do.
        let position = state.sets[self.body.set].column(&POSITION);
        let loads = self.body.loads.iter().map(|load| {
            let derivatives = self.derivatives(load.particle);
            let parts: [f64; T] = terms(load.offset);
            let moved = |k: usize| -> f64 {
                let there = derivatives
                    .iter()
                    .zip(parts)
                    .map(|(column, part)| part * column[k]);
                position[load.particle][k] + there.sum::<f64>()
            };
            (0..L.min(3)).map(|k| load.force[k] * moved(k)).sum::<f64>()
        });
        Entry {
            stored: stored - loads.sum::<f64>(),
            ..self.entry
        }
    }

    fn figures(&self, state: &State) -> Vec<Figure> {
        if self.body.anchors.is_empty() {
            return Vec::new();
        }
        let name = state.sets[self.body.set].name();
        let axes = ["x", "y", "z"].iter().zip(self.held.0).take(L.min(3));
        axes.map(|(axis, force)| Figure {
            name: format!("{name}_clamp_force_{axis}"),
            unit: "N",
            value: force,
        })
        .collect()
    }

    fn bytes(&self) -> usize {
        let vectors = self.places.len() * L * 8 + self.answers.len() * (L * T * 8 + 8);
        self.links.bytes() + vectors
    }

    fn save(&self) -> Vec<f64> {
        let (force, power) = self.held;
        [&self.entry.save()[..], &force, &[power]].concat()
    }

    fn restore(&mut self, state: &State, saved: &[f64]) {
        if let [fx, fy, fz, power] = *self.entry.restore(saved) {
            self.held = ([fx, fy, fz], power);
        }
        self.locate(state.sets[self.body.set].column(&POSITION), state.time);
        self.answer(1.0);
    }
}
