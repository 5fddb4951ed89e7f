//! A wire: how often droplets leave it, what they are, and which of them fly.

use std::sync::Arc;

use particles::{Matter, POSITION};
use run::Fault;

use super::ground::Ground;
use super::{Mirror, Parameters, shape};
use crate::heat::Caloric;
use crate::heat::ledger::Sum;
use crate::state::{PHASE, Particle, State, VELOCITY, phase};

/// Part of a spacing that a droplet falls in a step when it lands, where steps are adaptive.
const FALL: f64 = 0.4;
/// Part of a period by which a droplet may be early, for the rounding of times.
const EARLY: f64 = 1e-6;

/// A wire and its droplets.
pub struct Wire {
    parameters: Parameters,
    /// From the axis of the source \[m\].
    offset: [f64; 3],
    /// Time between two \[s\].
    period: f64,
    /// Places of the particles about the centre \[m\].
    shape: Vec<[f64; 3]>,
    temperature: f64,
    enthalpy: f64,
    mass: f64,
    born: u64,
    energy: Sum,
    flying: Vec<usize>,
    /// Height of the lowest metal at the start \[m\].
    floor: f64,
    /// Particles that have fallen past all metal.
    past: u64,
}

impl Wire {
    /// A wire of `metal`; `caloric` where the scene has heat.
    ///
    /// # Errors
    /// A fault at the key that is wrong.
    pub fn new(
        parameters: Parameters,
        metal: Matter,
        mirror: Option<Mirror>,
        caloric: Option<&Arc<Caloric>>,
    ) -> Result<Self, Fault> {
        let Some(period) = parameters.period(metal.spacing, mirror) else {
            let what = "has neither 'period_s' in s nor 'feed_m3_s' in m3/s, which say how often droplets come";
            return Err(Fault::at("", what));
        };
        if parameters.height_m < parameters.radius_m {
            let what = format!(
                "{} m is less than radius_m, {} m: droplets would be born in the metal below",
                parameters.height_m, parameters.radius_m
            );
            return Err(Fault::at("/height_m", what));
        }
        let shape = shape(parameters.radius_m, metal.spacing, mirror);
        let (temperature, enthalpy) = match (parameters.temperature_k, caloric) {
            (_, None) => (0.0, 0.0),
            (None, Some(_)) => {
                let what = "has no key 'temperature_k' in K, which a scene with heat needs";
                return Err(Fault::at("", what));
            }
            (Some(t), Some(caloric)) if caloric.covers(t) => {
                let enthalpy = caloric.enthalpy(t);
                if caloric.melting_point().is_some() && !caloric.is_liquid(enthalpy) {
                    return Err(Fault::at("/temperature_k", format!("{t} K is not liquid")));
                }
                (t, enthalpy)
            }
            (Some(t), Some(caloric)) => {
                let (from, to) = caloric.range();
                let what = format!("{t} K is outside of the properties, {from} K to {to} K");
                return Err(Fault::at("/temperature_k", what));
            }
        };
        Ok(Self {
            parameters,
            offset: [0.0; 3],
            period,
            shape,
            temperature,
            enthalpy,
            mass: metal.mass(),
            born: 0,
            energy: Sum::default(),
            flying: Vec::new(),
            floor: f64::NAN,
            past: 0,
        })
    }

    /// The same, at this offset from the axis of the source \[m\].
    #[must_use]
    pub fn beside(self, offset: [f64; 3]) -> Self {
        Self { offset, ..self }
    }

    /// Particles of a droplet.
    #[must_use]
    pub fn particles(&self) -> usize {
        self.shape.len()
    }

    /// Number of droplets born until the time \[s\], its own moment included.
    pub(super) fn due(&self, time: f64) -> u64 {
        // A millionth of a period decides, not the rounding of the time.
        (time / self.period + EARLY).floor() as u64 + 1
    }

    fn bear(&mut self, state: &mut State, source: [f64; 3]) {
        let mut centre: [f64; 3] = std::array::from_fn(|k| source[k] + self.offset[k]);
        centre[2] += self.parameters.height_m;
        for offset in &self.shape {
            self.flying.push(state.len());
            state.push(Particle {
                position: [0, 1, 2].map(|k| centre[k] + offset[k]),
                velocity: [0.0, 0.0, -self.parameters.speed_m_s],
                phase: phase::FLYING,
                droplet: true,
                wall: false,
                temperature: self.temperature,
                enthalpy: self.enthalpy,
            });
            self.energy.add(self.mass * self.enthalpy);
        }
        self.born += 1;
    }

