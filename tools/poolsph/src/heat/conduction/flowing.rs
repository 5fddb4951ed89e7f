//! Heat between moving particles and what they touch, pair by pair over the rows of [`crate::near`], and of walls in the
//! planes of faces.

use neighbours::ROWS;
use rayon::prelude::*;

use super::Conduction;
use super::exchanged::Exchanged;
use crate::heat::substances::{Substance, Substances};
use crate::near::{Near, Role};
use crate::stage::StageError;
use crate::state::{ENTHALPY, State, TEMPERATURE};

impl Conduction {
    /// Exchanges heat of pairs with a moving particle over `dt`.
    pub(super) fn exchange_in_flow(
        &mut self,
        state: &mut State,
        dt: f64,
    ) -> Result<(), StageError> {
        if let Some(walls) = &mut self.walls {
            walls.take(state)?;
        }
        let near = &state.near;
        let enthalpies = state.metal.column(&ENTHALPY);
        let marks = Substances::marks(&state.metal);
        let temperatures = state.metal.column(&TEMPERATURE);
        let mut exchanged = std::mem::take(&mut self.exchanged);
        (0..near.len())
            .into_par_iter()
            .with_min_len(ROWS)
            .map(|k| {
                let id = near.id[k] as usize;
                match near.role[k] {
                    Role::Backing => {
                        Exchanged::unchanged(near.id[k], enthalpies[id], temperatures[id])
                    }
                    _ => self.in_flow(near, k, (enthalpies[id], self.made.at(marks, id)), dt),
                }
            })
            .collect_into_vec(&mut exchanged);
        if let Some(walls) = &mut self.walls {
            walls.count(&exchanged);
            walls.look(state, &self.rest);
        }
        let stored = self.store(state, &exchanged);
        self.exchanged = exchanged;
        stored
    }

    fn in_flow(&self, near: &Near, k: usize, own: (f64, &Substance), dt: f64) -> Exchanged {
        let (enthalpy, own) = own;
        let (chunk, pairs) = (&near.lists.chunks()[k / ROWS], &near.pairs[k / ROWS]);
        let row = chunk.row(k % ROWS).iter();
        let weights = &pairs.value[chunk.range(k % ROWS)];
        let a = near.id[k] as usize;
        let [temperature, resistivity] = self.thermal[a];
        let moves = near.role[k] == Role::Liquid;
        let mut gain = 0.0;
        for (&j, weight) in row.zip(weights) {
            if moves || near.role[j as usize].flows() {
                let b = near.id[j as usize] as usize;
                let [other, resists] = self.thermal[b];
                gain += weight * 2.0 / (resistivity + resists) * (other - temperature);
            }
        }
        let mut out = 0.0;
        if let Some(walls) = &self.walls {
            // An image at its own temperature is counted above; what the wall adds to that is given here.
            let pairs = chunk.row(k % ROWS).iter().zip(weights);
            let pairs = pairs.map(|(&j, weight)| (j as usize, *weight));
            let (entering, more) = walls.through(near, k, pairs, &self.thermal);
            gain += more;
            out = -self.scale * dt * entering;
        }
        let enthalpy = enthalpy + self.scale * dt * gain / own.mass;
        Exchanged {
            a: a as u32,
            enthalpy,
            temperature: own.caloric.temperature(enthalpy),
            out,
            busy: true,
            wakes: false,
        }
    }
}
