//! How derivatives are formed and equations solved.

use schemars::JsonSchema;
use serde::Deserialize;

/// Interfaces by one-sided stencils.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct OneSided {}

/// Interfaces smeared over the support.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Smeared {}

/// How media meet.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Interfaces {
    /// Points on the interface carry the jump condition, with stencils of either side alone.
    OneSided(OneSided),
    /// As in the paper: stencils cross the interface, weighted by the harmonic mean of the property.
    Smeared(Smeared),
}

impl Default for Interfaces {
    fn default() -> Self {
        Self::OneSided(OneSided {})
    }
}

/// How derivatives are formed.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Method {
    /// Degree of the polynomials. With 1, slopes at interfaces and walls are linear with one quadratic term from the equation, and
    /// second derivatives are those of quadratics.
    #[serde(default = "order")]
    #[schemars(range(min = 1, max = 4))]
    pub order: usize,
    /// Radius of the support over the local spacing; at least what the order needs when it is absent (2.5 for
    /// order 2, as in the paper; 2.75, in a plane 3, for potentials of order 3 and 4 without an axis, whose
    /// polynomials are harmonic; for other potentials 3 for order 3 and 3.5 for order 4).
    #[schemars(range(min = 1.2, max = 8.0), extend("x-unit" = "1"))]
    pub support: Option<f64>,
    /// How media meet.
    #[serde(default)]
    pub interfaces: Interfaces,
    /// Whether weights of the Laplacian that are negative off the centre are replaced by the least nonnegative ones.
    #[serde(default)]
    pub positive: bool,
}

fn order() -> usize {
    2
}

impl Default for Method {
    fn default() -> Self {
        Self {
            order: order(),
            support: None,
            interfaces: Interfaces::default(),
            positive: false,
        }
    }
}

/// Ways to solve linear equations.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Way {
    /// Direct for small systems, else iterative; direct again where iterations stagnate.
    #[default]
    Auto,
    /// A sparse factorisation.
    Direct,
    /// BiCGStab(2) with algebraic multigrid.
    Iterative,
    /// BiCGStab(2) with incomplete factors that have the entries of the matrix, ILU(0), as in the paper.
    Ilu0,
    /// BiCGStab(2) with incomplete factors that have up to twice as many, ILUT.
    Ilut,
}

/// How equations are solved.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Solver {
    /// Method for the linear equations.
    #[serde(default)]
    pub way: Way,
    /// Largest residual at which the iteration ends, relative to the residual of a solution of zeros.
    #[serde(default = "tolerance")]
    #[schemars(range(min = 1e-15, max = 1e-3), extend("x-unit" = "1"))]
    pub tolerance: f64,
    /// Greatest number of iterations.
    #[serde(default = "iterations")]
    #[schemars(range(min = 1))]
    pub iterations: usize,
}

fn tolerance() -> f64 {
    1e-9
}

fn iterations() -> usize {
    1000
}

impl Default for Solver {
    fn default() -> Self {
        Self {
            way: Way::default(),
            tolerance: tolerance(),
            iterations: iterations(),
        }
    }
}
