//! Materials of a scene and what lies between them.

use run::property::Property;
use schemars::JsonSchema;
use serde::Deserialize;

use shapes::Shape;

/// A constituent of a mixture.
#[derive(Debug, Clone, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Constituent {
    /// Part of the mixture, from 0 to 1, a function of place (x, y, z, r). The parts of a mixture add up to 1.
    #[schemars(extend("x-unit" = "1"))]
    pub fraction: Property,
    /// Conductivity of the constituent, a function of T.
    #[schemars(extend("x-unit" = "W/(m K)"))]
    pub conductivity_w_m_k: Property,
}

/// Conductivity: one property, or a mixture of constituents.
#[derive(Debug, Clone, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Material {
    /// Name.
    pub name: String,
    /// Region of the material. A place has the first material of the list whose region contains it; the last material needs no
    /// region and fills the rest.
    pub region: Option<Shape>,
    /// Density: a number, a table over temperature, or a formula in x, y, z, r, T. Cells keep their volume: density
    /// times specific heat is what they store.
    #[schemars(extend("x-unit" = "kg/m3"))]
    pub density_kg_m3: Property,
    /// Specific heat: a number, a table over temperature, or a formula in x, y, z, r, T; latent heat is a peak of it.
    #[schemars(extend("x-unit" = "J/(kg K)"))]
    pub specific_heat_j_kg_k: Property,
    /// Conductivity: a number, a table over temperature, or a formula in x, y, z, r, T.
    #[schemars(extend("x-unit" = "W/(m K)"))]
    pub conductivity_w_m_k: Option<Property>,
    /// Conductivity by the rule of mixtures, the sum of fraction times conductivity (Rong and Kisu 2010, eq.
    /// 13); in place of `conductivity_w_m_k`.
    pub mixture: Option<Vec<Constituent>>,
}

/// A resistance between two materials that touch.
#[derive(Debug, Clone, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Contact {
    /// Names of the two materials.
    pub between: [String; 2],
    /// Resistance of the unit area.
    #[schemars(range(min = 0.0), extend("x-unit" = "m2 K/W"))]
    pub resistance_m2_k_w: f64,
}
