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

use particles::{POSITION, Set, sweep};
use rayon::prelude::*;
use run::Fault;
use run::property::{Arguments, Curve, OutOfRange};
use steps::Figure;

use super::MASS;
use super::columns::{ENTHALPY, FROZEN, HELD, SLAG, STATE, TEMPERATURE};
use super::conducting::{Conductor, Radius};
use super::depth::kept;
use super::heat_parameters::{ConductanceScene, GrainHeat};
use super::light::Lighting;
use super::lists::{AT_ONCE, Lists, ROWS};
use super::metal::Metal;
use super::metal_heat::Contacts;
use super::neighbours::Neighbours;
use super::parameters::Parameters;
use super::slow::{Busy, Long, Pass, SLOW};
use super::vapour::Vapour;
use crate::heat::Caloric;
use crate::stage::StageError;
use crate::state::{LIQUID, State};

/// Heat of grains as a stage.
pub struct Heat {
    pub(super) caloric: Arc<Caloric>,
    pub(super) conductor: Conductor,
    pub(super) held: Vec<Option<Curve>>,
    /// H of each pair of each chunk \[W/K\].
    pub(super) conductance: Vec<Vec<f64>>,
    /// Sum of H of each grain \[W/K\], and the heat that it gets \[W\].
    pub(super) sum: Vec<f64>,
    rate: Vec<f64>,
    /// Heat that kept temperatures have brought \[J\].
    pub(super) brought: f64,
    /// Slag that boils, if it can.
    vapour: Option<Vapour>,
    /// Light on grains.
    pub(super) lighting: Lighting,
    /// The longest step \[s\].
    pub(super) limit: f64,
    pub(super) busy: Busy,
    /// Whether contacts of grains of one temperature are asked for.
    pub(super) alike: bool,
    /// Long steps of what sleeps deep, if it has any.
    slow: Option<Long>,
}

/// Numbers of heat in a checkpoint.
pub(super) const SAVED: usize = 10;

/// A step of `step` \[s\] to `time` \[s\] of a pass.
struct Part<'a> {
    pass: Pass<'a>,
    time: f64,
    step: f64,
}

