//! Where a figure stands.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Where a figure stands in what a run wrote.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
#[schemars(rename = "FigureFrom")]
pub enum From {
    /// A value of the last record of a channel.
    Record {
        /// Channel.
        channel: String,
        /// Name of the value.
        value: String,
    },
    /// The mean of a value over the records of a channel between two times.
    Mean {
        /// Channel.
        channel: String,
        /// Name of the value.
        value: String,
        /// From when on.
        #[schemars(extend("x-unit" = "s"))]
        from_s: f64,
        /// Until when; the end where it is not said.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        #[schemars(extend("x-unit" = "s"))]
        until_s: Option<f64>,
    },
    /// The time at which a value falls below a limit for the first time.
    FallsBelow {
        /// Channel.
        channel: String,
        /// Name of the value.
        value: String,
        /// The limit, in the unit of the value.
        limit: f64,
    },
    /// The period of a value that swings, by its turning points.
    Period {
        /// Channel.
        channel: String,
        /// Name of the value.
        value: String,
    },
    /// The greatest value of a column of the last table of a channel.
    Greatest {
        /// Channel.
        channel: String,
        /// Name of the column.
        column: String,
    },
    /// A closing value of the run record.
    Closing(String),
    /// A measure of the bead at the end of a weld, as `report figures` names it.
    Bead(String),
    /// A column of the last frame of a channel at the point that stands at a place.
    Point {
        /// Channel.
        channel: String,
        /// Name of the column.
        column: String,
        /// Component of a vector; 0 for a scalar.
        #[serde(default)]
        component: usize,
        /// The place, where every run must have a point.
        #[schemars(extend("x-unit" = "m"))]
        at_m: [f64; 3],
    },
}

impl From {
    /// The channel, or what else holds it, and the name there.
    #[must_use]
    pub fn place(&self) -> (&str, &str) {
        match self {
            Self::Record { channel, value }
            | Self::Mean { channel, value, .. }
            | Self::FallsBelow { channel, value, .. }
            | Self::Period { channel, value } => (channel, value),
            Self::Greatest { channel, column }
            | Self::Point {
                channel, column, ..
            } => (channel, column),
            Self::Closing(name) => ("the run record", name),
            Self::Bead(measure) => ("the bead", measure),
        }
    }
}
