//! Reads an artefact: memory for one chunk, checksums checked, errors that name both sides.

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::{Arc, Mutex, PoisonError};

use serde::de::DeserializeOwned;

use crate::contents::{Channel, Indexed, Place, contents};
use crate::error::{Error, Result};
use crate::frame::Frame;
use crate::header::{Header, KINDS};
use crate::message::{POINT_CLOUD, RECORD, time_s};
use crate::recover::header_of;
use crate::store::{ChunkPlace, Store, Stored};
use crate::survey::{Lost, Survey, survey};
use crate::table::Record;

type Chunk = Arc<Vec<Stored>>;

/// An open artefact. It can be shared between threads.
#[derive(Debug)]
pub struct Reader {
    pub(crate) store: Store,
    header: Header,
    pub(crate) channels: BTreeMap<String, Indexed>,
    pub(crate) chunks: Vec<ChunkPlace>,
    metadata: BTreeMap<String, BTreeMap<String, String>>,
    last: Mutex<Option<(usize, Chunk)>>,
    lost: Vec<Lost>,
    lost_bytes: u64,
}

impl Reader {
    /// Opens a finished artefact of any kind.
    ///
    /// # Errors
    /// When the file is foreign, truncated or damaged.
    pub fn open(path: impl AsRef<Path>) -> Result<Self> {
        let store = Store::open(path.as_ref())?;
        let index = store.index()?;
        let whole = Survey {
            index,
            lost: Vec::new(),
            lost_bytes: 0,
        };
        Self::with_survey(store, whole)
    }

    /// Opens a finished artefact of a kind and major version.
    ///
    /// # Errors
    /// As [`Reader::open`], and when kind or major version are others.
    pub fn open_kind(path: impl AsRef<Path>, kind: &str, major: u32) -> Result<Self> {
        let reader = Self::open(path)?;
        reader.must_be(kind, major)?;
        Ok(reader)
    }

    /// Opens all whole chunks of a file that was never finished or is damaged.
    ///
    /// # Errors
    /// When the file is foreign or holds no readable header.
    pub fn recover(path: impl AsRef<Path>) -> Result<Self> {
        let store = Store::open(path.as_ref())?;
        let whole = survey(&store)?;
        Self::with_survey(store, whole)
    }

    fn with_survey(store: Store, found: Survey) -> Result<Self> {
        let index = found.index;
        let header = header_of(&store, &index)?;
        let channels = contents(&store, &index)?;
        Ok(Self {
            store,
            header,
            channels,
            chunks: index.chunks,
            metadata: index.metadata,
            last: Mutex::new(None),
            lost: found.lost,
            lost_bytes: found.lost_bytes,
        })
    }

    /// Refuses another kind or major version.
    ///
    /// # Errors
    /// [`Error::Kind`] or [`Error::Version`], naming both sides.
    pub fn must_be(&self, kind: &str, major: u32) -> Result<()> {
        let path = self.store.path.clone();
        if self.header.kind != kind {
            return Err(Error::Kind {
                path,
                expected: kind.to_owned(),
                found: self.header.kind.clone(),
            });
        }
        if self.header.version.major != major {
            let found = self.header.version;
            return Err(Error::Version {
                path,
                kind: kind.to_owned(),
                found,
                supported: major,
            });
        }
        Ok(())
    }

    /// Refuses a kind that no stage writes, and a major version that is not the one known.
    ///
    /// # Errors
    /// [`Error::UnknownKind`] or [`Error::Version`].
    pub fn must_be_known(&self) -> Result<()> {
        match KINDS.iter().find(|(kind, ..)| *kind == self.header.kind) {
            Some((kind, major, _)) => self.must_be(kind, *major),
            None => Err(Error::UnknownKind {
                path: self.store.path.clone(),
                found: self.header.kind.clone(),
                known: KINDS.map(|(kind, ..)| kind).join(", "),
            }),
        }
    }

