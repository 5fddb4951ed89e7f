//! Heat that the metal gives off at its surface: radiation (Komen 2019, third term of eq. 4.10),
//! a heat transfer to still gas, and vapour ([`super::vapour`]).
//!
//! ```text
//! m dh_a/dt = -dA_a ( eps sigma (T^4 - T_0^4) + Psi (T - T_0) + H_v M n(T) )
//! ```
//!
//! Vapour carries off heat; its mass, some thousandths of the pool, is not taken away.
//!
//! The hotter the metal, the more it gives off, by at most s for each kelvin: an explicit step falls
//! towards the balance without passing it as long as dt s dA < m c. A longer one is divided, particle
//! by particle.

use particles::POSITION;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use steps::Figure;

use super::bounds::outside;
use super::chunks::Chunks;
use super::ledger::Sum;
use super::received::{self, LOST};
use super::skin::Skin;
use super::substances::Substances;
use super::vapour::Evaporation;
use crate::patch;
use crate::stage::{Stage, StageError};
use crate::state::slag::SLAG;
use crate::state::{ENTHALPY, State, TEMPERATURE};

/// Stefan-Boltzmann constant \[W/(m2 K4)\].
const STEFAN_BOLTZMANN: f64 = 5.670_374_419e-8;
/// Most parts of a step; what would need more has left all temperatures of metal.
const PARTS_MOST: f64 = 1e4;

/// Heat given off at the surface (key `losses`).
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LossParameters {
    /// Temperature T_0 of the surroundings.
    #[schemars(extend("x-unit" = "K"), range(min = 0.0, max = 1e4))]
    pub surroundings_k: f64,
    /// Emissivity eps, for radiation to the surroundings; absent: no radiation.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-unit" = "1"), range(min = 0.0, max = 1.0))]
    pub emissivity: Option<f64>,
    /// Heat transfer coefficient Psi to the gas around; absent: no heat transfer to gas.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-unit" = "W/(m2 K)"), range(min = 0.0, max = 1e6))]
    pub transfer_w_m2_k: Option<f64>,
    /// Vapour; absent: the metal does not boil.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub evaporation: Option<Evaporation>,
    /// Where heat is given off.
    #[serde(default)]
    pub on: Where,
}

/// Where heat is given off.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Where {
    /// On the whole surface.
    #[default]
    All,
    /// Where the surface faces up by more than it faces sideways.
    Top,
}

/// The losses as a stage.
pub struct Losses {
    parameters: LossParameters,
    made: Substances,
    /// Radiated, transferred and evaporated \[J\].
    given: [Sum; 3],
    cooled: Chunks<Cooled>,
}

/// What a step leaves of a particle.
#[derive(Debug, Clone, Copy)]
struct Cooled {
    a: u32,
    /// \[J/kg\]
    enthalpy: f64,
    /// \[K\]
    temperature: f64,
    /// Radiated, transferred and evaporated \[J\].
    given: [f64; 3],
}

impl Losses {
    /// The losses of a scene.
    #[must_use]
    pub fn new(parameters: LossParameters, made: Substances) -> Self {
        Self {
            parameters,
            made,
            given: [Sum::default(); 3],
            cooled: Chunks::default(),
        }
    }

    /// Area on which particle `a` gives off heat \[m2\]; `None` where it gives off none.
    fn bare(&self, skin: &Skin<'_>, a: usize) -> Option<f64> {
        let (area, normal) = (skin.surface.area[a], skin.surface.normal[a]);
        let up = normal[2] > std::f64::consts::FRAC_1_SQRT_2;
        let hidden = self.parameters.on == Where::Top && !up;
        (skin.takes(a) && area > 0.0 && !hidden).then_some(area)
    }

    /// Radiation, transfer and vapour at temperature `t` \[K\] \[W/m2\], and the rise of their sum with
    /// temperature \[W/(m2 K)\].
    fn cooling(&self, t: f64) -> ([f64; 3], f64) {
        let p = &self.parameters;
        let around = p.surroundings_k;
        let radiation = p.emissivity.map(|eps| {
            let black = eps * STEFAN_BOLTZMANN;
            (
                black * (t.powi(4) - around.powi(4)),
                4.0 * black * t.powi(3),
            )
        });
        let transfer = p.transfer_w_m2_k.map(|psi| (psi * (t - around), psi));
        let vapour = p.evaporation.filter(|vapour| !vapour.is_cold(t));
        let vapour = vapour.map(|vapour| vapour.heat(t));
        let parts = [radiation, transfer, vapour].map(Option::unwrap_or_default);
        (
            parts.map(|part| part.0),
            parts.iter().map(|part| part.1).sum(),
        )
    }

