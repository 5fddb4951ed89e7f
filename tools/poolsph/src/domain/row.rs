//! Rows of places along the axes, and the faces of a box that they end at.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A face of a box by its outward direction.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub enum Face {
    /// Towards smaller x.
    #[serde(rename = "x-")]
    XLow,
    /// Towards greater x.
    #[serde(rename = "x+")]
    XHigh,
    /// Towards smaller y.
    #[serde(rename = "y-")]
    YLow,
    /// Towards greater y.
    #[serde(rename = "y+")]
    YHigh,
    /// Towards smaller z.
    #[serde(rename = "z-")]
    ZLow,
    /// Towards greater z.
    #[serde(rename = "z+")]
    ZHigh,
}

impl Face {
    /// Axis (0, 1, 2) and whether it is the upper side.
    pub(super) fn side(self) -> (usize, bool) {
        match self {
            Self::XLow => (0, false),
            Self::XHigh => (0, true),
            Self::YLow => (1, false),
            Self::YHigh => (1, true),
            Self::ZLow => (2, false),
            Self::ZHigh => (2, true),
        }
    }
}

/// Coordinates `anchor + (i + 1/2) d` within `low..high`.
pub(super) fn lattice(anchor: f64, low: f64, high: f64, d: f64) -> Vec<f64> {
    // A billionth of d decides for a point on a face, so that rounding does not.
    let slack = 1e-9;
    let first = ((low - anchor) / d - 0.5 - slack).ceil() as i64;
    let end = ((high - anchor) / d - 0.5 - slack).ceil() as i64;
    (first..end)
        .map(|i| anchor + (i as f64 + 0.5) * d)
        .collect()
}

/// All combinations, x fastest.
pub(super) fn product(axes: &[Vec<f64>; 3]) -> Vec<[f64; 3]> {
    let mut points = Vec::with_capacity(axes.iter().map(Vec::len).product());
    for &z in &axes[2] {
        for &y in &axes[1] {
            points.extend(axes[0].iter().map(|&x| [x, y, z]));
        }
    }
    points
}
