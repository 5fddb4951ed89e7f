//! Heat of the arc on the surface of the metal (Komen 2019, second term of eq. 4.10).
//!
//! ```text
//! m dh_a/dt = q(r_a) dA_a
//! ```
//!
//! r is the horizontal distance from the axis of the arc. The flux q is that of an arc above a flat
//! surface, part by part as the arc's table has it: convection, absorbed radiation, electrons, ions,
//! vapour. With `cathode` and `gas`, electrons, ions and convection follow from the temperature of
//! the metal as it is here, in place of that in the table. What the metal radiates itself is left
//! to [`super::Losses`].
//!
//! Such a flux falls with the temperature of the metal, by no more than s. An explicit step
//! approaches the balance without passing it as long as dt s dA < m c; a longer one is divided,
//! particle by particle.
//!
//! With `projected`, dA is the area seen from above: the metal takes what the table prescribes
//! whatever shape it has. With `area`, it is the whole area. A surface that faces down takes
//! nothing. The cross-section pi d^2/4 of eq. 4.10 would pass on 78.5 % of every flux.

mod offered;
mod parameters;
mod reached;
mod stands;

use std::sync::Arc as Shared;

use particles::Matter;
use run::Fault;
use steps::{Figure, Limit};

use super::bounds::outside;
use super::caloric::Caloric;
use super::chunks::Chunks;
use super::flux::Flux;
use super::ledger::Sum;
use super::received::{self, FROM_ARC};
use super::skin::Skin;
use crate::patch;
use crate::source::arcs::Burning;
use crate::stage::{Stage, StageError};
use crate::state::{ENTHALPY, State, TEMPERATURE};

use offered::Ground;
use parameters::ENERGIES;
pub use parameters::{ArcParameters, Onto, Part};
use reached::Reached;
use stands::{Stand, stands};

/// Fewest steps in a period of a waveform, where steps are adaptive.
const STEPS: f64 = 8.0;

/// An arc that heats.
struct Burner {
    burning: Burning,
    fluxes: Vec<Flux>,
    /// Which energy each flux puts in.
    energies: Vec<usize>,
    /// Distance beyond which there is no heat \[m\].
    reach: f64,
    reached: Reached,
}

impl Burner {
    /// What the fluxes fall with the temperature of the metal at most, below `hottest` \[K\] \[W/(m2 K)\].
    fn steepest(&self, hottest: f64) -> f64 {
        let fluxes = self.fluxes.iter().map(|flux| flux.steepest(hottest));
        self.burning.most() * fluxes.sum::<f64>()
    }
}

/// Heat of arcs as a stage.
pub struct Arc {
    caloric: Shared<Caloric>,
    metal: Matter,
    arcs: Vec<Burner>,
    /// Energies put in, by name \[J\].
    energies: Vec<(&'static str, Sum)>,
    onto: Onto,
    /// Area that takes a step whole, times that step \[m2 s\].
    whole: f64,
    power: f64,
    /// Into how many parts the last step was divided at most.
    parts: f64,
    /// Whether something of a flux that varies in time may have been missed.
    missed: bool,
    /// Temperature of the coldest metal that was heated \[K\].
    coldest: f64,
    /// Whether grains may have taken the heat.
    covered: bool,
    ground: Ground,
    /// Where each arc stands in this step, and how strongly it burns.
    stands: Vec<Stand>,
    heated: Chunks<Result<Heated, StageError>>,
}

/// A step of a particle: its number, its time and its length \[s\].
#[derive(Debug, Clone, Copy)]
struct Moment {
    step: u64,
    time: f64,
    dt: f64,
}

/// What of a particle lies under the arcs.
#[derive(Debug, Clone, Copy)]
struct Spot {
    at: [f64; 2],
    /// That the arcs fall on \[m2\].
    area: f64,
}

/// What a step leaves of a particle.
#[derive(Debug, Clone, Copy)]
struct Heated {
    a: u32,
    /// \[J/kg\]
    enthalpy: f64,
    /// \[K\]
    temperature: f64,
    /// Heat by energy \[J\].
    put: [f64; ENERGIES],
    /// Into how many parts its step was divided.
    parts: f64,
    /// Whether all of a flux that varies in time was found.
    found: bool,
}

impl Arc {
    /// The one arc of a scene; `surface` is the table over the radius of the arc input.
    ///
    /// # Errors
    /// A fault at the key that is wrong: neither formula nor input, both, or a column that the
    /// input lacks.
    pub fn new(
        parameters: &ArcParameters,
        caloric: Shared<Caloric>,
        metal: Matter,
        surface: Option<&artefact::Table>,
    ) -> Result<Self, Fault> {
        let mut arc = Self::without_arcs(caloric, metal, parameters.on);
        arc.burn(parameters, Burning::default(), surface)?;
        Ok(arc)
    }

