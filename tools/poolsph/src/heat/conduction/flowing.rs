//! Heat between moving particles and what they touch, pair by pair over the rows of [`crate::near`], and of walls in the
//! planes of faces.

use neighbours::ROWS;
use rayon::prelude::*;

use super::Conduction;
use super::exchanged::Exchanged;
use crate::faces::Turn;
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
        let near = &state.near;
        let enthalpies = state.metal.column(&ENTHALPY);
        let temperatures = state.metal.column(&TEMPERATURE);
        self.beside.clear();
        if self.walls {
            let (faces, time, beside) = (&state.faces, state.time, &mut self.beside);
            let found = near.temperatures(faces, time, temperatures, beside);
            found.map_err(|fault| StageError::Data(format!("temperature of a wall: {fault}")))?;
        }
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
                    _ => self.in_flow(near, k, enthalpies[id], dt),
                }
            })
            .collect_into_vec(&mut exchanged);
        if !self.beside.is_empty() {
            // What walls give and what they take are told apart: between a hot and a cold wall their sum says nothing.
            for one in &exchanged {
                match one.out < 0.0 {
                    true => self.in_walls.add(-one.out),
                    false => self.out_walls.add(one.out),
                }
            }
        }
        let stored = self.store(state, &exchanged);
        self.exchanged = exchanged;
        stored
    }

    fn in_flow(&self, near: &Near, k: usize, enthalpy: f64, dt: f64) -> Exchanged {
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
        if !self.beside.is_empty() {
            // An image at its own temperature is counted above; what the wall adds to that is given here.
            let (entering, more) = self.through_walls(near, k);
            gain += more;
            out = -self.scale * dt * entering;
        }
        let enthalpy = enthalpy + self.scale * dt * gain / self.metal.mass();
        Exchanged {
            a: a as u32,
            enthalpy,
            temperature: self.caloric.temperature(enthalpy),
            out,
            busy: true,
            wakes: false,
        }
    }

    /// What walls of held temperature give to the `k`-th particle of the copy, and how much more that is than what their
    /// images would give at the temperatures of their originals.
    fn through_walls(&self, near: &Near, k: usize) -> (f64, f64) {
        let (chunk, pairs) = (&near.lists.chunks()[k / ROWS], &near.pairs[k / ROWS]);
        let weights = &pairs.value[chunk.range(k % ROWS)];
        let [temperature, resistivity] = self.thermal[near.id[k] as usize];
        let (mut entering, mut more) = (0.0, 0.0);
        for (&j, weight) in chunk.row(k % ROWS).iter().zip(weights) {
            let j = j as usize;
            if near.images().turn(j).is_some_and(Turn::is_held) {
                let [other, resists] = self.thermal[near.id[j] as usize];
                let weight = weight * 2.0 / (resistivity + resists);
                entering += weight * (self.beside[j] - temperature);
                more += weight * (self.beside[j] - other);
            }
        }
        (entering, more)
    }
}
