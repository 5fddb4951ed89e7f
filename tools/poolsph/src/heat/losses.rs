//! Heat that the metal gives off at its surface: radiation (Komen 2019, third term of eq. 4.10),
//! a heat transfer to still gas, and vapour (eq. 5.24 for a gas free of it).
//!
//! ```text
//! m dh_a/dt = -dA_a ( eps sigma (T^4 - T_0^4) + Psi (T - T_0) + H_v p_v(T) sqrt(M / (2 pi R T)) )
//! p_v(T) = 1 atm exp( H_v M / R (1/T_b - 1/T) )
//! ```
//!
//! Vapour carries off heat; its mass, some thousandths of the pool, is not taken away.
//!
//! The hotter the metal, the more it gives off, by at most s for each kelvin: an explicit step falls
//! towards the balance without passing it as long as dt s dA < m c. A longer one is divided, particle
//! by particle.

use std::sync::Arc;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::bounds::outside;
use super::caloric::Caloric;
use super::ledger::Sum;
use crate::stage::{Figure, Stage, StageError};
use crate::state::{Column, Phase, State};

/// Stefan-Boltzmann constant \[W/(m2 K4)\].
const STEFAN_BOLTZMANN: f64 = 5.670_374_419e-8;
/// Molar gas constant \[J/(mol K)\].
const MOLAR_GAS: f64 = 8.314_462_618;
/// Pressure at the boiling point \[Pa\].
const ATMOSPHERE: f64 = 101_325.0;
/// Below this part of the boiling point the vapour pressure is under 1e-12 of that at it, for any
/// metal (Trouton's rule), and vapour is left out.
const COLD: f64 = 0.25;
/// Most parts of a step; what would need more has left all temperatures of metal.
const PARTS_MOST: f64 = 1e4;

/// Heat given off at the surface (key `losses`).
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LossParameters {
    /// T_0 of the surroundings.
    #[schemars(extend("x-unit" = "K"), range(min = 0.0, max = 1e4))]
    pub surroundings_k: f64,
    /// eps; absent: no radiation.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-unit" = "1"), range(min = 0.0, max = 1.0))]
    pub emissivity: Option<f64>,
    /// Psi; absent: no heat transfer to gas.
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

/// Vapour of the metal.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Evaporation {
    /// T_b at 1 atm.
    #[schemars(extend("x-unit" = "K"), range(min = 100.0, max = 1e4))]
    pub boiling_point_k: f64,
    /// H_v.
    #[schemars(extend("x-unit" = "J/kg"), range(min = 1.0, max = 1e8))]
    pub latent_heat_j_kg: f64,
    /// M.
    #[schemars(extend("x-unit" = "kg/mol"), range(min = 1e-3, max = 1.0))]
    pub molar_mass_kg_mol: f64,
}

impl Evaporation {
    /// Heat that vapour carries off at temperature `t` \[K\] \[W/m2\].
    #[must_use]
    pub fn heat(&self, t: f64) -> f64 {
        let molar = self.latent_heat_j_kg * self.molar_mass_kg_mol / MOLAR_GAS;
        let pressure = ATMOSPHERE * (molar * (1.0 / self.boiling_point_k - 1.0 / t)).exp();
        let per_speed = self.molar_mass_kg_mol / (std::f64::consts::TAU * MOLAR_GAS * t);
        self.latent_heat_j_kg * pressure * per_speed.sqrt()
    }

    /// Rise of that heat with temperature \[W/(m2 K)\].
    #[must_use]
    pub fn slope(&self, t: f64) -> f64 {
        let molar = self.latent_heat_j_kg * self.molar_mass_kg_mol / MOLAR_GAS;
        (self.heat(t) * (molar / t - 0.5) / t).max(0.0)
    }
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
    caloric: Arc<Caloric>,
    radiated: Sum,
    transferred: Sum,
    evaporated: Sum,
}

impl Losses {
    /// The losses of a scene.
    #[must_use]
    pub fn new(parameters: LossParameters, caloric: Arc<Caloric>) -> Self {
        Self {
            parameters,
            caloric,
            radiated: Sum::default(),
            transferred: Sum::default(),
            evaporated: Sum::default(),
        }
    }

    /// Area on which particle `a` gives off heat \[m2\]; `None` where it gives off none.
    fn bare(&self, state: &State, a: usize) -> Option<f64> {
        let patch = &state.surface[a];
        let off = state.wall[a] || state.phase[a] == Phase::Flying;
        let up = patch.normal[2] > std::f64::consts::FRAC_1_SQRT_2;
        let hidden = self.parameters.on == Where::Top && !up;
        (!off && patch.area > 0.0 && !hidden).then_some(patch.area)
    }