    /// The file.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.store.path
    }

    /// Who wrote it, from what.
    #[must_use]
    pub fn header(&self) -> &Header {
        &self.header
    }

    /// Chunks left out by [`Reader::recover`] because they are not whole.
    #[must_use]
    pub fn lost(&self) -> &[Lost] {
        &self.lost
    }

    /// Bytes behind the last whole chunk; 0 for a finished file.
    #[must_use]
    pub fn lost_bytes(&self) -> u64 {
        self.lost_bytes
    }

    /// Length of the file \[byte\].
    #[must_use]
    pub fn bytes(&self) -> u64 {
        self.store.bytes
    }

    /// A metadata record by name: what the file says beside its header.
    #[must_use]
    pub fn metadata(&self, name: &str) -> Option<&BTreeMap<String, String>> {
        self.metadata.get(name)
    }

    /// JSON Schema of the messages of a channel; empty for frames and packed grids.
    ///
    /// # Errors
    /// When the channel is absent.
    pub fn json_schema(&self, channel: &str) -> Result<&[u8]> {
        let info = &self.channel(channel)?.info;
        Ok(if info.schema_encoding == "jsonschema" {
            &info.schema_data
        } else {
            &[]
        })
    }

    /// All channels, sorted by name.
    #[must_use]
    pub fn channels(&self) -> Vec<Channel> {
        self.channels.values().map(Indexed::describe).collect()
    }

    /// Whether a channel exists.
    #[must_use]
    pub fn has(&self, channel: &str) -> bool {
        self.channels.contains_key(channel)
    }

    /// Simulated time of each message of a channel \[s\].
    ///
    /// # Errors
    /// When the channel is absent.
    pub fn times(&self, channel: &str) -> Result<Vec<f64>> {
        Ok(self
            .channel(channel)?
            .places
            .iter()
            .map(|p| time_s(p.log_time))
            .collect())
    }

    /// Simulated time of a message \[s\].
    ///
    /// # Errors
    /// When channel or index are absent.
    pub fn time(&self, channel: &str, index: usize) -> Result<f64> {
        Ok(time_s(self.place(channel, index, "")?.1.log_time))
    }

    /// Number of messages of a channel; 0 when it is absent.
    #[must_use]
    pub fn count(&self, channel: &str) -> usize {
        self.channels.get(channel).map_or(0, |c| c.places.len())
    }

    /// The frame with an index.
    ///
    /// # Errors
    /// When channel or index are absent, the channel holds no frames, or its chunk is damaged.
    pub fn frame(&self, channel: &str, index: usize) -> Result<Frame> {
        let (indexed, place) = self.place(channel, index, POINT_CLOUD)?;
        let data = self.data(channel, index, indexed.id, place)?;
        Frame::decode(
            &data.0[data.1].data,
            time_s(place.log_time),
            &indexed.units,
            self.origin(channel),
        )
        .map_err(|what| self.message_error(channel, index, what))
    }

    /// All frames of a channel, one at a time.
    ///
    /// # Errors
    /// When the channel is absent or holds no frames; then each frame as [`Reader::frame`].
    pub fn frames<'a>(
        &'a self,
        channel: &'a str,
    ) -> Result<impl Iterator<Item = Result<Frame>> + 'a> {
        self.must_hold(channel, POINT_CLOUD)?;
        Ok((0..self.count(channel)).map(move |i| self.frame(channel, i)))
    }

    /// The first record of a channel.
    ///
    /// # Errors
    /// As [`Reader::record_at`].
    pub fn record(&self, channel: &str) -> Result<Record> {
        self.record_at(channel, 0)
    }

    /// The record with an index.
    ///
    /// # Errors
    /// When channel or index are absent, the channel holds no records, or its chunk is damaged.
    pub fn record_at(&self, channel: &str, index: usize) -> Result<Record> {
        self.place(channel, index, RECORD)?;
        Ok(self
            .json_at::<Record>(channel, index)?
            .with_origin(&self.origin(channel)))
    }

    /// All records of a channel with their times \[s\].
    ///
    /// # Errors
    /// As [`Reader::record_at`].
    pub fn records(&self, channel: &str) -> Result<Vec<(f64, Record)>> {
        let times = self.times(channel)?;
        times
            .into_iter()
            .enumerate()
            .map(|(i, t)| Ok((t, self.record_at(channel, i)?)))
            .collect()
    }

    /// A JSON message of any schema.
    ///
    /// # Errors
    /// When channel or index are absent or the message does not fit `T`.
    pub fn json_at<T: DeserializeOwned>(&self, channel: &str, index: usize) -> Result<T> {
        let (indexed, place) = self.place(channel, index, "")?;
        let data = self.data(channel, index, indexed.id, place)?;
        serde_json::from_slice(&data.0[data.1].data)
            .map_err(|e| self.message_error(channel, index, e.to_string()))
    }

    /// All JSON messages of a channel with their times \[s\].
    ///
    /// # Errors
    /// As [`Reader::json_at`].
    pub fn json<T: DeserializeOwned>(&self, channel: &str) -> Result<Vec<(f64, T)>> {
        let times = self.times(channel)?;
        times
            .into_iter()
            .enumerate()
            .map(|(i, t)| Ok((t, self.json_at(channel, i)?)))
            .collect()
    }

    pub(crate) fn origin(&self, channel: &str) -> String {
        format!("{}: channel '{channel}'", self.store.path.display())
    }

    pub(crate) fn message_error(&self, channel: &str, index: usize, what: String) -> Error {
        Error::Message {
            path: self.store.path.clone(),
            channel: channel.to_owned(),
            index,
            what,
        }
    }

    pub(crate) fn channel(&self, channel: &str) -> Result<&Indexed> {
        self.channels.get(channel).ok_or_else(|| Error::NoChannel {
            path: self.store.path.clone(),
            channel: channel.to_owned(),
            present: self.channels.keys().cloned().collect::<Vec<_>>().join(", "),
        })
    }

    fn must_hold(&self, channel: &str, schema: &str) -> Result<&Indexed> {
        let indexed = self.channel(channel)?;
        if schema.is_empty() || indexed.info.schema == schema {
            return Ok(indexed);
        }
        Err(Error::Schema {
            path: self.store.path.clone(),
            channel: channel.to_owned(),
            expected: schema.to_owned(),
            found: indexed.info.schema.clone(),
        })
    }

    pub(crate) fn place(
        &self,
        channel: &str,
        index: usize,
        schema: &str,
    ) -> Result<(&Indexed, Place)> {
        let indexed = self.must_hold(channel, schema)?;
        let place = indexed
            .places
            .get(index)
            .copied()
            .ok_or_else(|| Error::Index {
                path: self.store.path.clone(),
                channel: channel.to_owned(),
                index,
                count: indexed.places.len(),
            })?;
        Ok((indexed, place))
    }

    /// The chunk of a message and the message's place in it.
    pub(crate) fn data(
        &self,
        channel: &str,
        index: usize,
        id: u16,
        place: Place,
    ) -> Result<(Chunk, usize)> {
        let chunk = self.chunk(place.chunk)?;
        let mut own = chunk.iter().enumerate().filter(|(_, m)| m.channel == id);
        let found = own
            .nth(place.within)
            .filter(|(_, m)| m.log_time == place.log_time)
            .map(|(i, _)| i);
        match found {
            Some(at) => Ok((chunk, at)),
            None => {
                Err(self.message_error(channel, index, "is not where the index says".to_owned()))
            }
        }
    }

    /// A decompressed chunk; the last one is kept.
    fn chunk(&self, number: usize) -> Result<Chunk> {
        let mut last = self.last.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((kept, chunk)) = last.as_ref()
            && *kept == number
        {
            return Ok(chunk.clone());
        }
        let place = &self.chunks[number];
        let chunk = Arc::new(self.store.chunk(place.offset, place.length, |_| ())?);
        *last = Some((number, chunk.clone()));
        Ok(chunk)
    }
}
