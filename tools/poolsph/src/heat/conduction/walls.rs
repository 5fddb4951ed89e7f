//! Walls in the planes of faces that hold a temperature: what they give and take.

use particles::POSITION;
use steps::Figure;

use super::Exchanged;
use crate::faces::Turn;
use crate::heat::ledger::Sum;
use crate::near::{Near, Role};
use crate::rest::Rest;
use crate::stage::StageError;
use crate::state::{State, TEMPERATURE, WALL, marked};

/// Numbers of a checkpoint.
const SAVED: usize = 8;

/// The walls of a scene.
#[derive(Debug, Default)]
pub(super) struct Walls {
    /// T of the particles of the copy and their images \[K\].
    beside: Vec<f64>,
    taken: Sum,
    given: Sum,
    /// When and where metal first froze beside one so that it takes nothing from it \[s, m\].
    unserved: Option<[f64; 4]>,
    served: Vec<bool>,
}

impl Walls {
    /// Takes the temperatures of the moment.
    pub(super) fn take(&mut self, state: &State) -> Result<(), StageError> {
        let temperatures = state.metal.column(&TEMPERATURE);
        self.beside.clear();
        let (near, beside) = (&state.near, &mut self.beside);
        let found = near.temperatures(&state.faces, state.time, temperatures, beside);
        found.map_err(|fault| StageError::Data(format!("temperature of a wall: {fault}")))
    }

    /// What walls give to the `k`-th particle of the copy over `weights` of its `row`, and how much more that is than what
    /// their images would give at the temperatures of their originals; `thermal` holds T and 1/k of each particle.
    pub(super) fn through(
        &self,
        near: &Near,
        k: usize,
        pairs: impl Iterator<Item = (usize, f64)>,
        thermal: &[[f64; 2]],
    ) -> (f64, f64) {
        let [temperature, resistivity] = thermal[near.id[k] as usize];
        let (mut entering, mut more) = (0.0, 0.0);
        for (j, weight) in pairs {
            if near.images().turn(j).is_some_and(Turn::is_held) {
                let [other, resists] = thermal[near.id[j] as usize];
                let weight = weight * 2.0 / (resistivity + resists);
                entering += weight * (self.beside[j] - temperature);
                more += weight * (self.beside[j] - other);
            }
        }
        (entering, more)
    }

    /// Counts what passed. What walls give and what they take are told apart: between a hot and a cold wall their sum says
    /// nothing.
    pub(super) fn count(&mut self, exchanged: &[Exchanged]) {
        for one in exchanged {
            match one.out < 0.0 {
                true => self.given.add(-one.out),
                false => self.taken.add(one.out),
            }
        }
    }

    /// Looks for metal that has frozen beside a wall so far from all liquid that the wall gives it nothing.
    pub(super) fn look(&mut self, state: &State, rest: &Rest) {
        if self.unserved.is_some() {
            return;
        }
        self.served.clear();
        self.served.resize(state.len(), false);
        for (id, role) in state.near.id.iter().zip(&state.near.role) {
            self.served[*id as usize] |= *role != Role::Backing;
        }
        let (places, wall) = (state.metal.column(&POSITION), state.metal.column(&WALL));
        let d = state.metal.matter.spacing;
        let mut frozen = (0..state.len()).filter(|a| {
            let idle = rest.holds(*a) && !self.served[*a] && !marked(wall, *a);
            idle && state.faces.is_beside_held(places[*a], d)
        });
        self.unserved = frozen.next().map(|a| {
            let [x, y, z] = places[a];
            [state.time, x, y, z]
        });
    }

    pub(super) fn figures(&self) -> [Figure; 2] {
        [
            ("energy_in_walls_j", self.given),
            ("energy_out_walls_j", self.taken),
        ]
        .map(|(name, sum)| Figure {
            name,
            unit: "J",
            value: sum.value(),
        })
    }

    pub(super) fn warning(&self) -> Option<String> {
        self.unserved.map(|[time, x, y, z]| {
            format!(
                "from {time:.4} s on metal that froze beside a wall of held temperature takes no heat from it, first at ({x:.4e}, \
                 {y:.4e}, {z:.4e}) m: such walls carry heat of liquid, and of what is frozen beside liquid"
            )
        })
    }

    pub(super) fn bytes(&self) -> usize {
        8 * self.beside.capacity() + self.served.capacity()
    }

    pub(super) fn save(&self) -> Vec<f64> {
        let sums = [self.taken, self.given];
        let mut saved: Vec<f64> = sums.iter().flat_map(Sum::save).collect();
        saved.extend(self.unserved.unwrap_or([f64::NAN; 4]));
        saved
    }

    /// Takes back what [`Walls::save`] gave; what follows it.
    pub(super) fn restore<'a>(&mut self, saved: &'a [f64]) -> &'a [f64] {
        let (own, after) = saved.split_at(SAVED.min(saved.len()));
        (self.taken, self.given) = (Sum::restored(own), Sum::restored(&own[2.min(own.len())..]));
        let at = own.get(4..).and_then(|at| at.first_chunk().copied());
        self.unserved = at.filter(|at: &[f64; 4]| !at[0].is_nan());
        after
    }
}
