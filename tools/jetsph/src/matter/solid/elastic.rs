//! The stage of an elastic solid.

use particles::{Column, POSITION, Set, sweep};
use steps::Limit;

use super::body::Body;
use super::breaking::Breaking;
use super::cell::{Derivatives, dimensions, gradient};
use super::cracks::Cracks;
use super::flowing::{PLASTIC_STRAIN, Plastic};
use super::fracture::{BROKEN, Criterion};
use super::law::equivalent_strain;
use super::links::Links;
use super::nonlocal::Boxes;
use super::plastic::History;
use super::stiffness::stiffness;
use super::tensor::{Matrix, UNIT};
use crate::matter::meeting::faces::PRESSED;
use crate::matter::meeting::skin::DEFORMATION;
use crate::stage::{Course, Entry, Figure, Stage, StageError};
use crate::state::{ACCELERATION, MASS, State};

/// Place at rest, along the axes of the lattice \[m\].
pub const REST: Column<[f64; 3]> = Column::new("rest", "m", [0.0; 3]).saved();
/// Cauchy stress \[Pa\].
pub const STRESS: Column<Matrix> = Column::new("stress", "Pa", [[0.0; 3]; 3]).shown();
/// Equivalent strain of the principal strains.
pub const EQUIVALENT_STRAIN: Column<f64> = Column::new("equivalent_strain", "1", 0.0).shown();

/// Part of the limit of stability that a step may take.
const SAFETY: f64 = 0.9;
/// The same where cracks may leave particles with fits that are stiffer than any at rest.
const CRACKED: f64 = 0.6;
/// The same where water without sound presses on its faces: their softness is known by a bound alone.
const BESIDE_WATER: f64 = 0.5;
/// Particles per unit of parallel work.
pub(super) const GRAIN: usize = 32;

/// An elastic solid: `L` numbers hold a vector, `T` terms a quadratic (2 and 5 in the plane, 4 and 9 in space).
pub struct Elastic<const L: usize, const T: usize> {
    pub(super) body: Body,
    pub(super) links: Links<T>,
    /// Places of particles and anchors \[m\].
    pub(super) places: Vec<[f64; L]>,
    /// Slopes of the energy of each cell.
    pub(super) answers: Vec<Derivatives<L, T>>,
    /// How many times stiffer the solid is than at rest.
    pub(super) stiffer: Vec<f64>,
    /// Greatest angular frequency at rest \[rad/s\].
    fastest: f64,
    /// How many times faster the square of it is beside cracks.
    pub(super) raised: f64,
    /// Force on the body at the anchors \[N\], as one sum, and the power of moving ones \[W\].
    pub(super) held: ([f64; 3], f64),
    pub(super) entry: Entry,
    /// Rate at which what rising loads can do grows \[W\].
    pub(super) rising: Course<1>,
    pub(super) breaking: Option<Breaking<T>>,
    pub(super) plastic: Option<Plastic>,
    /// Number of broken particles that the water knows of.
    pub(super) cracked: usize,
}

impl<const L: usize, const T: usize> Elastic<L, T> {
    /// The stage of a body whose particles stand at rest in `set`. Gives the particles that too few neighbours hold.
    #[must_use]
    pub fn new(body: Body, set: &Set) -> (Self, Vec<usize>) {
        let mut rest = set.column(&REST).to_vec();
        let n = rest.len();
        rest.extend_from_slice(&body.anchor_rest);
        let (links, loose) = Links::new(&rest, n, body.size, &body.shares.middle);
        let mut stage = Self {
            places: vec![[0.0; L]; n + body.anchors.len()],
            answers: vec![[[0.0; L]; T]; n],
            stiffer: vec![1.0; n],
            fastest: 0.0,
            raised: 1.0,
            held: ([0.0; 3], 0.0),
            entry: Entry::default(),
            rising: Course::default(),
            breaking: None,
            plastic: None,
            cracked: 0,
            links,
            body,
        };
        if loose.is_empty() {
            stage.fastest = stage.fastest_at_rest(&rest[..n], set.column(&MASS));
        }
        (stage, loose)
    }

