//! Whether a file is what it says: every checksum, every message against what its channel says of it, and what the
//! file says of itself against itself. `artefact validate` tells all of it; a program that makes something of a file
//! refuses at the first.

use std::collections::BTreeMap;

use jsonschema::Validator;
use mcap::records::op;
use serde_json::Value;

use crate::error::{Error, Result};
use crate::header::{KINDS, METADATA};
use crate::message::{GRID, POINT_CLOUD, RECORD, TABLE};
use crate::reader::Reader;
use crate::record::PREFIX;
use crate::schema::schema_faults;
use crate::store::Index;

/// A message of the file: chunk, channel, index in the channel.
type Held<'a> = (usize, &'a str, usize);

impl Reader {
    /// Refuses a file of which `artefact validate` finds anything wrong.
    ///
    /// # Errors
    /// The first fault.
    pub fn must_be_sound(&self) -> Result<()> {
        self.must_be_known()?;
        self.scrub()?;
        match self.faults(1).into_iter().next() {
            None => Ok(()),
            Some(what) => Err(Error::Unsound { what }),
        }
    }

    /// Opens a finished artefact of a kind and major version that is sound throughout.
    ///
    /// # Errors
    /// As [`Reader::open_kind`] and [`Reader::must_be_sound`].
    pub fn open_sound(path: impl AsRef<std::path::Path>, kind: &str, major: u32) -> Result<Self> {
        let reader = Self::open_kind(path, kind, major)?;
        reader.must_be_sound()?;
        Ok(reader)
    }

    /// What is wrong with what the file holds, at most so many faults; checksums are [`Reader::scrub`]'s.
    #[must_use]
    pub fn faults(&self, most: usize) -> Vec<String> {
        let mut found = Vec::new();
        self.of_itself(&mut found);
        self.units_agree(&mut found);
        let mut validators = BTreeMap::new();
        for channel in self.channels() {
            match self.validator(&channel.name) {
                Ok(validator) => drop(validators.insert(channel.name.clone(), validator)),
                Err(what) => found.push(format!("{}: {what}", self.origin(&channel.name))),
            }
            self.in_order(&channel.name, &mut found);
        }
        if let Err(e) = self.head_and_tail() {
            found.push(e.to_string());
        }
        for (_, channel, index) in self.by_chunk() {
            if found.len() >= most {
                break;
            }
            if let Some(validator) = validators.get(channel) {
                self.message_faults(channel, index, validator.as_ref(), &mut found);
            }
        }
        found.truncate(most);
        found
    }

