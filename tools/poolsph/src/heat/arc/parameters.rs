//! What a scene says of the heat of an arc, and the fluxes that follow from it.

use std::sync::Arc as Shared;

use particles::Matter;
use run::Fault;
use run::property::Property;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::heat::caloric::Caloric;
use crate::heat::cathode::{Cathode, Emitter};
use crate::heat::film::{Film, GasFilm};
use crate::heat::flux::{Flux, Law};
use crate::heat::radial::column;

/// Most energies that arcs put in: by part, and by formula.
pub(super) const ENERGIES: usize = Part::ALL.len() + 1;
/// Name of the energy of a formula.
const BY_FORMULA: &str = "energy_in_arc_j";

/// Heat of the arc (key `arc`): of the arc input, or of a formula.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ArcParameters {
    /// Heat flux in r, the distance from the axis of the source (m), and t; absent: the arc input.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-unit" = "W/m2"))]
    pub flux_w_m2: Option<Property>,
    /// Parts of the heat flux of the arc input that are used unchanged; absent: all parts that `cathode` and `gas` do not replace.
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

    /// The fluxes of an arc, of which `surface` is the table over the radius.
    ///
    /// # Errors
    /// A fault at the key that is wrong: neither formula nor input, both, or a column that the input lacks.
    pub(super) fn fluxes(
        &self,
        surface: Option<&artefact::Table>,
        metal: Matter,
        caloric: &Shared<Caloric>,
    ) -> Result<Vec<Flux>, Fault> {
        self.checked()?;
        match (&self.flux_w_m2, surface) {
            (Some(property), _) => {
                let curve = property.compile("/flux_w_m2", &["r", "t"])?;
                Ok(vec![Flux::new(BY_FORMULA, Law::Curve(curve))])
            }
            (None, None) => {
                let what = "needs flux_w_m2, or an arc source: --input arc=FILE";
                Err(Fault::at("", what))
            }
            (None, Some(table)) => self.of_table(table, metal, caloric),
        }
    }

    /// The parts of the arc input, each from the table or from what takes its place.
    fn of_table(
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
