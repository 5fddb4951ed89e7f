//! How points fill a body.

use schemars::JsonSchema;
use serde::Deserialize;

/// Arrangement of points.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Arrangement {
    /// The body's own: a box has a lattice with points on its faces, a disc or cylinder rings (Rong and Kisu
    /// 2010, fig. 11), a sphere shells.
    #[default]
    Fitted,
    /// A lattice along the axes, cut by the body: any composition of shapes.
    Cut,
}

/// Ratio of each spacing to the one before it.
#[derive(Debug, Clone, Copy, PartialEq, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Grading {
    /// Along x of a box.
    #[schemars(range(min = 0.5, max = 2.0))]
    pub x: Option<f64>,
    /// Along y of a box.
    #[schemars(range(min = 0.5, max = 2.0))]
    pub y: Option<f64>,
    /// Along z of a box, along the axis of a cylinder.
    #[schemars(range(min = 0.5, max = 2.0))]
    pub z: Option<f64>,
    /// Outward in a disc or cylinder.
    #[schemars(range(min = 0.5, max = 2.0))]
    pub r: Option<f64>,
}

/// How points fill the body.
#[derive(Debug, Clone, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Points {
    /// Distance of neighbouring points; a fitted arrangement takes the nearest that divides the body evenly.
    #[schemars(extend("x-unit" = "m", "exclusiveMinimum" = 0.0))]
    pub spacing_m: f64,
    /// How points are arranged in the body.
    #[serde(default)]
    pub arrangement: Arrangement,
    /// Random shift of each inner point along each axis, at most this part of the spacing.
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 0.45))]
    pub jitter: f64,
    /// Seed of the random shifts.
    #[serde(default)]
    pub seed: u64,
    /// Spacing that changes along an axis; even if absent.
    #[serde(default)]
    pub grading: Grading,
    /// Further points inside the body, wherever they lie.
    #[serde(default)]
    #[schemars(extend("x-unit" = "m"))]
    pub extra_m: Vec<Vec<f64>>,
}
