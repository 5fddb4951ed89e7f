//! The march in time, and what is written.

use run::scene::FloatWidth;
use schemars::JsonSchema;
use serde::Deserialize;

/// What becomes of an explicit step beyond its limit.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Beyond {
    /// It is divided into equal steps within the limit, and the record says so.
    #[default]
    Substep,
    /// The scene is refused.
    Refuse,
}

/// The explicit Euler method of the paper, first order in time.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Explicit {
    /// Step; 0.9 of the limit when it is absent.
    #[schemars(extend("x-unit" = "s", "exclusiveMinimum" = 0.0))]
    pub step_s: Option<f64>,
    /// What happens to a step beyond the stability limit.
    #[serde(default)]
    pub beyond_limit: Beyond,
}

/// A method whose steps follow its error.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Controlled {
    /// Largest error of a step, relative to the range of temperature.
    #[serde(default = "tolerance")]
    #[schemars(range(min = 1e-12, max = 0.1), extend("x-unit" = "1"))]
    pub tolerance: f64,
    /// Error of a step that is accepted whatever the range of temperature; 1e-10 of the greatest temperature when it is absent.
    #[schemars(extend("x-unit" = "K", "exclusiveMinimum" = 0.0))]
    pub floor_k: Option<f64>,
    /// Steps of this length in place of error control.
    #[schemars(extend("x-unit" = "s", "exclusiveMinimum" = 0.0))]
    pub step_s: Option<f64>,
}

fn tolerance() -> f64 {
    1e-4
}

impl Default for Controlled {
    fn default() -> Self {
        Self {
            tolerance: tolerance(),
            floor_k: None,
            step_s: None,
        }
    }
}

/// The march in time: exactly one method.
#[derive(Debug, Clone, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Time {
    /// End of the run.
    #[schemars(extend("x-unit" = "s", "exclusiveMinimum" = 0.0))]
    pub end_s: f64,
    /// Explicit Euler.
    pub explicit: Option<Explicit>,
    /// Runge-Kutta-Legendre of second order (Meyer, Balsara and Aslam 2014): explicit, with as many stages as
    /// the step needs.
    pub stabilised: Option<Controlled>,
    /// Singly diagonally implicit Runge-Kutta of second order, L-stable (Alexander 1977).
    pub implicit: Option<Controlled>,
}

/// A place whose temperature is written at every output.
#[derive(Debug, Clone, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Monitor {
    /// Name: a column of the table.
    pub name: String,
    /// Place in the body.
    #[schemars(extend("x-unit" = "m"), length(min = 2, max = 3))]
    pub place_m: Vec<f64>,
}

/// What is written, and when: start and end always.
#[derive(Debug, Clone, PartialEq, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Output {
    /// Times of frames, rising.
    #[serde(default)]
    #[schemars(extend("x-unit" = "s"))]
    pub at_s: Vec<f64>,
    /// Interval of frames.
    #[schemars(extend("x-unit" = "s", "exclusiveMinimum" = 0.0))]
    pub every_s: Option<f64>,
    /// Interval of monitors and balances; that of the frames when it is absent.
    #[schemars(extend("x-unit" = "s", "exclusiveMinimum" = 0.0))]
    pub monitors_every_s: Option<f64>,
    /// Width of the floats.
    #[serde(default)]
    pub precision: FloatWidth,
    /// Places whose temperature is written.
    #[serde(default)]
    pub monitors: Vec<Monitor>,
}
