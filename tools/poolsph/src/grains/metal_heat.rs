//! Heat between grains and the metal that they touch.
//!
//! ```text
//! m_a dh_a/dt += sum over b of H_ab (T_b - T_a),     m_b dh_b/dt -= the same          (Komen 2019, eq. 5.33)
//! sum over b of H_ab = 4 k_a k_b / (k_a + k_b) r_c + 2 H_g               shared by the push of each b on a
//! ```
//!
//! Metal is flat to a grain, however its particles lie: one contact, whose push is that of all of them together, with the radius
//! of an elastic sphere on a flat face (Hertz 1881). The face stands where the plane of symmetry of two grains would: the gas
//! has half the way of eq. 5.36 and conducts twice as well. Slag that wets the metal touches it through the whole grain, without gas. Four particles under a grain, each with a
//! contact of its own, would let through four times the gas. With contacts as wide as the overlap (5.34) each is counted by itself and as
//! between two grains, as the source does.
//!
//! What a grain gets metal gives, number for number, so the energy of both is kept as sums keep it.

use std::sync::Arc;

use contact::{Grain, Meeting, heat as conductance};
use particles::POSITION;
use run::property::OutOfRange;
use shapes::frame::{along, length};

use super::columns::POWDER;
use super::conducting::{Conducting, Radius};
use super::metal_pair::{Body, Pair};
use super::slow::Pass;
use crate::heat::Caloric;
use crate::heat::ledger::Sum;
use crate::heat::received::{self, FROM_POWDER, FROM_SLAG};
use crate::stage::StageError;
use crate::state::{ENTHALPY, State, TEMPERATURE};

/// Contacts of grains with metal.
#[derive(Debug, Clone, Copy)]
pub(super) struct Contacts<'a> {
    /// By rows of grains.
    pub(super) pairs: &'a [Pair],
    /// The metal.
    pub(super) bodies: &'a [Body],
}

/// A contact that conducts.
#[derive(Debug, Clone, Copy)]
struct Link {
    row: u32,
    body: u32,
    /// H \[W/K\].
    conductance: f64,
    /// Heat into the grain \[W\].
    rate: f64,
}

/// Heat between grains and metal.
#[derive(Debug, Clone)]
pub struct Exchange {
    /// That of the metal.
    caloric: Arc<Caloric>,
    /// Effective modulus of a grain on metal \[Pa\].
    modulus: f64,
    links: Vec<Link>,
    /// Sum of H of each body \[W/K\].
    sums: Vec<f64>,
    /// Heat that grains have given to metal \[J\].
    given: Sum,
}

impl Exchange {
    /// Heat between grains and metal of these properties; `modulus` is the effective one of both \[Pa\].
    #[must_use]
    pub fn new(caloric: Arc<Caloric>, modulus: f64) -> Self {
        Self {
            caloric,
            modulus,
            links: Vec::new(),
            sums: Vec::new(),
            given: Sum::default(),
        }
    }

    /// Heat that grains have given to metal \[J\].
    #[must_use]
    pub fn given(&self) -> f64 {
        self.given.value()
    }

    /// Conductances of all contacts; adds those of each grain to `sums` \[W/K\], and gives the fastest rate of a particle of metal \[1/s\].
    pub(super) fn conduct(
        &mut self,
        contacts: Contacts<'_>,
        grains: &Conducting<'_>,
        pass: Pass<'_>,
        state: &State,
        sums: &mut [f64],
    ) -> Result<f64, OutOfRange> {
        let Contacts { pairs, bodies } = contacts;
        self.links.clear();
        let rows = pairs.chunk_by(|a, b| a.near.row == b.near.row);
        for row in rows.filter(|row| pass.takes_alone(row[0].near.row as usize)) {
            self.of_grain(row, bodies, grains, state)?;
        }
        self.sums.clear();
        self.sums.resize(bodies.len(), 0.0);
        for link in &self.links {
            sums[link.row as usize] += link.conductance;
            self.sums[link.body as usize] += link.conductance;
        }
        let greatest = self.sums.iter().copied().fold(0.0, f64::max);
        Ok(greatest / (state.metal.matter.mass() * self.caloric.least_heat()))
    }