    /// None yet; what they heat takes them by `onto`.
    #[must_use]
    pub fn without_arcs(caloric: Shared<Caloric>, metal: Matter, onto: Onto) -> Self {
        Self {
            caloric,
            metal,
            arcs: Vec::new(),
            energies: Vec::new(),
            onto,
            whole: f64::INFINITY,
            power: 0.0,
            parts: 1.0,
            missed: false,
            coldest: f64::MAX,
            covered: false,
            ground: Ground::WHOLE,
            stands: Vec::new(),
            heated: Chunks::default(),
        }
    }

    /// Adds an arc.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn burn(
        &mut self,
        parameters: &ArcParameters,
        burning: Burning,
        surface: Option<&artefact::Table>,
    ) -> Result<(), Fault> {
        let fluxes = parameters.fluxes(surface, self.metal, &self.caloric)?;
        let mut energies = Vec::with_capacity(fluxes.len());
        for flux in &fluxes {
            let known = self
                .energies
                .iter()
                .position(|(name, _)| *name == flux.name);
            energies.push(known.unwrap_or(self.energies.len()));
            if known.is_none() {
                self.energies.push((flux.name, Sum::default()));
            }
        }
        self.arcs.push(Burner {
            burning,
            reach: fluxes.iter().map(Flux::reach).fold(0.0, f64::max),
            reached: Reached::default(),
            fluxes,
            energies,
        });
        let hottest = self.caloric.range().1;
        let steepest: f64 = self.arcs.iter().map(|arc| arc.steepest(hottest)).sum();
        self.whole = self.metal.mass() * self.caloric.least_heat() / steepest;
        Ok(())
    }

    /// What of particle `a` lies under the arcs; `None` where none reaches. What a particle has of the plan lies around it;
    /// its whole area lies before it on the surface. What lies `near` \[m\] beyond the reach of an arc counts too.
    fn lit(&self, skin: &Skin<'_>, a: usize, near: f64) -> Option<Spot> {
        let patch = skin.surface.at(a);
        if patch.area.max(patch.seen) <= 0.0 || !skin.takes(a) {
            return None;
        }
        let ([x, y, _], area) = match self.onto {
            Onto::Projected => (skin.position[a], patch.seen),
            Onto::Area if patch.normal[2] > 0.0 => (patch.foot(skin.position[a]), patch.area),
            Onto::Area => return None,
        };
        let reach = |stand: &Stand| self.arcs[stand.arc].reach + near;
        let mut stands = self.stands.iter();
        let reached = stands.any(|stand| stand.square([x, y]) <= reach(stand) * reach(stand));
        (reached && area > 0.0).then_some(Spot { at: [x, y], area })
    }

    /// Heats particle `a`, in as many parts of the step as it takes.
    fn heat(
        &self,
        skin: &Skin<'_>,
        a: usize,
        spot: Spot,
        now: Moment,
    ) -> Result<Heated, StageError> {
        let Moment { step, time, dt } = now;
        let mut heated = Heated {
            a: a as u32,
            enthalpy: skin.enthalpy[a],
            temperature: skin.temperature[a],
            put: [0.0; ENERGIES],
            parts: (dt * spot.area / self.whole).ceil().max(1.0),
            found: true,
        };
        let parts = heated.parts;
        for _ in 0..parts as u64 {
            let mut gain = 0.0;
            for stand in &self.stands {
                let (arc, square) = (&self.arcs[stand.arc], stand.square(spot.at));
                if stand.level <= 0.0 || square > arc.reach * arc.reach {
                    continue;
                }
                let from = [0, 1].map(|k| spot.at[k] - stand.axis[k]);
                for (flux, energy) in arc.fluxes.iter().zip(&arc.energies) {
                    let kelvin = heated.temperature;
                    let (mean, found) = flux.over(from, self.metal.spacing, kelvin, [time, dt])?;
                    let heat = stand.level * mean * spot.area * dt / parts;
                    heated.found &= found;
                    heated.put[*energy] += heat;
                    gain += heat;
                }
            }
            heated.enthalpy += gain / self.metal.mass();
            heated.temperature = self.caloric.temperature(heated.enthalpy);
            if !self.caloric.covers(heated.temperature) {
                let (at, value) = (skin.position[a], heated.temperature);
                return Err(outside(step, a, at, value, &self.caloric));
            }
        }
        Ok(heated)
    }
}

