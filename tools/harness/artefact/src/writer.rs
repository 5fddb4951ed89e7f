//! Writes an artefact to `NAME.part` and renames it when it is whole.
//!
//! The bytes are a function of the header and the messages alone. Messages wait in memory until
//! their chunk is full; a chunk ends after a frame or after one MiB of JSON, whichever comes
//! first, never because of a checkpoint or of the clock.

use std::collections::BTreeMap;
use std::fs::File;
use std::io::BufWriter;
use std::path::{Path, PathBuf};

use mcap::records::{MessageHeader, Metadata};
use mcap::{Compression, McapError, WriteOptions};
use serde::{Deserialize, Serialize};

use crate::atomic::{beside, rename_synced};
use crate::error::{Error, Result, io_error};
use crate::frame::Frame;
use crate::header::{Header, METADATA};
use crate::message::{Topic, log_time};
use crate::table::{Record, Table};

/// JSON is gathered into chunks of this size \[byte\].
const CHUNK_BYTES: usize = 1 << 20;
/// zstd level: speed matters more than the last per cent.
const LEVEL: u32 = 1;

/// A message that waits for its chunk to be full.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct Waiting {
    topic: Topic,
    log_time: u64,
    text: String,
}

/// How far a writer has come: what a checkpoint keeps of it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, Default)]
pub struct Position {
    /// Messages in chunks that are whole and on the disk.
    pub messages: u64,
    waiting: Vec<Waiting>,
}

impl Position {
    /// All messages written so far.
    #[must_use]
    pub fn total(&self) -> u64 {
        self.messages + self.waiting.len() as u64
    }
}

/// What the writer knows of a channel.
#[derive(Debug)]
struct Open {
    topic: Topic,
    id: Option<u16>,
    sequence: u32,
    last: u64,
}

/// Writes an artefact.
///
/// Dropping a writer without [`Writer::finish`] leaves `NAME.part` with all whole chunks.
#[derive(Debug)]
pub struct Writer {
    path: PathBuf,
    part: PathBuf,
    file: Output,
    sync: File,
    channels: BTreeMap<String, Open>,
    waiting: Vec<Waiting>,
    waiting_bytes: usize,
    messages: u64,
}

/// The MCAP writer, which must not write an end record when it is dropped half-way.
struct Output(Option<mcap::Writer<BufWriter<File>>>);

impl std::fmt::Debug for Output {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str("Output")
    }
}

impl Drop for Output {
    fn drop(&mut self) {
        if let Some(writer) = self.0.take() {
            drop(writer.into_inner());
        }
    }
}

impl Writer {
    /// Begins `path`.part with `header`.
    ///
    /// # Errors
    /// When the file cannot be created or written.
    pub fn create(path: impl AsRef<Path>, header: &Header) -> Result<Self> {
        let path = path.as_ref();
        Self::begin(path, beside(path, ".part"), header)
    }

    pub(crate) fn begin(path: &Path, part: PathBuf, header: &Header) -> Result<Self> {
        let file = File::create(&part).map_err(io_error(&part, "create"))?;
        let sync = file.try_clone().map_err(io_error(&part, "create"))?;
        let options = WriteOptions::new()
            .compression(Some(Compression::Zstd))
            .compression_level(LEVEL)
            // Without worker threads: the bytes must not depend on the machine.
            .compression_threads(0)
            .chunk_size(None)
            .library("fusionline");
        let mut out = options
            .create(BufWriter::with_capacity(1 << 16, file))
            .map_err(refused(&part))?;
        out.write_metadata(&Metadata {
            name: METADATA.to_owned(),
            metadata: header.to_metadata(),
        })
        .map_err(refused(&part))?;
        out.flush().map_err(refused(&part))?;
        Ok(Self {
            path: path.to_owned(),
            part,
            file: Output(Some(out)),
            sync,
            channels: BTreeMap::new(),
            waiting: Vec::new(),
            waiting_bytes: 0,
            messages: 0,
        })
    }

    /// The file as it will be named when finished.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Writes a frame at simulated time `time_s` and ends the chunk.
    ///
    /// # Errors
    /// When columns differ in length or from the channel's first frame, a value is not finite, or
    /// the disk refuses.
    pub fn frame(&mut self, channel: &str, time_s: f64, frame: &Frame) -> Result<()> {
        self.check(channel, frame.fault(), frame.not_finite())?;
        let time = self.time(channel, time_s)?;
        let topic = Topic::frames(channel, &frame.layout());
        self.admit(&topic, time)?;
        self.end_waiting()?;
        self.put(channel, time, &frame.encode(time))?;
        self.end_chunk()
    }

