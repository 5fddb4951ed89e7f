//! What can be saved of a file that was never finished, and how a run takes it up again.

use std::collections::BTreeMap;
use std::path::Path;

use mcap::MAGIC;
use mcap::parse_record;
use mcap::records::{Record, op};

use crate::atomic::beside;
use crate::error::{Error, Result};
use crate::header::{Header, METADATA};
use crate::message::{COLUMNS, Topic, UNITS};
use crate::store::{ChannelInfo, ChunkPlace, Index, PREFIX, Store, Stored};
use crate::writer::{Position, Writer};

/// Name of the metadata record of a file that was saved from a run that did not finish.
pub const RECOVERED: &str = "fusionline.recovered";

/// A chunk that was found whole, with its messages.
struct Whole {
    place: (u64, u64),
    messages: Vec<Stored>,
}

/// Walks over the records from the start and stops at the first that is not whole.
struct Walk<'a> {
    store: &'a Store,
    offset: u64,
    index: Index,
}

impl<'a> Walk<'a> {
    fn new(store: &'a Store) -> Self {
        Self {
            store,
            offset: MAGIC.len() as u64,
            index: Index::default(),
        }
    }

    /// The next whole chunk; metadata and channels are learnt on the way.
    fn next_chunk(&mut self) -> Result<Option<Whole>> {
        while let Some((opcode, length)) = self.store.prefix_at(self.offset)? {
            let (at, size) = (self.offset, PREFIX + length);
            match opcode {
                op::CHUNK => {
                    let index = &mut self.index;
                    // A chunk that was cut or overwritten ends what can be saved.
                    let Ok(messages) = self.store.chunk(at, size, |record| index.learn(record))
                    else {
                        return Ok(None);
                    };
                    self.offset += size;
                    return Ok(Some(Whole {
                        place: (at, size),
                        messages,
                    }));
                }
                op::METADATA => {
                    let Some((_, body)) = self.store.record_at(at)? else {
                        return Ok(None);
                    };
                    if let Ok(record @ Record::Metadata(_)) = parse_record(opcode, &body) {
                        self.index.learn(record);
                    }
                }
                op::DATA_END => return Ok(None),
                op::HEADER..=op::DATA_END => {}
                _ => return Ok(None),
            }
            self.offset += size;
        }
        Ok(None)
    }
}

/// The index of a file without an end, up to its last whole chunk, and the bytes that are lost.
pub(crate) fn index_of_part(store: &Store) -> Result<(Index, u64)> {
    let mut walk = Walk::new(store);
    let mut chunks = Vec::new();
    let mut saved = walk.offset;
    while let Some(chunk) = walk.next_chunk()? {
        let mut times: BTreeMap<u16, Vec<u64>> = BTreeMap::new();
        for message in &chunk.messages {
            times
                .entry(message.channel)
                .or_default()
                .push(message.log_time);
        }
        let (offset, length) = chunk.place;
        chunks.push(ChunkPlace {
            offset,
            length,
            times,
        });
        saved = walk.offset;
    }
    let lost = store.bytes.saturating_sub(saved.max(walk.offset));
    let mut index = walk.index;
    index.chunks = chunks;
    Ok((index, lost))
}

/// The header in an index.
pub(crate) fn header_of(store: &Store, index: &Index) -> Result<Header> {
    let map = index.metadata.get(METADATA).ok_or_else(|| Error::NotOurs {
        path: store.path.clone(),
    })?;
    Header::from_metadata(&store.path, map)
}

