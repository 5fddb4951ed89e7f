//! How a table goes into a file and comes out: as JSON, or packed where it is a grid of equal cells.
//!
//! What all grids of a channel share (axes, units) stands in the metadata of the channel; the
//! scalars that belong to each stand in a record of the same time, in the channel `NAME/attributes`.

use std::collections::BTreeMap;

use serde::de::DeserializeOwned;

use crate::error::{Error, Result};
use crate::grid;
use crate::lattice::Lattice;
use crate::message::{ATTRIBUTES, AXES, COLUMNS, FRAME_ID, GRID, RECORD, TABLE, Topic};
use crate::reader::Reader;
use crate::table::{Quantity, Record, Series, Table};
use crate::values::Precision;
use crate::writer::Writer;

impl Writer {
    /// Writes a table or grid. A grid of equal cells in space becomes a packed `foxglove.Grid`,
    /// and ends the chunk; any other table becomes JSON.
    ///
    /// # Errors
    /// When columns differ in length or name from the shape or the channel's first table, a value
    /// is not finite, or the disk refuses.
    pub fn table(&mut self, channel: &str, time_s: f64, table: &Table) -> Result<()> {
        self.check(channel, table.fault(), table.not_finite())?;
        match Lattice::of(table) {
            Some(lattice) => self.grid(channel, time_s, (table, &lattice)),
            None => self.text(Topic::table(channel, table), time_s, table),
        }
    }

    fn grid(&mut self, channel: &str, time_s: f64, grid: (&Table, &Lattice)) -> Result<()> {
        let (table, lattice) = grid;
        let topic = Topic::grid(channel, table);
        let time = self.admit_at(&topic, time_s)?;
        let record = attributes(table);
        let beside = topic.more.get(ATTRIBUTES);
        if let Some(beside) = beside {
            self.admit(&Topic::record(beside, &record), time)?;
        }
        self.end_waiting()?;
        self.put(channel, time, &grid::encode(table, lattice, time))?;
        if let Some(beside) = beside {
            let text = serde_json::to_vec(&record);
            let text = text.map_err(|e| self.unfit(beside, e.to_string()))?;
            self.put(beside, time, &text)?;
        }
        self.end_chunk()
    }
}

/// Longest number of a JSON text, with what parts it from the next \[byte\]: `-1.2345678901234567e-308,`.
const NUMBER: usize = 26;
/// What a series or a message has beside its numbers, at most \[byte\].
const NAMES: usize = 200;

impl Table {
    /// Bytes of the message that holds such a table, at most, before they are compressed; the values do not matter.
    #[must_use]
    pub fn most_bytes(&self) -> usize {
        let series = self.columns.len() + self.axes.len() + self.attributes.len() + 1;
        // The axes of a packed grid stand once, with its channel.
        let along: usize = self.axes.iter().map(|axis| axis.values.len()).sum();
        let (width, along) = match (Lattice::of(self), self.precision()) {
            (Some(_), Precision::F32) => (4, 0),
            (Some(_), Precision::F64) => (8, 0),
            (None, _) => (NUMBER, along),
        };
        series * NAMES + along * NUMBER + self.columns.len() * self.len() * width
    }
}

fn attributes(table: &Table) -> Record {
    let scalars = table.attributes.iter();
    scalars.fold(Record::new(), |record, (name, q)| {
        record.with(name, &q.unit, q.value)
    })
}

impl Reader {
    /// The first table of a channel.
    ///
    /// # Errors
    /// As [`Reader::table_at`].
    pub fn table(&self, channel: &str) -> Result<Table> {
        self.table_at(channel, 0)
    }

    /// The table or grid with an index, however it is encoded.
    ///
    /// # Errors
    /// When channel or index are absent, the channel holds no tables, its chunk is damaged, or the
    /// message is not what the channel says.
    pub fn table_at(&self, channel: &str, index: usize) -> Result<Table> {
        let table = if self.channel(channel)?.info.schema == GRID {
            self.grid_at(channel, index)?
        } else {
            self.place(channel, index, TABLE)?;
            let table: Table = self.json_at(channel, index)?;
            table.in_frame(&self.frame_id(channel)?)
        };
        match table.fault() {
            Some(what) => Err(self.message_error(channel, index, what)),
            None => Ok(table.with_origin(&self.origin(channel))),
        }
    }

