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

use std::sync::Arc as Shared;

use particles::Matter;
use run::Fault;
use run::property::Property;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::bounds::outside;
use super::caloric::Caloric;
use super::cathode::{Cathode, Emitter};
use super::chunks::Chunks;
use super::film::{Film, GasFilm};
use super::flux::{Flux, Law};
use super::ledger::Sum;
use super::radial::column;
use super::skin::Skin;
use crate::patch;
use crate::stage::{Figure, Limit, Stage, StageError};
use crate::state::{ENTHALPY, State, TEMPERATURE};

/// Most fluxes at once.
const PARTS: usize = Part::ALL.len();

/// Heat of the arc (key `arc`): of the arc input, or of a formula.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ArcParameters {
    /// Heat flux in r, the distance from the axis of the source (m), and t; absent: the arc input.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-unit" = "W/m2"))]
    pub flux_w_m2: Option<Property>,
    /// Parts of the arc input that are taken as they are; absent: all that `cathode` and `gas` leave.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub parts: Option<Vec<Part>>,
    /// Electrons and ions by the temperature of the metal, from the current density of the arc
    /// input; absent: as the arc input has them.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub cathode: Option<Cathode>,
    /// Convection by the temperature of the metal, from the gas temperature of the arc input;
    /// absent: as the arc input has it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub gas: Option<GasFilm>,
    /// The area that the flux falls on.
    #[serde(default)]
    pub on: Onto,
}

/// The area that a flux falls on.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Onto {
    /// The area as seen from above.
    #[default]
    Projected,
    /// The whole area that does not face down.
    Area,
}

/// Parts of the heat flux.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Part {
    /// Conduction and convection from the gas.
    Convection,
    /// Radiation of the arc that the metal absorbs.
    Radiation,
    /// Electrons: taken up by an anode, given off by a cathode.
    Electron,
    /// Ions that recombine.
    Ion,
    /// Vapour, a loss.
    Vapour,
}

impl Part {
    const ALL: [Self; 5] = [
        Self::Convection,
        Self::Radiation,
        Self::Electron,
        Self::Ion,
        Self::Vapour,
    ];

    /// Column of the arc's table, and name of the energy.
    fn names(self) -> (&'static str, &'static str) {
        match self {
            Self::Convection => ("heat_flux_convection_w_m2", "energy_in_arc_convection_j"),
            Self::Radiation => ("heat_flux_radiation_w_m2", "energy_in_arc_radiation_j"),
            Self::Electron => ("heat_flux_electron_w_m2", "energy_in_arc_electron_j"),
            Self::Ion => ("heat_flux_ion_w_m2", "energy_in_arc_ion_j"),
            Self::Vapour => ("heat_flux_vapour_w_m2", "energy_in_arc_vapour_j"),
        }
    }
}