    /// All messages in the order of their chunks, so that each is unfolded once.
    fn by_chunk(&self) -> Vec<Held<'_>> {
        let mut held: Vec<Held<'_>> = Vec::new();
        for (name, indexed) in &self.channels {
            let places = indexed.places.iter().enumerate();
            held.extend(places.map(|(index, place)| (place.chunk, name.as_str(), index)));
        }
        held.sort();
        held
    }

    /// The kind of the file, the tool that wrote it and the scene that it was made from do not contradict each other.
    fn of_itself(&self, found: &mut Vec<String>) {
        let header = self.header();
        let at = format!("{}: metadata record '{METADATA}'", self.path().display());
        let (kind, tool) = (header.kind.as_str(), header.tool.as_str());
        let writes = |(_, _, tools): &&(&str, u32, &[&str])| tools.contains(&tool);
        let own: Vec<&str> = KINDS
            .iter()
            .filter(writes)
            .map(|(kind, ..)| *kind)
            .collect();
        if !own.is_empty() && !own.contains(&kind) {
            let own = own.join(" and ");
            found.push(format!(
                "{at}: is of kind '{kind}' by '{tool}', which writes {own}"
            ));
        }
        let scene = header.scene["kind"].as_str();
        if scene.is_some_and(|scene| scene.strip_suffix(".scene") != Some(tool)) {
            let scene = scene.unwrap_or_default();
            found.push(format!(
                "{at}: is by '{tool}', its scene is of kind '{scene}'"
            ));
        }
    }

    /// What the record of the header says of units must be what the channels say. Older files say it in the channels
    /// alone.
    fn units_agree(&self, found: &mut Vec<String>) {
        let record = self.metadata(METADATA);
        let Some(text) = record.and_then(|record| record.get("units")) else {
            return;
        };
        let at = format!(
            "{}: metadata record '{METADATA}', units",
            self.path().display()
        );
        let stated: BTreeMap<String, BTreeMap<String, String>> = match serde_json::from_str(text) {
            Ok(stated) => stated,
            Err(e) => return found.push(format!("{at}: {e}")),
        };
        let nothing = BTreeMap::new();
        for (name, indexed) in &self.channels {
            let stated = stated.get(name).unwrap_or(&nothing);
            for column in stated.keys().chain(indexed.units.keys()) {
                let (a, b) = (stated.get(column), indexed.units.get(column));
                if a != b {
                    let word =
                        |unit: Option<&String>| unit.map_or("none", String::as_str).to_owned();
                    let (a, b) = (word(a), word(b));
                    found.push(format!(
                        "{at}: channel '{name}', column '{column}': '{a}', the channel says '{b}'"
                    ));
                }
            }
        }
    }

    fn in_order(&self, channel: &str, found: &mut Vec<String>) {
        let Ok(times) = self.times(channel) else {
            return;
        };
        if let Some(i) = times.windows(2).position(|w| w[1] < w[0]) {
            let (after, before) = (times[i + 1], times[i]);
            found.push(format!(
                "{}, message {}: its time {after} s is before {before} s of the message before it",
                self.origin(channel),
                i + 1
            ));
        }
    }

    /// What stands among the data is what the summary at the end says of it: the same chunks, the same channels,
    /// nothing else.
    fn head_and_tail(&self) -> Result<()> {
        let store = &self.store;
        let mut chunks = self.chunks.iter();
        let mut learnt = Index::default();
        let mut at = mcap::MAGIC.len() as u64;
        while let Some((opcode, length)) = store.prefix_at(at)? {
            let place = || format!("byte {at}");
            match opcode {
                op::CHUNK => {
                    let size = PREFIX + length;
                    let next = chunks.next().filter(|c| (c.offset, c.length) == (at, size));
                    if next.is_none() {
                        return Err(
                            store.damaged(place(), "the summary does not list this chunk here")
                        );
                    }
                    store.chunk(at, size, |record| learnt.learn(record))?;
                }
                op::HEADER | op::METADATA | op::MESSAGE_INDEX => {}
                op::DATA_END => break,
                other => {
                    let what =
                        format!("a record of the sort {other:#04x}, which none of ours writes");
                    return Err(store.damaged(place(), what));
                }
            }
            at += PREFIX + length;
        }
        if let Some(chunk) = chunks.next() {
            let place = format!("the chunk at byte {}", chunk.offset);
            return Err(store.damaged(place, "the summary lists it, it is not there"));
        }
        for (name, indexed) in &self.channels {
            if learnt.channels.get(&indexed.id) != Some(&indexed.info) {
                let place = format!("channel '{name}'");
                return Err(
                    store.damaged(place, "the summary says other things of it than its data")
                );
            }
        }
        Ok(())
    }

    /// The validator of the JSON messages of a channel; `None` for frames and packed grids.
    fn validator(&self, channel: &str) -> std::result::Result<Option<Validator>, String> {
        let info = &self.channel(channel).map_err(|e| e.to_string())?.info;
        let packed = info.schema == POINT_CLOUD || info.schema == GRID;
        let encoding = if packed { "protobuf" } else { "jsonschema" };
        if info.schema_encoding != encoding {
            let (schema, found) = (&info.schema, &info.schema_encoding);
            return Err(format!(
                "its schema '{schema}' is encoded as '{found}', wanted is '{encoding}'"
            ));
        }
        if packed {
            return Ok(None);
        }
        let wrong = |what: String| format!("its JSON Schema '{}': {what}", info.schema);
        let schema: Value =
            serde_json::from_slice(&info.schema_data).map_err(|e| wrong(e.to_string()))?;
        jsonschema::validator_for(&schema)
            .map(Some)
            .map_err(|e| wrong(e.to_string()))
    }

    fn message_faults(
        &self,
        channel: &str,
        index: usize,
        validator: Option<&Validator>,
        found: &mut Vec<String>,
    ) {
        let time = self.time(channel, index).unwrap_or(f64::NAN);
        let at = format!("{}, t = {time} s", self.origin(channel));
        if let Some(validator) = validator {
            let before = found.len();
            match self.json_at::<Value>(channel, index) {
                Ok(value) => schema_faults(validator, &value, &at, found),
                Err(e) => found.push(e.to_string()),
            }
            if found.len() > before {
                return;
            }
        }
        match self.columns(channel, index) {
            Ok(columns) => self.column_faults(channel, &columns, &at, found),
            Err(e) => found.push(e.to_string()),
        }
    }

    /// The columns of a message: name, unit, values.
    fn columns(&self, channel: &str, index: usize) -> Result<Vec<(String, String, Vec<f64>)>> {
        Ok(match self.channel(channel)?.info.schema.as_str() {
            POINT_CLOUD => {
                let frame = self.frame(channel, index)?;
                if let Some(what) = frame.fault() {
                    return Err(self.message_error(channel, index, what));
                }
                let columns = frame.columns().iter();
                columns
                    .map(|c| (c.name.clone(), c.unit.clone(), c.values.to_f64()))
                    .collect()
            }
            TABLE | GRID => {
                let table = self.table_at(channel, index)?;
                let series = table.axes.into_iter().chain(table.columns);
                let scalars = table.attributes.into_iter();
                series
                    .map(|c| (c.name, c.unit, c.values))
                    .chain(scalars.map(|(name, q)| (name, q.unit, vec![q.value])))
                    .collect()
            }
            RECORD => {
                let values = self.record_at(channel, index)?.values.into_iter();
                values.map(|e| (e.name, e.unit, vec![e.value])).collect()
            }
            _ => Vec::new(),
        })
    }

    fn column_faults(
        &self,
        channel: &str,
        columns: &[(String, String, Vec<f64>)],
        at: &str,
        found: &mut Vec<String>,
    ) {
        let Ok(indexed) = self.channel(channel) else {
            return;
        };
        for (name, unit, values) in columns {
            let said = indexed.units.get(name);
            let named = said.is_some_and(|unit| !unit.is_empty());
            if !named && (unit.is_empty() || !indexed.units.is_empty()) {
                found.push(format!(
                    "{at}, column '{name}': the file states no unit for it"
                ));
            }
            let Some(row) = values.iter().position(|x| !x.is_finite()) else {
                continue;
            };
            let more = match values.iter().filter(|x| !x.is_finite()).count() - 1 {
                0 => String::new(),
                n => format!(" (and {n} more in this column)"),
            };
            let x = values[row];
            found.push(format!(
                "{at}, column '{name}', row {row}: {x} is not a finite number{more}"
            ));
        }
    }
}
