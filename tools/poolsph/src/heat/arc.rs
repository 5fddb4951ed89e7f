//! Heat of the arc on the surface of the metal (Komen 2019, second term of eq. 4.10).
//!
//! ```text
//! m dh_a/dt = q(r_a) dA_a
//! ```
//!
//! r is the horizontal distance from the axis of the arc. The flux q is that of an arc above a flat
//! surface, part by part as the arc's table has it: convection, absorbed radiation, electrons, ions,
//! vapour. What the metal radiates itself depends on its own temperature and is left to
//! [`super::Losses`].
//!
//! With `projected`, dA is the area seen from above: the metal takes what the table prescribes
//! whatever shape it has. With `area`, it is the whole area. A surface that faces down takes
//! nothing. The cross-section pi d^2/4 of eq. 4.10 would pass on 78.5 % of every flux.

use props::Table;
use run::Fault;
use run::property::{Arguments, Curve, Property};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::bounds::outside;
use super::caloric::Caloric;
use super::ledger::Sum;
use crate::stage::{Figure, Stage, StageError};
use crate::state::{Column, Metal, Phase, State};

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
    /// Parts of the arc input that are taken; absent: all.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub parts: Option<Vec<Part>>,
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

/// q(r), and the heat it has put in.
struct Flux {
    name: &'static str,
    law: Law,
    put: Sum,
}

enum Law {
    /// Zero beyond the last row.
    Table(Table),
    Curve(Curve),
}

impl Flux {
    fn new(name: &'static str, law: Law) -> Self {
        Self {
            name,
            law,
            put: Sum::default(),
        }
    }

    fn at(&self, r: f64, time: f64) -> Result<f64, StageError> {
        match &self.law {
            Law::Table(table) if r > table.last() => Ok(0.0),
            Law::Table(table) => Ok(table.held(r)),
            Law::Curve(curve) => curve
                .value(&Arguments {
                    r,
                    time,
                    ..Arguments::default()
                })
                .map_err(|fault| StageError::Data(format!("heat flux of the arc: {fault}"))),
        }
    }

    /// Distance beyond which there is nothing \[m\].
    fn reach(&self) -> f64 {
        match &self.law {
            Law::Table(table) => table.last(),
            Law::Curve(_) => f64::INFINITY,
        }
    }
}

/// Heat of the arc as a stage.
pub struct Arc {
    caloric: std::sync::Arc<Caloric>,
    metal: Metal,
    fluxes: Vec<Flux>,
    /// Distance beyond which there is no heat \[m\].
    reach: f64,
    onto: Onto,
    power: f64,
}

impl Arc {
    /// The arc of a scene; `surface` is the table over the radius of the arc input.
    ///
    /// # Errors
    /// A fault at the key that is wrong: neither formula nor input, both, or a column that the
    /// input lacks.
    pub fn new(
        parameters: &ArcParameters,
        caloric: std::sync::Arc<Caloric>,
        metal: Metal,
        surface: Option<&artefact::Table>,
    ) -> Result<Self, Fault> {
        let fluxes = match (&parameters.flux_w_m2, surface) {
            (Some(_), _) if parameters.parts.is_some() => {
                let what = "parts belong to the arc input, but flux_w_m2 is given";
                return Err(Fault::at("/parts", what));
            }
            (Some(property), _) => {
                let curve = property.compile("/flux_w_m2", &["r", "t"])?;
                vec![Flux::new("energy_in_arc_j", Law::Curve(curve))]
            }
            (None, None) => {
                let what = "needs flux_w_m2, or an arc source: --input arc=FILE";
                return Err(Fault::at("", what));
            }
            (None, Some(table)) => {
                let parts = parameters.parts.as_deref().unwrap_or(&Part::ALL);
                let read = parts
                    .iter()
                    .filter_map(|part| read(*part, table, parameters));
                read.collect::<Result<_, _>>()?
            }
        };
        let reach = fluxes.iter().map(Flux::reach).fold(0.0, f64::max);
        Ok(Self {
            reach,
            caloric,
            metal,
            fluxes,
            onto: parameters.on,
            power: 0.0,
        })
    }

    /// Heat of each flux into particle `a` in a second \[W\]; `None` where the arc does not reach.
    fn heating(&self, state: &State, a: usize) -> Option<Result<[f64; PARTS], StageError>> {
        let axis = state.source.map_or([0.0; 3], |source| source.position);
        let [x, y, _] = state.position[a];
        let (dx, dy) = (x - axis[0], y - axis[1]);
        let square = dx * dx + dy * dy;
        if square > self.reach * self.reach || state.wall[a] || state.phase[a] == Phase::Flying {
            return None;
        }
        let patch = &state.surface[a];
        let area = match self.onto {
            Onto::Projected => patch.seen,
            Onto::Area if patch.normal[2] > 0.0 => patch.area,
            Onto::Area => 0.0,
        };
        if area <= 0.0 {
            return None;
        }
        let mut heat = [0.0; PARTS];
        for (heat, flux) in heat.iter_mut().zip(&self.fluxes) {
            match flux.at(square.sqrt(), state.time) {
                Ok(q) => *heat = q * area,
                Err(fault) => return Some(Err(fault)),
            }
        }
        Some(Ok(heat))
    }
}

/// A part of the table; vapour that the table does not have is no part of it.
fn read(
    part: Part,
    table: &artefact::Table,
    parameters: &ArcParameters,
) -> Option<Result<Flux, Fault>> {
    let (column, name) = part.names();
    if parameters.parts.is_none() && !table.has(column) {
        return None;
    }
    let columns = table
        .values("radius_m")
        .and_then(|r| Ok((r, table.values(column)?)));
    let made = columns
        .map_err(|fault| fault.to_string())
        .and_then(|(r, q)| Table::new(r.to_vec(), q.to_vec()).map_err(|fault| fault.to_string()));
    Some(match made {
        Ok(table) => Ok(Flux::new(name, Law::Table(table))),
        Err(fault) => Err(Fault::at("/parts", format!("arc input: {fault}"))),
    })
}

impl Stage for Arc {
    fn name(&self) -> &'static str {
        "arc"
    }

    fn needs(&self) -> &'static [Column] {
        &[Column::Temperature, Column::Enthalpy, Column::Surface]
    }

    fn advance(&mut self, state: &mut State, dt: f64) -> Result<(), StageError> {
        self.power = 0.0;
        for k in 0..state.exposed.len() {
            let a = state.exposed[k] as usize;
            let Some(heat) = self.heating(state, a) else {
                continue;
            };
            let mut gain = 0.0;
            for (flux, power) in self.fluxes.iter_mut().zip(heat?) {
                flux.put.add(power * dt);
                gain += power;
            }
            self.power += gain;
            state.enthalpy[a] += gain * dt / self.metal.mass();
            state.temperature[a] = self.caloric.temperature(state.enthalpy[a]);
            if !self.caloric.covers(state.temperature[a]) {
                return Err(outside(state, a, state.temperature[a], &self.caloric));
            }
        }
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

    fn save(&self) -> Vec<f64> {
        self.fluxes
            .iter()
            .flat_map(|flux| flux.put.save())
            .collect()
    }

    fn restore(&mut self, saved: &[f64]) {
        for (flux, parts) in self.fluxes.iter_mut().zip(saved.chunks(2)) {
            flux.put = Sum::restored(parts);
        }
    }
}
