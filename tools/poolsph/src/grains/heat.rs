//! Heat between grains that touch, and their change of state.
//!
//! ```text
//! m dh_a/dt = sum over contacts of (H_c + H_g) (T_b - T_a)                     (Komen 2019, eq. 5.33)
//! H_c = 4 k_a k_b / (k_a + k_b) r_c,  H_g = k_g 2 pi (1 - (r_c/r)^2/2) (r - r_c) / (1 - pi/4)     (5.35 made right, 5.36)
//! ```
//!
//! r_c is that of elastic spheres of the real modulus under the same push (Hertz 1881), so that what a bed conducts does not hang on
//! the spring of its contacts; or that of the overlap (5.34), with H_c made right or as printed, half of it. In the gas
//! formula the radius of unequal spheres is twice the effective one.
//!
//! The enthalpy is the state and temperature follows from it, as in the metal: what one grain gives the other gets, bit for bit. A
//! grain of powder becomes slag, and slag frozen slag, halfway through the latent heat; slag conducts so many times
//! better as its scene says, for its convection (Komen 2019, section 5.3.2: three times).

use std::sync::Arc;

use contact::{Grain, Meeting, Normal, heat as conductance};
use particles::{Column, POSITION, Set, sweep};
use rayon::prelude::*;
use run::Fault;
use run::property::{Arguments, Curve, OutOfRange};

use super::lists::{Lists, ROWS, Touch};
use super::parameters::{ConductanceScene, GrainHeat, Law, Parameters};
use super::{MASS, RADIUS};
use crate::heat::Caloric;
use crate::stage::StageError;
use crate::state::{LIQUID, State};

/// T \[K\].
pub const TEMPERATURE: Column<f64> = Column::new("temperature", "K", 0.0).saved().shown();
/// Specific enthalpy \[J/kg\].
pub const ENTHALPY: Column<f64> = Column::new("enthalpy", "J/kg", 0.0).saved();
/// [`POWDER`], [`SLAG`] or [`FROZEN`].
pub const STATE: Column<u8> = Column::new("state", "1", POWDER).saved().shown();
/// Number of the body that keeps its temperature, plus one; 0 for a free grain.
pub const HELD: Column<u8> = Column::new("held", "1", 0).saved();

/// A grain that has not melted yet.
pub const POWDER: u8 = 0;
/// A grain that is molten.
pub const SLAG: u8 = 1;
/// A grain that has set again.
pub const FROZEN: u8 = 2;

/// Part of the longest stable step that is taken.
const PART: f64 = 0.5;

/// How the radius of a contact is found.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Radius {
    /// From the push, by the effective modulus \[Pa\].
    Force(f64),
    /// From the overlap; `printed` takes half of the conductance.
    Overlap { printed: bool },
}

/// Heat of grains as a stage.
pub struct Heat {
    caloric: Arc<Caloric>,
    law: Law,
    radius: Radius,
    gas: Option<Curve>,
    slag: f64,
    held: Vec<Option<Curve>>,
    /// H of each pair of each chunk \[W/K\].
    conductance: Vec<Vec<f64>>,
    /// Sum of H of each grain \[W/K\], and the heat that it gets \[W\].
    sum: Vec<f64>,
    rate: Vec<f64>,
    /// Heat that kept temperatures have brought \[J\].
    pub(super) brought: f64,
    /// The longest step \[s\].
    pub(super) limit: f64,
}

impl Heat {
    /// Heat of the grains of a scene.
    ///
    /// # Errors
    /// A property that cannot be read.
    pub fn new(scene: &Parameters, heat: &GrainHeat) -> Result<Self, Fault> {
        let gas = heat.gas_conductivity_w_m_k.as_ref();
        let gas = gas
            .map(|k| k.compile_positive("/heat/gas_conductivity_w_m_k", &["T"], "W/(m K)"))
            .transpose()?;
        let held = |(i, body): (usize, &super::parameters::GrainBody)| {
            let curve = body.held_temperature_k.as_ref();
            curve
                .map(|t| t.compile(&format!("/bodies/{i}/held_temperature_k"), &["t"]))
                .transpose()
        };
        Ok(Self {
            caloric: heat.caloric().map_err(|fault| fault.within("/heat"))?,
            law: scene.contact.law(),
            radius: match heat.contact {
                ConductanceScene::Elastic(elastic) => Radius::Force(elastic.effective()),
                ConductanceScene::Overlap => Radius::Overlap { printed: false },
                ConductanceScene::Printed => Radius::Overlap { printed: true },
            },
            gas,
            slag: heat.melting.map_or(1.0, |m| m.slag_conductivity_ratio),
            held: scene
                .bodies
                .iter()
                .enumerate()
                .map(held)
                .collect::<Result<_, _>>()?,
            conductance: Vec::new(),
            sum: Vec::new(),
            rate: Vec::new(),
            brought: 0.0,
            limit: f64::INFINITY,
        })
    }

