//! What a scene says of grains beside metal.

use schemars::JsonSchema;
use serde::Deserialize;

/// Elastic spheres.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct HertzScene {
    /// E.
    #[schemars(extend("x-unit" = "Pa", "exclusiveMinimum" = 0.0))]
    pub youngs_modulus_pa: f64,
    /// nu.
    #[schemars(extend("x-unit" = "1", "exclusiveMinimum" = -1.0, "exclusiveMaximum" = 0.5))]
    pub poisson_ratio: f64,
}

impl HertzScene {
    /// Effective modulus of two of it \[Pa\].
    #[must_use]
    pub fn effective(self) -> f64 {
        0.5 * self.youngs_modulus_pa / (1.0 - self.poisson_ratio * self.poisson_ratio)
    }
}

/// What metal is to grains.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MetalScene {
    /// Coefficient of friction of grains on metal, if it is another.
    #[schemars(range(min = 0.0), extend("x-unit" = "1"))]
    pub friction: Option<f64>,
    /// Elasticity of the metal, for the width of contacts that conduct; that of steel if absent.
    #[serde(default = "steel")]
    pub elastic: HertzScene,
}

/// 210 GPa, 0.3.
fn steel() -> HertzScene {
    HertzScene {
        youngs_modulus_pa: 210e9,
        poisson_ratio: 0.3,
    }
}

impl Default for MetalScene {
    fn default() -> Self {
        Self {
            friction: None,
            elastic: steel(),
        }
    }
}

impl MetalScene {
    /// Effective modulus of a grain on the metal \[Pa\]: `1/E* = (1 - nu_a^2)/E_a + (1 - nu_b^2)/E_b`; of the metal alone where
    /// contacts are as wide as their overlap, whatever the grains.
    #[must_use]
    pub fn modulus(self, grains: Option<HertzScene>) -> f64 {
        let soft = |of: HertzScene| 0.5 / of.effective();
        1.0 / (grains.map_or(0.0, soft) + soft(self.elastic))
    }
}
