//! What a scene says of a second liquid (key `slag`).

use std::sync::Arc;

use run::Fault;
use run::property::Property;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::law::Law;
use crate::heat::{Caloric, Properties};
use crate::state::slag::Slag;

/// A second liquid that does not mix with the metal, such as slag upon a pool: bodies of the material "slag".
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Parameters {
    /// rho \[kg/m3\].
    #[schemars(extend("x-unit" = "kg/m3", "exclusiveMinimum" = 0.0))]
    pub density_kg_m3: f64,
    /// Dynamic viscosity mu(T). Slag has no state but the liquid one: where it is cold it is stiff, as glass is. The greatest value bounds the
    /// step.
    #[schemars(extend("x-unit" = "Pa s"))]
    pub viscosity_pa_s: Property,
    /// Its heat, where the scene has heat; its latent heat is taken up at the melting point.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub heat: Option<Properties>,
    /// Tension of the interface between both liquids \[N/m\]; it meets walls at right angles. Absent: none.
    #[serde(default)]
    #[schemars(range(min = 0.0), extend("x-unit" = "N/m"))]
    pub interface_tension_n_m: f64,
    /// Tension of its free surface \[N/m\], where the scene has tension; that of the metal if absent. Along the line where slag, metal and gas
    /// meet the three tensions are not balanced: how far slag spreads on metal is not told.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0.0), extend("x-unit" = "N/m"))]
    pub surface_tension_n_m: Option<f64>,
}

impl Parameters {
    /// What the state knows of it, and the law of its viscosity.
    ///
    /// # Errors
    /// A fault at the key that is wrong.
    pub fn slag(&self) -> Result<(Slag, Law), Fault> {
        let range = self.caloric()?.map(|caloric| caloric.range());
        let law = Law::over(&self.viscosity_pa_s, "/slag/viscosity_pa_s", range)?;
        let slag = Slag {
            density: self.density_kg_m3,
            viscosity: law.largest(),
            interface_tension: self.interface_tension_n_m,
            surface_tension: self.surface_tension_n_m,
        };
        Ok((slag, law))
    }

    /// Its thermal properties, where it has some.
    ///
    /// # Errors
    /// A fault at the key that is wrong.
    pub fn caloric(&self) -> Result<Option<Arc<Caloric>>, Fault> {
        let made = self.heat.as_ref().map(Properties::caloric).transpose();
        made.map_err(|fault| fault.within("/slag/heat"))
    }
}