    /// Vapour at temperature `t` \[K\], if there is any.
    fn vapour(&self, t: f64) -> Option<Evaporation> {
        let hot = |vapour: &Evaporation| t > COLD * vapour.boiling_point_k;
        self.parameters.evaporation.filter(hot)
    }

    /// Radiation, transfer and vapour at temperature `t` \[K\] \[W/m2\].
    fn cooling(&self, t: f64) -> [f64; 3] {
        let p = &self.parameters;
        let around = p.surroundings_k;
        let radiation = p
            .emissivity
            .map(|eps| eps * STEFAN_BOLTZMANN * (t.powi(4) - around.powi(4)));
        let transfer = p.transfer_w_m2_k.map(|psi| psi * (t - around));
        let vapour = self.vapour(t).map(|vapour| vapour.heat(t));
        [radiation, transfer, vapour].map(|q| q.unwrap_or(0.0))
    }

    /// Greatest rise of the heat given off with temperature on the way from `t` \[K\] to the balance
    /// \[W/(m2 K)\]: all three rise the more the hotter the metal is.
    fn slope(&self, t: f64) -> f64 {
        let p = &self.parameters;
        let hottest = t.max(p.surroundings_k);
        let radiation = 4.0 * STEFAN_BOLTZMANN * hottest.powi(3) * p.emissivity.unwrap_or(0.0);
        let vapour = self.vapour(hottest).map(|vapour| vapour.slope(hottest));
        radiation + p.transfer_w_m2_k.unwrap_or(0.0) + vapour.unwrap_or(0.0)
    }

    /// Cools particle `a` for `dt` \[s\] by what it gives off at its present temperature.
    fn cool(&mut self, state: &mut State, a: usize, area: f64, dt: f64) -> Result<(), StageError> {
        let [radiation, transfer, vapour] = self.cooling(state.temperature[a]).map(|q| q * area);
        if (radiation + transfer + vapour).to_bits() == 0 {
            return Ok(());
        }
        self.radiated.add(radiation * dt);
        self.transferred.add(transfer * dt);
        self.evaporated.add(vapour * dt);
        state.enthalpy[a] -= (radiation + transfer + vapour) * dt / state.metal.mass();
        state.temperature[a] = self.caloric.temperature(state.enthalpy[a]);
        if !self.caloric.covers(state.temperature[a]) {
            return Err(outside(state, a, state.temperature[a], &self.caloric));
        }
        Ok(())
    }
}

impl Stage for Losses {
    fn name(&self) -> &'static str {
        "losses"
    }

    fn needs(&self) -> &'static [Column] {
        &[Column::Temperature, Column::Enthalpy, Column::Surface]
    }

    fn advance(&mut self, state: &mut State, dt: f64) -> Result<(), StageError> {
        let capacity = state.metal.mass() * self.caloric.least_heat();
        for k in 0..state.exposed.len() {
            let a = state.exposed[k] as usize;
            let Some(area) = self.bare(state, a) else {
                continue;
            };
            let share = dt * area * self.slope(state.temperature[a]) / capacity;
            let parts = share.ceil().clamp(1.0, PARTS_MOST);
            for _ in 0..parts as u64 {
                self.cool(state, a, area, dt / parts)?;
            }
        }
        Ok(())
    }

    fn figures(&self) -> Vec<Figure> {
        let p = &self.parameters;
        let parts = [
            (
                p.emissivity.is_some(),
                "energy_out_radiation_j",
                self.radiated,
            ),
            (
                p.transfer_w_m2_k.is_some(),
                "energy_out_transfer_j",
                self.transferred,
            ),
            (
                p.evaporation.is_some(),
                "energy_out_vapour_j",
                self.evaporated,
            ),
        ];
        let given = parts.into_iter().filter(|part| part.0);
        given
            .map(|(_, name, sum)| Figure {
                name,
                unit: "J",
                value: sum.value(),
            })
            .collect()
    }

    fn save(&self) -> Vec<f64> {
        [self.radiated, self.transferred, self.evaporated]
            .iter()
            .flat_map(Sum::save)
            .collect()
    }

    fn restore(&mut self, saved: &[f64]) {
        let mut sums = saved.chunks(2).map(Sum::restored);
        let mut next = || sums.next().unwrap_or_default();
        self.radiated = next();
        self.transferred = next();
        self.evaporated = next();
    }
}
