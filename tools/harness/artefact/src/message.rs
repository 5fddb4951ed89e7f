//! A message before it is in a file: channel, schema, time, bytes.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use crate::cloud;
use crate::table::{Record, Table};

/// Schema name of a [`Table`].
pub const TABLE: &str = "fusionline.table.v1";
/// Schema name of a [`Record`].
pub const RECORD: &str = "fusionline.record.v1";
/// Schema name of a [`crate::Frame`].
pub const POINT_CLOUD: &str = cloud::SCHEMA;

const TABLE_SCHEMA: &str = include_str!("../../../../schemas/table.v1.json");
const RECORD_SCHEMA: &str = include_str!("../../../../schemas/record.v1.json");

/// What a channel carries; equal for all of its messages.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) struct Topic {
    /// Name of the channel, for example `/particles`.
    pub(crate) channel: String,
    /// Name of the schema.
    pub(crate) schema: String,
    /// JSON Schema; empty for a point cloud, whose descriptor is known.
    pub(crate) json_schema: String,
    /// Unit of each column.
    pub(crate) units: BTreeMap<String, String>,
    /// Types of the columns of a frame, in order.
    pub(crate) layout: Vec<String>,
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
        }
    }

    pub(crate) fn table(channel: &str, table: &Table) -> Self {
        Self::json(channel, TABLE, TABLE_SCHEMA, table.units())
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
        }
    }

    pub(crate) fn is_frames(&self) -> bool {
        self.schema == POINT_CLOUD
    }

    pub(crate) fn schema_encoding(&self) -> &'static str {
        if self.is_frames() {
            "protobuf"
        } else {
            "jsonschema"
        }
    }

    pub(crate) fn message_encoding(&self) -> &'static str {
        if self.is_frames() { "protobuf" } else { "json" }
    }

    pub(crate) fn schema_data(&self) -> Vec<u8> {
        if self.is_frames() {
            cloud::descriptor()
        } else {
            self.json_schema.clone().into_bytes()
        }
    }

    /// The metadata of the channel record.
    pub(crate) fn metadata(&self) -> BTreeMap<String, String> {
        let text = |value: serde_json::Result<String>| value.unwrap_or_default();
        let mut map = BTreeMap::new();
        if !self.units.is_empty() {
            map.insert("units".to_owned(), text(serde_json::to_string(&self.units)));
        }
        if !self.layout.is_empty() {
            map.insert(
                "columns".to_owned(),
                text(serde_json::to_string(&self.layout)),
            );
        }
        map
    }
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

/// Log time as simulated time \[s\].
#[must_use]
#[allow(clippy::cast_precision_loss, reason = "exact below 104 days")]
pub(crate) fn time_s(log_time: u64) -> f64 {
    log_time as f64 / 1e9
}