impl ArcParameters {
    /// The key that takes the place of a part of the table, if it is there.
    fn instead(&self, part: Part) -> Option<&'static str> {
        match part {
            Part::Electron | Part::Ion => self.cathode.map(|_| "cathode"),
            Part::Convection => self.gas.as_ref().map(|_| "gas"),
            Part::Radiation | Part::Vapour => None,
        }
    }

    /// A fault where a heat is given twice, or belongs to an input that is not used.
    fn checked(&self) -> Result<(), Fault> {
        let given = [
            ("parts", self.parts.is_some()),
            ("cathode", self.cathode.is_some()),
            ("gas", self.gas.is_some()),
        ];
        if let (Some(_), Some((key, _))) = (&self.flux_w_m2, given.iter().find(|key| key.1)) {
            let what = format!("{key}: belongs to the arc input, but flux_w_m2 is given");
            return Err(Fault::at(&format!("/{key}"), what));
        }
        for (i, part) in self.parts.iter().flatten().enumerate() {
            if let Some(key) = self.instead(*part) {
                let what = format!("this part follows from the key '{key}': give one of the two");
                return Err(Fault::at(&format!("/parts/{i}"), what));
            }
        }
        Ok(())
    }

    /// The parts of the arc input, each from the table or from what takes its place.
    fn fluxes(
        &self,
        surface: &artefact::Table,
        metal: Matter,
        caloric: &Shared<Caloric>,
    ) -> Result<Vec<Flux>, Fault> {
        let emitter = self.cathode.map(|cathode| Emitter::new(cathode, surface));
        let emitter = emitter.transpose()?.map(Shared::new);
        let mut fluxes = Vec::new();
        for part in Part::ALL {
            let (name, energy) = part.names();
            let law = match (part, &emitter, &self.gas) {
                (Part::Electron, Some(emitter), _) => Law::Electrons(Shared::clone(emitter)),
                (Part::Ion, Some(emitter), _) => Law::Ions(Shared::clone(emitter)),
                (Part::Convection, _, Some(gas)) => {
                    let caloric = Shared::clone(caloric);
                    Law::Film(Film::new(gas, surface, metal.spacing, caloric)?)
                }
                _ if self.takes(part, surface.has(name)) => {
                    let table = column(surface, name, |q| q);
                    Law::Table(table.map_err(|what| Fault::at("/parts", what))?)
                }
                _ => continue,
            };
            fluxes.push(Flux::new(energy, law));
        }
        Ok(fluxes)
    }

    /// Whether a part is taken from the table, which may have it.
    fn takes(&self, part: Part, there: bool) -> bool {
        let parts = self.parts.as_ref();
        parts.map_or(there, |parts| parts.contains(&part))
    }
}

/// Heat of the arc as a stage.
pub struct Arc {
    caloric: Shared<Caloric>,
    metal: Matter,
    fluxes: Vec<Flux>,
    /// Distance beyond which there is no heat \[m\].
    reach: f64,
    onto: Onto,
    /// Area that takes a step whole, times that step \[m2 s\].
    whole: f64,
    power: f64,
    /// Into how many parts the last step was divided at most.
    parts: f64,
    /// Whether something of a flux that varies in time may have been missed.
    missed: bool,
    heated: Chunks<Result<Heated, StageError>>,
}

/// What a step leaves of a particle.
#[derive(Debug, Clone, Copy)]
struct Heated {
    a: u32,
    /// \[J/kg\]
    enthalpy: f64,
    /// \[K\]
    temperature: f64,
    /// Heat by flux \[J\].
    put: [f64; PARTS],
    /// Into how many parts its step was divided.
    parts: f64,
    /// Whether all of a flux that varies in time was found.
    found: bool,
}