    /// Cools particle `a` for `dt` \[s\], in as many parts as it takes; `None` where nothing is given
    /// off.
    fn cool(&self, skin: &Skin<'_>, a: usize, dt: f64) -> Option<Cooled> {
        let area = self.bare(skin, a)?;
        let mut cooled = Cooled {
            a: a as u32,
            enthalpy: skin.enthalpy[a],
            temperature: skin.temperature[a],
            given: [0.0; 3],
        };
        let own = self.made.which(skin.slag(a));
        let (mass, caloric) = (own.mass, &own.caloric);
        let (mut flux, mut rise) = self.cooling(cooled.temperature);
        // On the way to the balance the rise is greatest where the metal is hottest.
        if cooled.temperature < self.parameters.surroundings_k {
            rise = self.cooling(self.parameters.surroundings_k).1;
        }
        let share = dt * area * rise / (mass * caloric.least_heat());
        let parts = share.ceil().clamp(1.0, PARTS_MOST);
        for part in 0..parts as u64 {
            if part > 0 {
                (flux, _) = self.cooling(cooled.temperature);
            }
            let heat = flux.map(|q| q * area * dt / parts);
            let sum = heat[0] + heat[1] + heat[2];
            if sum.to_bits() == 0 {
                break;
            }
            cooled.given = std::array::from_fn(|i| cooled.given[i] + heat[i]);
            cooled.enthalpy -= sum / mass;
            cooled.temperature = caloric.temperature(cooled.enthalpy);
            if !caloric.covers(cooled.temperature) {
                break;
            }
        }
        Some(cooled)
    }
}

impl Stage for Losses {
    fn name(&self) -> &'static str {
        "losses"
    }

    fn declare(&self, state: &mut State) {
        state.metal.declare(&TEMPERATURE);
        state.metal.declare(&ENTHALPY);
        patch::declare(&mut state.metal);
    }

    fn advance(&mut self, state: &mut State, dt: f64) -> Result<(), StageError> {
        let mut cooled = std::mem::take(&mut self.cooled);
        let skin = Skin::of(&state.metal);
        cooled.fill(&state.exposed, |a| self.cool(&skin, a, dt));
        let columns = (&POSITION, &ENTHALPY, &TEMPERATURE, &LOST, &SLAG);
        let (places, enthalpies, temperatures, told, slag) = state.metal.columns_mut(columns);
        for one in cooled.drain() {
            let a = one.a as usize;
            let caloric = &self.made.at(slag, a).caloric;
            if !caloric.covers(one.temperature) {
                let (at, value) = (places[a], one.temperature);
                return Err(outside(state.step, a, at, value, caloric));
            }
            (enthalpies[a], temperatures[a]) = (one.enthalpy, one.temperature);
            received::add(told, a, one.given.iter().sum());
            for (sum, heat) in self.given.iter_mut().zip(one.given) {
                sum.add(heat);
            }
        }
        self.cooled = cooled;
        Ok(())
    }

    fn figures(&self) -> Vec<Figure> {
        let p = &self.parameters;
        let parts = [
            (p.emissivity.is_some(), "energy_out_radiation_j"),
            (p.transfer_w_m2_k.is_some(), "energy_out_transfer_j"),
            (p.evaporation.is_some(), "energy_out_vapour_j"),
        ];
        let given = parts.into_iter().zip(&self.given);
        given
            .filter(|((there, _), _)| *there)
            .map(|((_, name), sum)| Figure {
                name,
                unit: "J",
                value: sum.value(),
            })
            .collect()
    }

    fn save(&self) -> Vec<f64> {
        self.given.iter().flat_map(Sum::save).collect()
    }

    fn restore(&mut self, saved: &[f64]) {
        for (sum, parts) in self.given.iter_mut().zip(saved.chunks(2)) {
            *sum = Sum::restored(parts);
        }
    }
}