impl Stage for Arc {
    fn name(&self) -> &'static str {
        "arc"
    }

    fn declare(&self, state: &mut State) {
        state.metal.declare(&TEMPERATURE);
        state.metal.declare(&ENTHALPY);
        patch::declare(&mut state.metal);
    }

    fn limit(&self, _state: &State) -> Option<Limit> {
        let seconds = self.whole / (self.metal.spacing * self.metal.spacing);
        seconds
            .is_finite()
            .then(|| Limit::dividing("arc_feedback", seconds))
    }

    fn follows(&self, state: &State) -> f64 {
        let periods = self.arcs.iter().filter_map(|arc| arc.burning.period());
        let limit = self.limit(state).map(|limit| limit.seconds);
        limit
            .into_iter()
            .chain(periods.map(|period| period / STEPS))
            .fold(f64::INFINITY, f64::min)
    }

    fn parts(&self) -> u64 {
        self.parts as u64
    }

    fn advance(&mut self, state: &mut State, dt: f64) -> Result<(), StageError> {
        let mut heated = std::mem::take(&mut self.heated);
        let skin = Skin::of(&state.metal);
        let now = Moment {
            step: state.step,
            time: state.time,
            dt,
        };
        self.covered = state.grains.is_some();
        let (times, spacing) = ([state.time, dt], self.metal.spacing);
        let followed = stands(&self.arcs, state.source, times, spacing, &mut self.stands);
        self.missed |= !followed;
        if state.step.is_multiple_of(reached::EVERY) {
            self.compare(&skin, state, times)?;
        }
        heated.fill(&state.exposed, |a| {
            let spot = self.lit(&skin, a, 0.0)?;
            Some(self.heat(&skin, a, spot, now))
        });
        let columns = (&ENTHALPY, &TEMPERATURE, &FROM_ARC);
        let (enthalpies, temperatures, told) = state.metal.columns_mut(columns);
        let mut gain = 0.0;
        self.parts = 1.0;
        for one in heated.drain() {
            let one = one?;
            self.parts = self.parts.max(one.parts);
            self.missed |= !one.found;
            self.coldest = self.coldest.min(one.temperature);
            let a = one.a as usize;
            (enthalpies[a], temperatures[a]) = (one.enthalpy, one.temperature);
            received::add(told, a, one.put.iter().sum());
            for ((_, sum), heat) in self.energies.iter_mut().zip(one.put) {
                sum.add(heat);
                gain += heat;
            }
        }
        self.power = gain / dt;
        self.heated = heated;
        Ok(())
    }

    fn figures(&self) -> Vec<Figure> {
        let put = self.energies.iter().map(|(name, sum)| Figure {
            name: *name,
            unit: "J",
            value: sum.value(),
        });
        let power = Figure {
            name: "arc_power_w",
            unit: "W",
            value: self.power,
        };
        std::iter::once(power).chain(put).collect()
    }

    fn warnings(&self) -> Vec<String> {
        let missed = "flux_w_m2 changes faster in time or in space than could be followed: heat may be missed";
        let missed = self.missed.then(|| missed.to_owned());
        let none = |(_, sum): &(&str, Sum)| sum.value().abs() <= 0.0;
        let nothing = !self.covered && self.energies.iter().all(none);
        let nothing = nothing.then(|| {
            "the arc gave the metal no heat at all: see where its axis is, and when it burns"
                .to_owned()
        });
        let beside = match self.covered || nothing.is_some() {
            true => Vec::new(),
            false => self.beside(Reached::warning),
        };
        let told = missed.into_iter().chain(nothing).chain(self.cold());
        told.chain(beside).collect()
    }

    fn notes(&self) -> Vec<String> {
        match self.covered {
            true => Vec::new(),
            false => self.beside(Reached::note),
        }
    }

    fn save(&self) -> Vec<f64> {
        let put = self.energies.iter().flat_map(|(_, sum)| sum.save());
        let reached = self.arcs.iter().flat_map(|arc| arc.reached.save());
        let missed = f64::from(u8::from(self.missed));
        put.chain(reached).chain([self.coldest, missed]).collect()
    }

    fn restore(&mut self, saved: &[f64]) {
        if let [.., coldest, missed] = saved {
            (self.coldest, self.missed) = (*coldest, *missed > 0.0);
        }
        for ((_, sum), parts) in self.energies.iter_mut().zip(saved.chunks_exact(2)) {
            *sum = Sum::restored(parts);
        }
        let arcs = saved.get(2 * self.energies.len()..).unwrap_or_default();
        for (arc, parts) in self.arcs.iter_mut().zip(arcs.as_chunks::<6>().0) {
            arc.reached = Reached::restored(*parts);
        }
    }
}

#[cfg(test)]
mod tests;