    /// Conductances of all contacts \[W/K\] and the longest step \[s\].
    fn conduct(&mut self, set: &Set, lists: &Lists) -> Result<(), OutOfRange> {
        let mut all = std::mem::take(&mut self.conductance);
        let columns = (
            set.column(&POSITION),
            set.column(&RADIUS),
            set.column(&MASS),
        );
        let (temperature, states) = (set.column(&TEMPERATURE), set.column(&STATE));
        let grain = |a: usize| Grain {
            position: columns.0[a],
            velocity: [0.0; 3],
            spin: [0.0; 3],
            radius: columns.1[a],
            mass: columns.2[a],
        };
        let own = |a: usize| {
            let k = self.caloric.conductivity(temperature[a]);
            if states[a] == SLAG { self.slag * k } else { k }
        };
        let pair = |a: usize, b: usize| -> Result<f64, OutOfRange> {
            let Some(meeting) = Meeting::of(&grain(a), &grain(b)) else {
                return Ok(0.0);
            };
            let gas = match &self.gas {
                None => None,
                Some(gas) => Some(gas.at_temperature(0.5 * (temperature[a] + temperature[b]))?),
            };
            Ok(self.of_contact(&meeting, columns.1[a], [own(a), own(b)], gas))
        };
        all.resize_with(lists.chunks.len(), Vec::new);
        let chunks = all.par_iter_mut().zip(&lists.chunks).enumerate();
        let done: Result<(), OutOfRange> = chunks
            .map(|(c, (conductance, chunk))| {
                conductance.clear();
                for other in &chunk.pairs {
                    let touching = other.state == Touch::Touching;
                    let h = if touching {
                        pair(c * ROWS + other.own as usize, other.other as usize)?
                    } else {
                        0.0
                    };
                    conductance.push(h);
                }
                Ok(())
            })
            .collect();
        self.conductance = all;
        done?;
        let mut sum = std::mem::take(&mut self.sum);
        sum.resize(set.len(), 0.0);
        self.gather(lists, &mut sum, |_, _| 1.0);
        let least = self.caloric.least_heat();
        let fastest = sweep::greatest(set.len(), |a| sum[a] / (columns.2[a] * least));
        self.sum = sum;
        self.limit = fastest.map_or(f64::INFINITY, |(_, rate)| PART / rate);
        Ok(())
    }

    fn of_contact(&self, meeting: &Meeting, radius: f64, k: [f64; 2], gas: Option<f64>) -> f64 {
        let wide = 2.0 * meeting.radius;
        let arm = meeting.arms[0];
        let by_overlap = (radius * radius - arm * arm).max(0.0).sqrt();
        let (r_c, solid) = match self.radius {
            Radius::Force(modulus) => {
                let push = match &self.law {
                    Law::Linear(law) => law.push(&still(meeting)),
                    Law::Hertz(law) => law.push(&still(meeting)),
                };
                let r_c = conductance::radius_by_force(push, meeting.radius, modulus);
                (r_c, conductance::constriction(k, r_c))
            }
            Radius::Overlap { printed: false } => {
                (by_overlap, conductance::constriction(k, by_overlap))
            }
            Radius::Overlap { printed: true } => (
                by_overlap,
                conductance::constriction_as_printed(k, by_overlap),
            ),
        };
        solid + gas.map_or(0.0, |k_g| conductance::gas(k_g, wide, r_c))
    }

    /// Sums H times `weight(a, b)` over the contacts of each grain a, in the order of the list.
    fn gather(&self, lists: &Lists, sums: &mut [f64], weight: impl Fn(usize, usize) -> f64 + Sync) {
        let chunks = sums.par_chunks_mut(ROWS).zip(&lists.chunks).enumerate();
        chunks.for_each(|(c, (sums, chunk))| {
            let first = c * ROWS;
            sums.fill(0.0);
            for (place, pair) in chunk.pairs.iter().enumerate() {
                let (own, b) = (pair.own as usize, pair.other as usize);
                let h = self.conductance[c][place];
                if h > 0.0 {
                    sums[own] += h * weight(first + own, b);
                    if place < chunk.inner {
                        sums[b - first] += h * weight(b, first + own);
                    }
                }
            }
            for incoming in &chunk.incoming {
                let from = &lists.chunks[incoming.chunk as usize];
                let place = from.place(*incoming);
                let h = self.conductance[incoming.chunk as usize][place];
                if h > 0.0 {
                    let row = incoming.row as usize;
                    let b = incoming.chunk as usize * ROWS + from.pairs[place].own as usize;
                    sums[row] += h * weight(first + row, b);
                }
            }
        });
    }

