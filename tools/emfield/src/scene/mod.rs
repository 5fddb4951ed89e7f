//! The scene: a domain, bodies in it, points, and what acts: electrostatics, eddy currents or both.

pub(crate) mod faults;
mod groups;

pub mod alternating;
pub mod currents;
pub mod domain;
pub mod faces;
pub mod liquid;
pub mod method;
pub mod output;
pub(crate) mod permeability;
pub mod potential;
pub mod warmth;

use schemars::JsonSchema;
use serde::Deserialize;

pub use alternating::MagneticField;
pub use currents::{Amplitude, Coil, EddyCurrents, ElectricPotential, Magnet};
pub use domain::{BodyScene, Domain, Geometry, Medium};
pub use faces::Faces;
pub use groups::Groups;
pub use liquid::{ElectricField, Equilibrium, Liquid, LiquidMarch};
pub use method::{Interfaces, Method, Solver};
pub use output::Output;
pub use permeability::Permeability;
pub use potential::Electrostatics;
pub use warmth::{LiquidHeat, LiquidMelting, LiquidRadiation};

use crate::cloud::layout::SURROUNDINGS;
use crate::cloud::points::Points;

/// Electric and magnetic fields of bodies.
#[derive(Debug, Clone, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Scene {
    /// Title of reports.
    pub title: Option<String>,
    /// Plane (x, y; per metre of depth), axisymmetric (r, z) or in space (x, y, z): the coordinates of all places
    /// and shapes of the scene.
    pub geometry: Geometry,
    /// Where fields are sought; absent where none are.
    #[serde(default)]
    pub domain: Domain,
    /// What fills the domain outside the bodies; vacuum when it is absent.
    #[serde(default)]
    pub surroundings: Medium,
    /// Bodies; where two overlap, the first counts.
    #[serde(default)]
    #[schemars(length(max = 200))]
    pub bodies: Vec<BodyScene>,
    /// The electric field of charges and electrodes; left out when it is absent.
    pub electrostatics: Option<Electrostatics>,
    /// Currents that a changing magnetic field drives; left out when it is absent.
    pub eddy_currents: Option<EddyCurrents>,
    /// A liquid that moves; left out when it is absent.
    pub liquid: Option<Liquid>,
    /// How points fill the domain.
    pub points: Points,
    /// How derivatives are formed.
    #[serde(default)]
    pub method: Method,
    /// How equations are solved.
    #[serde(default)]
    pub solver: Solver,
    /// What is written.
    #[serde(default)]
    pub output: Output,
}

impl Scene {
    /// Properties of a medium: 0 the surroundings, `k + 1` body `k`.
    #[must_use]
    pub fn medium(&self, number: usize) -> Medium {
        match number.checked_sub(1) {
            None => self.surroundings,
            Some(body) => self.bodies[body].medium(),
        }
    }

    /// Whether a medium is a coil of points.
    #[must_use]
    pub fn carries(&self, number: usize) -> bool {
        let coils = self.eddy_currents.iter().flat_map(|e| &e.coils);
        let name = number.checked_sub(1).map(|k| &self.bodies[k].name);
        coils
            .filter_map(Coil::region)
            .any(|r| Some(&r.body) == name)
    }

    /// Whether the permeability of a medium depends on the field.
    #[must_use]
    pub fn saturates(&self, number: usize) -> bool {
        let body = number.checked_sub(1).map(|k| &self.bodies[k]);
        body.is_some_and(|b| b.relative_permeability.saturates())
    }

    /// Whether a medium has another permeability than the surroundings, and potentials are computed, whose slopes know it.
    #[must_use]
    pub fn magnetic(&self, number: usize) -> bool {
        if self.saturates(number) {
            return true;
        }
        let own = self.medium(number).relative_permeability;
        let around = self.surroundings.relative_permeability;
        (own - around).abs() > 1e-12 * around
    }

    /// Name of a medium.
    #[must_use]
    pub fn medium_name(&self, number: usize) -> &str {
        match number.checked_sub(1) {
            None => SURROUNDINGS,
            Some(body) => &self.bodies[body].name,
        }
    }
}

#[cfg(test)]
mod tests;