    /// The contacts of one grain.
    fn of_grain(
        &mut self,
        row: &[Pair],
        bodies: &[Body],
        grains: &Conducting<'_>,
        state: &State,
    ) -> Result<(), OutOfRange> {
        let a = row[0].near.row as usize;
        let grain = grains.grain(a);
        let touching = row.iter().filter_map(|pair| {
            let meeting = bodies[pair.body as usize].meeting(&grain)?;
            (meeting.overlap > 0.0).then_some((pair.body, meeting))
        });
        let temperatures = state.metal.column(&TEMPERATURE);
        let own = grains.conductivity(a);
        let first = self.links.len();
        let spread = grains.spread(a);
        let shared = spread || matches!(grains.radius(), Radius::Force(_));
        let (mut all, mut sum) = ([0.0; 3], 0.0);
        for (body, meeting) in touching {
            let push = grains.push(&meeting);
            (all, sum) = (along(all, push, meeting.normal), sum + push);
            let id = bodies[body as usize].id as usize;
            let metal = temperatures[id];
            let pair = [own, self.caloric.conductivity(metal)];
            let gas = grains.gas(0.5 * (grains.temperature[a] + metal))?;
            let conductance = match grains.radius() {
                Radius::Overlap { printed } if !shared => {
                    self.by_overlap(&grain, &meeting, pair, gas, printed)
                }
                // For now the push alone: the width follows from that of all together.
                _ => push,
            };
            self.links.push(Link {
                row: a as u32,
                body,
                conductance,
                rate: 0.0,
            });
        }
        if shared && sum > 0.0 {
            let r_c = if spread {
                grain.radius
            } else {
                conductance::radius_by_force(length(all), grain.radius, self.modulus)
            };
            for link in &mut self.links[first..] {
                let id = bodies[link.body as usize].id as usize;
                let metal = temperatures[id];
                let gas = grains.gas(0.5 * (grains.temperature[a] + metal))?;
                let solid = conductance::constriction([own, self.caloric.conductivity(metal)], r_c);
                let around = gas.map_or(0.0, |k| 2.0 * conductance::gas(k, grain.radius, r_c));
                link.conductance *= (solid + around) / sum;
            }
        }
        Ok(())
    }

    /// The conductance of a contact as wide as its overlap \[W/K\] (eqs 5.34 to 5.36).
    fn by_overlap(
        &self,
        grain: &Grain,
        meeting: &Meeting,
        pair: [f64; 2],
        gas: Option<f64>,
        printed: bool,
    ) -> f64 {
        let (r, arm) = (grain.radius, meeting.arms[0]);
        let r_c = (r * r - arm * arm).max(0.0).sqrt();
        let solid = if printed {
            conductance::constriction_as_printed(pair, r_c)
        } else {
            conductance::constriction(pair, r_c)
        };
        solid + gas.map_or(0.0, |k| conductance::gas(k, r, r_c))
    }

    /// Adds the heat that each grain gets from metal to `rates` \[W\].
    pub(super) fn flow(
        &mut self,
        bodies: &[Body],
        grains: &[f64],
        metal: &[f64],
        rates: &mut [f64],
    ) {
        for link in &mut self.links {
            let (a, id) = (link.row as usize, bodies[link.body as usize].id as usize);
            link.rate = link.conductance * (metal[id] - grains[a]);
            rates[a] += link.rate;
        }
    }

    /// Takes from the metal what the grains, by what they are, have got in a step of `step` \[s\].
    pub(super) fn take(&mut self, bodies: &[Body], grains: &[u8], state: &mut State, step: f64) {
        let mass = state.metal.matter.mass();
        let columns = (&ENTHALPY, &TEMPERATURE, &FROM_POWDER, &FROM_SLAG);
        let (enthalpies, temperatures, powder, slag) = state.metal.columns_mut(columns);
        for link in &self.links {
            let id = bodies[link.body as usize].id as usize;
            enthalpies[id] -= step * link.rate / mass;
            self.given.add(-step * link.rate);
            let told = match grains[link.row as usize] {
                POWDER => &mut *powder,
                _ => &mut *slag,
            };
            received::add(told, id, -step * link.rate);
        }
        for link in &self.links {
            let id = bodies[link.body as usize].id as usize;
            temperatures[id] = self.caloric.temperature(enthalpies[id]);
        }
    }

    /// An error where metal has left what its properties hold for.
    pub(super) fn beyond(&self, bodies: &[Body], state: &State) -> Result<(), StageError> {
        let ids = self.links.iter().map(|link| bodies[link.body as usize].id);
        let temperatures = state.metal.column(&TEMPERATURE);
        for id in ids.map(|id| id as usize) {
            let value = temperatures[id];
            if !self.caloric.covers(value) {
                let place = state.metal.column(&POSITION)[id];
                return Err(crate::heat::outside(
                    state.step,
                    id,
                    place,
                    value,
                    &self.caloric,
                ));
            }
        }
        Ok(())
    }

    /// The heat given, as numbers for a checkpoint.
    pub(super) fn save(&self) -> [f64; 2] {
        self.given.save()
    }

    /// Takes back what [`Exchange::save`] gave.
    pub(super) fn restore(&mut self, saved: &[f64]) {
        self.given = Sum::restored(saved);
    }
}