    /// With fracture; `middles` are those of the cells \[m\] and `axes` those of the lattice.
    #[must_use]
    pub fn breaking(
        mut self,
        criterion: Criterion,
        set: &Set,
        middles: &[[f64; 3]],
        axes: Matrix,
    ) -> Self {
        let mut rest = set.column(&REST).to_vec();
        let n = rest.len();
        rest.extend_from_slice(&self.body.anchor_rest);
        let size = self
            .body
            .cell
            .volume
            .powf(if T == 5 { 0.5 } else { 1.0 / 3.0 });
        let cracks = Cracks::new(&rest, middles, self.body.size, &self.body.shares.middle);
        let moment = self.body.cell.moment;
        let stiffness = (0..n).map(|a| stiffness(self.links.row(a).weight, moment));
        let stiffness = stiffness.collect();
        self.breaking = Some(Breaking::new(criterion, cracks, size, stiffness, axes));
        self
    }

    /// With fracture by the mean over a length \[m\] around cells with these middles \[m\].
    #[must_use]
    pub fn breaking_over(mut self, length: f64, middles: &[[f64; 3]]) -> Self {
        let (size, dimensions) = (self.body.size, dimensions(T));
        let boxes = Boxes::new(middles, size, length, dimensions);
        if let Some(breaking) = &mut self.breaking {
            breaking.boxes = Some(boxes);
        }
        self
    }

    /// Takes the places of particles and anchors up.
    pub(super) fn place(&mut self, all: &[[f64; 3]]) {
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
}

impl<const L: usize, const T: usize> Stage for Elastic<L, T> {
    fn name(&self) -> &'static str {
        "elastic"
    }

    fn limit(&self, state: &State) -> Option<Limit> {
        let stiffer = sweep::greatest(self.stiffer.len(), |a| self.stiffer[a]);
        let stiffer = stiffer.map_or(1.0, |(_, most)| most.max(1.0));
        let part = if state.sets[self.body.set].has(&PRESSED) {
            BESIDE_WATER
        } else if self.breaking.is_some() {
            CRACKED
        } else {
            SAFETY
        };
        let seconds = part * 2.0 / (self.fastest * (stiffer * self.raised).sqrt());
        Some(Limit::dividing("elastic_waves", seconds))
    }

    fn exchange(&mut self, state: &mut State, dt: f64) -> Result<(), StageError> {
        self.break_between(state, dt);
        Ok(())
    }

    fn act(&mut self, state: &mut State, dt: f64) -> Result<(), StageError> {
        let time = state.time + dt;
        let set = &mut state.sets[self.body.set];
        let position = set.take(&POSITION);
        self.locate(&position, time);
        set.put(&POSITION, position);
        let n = set.len();
        self.answer(time);
        if self.breaks(set, time) {
            self.answer(time);
        }
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
        if !set.has(&PRESSED) {
            self.twisted(set);
        }
        let mut acceleration = set.take(&ACCELERATION);
        self.accelerate(&mut acceleration, set.column(&MASS));
        set.put(&ACCELERATION, acceleration);
        self.outside(state, dt);
        let set = &mut state.sets[self.body.set];
        if set.has(&PRESSED) {
            self.show_pulled(set);
            self.show_push(set);
            self.show_giving(set);
        }
        Ok(())
    }

    fn receive(&mut self, state: &mut State, dt: f64) {
        let set = &mut state.sets[self.body.set];
        if set.has(&PRESSED) && dt > 0.0 {
            self.take_impulses(set, dt);
        }
    }

    fn look(&mut self, state: &mut State, time: f64) {
        let set = &mut state.sets[self.body.set];
        if set.has(&DEFORMATION) {
            let position = set.take(&POSITION);
            self.locate(&position, time);
            set.put(&POSITION, position);
            self.show_shape(set);
        }
    }