    /// Droplets fall for `dt` \[s\], land, and are born below a source until the end of the step. Gives the part of a period that
    /// has passed since the last was born.
    pub(super) fn advance(&mut self, state: &mut State, source: [f64; 3], dt: f64) -> f64 {
        let fall = self.parameters.speed_m_s * dt;
        if self.floor.is_nan() {
            let heights = state
                .metal
                .column(&POSITION)
                .iter()
                .map(|x| x[2])
                .reduce(f64::min);
            self.floor = heights.unwrap_or(f64::NEG_INFINITY);
        }
        let places = state.metal.column_mut(&POSITION);
        for &a in &self.flying {
            places[a][2] -= fall;
        }
        self.land(state, fall);
        self.pass(state);
        // The end of the step is what frames show.
        let end = state.end(dt);
        let due = self.due(end);
        while self.born < due {
            self.bear(state, source);
        }
        (end / self.period - (due - 1) as f64).clamp(0.0, 1.0)
    }

    /// Droplets that have come near what does not fly join it; `fall` is the way of the step \[m\].
    fn land(&mut self, state: &mut State, fall: f64) {
        let reach = if state.flowing {
            state.metal.matter.support()
        } else {
            state.metal.matter.spacing
        };
        let Some(ground) = Ground::below(state, &self.flying, reach) else {
            return;
        };
        let mut flying = Vec::with_capacity(self.flying.len());
        for droplet in self.flying.chunks(self.shape.len()) {
            if !ground.touches(state, droplet, 0.0) {
                flying.extend_from_slice(droplet);
                continue;
            }
            // One that comes to rest goes back to where it touches and does not dig in.
            let back = if state.flowing {
                0.0
            } else {
                ground.back(state, droplet, fall)
            };
            let (phases, places, velocities) =
                (state.metal).columns_mut((&PHASE, &POSITION, &VELOCITY));
            for &a in droplet {
                phases[a] = phase::LIQUID;
                places[a][2] += back;
                if !state.flowing {
                    velocities[a] = [0.0; 3];
                }
            }
        }
        self.flying = flying;
    }

    /// Droplets that are below all metal have missed it: they are followed no farther.
    fn pass(&mut self, state: &mut State) {
        let below = self.floor - state.metal.matter.support();
        let (places, velocities) = state.metal.columns_mut((&POSITION, &VELOCITY));
        let particles = self.shape.len();
        let gone = |droplet: &&[usize]| droplet.iter().all(|a| places[*a][2] < below);
        let (mut past, mut flying) = (Vec::new(), Vec::with_capacity(self.flying.len()));
        for droplet in self.flying.chunks(particles) {
            let to = if gone(&droplet) {
                &mut past
            } else {
                &mut flying
            };
            to.extend_from_slice(droplet);
        }
        for a in &past {
            velocities[*a] = [0.0; 3];
        }
        self.past += past.len() as u64;
        self.flying = flying;
    }

    /// What a reader of the run must be told of wire `number`.
    pub(super) fn warning(&self, number: usize) -> Option<String> {
        let mass = self.mass * self.past as f64;
        (self.past > 0).then(|| {
            format!("droplets of wire {number}: {mass:.3e} kg have fallen past the metal; see where their axis is")
        })
    }

    /// How long a step follows the fall \[s\].
    pub(super) fn follows(&self, state: &State) -> f64 {
        let (places, phases) = (state.metal.column(&POSITION), state.metal.column(&PHASE));
        let height = |a: usize| places[a][2];
        let Some(lowest) = self.flying.iter().map(|a| height(*a)).reduce(f64::min) else {
            return f64::INFINITY;
        };
        // Down to where it may meet something it falls freely.
        let rests = (0..state.len()).filter(|a| phases[*a] != phase::FLYING);
        let top = rests.map(height).fold(f64::NEG_INFINITY, f64::max);
        let free = lowest - top - state.metal.matter.support();
        free.max(FALL * state.metal.matter.spacing) / self.parameters.speed_m_s
    }

    /// When the next is born \[s\].
    pub(super) fn next(&self) -> f64 {
        (self.born as f64 - EARLY) * self.period
    }

    /// Droplets born.
    pub(super) fn born(&self) -> u64 {
        self.born
    }

    /// Energy of all droplets \[J\].
    pub(super) fn energy(&self) -> f64 {
        self.energy.value()
    }

    pub(super) fn save(&self) -> Vec<f64> {
        let [total, lost] = self.energy.save();
        let mut saved = vec![self.born as f64, total, lost, self.floor, self.past as f64];
        saved.extend(self.flying.iter().map(|a| *a as f64));
        saved
    }

    pub(super) fn restore(&mut self, saved: &[f64]) {
        let [born, total, lost, floor, past, flying @ ..] = saved else {
            return;
        };
        (self.born, self.past) = (*born as u64, *past as u64);
        self.energy = Sum::restored(&[*total, *lost]);
        self.floor = *floor;
        self.flying = flying.iter().map(|a| *a as usize).collect();
    }
}
