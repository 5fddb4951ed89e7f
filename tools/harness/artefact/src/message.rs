//! A message before it is in a file: channel, schema, time, bytes.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use crate::table::{Record, Table, WORLD};
use crate::values::Precision;
use crate::{cloud, grid};

/// Schema name of a [`Table`].
pub const TABLE: &str = "fusionline.table.v1";
/// Schema name of a [`Record`].
pub const RECORD: &str = "fusionline.record.v1";
/// Schema name of a [`crate::Frame`].
pub const POINT_CLOUD: &str = cloud::SCHEMA;
/// Schema name of a [`Table`] that is a grid of equal cells in space.
pub const GRID: &str = grid::SCHEMA;

/// Metadata of a channel: axes of its grids, with unit and values.
pub(crate) const AXES: &str = "axes";
/// Metadata of a channel: the channel of the scalars that belong to its grids.
pub(crate) const ATTRIBUTES: &str = "attributes";
/// Metadata of a channel: frame of reference of its tables, where it is not the world.
pub(crate) const FRAME_ID: &str = "frame_id";
/// Metadata of a channel: unit of each column.
pub(crate) const UNITS: &str = "units";
/// Metadata of a channel: name and type of each packed column.
pub(crate) const COLUMNS: &str = "columns";

const TABLE_SCHEMA: &str = include_str!("../../../../schemas/table.v1.json");
const RECORD_SCHEMA: &str = include_str!("../../../../schemas/record.v1.json");

/// What a channel carries; equal for all of its messages.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) struct Topic {
    /// Name of the channel, for example `/particles`.
    pub(crate) channel: String,
    /// Name of the schema.
    pub(crate) schema: String,
    /// JSON Schema; empty for Foxglove's messages, whose descriptors are known.
    pub(crate) json_schema: String,
    /// Unit of each column.
    pub(crate) units: BTreeMap<String, String>,
    /// Types of the columns of a frame or packed grid, in order.
    pub(crate) layout: Vec<String>,
    /// What else the metadata of the channel says.
    #[serde(default)]
    pub(crate) more: BTreeMap<String, String>,
}

impl Topic {
    pub(crate) fn frames(channel: &str, layout: &[(String, String, &'static str)]) -> Self {
        Self {
            channel: channel.to_owned(),
            schema: POINT_CLOUD.to_owned(),
            json_schema: String::new(),
            units: layout
                .iter()
                .map(|(name, unit, _)| (name.clone(), unit.clone()))
                .collect(),
            layout: layout
                .iter()
                .map(|(name, _, kind)| format!("{name} {kind}"))
                .collect(),
            more: BTreeMap::new(),
        }
    }

    pub(crate) fn table(channel: &str, table: &Table) -> Self {
        Self {
            more: frame_of(table),
            ..Self::json(channel, TABLE, TABLE_SCHEMA, table.units())
        }
    }

    /// A channel of grids of equal cells, with the axes that they share.
    pub(crate) fn grid(channel: &str, table: &Table) -> Self {
        let columns = table.columns.iter();
        let kind = match table.precision() {
            Precision::F32 => "f32",
            Precision::F64 => "f64",
        };
        let mut more = frame_of(table);
        more.insert(
            AXES.to_owned(),
            serde_json::to_string(&table.axes).unwrap_or_default(),
        );
        if !table.attributes.is_empty() {
            more.insert(ATTRIBUTES.to_owned(), format!("{channel}/{ATTRIBUTES}"));
        }
        Self {
            layout: columns.map(|c| format!("{} {kind}", c.name)).collect(),
            more,
            ..Self::json(channel, GRID, "", table.units())
        }
    }

    pub(crate) fn record(channel: &str, record: &Record) -> Self {
        Self::json(channel, RECORD, RECORD_SCHEMA, record.units())
    }

    pub(crate) fn json(
        channel: &str,
        schema: &str,
        json_schema: &str,
        units: BTreeMap<String, String>,
    ) -> Self {
        Self {
            channel: channel.to_owned(),
            schema: schema.to_owned(),
            json_schema: json_schema.to_owned(),
            units,
            layout: Vec::new(),
            more: BTreeMap::new(),
        }
    }

    /// Whether the messages are packed: Foxglove's own, not JSON.
    fn is_packed(&self) -> bool {
        self.schema == POINT_CLOUD || self.schema == GRID
    }

    pub(crate) fn schema_encoding(&self) -> &'static str {
        if self.is_packed() {
            "protobuf"
        } else {
            "jsonschema"
        }
    }

    pub(crate) fn message_encoding(&self) -> &'static str {
        if self.is_packed() { "protobuf" } else { "json" }
    }

    pub(crate) fn schema_data(&self) -> Vec<u8> {
        match self.schema.as_str() {
            POINT_CLOUD => cloud::descriptor(),
            GRID => grid::descriptor(),
            _ => self.json_schema.clone().into_bytes(),
        }
    }

    /// The metadata of the channel record.
    pub(crate) fn metadata(&self) -> BTreeMap<String, String> {
        let text = |value: serde_json::Result<String>| value.unwrap_or_default();
        let mut map = self.more.clone();
        if !self.units.is_empty() {
            map.insert(UNITS.to_owned(), text(serde_json::to_string(&self.units)));
        }
        if !self.layout.is_empty() {
            map.insert(
                COLUMNS.to_owned(),
                text(serde_json::to_string(&self.layout)),
            );
        }
        map
    }
}

fn frame_of(table: &Table) -> BTreeMap<String, String> {
    let named = [(FRAME_ID, table.frame_id())].into_iter();
    named
        .filter(|(_, frame)| *frame != WORLD)
        .map(|(key, frame)| (key.to_owned(), frame.to_owned()))
        .collect()
}

/// Simulated time as log time.
#[must_use]
#[allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "times are positive and below 500 years"
)]
pub(crate) fn log_time(time_s: f64) -> u64 {
    (time_s * 1e9).round() as u64
}

/// Whether two simulated times \[s\] are one time in a file.
#[must_use]
pub fn one_time(first_s: f64, second_s: f64) -> bool {
    log_time(first_s) == log_time(second_s)
}

/// Log time as simulated time \[s\].
#[must_use]
#[allow(clippy::cast_precision_loss, reason = "exact below 104 days")]
pub(crate) fn time_s(log_time: u64) -> f64 {
    log_time as f64 / 1e9
}
