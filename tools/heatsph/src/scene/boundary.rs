//! What happens at the surface of the body.

use run::property::Property;
use schemars::JsonSchema;
use serde::Deserialize;

use shapes::Shape;

/// Heat passed to surroundings in proportion to the difference of temperature (Robin).
#[derive(Debug, Clone, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Convection {
    /// Heat transfer coefficient, a function of x, y, z, r, t.
    #[schemars(extend("x-unit" = "W/(m2 K)"))]
    pub coefficient_w_m2_k: Property,
    /// Temperature of the surroundings, a function of x, y, z, r, t.
    #[schemars(extend("x-unit" = "K"))]
    pub ambient_k: Property,
}

/// Radiation between a grey surface and black surroundings.
#[derive(Debug, Clone, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Radiation {
    /// Emissivity, a function of x, y, z, r, t.
    #[schemars(extend("x-unit" = "1"))]
    pub emissivity: Property,
    /// Temperature of the surroundings, a function of x, y, z, r, t.
    #[schemars(extend("x-unit" = "K"))]
    pub surroundings_k: Property,
}

/// A condition on named faces: exactly one of temperature, flux, convection and radiation. A flux, convection
/// and radiation may stand together as several entries on one face; a temperature stands alone. Faces that no
/// entry names are insulated.
#[derive(Debug, Clone, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Boundary {
    /// Name in the tables of the artefact; the faces when it is absent, a second entry on them with a number: `x- 2`.
    pub name: Option<String>,
    /// Faces: `x-` ... `z+` of a box, `side`, `bottom`, `top` of a cylinder, `rim` of a disc, `surface` of a
    /// sphere, `plane` of a half space; `hole.rim` where the shape has the name `hole`.
    #[schemars(length(min = 1))]
    pub on: Vec<String>,
    /// Only the part of the faces within this shape, by its own area. A temperature is held at whole points.
    pub within: Option<Shape>,
    /// Prescribed temperature (Dirichlet), a function of x, y, z, r, t.
    #[schemars(extend("x-unit" = "K"))]
    pub temperature_k: Option<Property>,
    /// Heat flux into the body (Neumann), a function of x, y, z, r, t.
    #[schemars(extend("x-unit" = "W/m2"))]
    pub heat_flux_w_m2: Option<Property>,
    /// Convection (Robin).
    pub convection: Option<Convection>,
    /// Radiation.
    pub radiation: Option<Radiation>,
}