    /// Writes a table or grid.
    ///
    /// # Errors
    /// When columns differ in length or name from the shape or the channel's first table, a value
    /// is not finite, or the disk refuses.
    pub fn table(&mut self, channel: &str, time_s: f64, table: &Table) -> Result<()> {
        self.check(channel, table.fault(), table.not_finite())?;
        self.text(Topic::table(channel, table), time_s, table)
    }

    /// Writes a record of named scalars.
    ///
    /// # Errors
    /// When names differ from the channel's first record, a value is not finite, or the disk
    /// refuses.
    pub fn record(&mut self, channel: &str, time_s: f64, record: &Record) -> Result<()> {
        self.check(channel, None, record.not_finite())?;
        self.text(Topic::record(channel, record), time_s, record)
    }

    /// Writes any serialisable value under a JSON Schema of its own.
    ///
    /// # Errors
    /// When the value does not serialise or the disk refuses.
    pub fn json<T: Serialize>(
        &mut self,
        channel: &str,
        time_s: f64,
        schema: (&str, &str),
        value: &T,
    ) -> Result<()> {
        self.text(
            Topic::json(channel, schema.0, schema.1, BTreeMap::new()),
            time_s,
            value,
        )
    }

    /// How far the writer has come, with everything up to there synced to the disk.
    ///
    /// # Errors
    /// When the disk refuses.
    pub fn position(&mut self) -> Result<Position> {
        self.flush()?;
        self.sync
            .sync_data()
            .map_err(io_error(&self.part, "sync"))?;
        Ok(Position {
            messages: self.messages,
            waiting: self.waiting.clone(),
        })
    }

    /// Hands all whole chunks to the system.
    ///
    /// # Errors
    /// When the disk refuses.
    pub fn flush(&mut self) -> Result<()> {
        let part = self.part.clone();
        self.out()?.flush().map_err(refused(&part))
    }

    /// Writes the index and the end record, syncs, and gives the file its name.
    ///
    /// # Errors
    /// When the disk refuses; the file then keeps the name `NAME.part`.
    pub fn finish(mut self) -> Result<()> {
        self.end_waiting()?;
        let units: BTreeMap<String, String> = self
            .channels
            .iter()
            .filter(|(_, open)| !open.topic.units.is_empty())
            .map(|(name, open)| {
                (
                    name.clone(),
                    serde_json::to_string(&open.topic.units).unwrap_or_default(),
                )
            })
            .collect();
        let part = self.part.clone();
        let out = self.out()?;
        out.write_metadata(&Metadata {
            name: format!("{METADATA}.units"),
            metadata: units,
        })
        .and_then(|()| out.finish())
        .map_err(refused(&part))?;
        let writer = self.file.0.take().ok_or_else(|| closed(&part))?;
        let file = writer
            .into_inner()
            .into_inner()
            .map_err(|e| io_error(&part, "write")(e.into_error()))?;
        file.sync_all().map_err(io_error(&part, "sync"))?;
        rename_synced(&self.part, &self.path)
    }

    fn text<T: Serialize>(&mut self, topic: Topic, time_s: f64, value: &T) -> Result<()> {
        let log_time = self.time(&topic.channel, time_s)?;
        self.admit(&topic, log_time)?;
        let text =
            serde_json::to_string(value).map_err(|e| self.unfit(&topic.channel, e.to_string()))?;
        self.wait(Waiting {
            topic,
            log_time,
            text,
        })
    }

    fn wait(&mut self, message: Waiting) -> Result<()> {
        self.waiting_bytes += message.text.len();
        self.waiting.push(message);
        if self.waiting_bytes >= CHUNK_BYTES {
            self.end_waiting()
        } else {
            Ok(())
        }
    }

    /// Writes what waits as one chunk.
    fn end_waiting(&mut self) -> Result<()> {
        if self.waiting.is_empty() {
            return Ok(());
        }
        self.waiting_bytes = 0;
        for message in std::mem::take(&mut self.waiting) {
            self.put(
                &message.topic.channel,
                message.log_time,
                message.text.as_bytes(),
            )?;
        }
        self.end_chunk()
    }