    fn grid_at(&self, channel: &str, index: usize) -> Result<Table> {
        let (indexed, place) = self.place(channel, index, GRID)?;
        let axes: Vec<Series> = self.said(channel, AXES)?.ok_or_else(|| {
            self.store
                .damaged(at(channel), format!("no entry '{AXES}'"))
        })?;
        let mut table = Table::default().in_frame(&self.frame_id(channel)?);
        table.shape = axes.iter().map(|axis| axis.values.len()).collect();
        table.axes = axes;
        table.attributes = self.attributes_of(channel, index, place.log_time)?;
        let data = self.data(channel, index, indexed.id, place)?;
        let unit = |name: &str| indexed.units.get(name).cloned().unwrap_or_default();
        let layout: Vec<String> = self.said(channel, COLUMNS)?.unwrap_or_default();
        grid::decode(&data.0[data.1].data, table, &layout, unit)
            .map_err(|what| self.message_error(channel, index, what))
    }

    /// The scalars that belong to a grid: the record with the same index beside it.
    fn attributes_of(
        &self,
        channel: &str,
        index: usize,
        log_time: u64,
    ) -> Result<BTreeMap<String, Quantity>> {
        let metadata = &self.channel(channel)?.info.metadata;
        let Some(beside) = metadata.get(ATTRIBUTES) else {
            return Ok(BTreeMap::new());
        };
        let (_, place) = self.place(beside, index, RECORD)?;
        if place.log_time != log_time {
            let what = format!(
                "is at {} ns, the grid that it belongs to at {log_time} ns",
                place.log_time
            );
            return Err(self.message_error(beside, index, what));
        }
        let record = self.record_at(beside, index)?;
        let scalar = |e: crate::table::Entry| {
            let (value, unit) = (e.value, e.unit);
            (e.name, Quantity { value, unit })
        };
        Ok(record.values.into_iter().map(scalar).collect())
    }

    fn frame_id(&self, channel: &str) -> Result<String> {
        let metadata = &self.channel(channel)?.info.metadata;
        Ok(metadata.get(FRAME_ID).cloned().unwrap_or_default())
    }

    /// An entry of the metadata of a channel.
    fn said<T: DeserializeOwned>(&self, channel: &str, key: &str) -> Result<Option<T>> {
        let text = self.channel(channel)?.info.metadata.get(key);
        let wrong = |e: serde_json::Error| -> Error {
            self.store.damaged(at(channel), format!("{key}: {e}"))
        };
        text.map(|t| serde_json::from_str(t).map_err(wrong))
            .transpose()
    }
}

fn at(channel: &str) -> String {
    format!("metadata of channel '{channel}'")
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A grid of numbers that take the most digits.
    fn long(y: &[f64]) -> Table {
        let x = [0.1, 0.2, 0.3];
        let values = vec![-1.234_567_890_123_456_7e-308; 3 * y.len()];
        Table::grid(&[("x_m", "m", &x), ("y_m", "m", y)])
            .column("temperature_k", "K", values.clone())
            .column("velocity_x_m_s", "m/s", values)
            .attribute("phase_time_s", "s", -1.234_567_890_123_456_7e-308)
    }

    #[test]
    fn no_message_is_longer_than_told() {
        let mut y: Vec<f64> = (0..400).map(|k| 0.5 * f64::from(k)).collect();
        let even = long(&y);
        for table in [even.clone(), even.in_precision(Precision::F32)] {
            let lattice = Lattice::of(&table).unwrap();
            let found = grid::encode(&table, &lattice, 0).len();
            let told = table.most_bytes();
            assert!((found..found + 6 * NAMES).contains(&told), "{found} {told}");
        }
        y[3] = 1.6;
        let uneven = long(&y);
        assert!(Lattice::of(&uneven).is_none());
        let found = serde_json::to_vec(&uneven).unwrap().len();
        let told = uneven.most_bytes();
        let most = found * 3 / 2;
        assert!((found..most).contains(&told), "{found} {told}");
    }
}