impl Arc {
    /// The arc of a scene; `surface` is the table over the radius of the arc input.
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
        parameters.checked()?;
        let fluxes = match (&parameters.flux_w_m2, surface) {
            (Some(property), _) => {
                let curve = property.compile("/flux_w_m2", &["r", "t"])?;
                vec![Flux::new("energy_in_arc_j", Law::Curve(curve))]
            }
            (None, None) => {
                let what = "needs flux_w_m2, or an arc source: --input arc=FILE";
                return Err(Fault::at("", what));
            }
            (None, Some(table)) => parameters.fluxes(table, metal, &caloric)?,
        };
        let reach = fluxes.iter().map(Flux::reach).fold(0.0, f64::max);
        let hottest = caloric.range().1;
        let steepest: f64 = fluxes.iter().map(|flux| flux.steepest(hottest)).sum();
        Ok(Self {
            reach,
            whole: metal.mass() * caloric.least_heat() / steepest,
            caloric,
            metal,
            fluxes,
            onto: parameters.on,
            power: 0.0,
            parts: 1.0,
            missed: false,
            heated: Chunks::default(),
        })
    }

    /// Distance from the axis \[m\] and area that the arc falls on \[m2\] of particle `a`; `None`
    /// where it does not reach. What a particle has of the plan lies around it; its whole area lies before it on the
    /// surface.
    fn lit(&self, skin: &Skin<'_>, axis: [f64; 3], a: usize) -> Option<(f64, f64)> {
        let patch = skin.surface.at(a);
        if patch.area.max(patch.seen) <= 0.0 || !skin.takes(a) {
            return None;
        }
        let ([x, y, _], area) = match self.onto {
            Onto::Projected => (skin.position[a], patch.seen),
            Onto::Area if patch.normal[2] > 0.0 => (patch.foot(skin.position[a]), patch.area),
            Onto::Area => return None,
        };
        let (dx, dy) = (x - axis[0], y - axis[1]);
        let square = dx * dx + dy * dy;
        let within = square <= self.reach * self.reach && area > 0.0;
        within.then(|| (square.sqrt(), area))
    }

    /// Heats particle `a` for `dt` \[s\], in as many parts as it takes.
    fn heat(
        &self,
        (skin, a): (&Skin<'_>, usize),
        (r, area): (f64, f64),
        (step, time, dt): (u64, f64, f64),
    ) -> Result<Heated, StageError> {
        let mut heated = Heated {
            a: a as u32,
            enthalpy: skin.enthalpy[a],
            temperature: skin.temperature[a],
            put: [0.0; PARTS],
            parts: (dt * area / self.whole).ceil().max(1.0),
            found: true,
        };
        let parts = heated.parts;
        for _ in 0..parts as u64 {
            let mut gain = 0.0;
            for (put, flux) in heated.put.iter_mut().zip(&self.fluxes) {
                let (mean, found) = flux.at(r, heated.temperature, time, dt)?;
                let heat = mean * area * dt / parts;
                heated.found &= found;
                *put += heat;
                gain += heat;
            }
            heated.enthalpy += gain / self.metal.mass();
            heated.temperature = self.caloric.temperature(heated.enthalpy);
            if !self.caloric.covers(heated.temperature) {
                let particle = (a, skin.position[a]);
                return Err(outside(step, particle, heated.temperature, &self.caloric));
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

    fn dt_limit(&self, _state: &State) -> Option<Limit> {
        let seconds = self.whole / (self.metal.spacing * self.metal.spacing);
        seconds
            .is_finite()
            .then(|| Limit::dividing("arc_feedback", seconds))
    }

    fn parts(&self) -> u64 {
        self.parts as u64
    }

    fn advance(&mut self, state: &mut State, dt: f64) -> Result<(), StageError> {
        let mut heated = std::mem::take(&mut self.heated);
        let skin = Skin::of(&state.metal);
        let axis = state.source.map_or([0.0; 3], |source| source.position);
        let time = (state.step, state.time, dt);
        heated.fill(&state.exposed, |a| {
            let lit = self.lit(&skin, axis, a)?;
            Some(self.heat((&skin, a), lit, time))
        });
        let (enthalpies, temperatures) = state.metal.columns_mut((&ENTHALPY, &TEMPERATURE));
        let mut gain = 0.0;
        self.parts = 1.0;
        for one in heated.drain() {
            let one = one?;
            self.parts = self.parts.max(one.parts);
            self.missed |= !one.found;
            let a = one.a as usize;
            (enthalpies[a], temperatures[a]) = (one.enthalpy, one.temperature);
            for (flux, heat) in self.fluxes.iter_mut().zip(one.put) {
                flux.put.add(heat);
                gain += heat;
            }
        }
        self.power = gain / dt;
        self.heated = heated;
        Ok(())
    }

    fn figures(&self) -> Vec<Figure> {
        let put = self.fluxes.iter().map(|flux| Figure {
            name: flux.name,
            unit: "J",
            value: flux.put.value(),
        });
        let power = Figure {
            name: "arc_power_w",
            unit: "W",
            value: self.power,
        };
        std::iter::once(power).chain(put).collect()
    }

    fn warnings(&self) -> Vec<String> {
        let missed = "flux_w_m2 has more pulses in time than could be followed: heat may be missed";
        self.missed.then(|| missed.to_owned()).into_iter().collect()
    }

    fn save(&self) -> Vec<f64> {
        let put = self.fluxes.iter().flat_map(|flux| flux.put.save());
        put.chain([f64::from(u8::from(self.missed))]).collect()
    }

    fn restore(&mut self, saved: &[f64]) {
        self.missed = saved.last().is_some_and(|missed| *missed > 0.0);
        for (flux, parts) in self.fluxes.iter_mut().zip(saved.chunks_exact(2)) {
            flux.put = Sum::restored(parts);
        }
    }
}