    /// Writes one message into the open chunk; the channel is known by then.
    pub(crate) fn put(&mut self, channel: &str, log_time: u64, data: &[u8]) -> Result<()> {
        let part = self.part.clone();
        let out = self.file.0.as_mut().ok_or_else(|| closed(&part))?;
        let open = self
            .channels
            .get_mut(channel)
            .ok_or_else(|| closed(&part))?;
        let channel_id = match open.id {
            Some(id) => id,
            None => {
                let topic = &open.topic;
                let id = out
                    .add_schema(&topic.schema, topic.schema_encoding(), &topic.schema_data())
                    .and_then(|schema| {
                        out.add_channel(
                            schema,
                            channel,
                            topic.message_encoding(),
                            &topic.metadata(),
                        )
                    })
                    .map_err(refused(&part))?;
                open.id = Some(id);
                id
            }
        };
        let header = MessageHeader {
            channel_id,
            sequence: open.sequence,
            log_time,
            publish_time: log_time,
        };
        open.sequence += 1;
        self.messages += 1;
        out.write_to_known_channel(&header, data)
            .map_err(refused(&part))
    }

    /// Ends the open chunk.
    pub(crate) fn end_chunk(&mut self) -> Result<()> {
        self.flush()
    }

    /// Makes a channel known, or refuses a message that does not fit it.
    pub(crate) fn admit(&mut self, topic: &Topic, time: u64) -> Result<()> {
        match self.channels.get_mut(&topic.channel) {
            None => {
                let open = Open {
                    topic: topic.clone(),
                    id: None,
                    sequence: 0,
                    last: time,
                };
                self.channels.insert(topic.channel.clone(), open);
                Ok(())
            }
            Some(open) if open.topic != *topic => {
                let what = format!(
                    "columns changed: began with {} {:?} {:?}, now {} {:?} {:?}",
                    open.topic.schema,
                    open.topic.units,
                    open.topic.layout,
                    topic.schema,
                    topic.units,
                    topic.layout
                );
                Err(self.unfit(&topic.channel, what))
            }
            Some(open) if time < open.last => {
                let what = format!("time runs backwards: {} ns after {} ns", time, open.last);
                Err(self.unfit(&topic.channel, what))
            }
            Some(open) => {
                open.last = time;
                Ok(())
            }
        }
    }

    /// Takes up what waited when a checkpoint was written.
    pub(crate) fn take_up(&mut self, position: &Position) -> Result<()> {
        for message in &position.waiting {
            self.admit(&message.topic, message.log_time)?;
            self.wait(message.clone())?;
        }
        Ok(())
    }

    /// Gives the partial file its usual name, once it holds all that was replayed.
    pub(crate) fn settle(&mut self) -> Result<()> {
        self.flush()?;
        self.sync
            .sync_data()
            .map_err(io_error(&self.part, "sync"))?;
        let part = beside(&self.path, ".part");
        rename_synced(&self.part, &part)?;
        self.part = part;
        Ok(())
    }

    fn check(
        &self,
        channel: &str,
        fault: Option<String>,
        not_finite: Option<(String, usize, f64)>,
    ) -> Result<()> {
        if let Some(what) = fault {
            return Err(self.unfit(channel, what));
        }
        match not_finite {
            None => Ok(()),
            Some((column, index, value)) => Err(Error::NotFinite {
                path: self.path.clone(),
                channel: channel.to_owned(),
                column,
                index,
                value,
            }),
        }
    }

    fn time(&self, channel: &str, time_s: f64) -> Result<u64> {
        if time_s.is_finite() && time_s >= 0.0 {
            Ok(log_time(time_s))
        } else {
            Err(self.unfit(
                channel,
                format!("time {time_s} s is no time of a run: from 0 s on"),
            ))
        }
    }

    fn unfit(&self, channel: &str, what: String) -> Error {
        Error::Unfit {
            path: self.path.clone(),
            channel: channel.to_owned(),
            what,
        }
    }

    fn out(&mut self) -> Result<&mut mcap::Writer<BufWriter<File>>> {
        let part = &self.part;
        self.file.0.as_mut().ok_or_else(|| closed(part))
    }
}

/// The error for a writer that is no longer open: our own invariant.
fn closed(part: &Path) -> Error {
    Error::Damaged {
        path: part.to_owned(),
        place: "writer".to_owned(),
        what: "already closed".to_owned(),
    }
}

/// An error of the MCAP writer with the file it concerns.
fn refused(part: &Path) -> impl Fn(McapError) -> Error {
    let path = part.to_owned();
    move |error| match error {
        McapError::Io(source) => Error::Io {
            path: path.clone(),
            action: "write",
            source,
        },
        other => Error::Io {
            path: path.clone(),
            action: "write",
            source: std::io::Error::other(other),
        },
    }
}