fn topic_of(store: &Store, info: &ChannelInfo) -> Result<Topic> {
    let parse = |key: &str| {
        info.metadata
            .get(key)
            .map_or("null", String::as_str)
            .to_owned()
    };
    let wrong = |e: serde_json::Error| store.damaged(format!("channel '{}'", info.name), e);
    let units: Option<_> = serde_json::from_str(&parse(UNITS)).map_err(wrong)?;
    let layout: Option<_> = serde_json::from_str(&parse(COLUMNS)).map_err(wrong)?;
    let json_schema = if info.schema_encoding == "protobuf" {
        String::new()
    } else {
        String::from_utf8(info.schema_data.clone())
            .map_err(|e| store.damaged(format!("channel '{}'", info.name), e))?
    };
    Ok(Topic {
        channel: info.name.clone(),
        schema: info.schema.clone(),
        json_schema,
        units: units.unwrap_or_default(),
        layout: layout.unwrap_or_default(),
        more: info
            .metadata
            .iter()
            .filter(|(key, _)| *key != UNITS && *key != COLUMNS)
            .map(|(key, value)| (key.clone(), value.clone()))
            .collect(),
    })
}

/// Copies whole chunks into `writer` until `wanted` messages are there (`None`: all of them).
fn replay(store: &Store, writer: &mut Writer, wanted: Option<u64>) -> Result<u64> {
    let mut walk = Walk::new(store);
    let mut done = 0;
    while wanted.is_none_or(|n| done < n) {
        let Some(chunk) = walk.next_chunk()? else {
            break;
        };
        for message in &chunk.messages {
            let info = walk.index.channels.get(&message.channel).ok_or_else(|| {
                store.damaged(
                    format!("chunk at byte {}", chunk.place.0),
                    "a message of an unknown channel",
                )
            })?;
            let topic = topic_of(store, info)?;
            writer.admit(&topic, message.log_time)?;
            writer.put(&topic.channel, message.log_time, &message.data)?;
            done += 1;
        }
        writer.end_chunk()?;
    }
    Ok(done)
}

impl Writer {
    /// Takes up `path`.part at `position`: what was written after it is dropped, and the finished
    /// file will have the same bytes as that of an undisturbed run.
    ///
    /// # Errors
    /// When the partial file was made by another scene, input or tool version, or holds fewer
    /// messages than `position` says.
    pub fn resume(path: impl AsRef<Path>, header: &Header, position: &Position) -> Result<Self> {
        let path = path.as_ref();
        let old = beside(path, ".part");
        let store = Store::open(&old)?;
        let mut walk = Walk::new(&store);
        walk.next_chunk()?;
        header.must_equal(&header_of(&store, &walk.index)?, &old)?;
        let mut writer = Self::begin(path, beside(path, ".part.resumed"), header)?;
        let done = replay(&store, &mut writer, Some(position.messages))?;
        if done != position.messages {
            let what = format!(
                "{done} messages are whole, the checkpoint wants {}",
                position.messages
            );
            return Err(store.damaged("the data", what));
        }
        writer.settle()?;
        writer.take_up(position)?;
        Ok(writer)
    }
}

/// What was saved of a file that was never finished.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Saved {
    /// Messages in whole chunks.
    pub messages: u64,
    /// Bytes behind the last whole chunk, which are lost.
    pub lost_bytes: u64,
}

/// Writes all that is whole in `from` to `to` as a finished file, whose metadata record
/// [`RECOVERED`] says so. The file `from` stays as it is.
///
/// # Errors
/// When `from` has no readable header or `to` cannot be written.
pub fn recover(from: &Path, to: &Path) -> Result<Saved> {
    let store = Store::open(from)?;
    let (index, lost_bytes) = index_of_part(&store)?;
    // Not `to`.part: that may be the very file that is saved.
    let part = beside(to, ".part.recovered");
    let mut writer = Writer::begin(to, part, &header_of(&store, &index)?)?;
    let messages = replay(&store, &mut writer, None)?;
    let note = [
        ("messages", messages.to_string()),
        ("lost_bytes", lost_bytes.to_string()),
    ];
    writer.note(
        RECOVERED,
        note.map(|(key, value)| (key.to_owned(), value)).into(),
    )?;
    writer.finish()?;
    Ok(Saved {
        messages,
        lost_bytes,
    })
}