/// Values of chunks that get heat, changed.
fn change<T: Send>(get: &[bool], values: &mut [T], change: impl Fn(usize, &mut T) + Sync) {
    let chunks = values.par_chunks_mut(ROWS).zip(get).enumerate();
    let chunks = chunks.with_max_len(AT_ONCE);
    let chunks = chunks.filter(|(_, (_, gets))| **gets);
    chunks.for_each(|(c, (values, _))| {
        for (own, value) in values.iter_mut().enumerate() {
            change(c * ROWS + own, value);
        }
    });
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
        let caloric = heat.caloric().map_err(|fault| fault.within("/heat"))?;
        let boiling = heat.melting.and_then(|melting| melting.boiling_k);
        if let Some(fault) = heat.unmolten() {
            return Err(fault.within("/heat"));
        }
        Ok(Self {
            vapour: boiling.map(|t| Vapour::new(caloric.enthalpy(t), heat.slag_vapour)),
            lighting: Lighting::new(scene.walls.iter().any(|wall| wall.light.is_some())),
            conductor: Conductor {
                caloric: caloric.clone(),
                law: scene.contact.law(),
                radius: match heat.contact {
                    ConductanceScene::Elastic(elastic) => Radius::Force(elastic.effective()),
                    ConductanceScene::Overlap => Radius::Overlap { printed: false },
                    ConductanceScene::Printed => Radius::Overlap { printed: true },
                },
                gas,
                slag: heat.melting.map_or(1.0, |m| m.slag_conductivity_ratio),
                wets: heat.slag_wets,
            },
            caloric,
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
            busy: Busy::default(),
            alike: false,
            slow: None,
        })
    }

    /// Sums H times `weight(a, b)` over the contacts of each grain a, in the order of the list.
    pub(super) fn gather(
        &self,
        lists: &Lists,
        sums: &mut [f64],
        weight: impl Fn(usize, usize) -> f64 + Sync,
    ) {
        let conductance = |chunk: usize, place: usize| {
            let all = &self.conductance[chunk];
            all.get(place).copied().unwrap_or(0.0)
        };
        lists.sum(&self.busy.get, sums, conductance, weight);
    }

    /// One part of a pass.
    fn step(
        &mut self,
        set: &mut Set,
        state: &mut State,
        around: &mut Neighbours<'_>,
        part: Part<'_>,
    ) -> Result<(), OutOfRange> {
        let Part { pass, time, step } = part;
        let mut rate = std::mem::take(&mut self.rate);
        rate.resize(set.len(), 0.0);
        let temperature = set.column(&TEMPERATURE);
        let lists = around.lists;
        self.gather(lists, &mut rate, |a, b| temperature[b] - temperature[a]);
        let metal = around.metal.as_deref_mut();
        if let Some((exchange, Contacts { bodies, .. })) = metal.and_then(Metal::exchange) {
            exchange.flow(
                bodies,
                temperature,
                state.metal.column(&TEMPERATURE),
                &mut rate,
            );
            exchange.take(bodies, set.column(&STATE), state, step);
        }
        if pass.shines() {
            self.lighting.heat(temperature, &mut rate, step);
        }
        let mut enthalpy = set.take(&ENTHALPY);
        let mass = set.column(&MASS);
        let get = &self.busy.get;
        change(get, &mut enthalpy, |a, h| *h += step * rate[a] / mass[a]);
        if let Some(vapour) = &mut self.vapour {
            vapour.rise(lists, get, mass, &mut enthalpy);
        }
        let held = set.column(&HELD).iter().enumerate();
        for (a, body) in held.filter(|(_, body)| **body > 0) {
            if let Some(curve) = &self.held[*body as usize - 1] {
                let kept = curve.value(&Arguments::at([0.0; 3], time))?;
                let kept = self.caloric.enthalpy(kept);
                self.brought += mass[a] * (kept - enthalpy[a]);
                enthalpy[a] = kept;
            }
        }
        let (caloric, vapour) = (&self.caloric, self.vapour.as_ref());
        let (temperatures, held) = set.columns_mut((&TEMPERATURE, &HELD));
        change(get, temperatures, |a, t| {
            let held = held.get(a).is_some_and(|body| *body > 0);
            // What has got no heat has the temperature that it had.
            let boils = vapour.is_some_and(|vapour| vapour.changes(a, enthalpy[a]));
            if rate[a] != 0.0 || held || boils {
                let h = vapour.map_or(enthalpy[a], |vapour| vapour.sensible(enthalpy[a]));
                *t = caloric.temperature(h);
            }
        });
        set.put(&ENTHALPY, enthalpy);
        self.rate = rate;
        Ok(())
    }

    /// Powder melts to slag, slag sets.
    pub(super) fn change(&self, set: &mut Set) {
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

impl Heat {
    /// Heat over `dt` \[s\] between grains of `set` that touch, and with the metal beside them.
    ///
    /// # Errors
    /// A temperature that the properties do not hold.
    pub fn advance(
        &mut self,
        set: &mut Set,
        mut around: Neighbours<'_>,
        state: &mut State,
        dt: f64,
    ) -> Result<(), StageError> {
        let mut march = || -> Result<(), OutOfRange> {
            self.lighting.fall(around.walls.lit(), [state.time, dt])?;
            let Some(slow) = self.slow.as_mut() else {
                return self.pass(set, state, &mut around, Pass::Every, dt);
            };
            slow.waited += dt;
            let waited = slow.waited;
            let flags = set.take(&SLOW);
            if slow.due(state.step, state.stride) {
                self.pass(set, state, &mut around, Pass::Slow(&flags), waited)?;
            }
            let done = self.pass(set, state, &mut around, Pass::Quick(&flags), dt);
            set.put(&SLOW, flags);
            done
        };
        march().map_err(|what| StageError::Data(what.to_string()))?;
        if let Some(slow) = &mut self.slow
            && slow.due(state.step, state.stride)
        {
            slow.waited = 0.0;
            let depth = around.depth;
            sweep::fill(set.column_mut(&SLOW), |row| u8::from(kept(depth, row)));
        }
        self.change(set);
        let metal = around.metal.and_then(Metal::exchange);
        if let Some((exchange, Contacts { bodies, .. })) = metal {
            exchange.beyond(bodies, state)?;
        }
        self.beyond(set, state.step).map_or(Ok(()), Err)
    }

    /// Heat of one pass over `dt` \[s\].
    fn pass(
        &mut self,
        set: &mut Set,
        state: &mut State,
        around: &mut Neighbours<'_>,
        pass: Pass<'_>,
        dt: f64,
    ) -> Result<(), OutOfRange> {
        let lists = around.lists;
        self.alike = false;
        self.conduct(set, state, lists, around.metal.as_deref_mut(), pass)?;
        if self.limit * (1.0 + 1e-9) < dt {
            // In the parts of a divided step heat comes to contacts that had none to pass at its start.
            self.alike = true;
            self.conduct(set, state, lists, around.metal.as_deref_mut(), pass)?;
        }
        let parts = (dt / self.limit - 1e-9).ceil().max(1.0);
        let step = dt / parts;
        for part in 1..=parts as u64 {
            let time = state.time + part as f64 * step;
            self.step(set, state, around, Part { pass, time, step })?;
        }
        Ok(())
    }

    /// Lets the heat of what sleeps deep go once in `interval` steps.
    #[must_use]
    pub fn slowly(self, interval: u64) -> Self {
        let slow = (interval > 1).then_some(Long {
            interval,
            waited: 0.0,
        });
        Self { slow, ..self }
    }

    /// Whether heat of what sleeps goes in the step of `stride` of the scene's after `step` others, so that all contacts are wanted.
    pub(super) fn wants_all(&self, step: u64, stride: u64) -> bool {
        self.slow.as_ref().is_none_or(|slow| slow.due(step, stride))
    }

    /// Sums, the longest step and the time of a long one, for a checkpoint.
    pub(super) fn saved(&self) -> [f64; SAVED] {
        let waited = self.slow.as_ref().map_or(0.0, |slow| slow.waited);
        let [a, b, c, d, e] = self.lighting.saved();
        let [left, condensed] = self.vapour.as_ref().map_or([0.0; 2], |vapour| vapour.sums);
        [
            self.brought,
            self.limit,
            left,
            condensed,
            waited,
            a,
            b,
            c,
            d,
            e,
        ]
    }

    /// Takes back what [`Heat::saved`] gave.
    pub(super) fn take_back(&mut self, saved: [f64; SAVED]) {
        let [brought, limit, left, condensed, waited, light @ ..] = saved;
        (self.brought, self.limit) = (brought, limit);
        if let Some(vapour) = &mut self.vapour {
            vapour.sums = [left, condensed];
        }
        self.lighting.take_back(light);
        if let Some(slow) = &mut self.slow {
            slow.waited = waited;
        }
    }

    /// Sums over the run.
    pub(super) fn figures(&self) -> Vec<Figure> {
        let figure = |name, value| Figure {
            name,
            unit: "J",
            value,
        };
        let mut figures = vec![figure("grain_heat_held_j", self.brought)];
        figures.extend(self.vapour.iter().flat_map(Vapour::figures));
        figures.extend(self.lighting.figures());
        figures
    }

    /// Bytes held.
    #[must_use]
    pub fn bytes(&self) -> usize {
        let pairs: usize = self.conductance.iter().map(Vec::capacity).sum();
        8 * (pairs + self.sum.capacity() + self.rate.capacity())
    }
}