    /// One step of `step` \[s\] to `time` \[s\].
    fn step(
        &mut self,
        (set, lists): (&mut Set, &Lists),
        time: f64,
        step: f64,
    ) -> Result<(), OutOfRange> {
        let mut rate = std::mem::take(&mut self.rate);
        rate.resize(set.len(), 0.0);
        let temperature = set.column(&TEMPERATURE);
        self.gather(lists, &mut rate, |a, b| temperature[b] - temperature[a]);
        let mut enthalpy = set.take(&ENTHALPY);
        let mass = set.column(&MASS);
        sweep::change(&mut enthalpy, |a, h| *h += step * rate[a] / mass[a]);
        let held = set.column(&HELD).iter().enumerate();
        for (a, body) in held.filter(|(_, body)| **body > 0) {
            if let Some(curve) = &self.held[*body as usize - 1] {
                let kept = curve.value(&Arguments::at([0.0; 3], time))?;
                let kept = self.caloric.enthalpy(kept);
                self.brought += mass[a] * (kept - enthalpy[a]);
                enthalpy[a] = kept;
            }
        }
        let caloric = &self.caloric;
        sweep::fill(set.column_mut(&TEMPERATURE), |a| {
            caloric.temperature(enthalpy[a])
        });
        set.put(&ENTHALPY, enthalpy);
        self.rate = rate;
        Ok(())
    }

    /// Powder melts to slag, slag sets.
    fn change(&self, set: &mut Set) {
        let mut states = set.take(&STATE);
        let enthalpy = set.column(&ENTHALPY);
        sweep::change(&mut states, |a, state| {
            let liquid = self.caloric.molten(enthalpy[a]) >= LIQUID;
            *state = match (*state, liquid) {
                (_, true) => SLAG,
                (SLAG, false) => FROZEN,
                (state, false) => state,
            };
        });
        set.put(&STATE, states);
    }

    fn beyond(&self, set: &Set, step: u64) -> Option<StageError> {
        let temperature = set.column(&TEMPERATURE);
        let row = temperature.iter().position(|t| !self.caloric.covers(*t))?;
        let (low, high) = self.caloric.range();
        let value = temperature[row];
        Some(StageError::Diverged {
            step,
            particle: row,
            place: set.column(&POSITION)[row],
            quantity: "temperature of a grain",
            value,
            limit: if value < low { low } else { high },
            unit: "K",
        })
    }
}

/// A contact whose overlap stands still.
fn still(meeting: &Meeting) -> Meeting {
    Meeting {
        approach: 0.0,
        ..*meeting
    }
}

/// Gives the grains of a scene the columns of heat and their first temperatures.
///
/// # Errors
/// A body without a temperature, or one that the properties do not hold.
pub fn warm(scene: &Parameters, heat: &Heat, set: &mut Set, counts: &[usize]) -> Result<(), Fault> {
    for column in [&TEMPERATURE, &ENTHALPY] {
        set.declare(column);
    }
    set.declare(&STATE);
    if heat.held.iter().any(Option::is_some) {
        set.declare(&HELD);
    }
    let mut row = 0;
    for (i, (body, count)) in scene.bodies.iter().zip(counts).enumerate() {
        let at = format!("/bodies/{i}");
        let first = match (&body.temperature_k, &heat.held[i]) {
            (Some(property), _) => {
                property.compile(&format!("{at}/temperature_k"), &["x", "y", "z", "r"])?
            }
            (None, Some(held)) => held.clone(),
            (None, None) => {
                return Err(Fault::at(
                    &at,
                    "has no key 'temperature_k' in K, which grains with heat need",
                ));
            }
        };
        for _ in 0..*count {
            let place = set.column(&POSITION)[row];
            let value = first.value(&Arguments::at(place, 0.0));
            let value = value
                .map_err(|what| Fault::at(&format!("{at}/temperature_k"), what.to_string()))?;
            if !heat.caloric.covers(value) {
                let (low, high) = heat.caloric.range();
                let what = format!("gives {value} K; the properties hold from {low} to {high} K");
                return Err(Fault::at(&format!("{at}/temperature_k"), what));
            }
            set.column_mut(&TEMPERATURE)[row] = value;
            let enthalpy = heat.caloric.enthalpy(value);
            set.column_mut(&ENTHALPY)[row] = enthalpy;
            if heat.held[i].is_some() {
                set.column_mut(&HELD)[row] = i as u8 + 1;
            }
            row += 1;
        }
    }
    heat.change(set);
    Ok(())
}

impl Heat {
    /// Heat over `dt` \[s\] between grains of `set` that touch by `lists`.
    ///
    /// # Errors
    /// A temperature that the properties do not hold.
    pub fn advance(
        &mut self,
        (set, lists): (&mut Set, &Lists),
        state: &State,
        dt: f64,
    ) -> Result<(), StageError> {
        let mut march = || -> Result<(), OutOfRange> {
            self.conduct(set, lists)?;
            let parts = (dt / self.limit - 1e-9).ceil().max(1.0);
            let step = dt / parts;
            for part in 1..=parts as u64 {
                self.step((set, lists), state.time + part as f64 * step, step)?;
            }
            Ok(())
        };
        march().map_err(|what| StageError::Data(what.to_string()))?;
        self.change(set);
        self.beyond(set, state.step).map_or(Ok(()), Err)
    }

    /// Bytes held.
    #[must_use]
    pub fn bytes(&self) -> usize {
        let pairs: usize = self.conductance.iter().map(Vec::capacity).sum();
        8 * (pairs + self.sum.capacity() + self.rate.capacity())
    }
}