    fn show(&self, state: &mut State) {
        let law = self.body.cell.law;
        let whole = |a: usize| !self.links.row(a).other.is_empty();
        let deformation = |a: usize| {
            let shape = if whole(a) {
                gradient(&self.derivatives(a))
            } else {
                UNIT
            };
            law.completed(shape)
        };
        let set = &mut state.sets[self.body.set];
        sweep::fill(set.column_mut(&STRESS), |a| {
            let flowing = if whole(a) {
                self.flowing_stress(a)
            } else {
                None
            };
            flowing.unwrap_or_else(|| law.cauchy(&deformation(a)))
        });
        if let Some(plastic) = &self.plastic {
            let strain = |a: usize| plastic.histories[a].strain;
            sweep::fill(set.column_mut(&PLASTIC_STRAIN), strain);
        }
        sweep::fill(set.column_mut(&EQUIVALENT_STRAIN), |a| {
            equivalent_strain(&deformation(a))
        });
    }

    fn declare(&self, state: &mut State) {
        let set = &mut state.sets[self.body.set];
        set.declare(&STRESS);
        set.declare(&EQUIVALENT_STRAIN);
        if self.breaking.is_some() {
            set.declare(&BROKEN);
        }
        if self.plastic.is_some() {
            set.declare(&PLASTIC_STRAIN);
        }
    }

    fn entry(&self, state: &State) -> Entry {
        // A dead load stores what it can still do.
        let position = state.sets[self.body.set].column(&POSITION);
        Entry {
            stored: self.stored() - self.load_potential(position, state.time),
            spent: self.entry.spent + self.taken(),
            ..self.entry
        }
    }

    fn figures(&self, state: &State) -> Vec<Figure> {
        let mut figures = self.cracks(state);
        if self.body.anchors.is_empty() {
            return figures;
        }
        let name = state.sets[self.body.set].name();
        let set = &state.sets[self.body.set];
        let leaning = if set.has(&PRESSED) {
            self.leaning(set)
        } else {
            [0.0; 3]
        };
        let whole = [0, 1, 2].map(|k| self.held.0[k] + leaning[k]);
        let axes = ["x", "y", "z"].iter().zip(whole).take(L.min(3));
        figures.extend(axes.map(|(axis, force)| Figure {
            name: format!("{name}_clamp_force_{axis}"),
            unit: "N",
            value: force,
        }));
        figures
    }

    fn closing(&self, state: &State) -> Vec<Figure> {
        self.first_break(state)
    }

    fn bytes(&self) -> usize {
        let vectors = self.places.len() * L * 8 + self.answers.len() * (L * T * 8 + 8);
        self.links.bytes() + vectors + self.breaking.as_ref().map_or(0, Breaking::bytes)
    }

    fn save(&self) -> Vec<f64> {
        let (force, power) = self.held;
        let mut saved = [
            &self.entry.save()[..],
            &force,
            &[power],
            &self.saved_cracks(),
            &self.rising.last(),
        ]
        .concat();
        saved.extend(self.saved_trials());
        let plastic = self.plastic.iter();
        saved.extend(plastic.flat_map(|p| p.histories.iter().flat_map(History::save)));
        saved
    }

    fn restore(&mut self, state: &State, saved: &[f64]) {
        if let [fx, fy, fz, power, rest @ ..] = self.entry.restore(saved) {
            self.held = ([*fx, *fy, *fz], *power);
            let rest = self.take_up(state.sets[self.body.set].column(&BROKEN), rest);
            let rest = self.rising.restore(rest);
            let histories = self.take_trials(rest);
            if let Some(plastic) = &mut self.plastic {
                plastic.histories = History::restored(histories);
            }
        }
        self.locate(state.sets[self.body.set].column(&POSITION), state.time);
        // Rounding must not let flow what has flown.
        let plastic = self.plastic.clone();
        self.answer(state.time);
        self.plastic = plastic;
    }
}
