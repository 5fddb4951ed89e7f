//! Writes an artefact to `NAME.part` and renames it when it is whole.
//!
//! The bytes are a function of the header and the messages alone. Messages wait in memory until
//! their chunk is full; a chunk ends after a frame or after one MiB of JSON, whichever comes
//! first, never because of a checkpoint or of the clock. A packed grid ends its chunk as a frame does.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use mcap::records::MessageHeader;
use serde::{Deserialize, Serialize};

use crate::atomic::beside;
use crate::error::{Error, Result};
use crate::frame::Frame;
use crate::header::{Header, METADATA};
use crate::message::{Topic, UNITS, log_time, one_time};
use crate::part::Part;
use crate::place::must_be_replaceable;
use crate::table::Record;

/// JSON is gathered into chunks of this size \[byte\].
const CHUNK_BYTES: usize = 1 << 20;

/// Part of a time by which rounding parts two names of one moment.
const SAME: f64 = 1e-12;

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
    /// The simulated time of the last message \[s\]; of none that is taken up.
    moment: Option<f64>,
}

/// Writes an artefact.
///
/// Dropping a writer without [`Writer::finish`] leaves `NAME.part` with all whole chunks.
#[derive(Debug)]
pub struct Writer {
    path: PathBuf,
    part: Part,
    header: BTreeMap<String, String>,
    channels: BTreeMap<String, Open>,
    waiting: Vec<Waiting>,
    waiting_bytes: usize,
    messages: u64,
}

impl Writer {
    /// Begins `path`.part with `header`.
    ///
    /// # Errors
    /// When the file cannot be created or written, or what bears its name is no file.
    pub fn create(path: impl AsRef<Path>, header: &Header) -> Result<Self> {
        let path = path.as_ref();
        Self::begin(path, beside(path, ".part"), header)
    }

    pub(crate) fn begin(path: &Path, part: PathBuf, header: &Header) -> Result<Self> {
        must_be_replaceable(path)?;
        Ok(Self {
            path: path.to_owned(),
            part: Part::create(part, header)?,
            header: header.to_metadata(),
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
        let topic = Topic::frames(channel, &frame.layout());
        let time = self.admit_at(&topic, time_s)?;
        self.end_waiting()?;
        self.put(channel, time, &frame.encode(time))?;
        self.end_chunk()
    }

    /// Writes a record of named scalars.
    ///
    /// # Errors
    /// When names differ from the channel's first record, a value is not finite, or the disk
    /// refuses.
    pub fn record(&mut self, channel: &str, time_s: f64, record: &Record) -> Result<()> {
        self.check(channel, record.fault(), record.not_finite())?;
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
        self.part.sync()?;
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
        self.part.flush()
    }

    /// Writes the index and the end record, syncs, and gives the file its name.
    ///
    /// # Errors
    /// When the disk refuses; the file then keeps the name `NAME.part`.
    pub fn finish(mut self) -> Result<()> {
        self.end_waiting()?;
        let header = std::mem::take(&mut self.header);
        self.part.metadata(METADATA, self.complete(header))?;
        self.part.finish(&self.path)
    }

    /// The metadata record `fusionline` with the unit of each column of each channel, which is
    /// known at the end alone.
    fn complete(&self, mut header: BTreeMap<String, String>) -> BTreeMap<String, String> {
        let channels = self.channels.iter().map(|(name, open)| (name, &open.topic));
        let units: BTreeMap<&String, &BTreeMap<String, String>> = channels
            .filter(|(_, topic)| !topic.units.is_empty())
            .map(|(name, topic)| (name, &topic.units))
            .collect();
        let text = serde_json::to_string(&units).unwrap_or_default();
        header.insert(UNITS.to_owned(), text);
        header
    }

    pub(crate) fn text<T: Serialize>(
        &mut self,
        topic: Topic,
        time_s: f64,
        value: &T,
    ) -> Result<()> {
        let log_time = self.admit_at(&topic, time_s)?;
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
    pub(crate) fn end_waiting(&mut self) -> Result<()> {
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
        let Some(open) = self.channels.get_mut(channel) else {
            return Err(self.unfit(channel, "is not known yet".to_owned()));
        };
        let channel_id = match open.id {
            Some(id) => id,
            None => self.part.channel(&open.topic)?,
        };
        open.id = Some(channel_id);
        let header = MessageHeader {
            channel_id,
            sequence: open.sequence,
            log_time,
            publish_time: log_time,
        };
        open.sequence += 1;
        self.messages += 1;
        self.part.message(&header, data)
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
                    moment: None,
                };
                self.channels.insert(topic.channel.clone(), open);
                Ok(())
            }
            Some(open) if open.topic.more != topic.more => {
                let what = "axes or frame of reference changed: a channel keeps them";
                Err(self.unfit(&topic.channel, what.to_owned()))
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

    /// Admits a message of a simulated time, and refuses two moments that would share a time in the file.
    pub(crate) fn admit_at(&mut self, topic: &Topic, time_s: f64) -> Result<u64> {
        let time = self.time(&topic.channel, time_s)?;
        self.admit(topic, time)?;
        let before = self.channels.get_mut(&topic.channel).and_then(|open| {
            let before = open.moment.replace(time_s)?;
            let is_other = (time_s - before).abs() > SAME * time_s;
            (is_other && one_time(before, time_s)).then_some(before)
        });
        match before {
            None => Ok(time),
            Some(before) => {
                let what = format!(
                    "{before:e} s and {time_s:e} s are both {time} ns: times are whole nanoseconds, write less often"
                );
                Err(self.unfit(&topic.channel, what))
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
        self.part.sync()?;
        self.part.rename(beside(&self.path, ".part"))
    }

    /// Writes a metadata record that says more than the header.
    pub(crate) fn note(&mut self, name: &str, note: BTreeMap<String, String>) -> Result<()> {
        self.part.metadata(name, note)
    }

    pub(crate) fn check(
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

    pub(crate) fn time(&self, channel: &str, time_s: f64) -> Result<u64> {
        if time_s.is_finite() && time_s >= 0.0 {
            Ok(log_time(time_s))
        } else {
            Err(self.unfit(
                channel,
                format!("time {time_s} s is no time of a run: from 0 s on"),
            ))
        }
    }

    pub(crate) fn unfit(&self, channel: &str, what: String) -> Error {
        Error::Unfit {
            path: self.path.clone(),
            channel: channel.to_owned(),
            what,
        }
    }
}
