//! What can be saved of a file that was never finished or is damaged, and how a run takes it up again.

use std::collections::BTreeMap;
use std::path::Path;

use crate::atomic::beside;
use crate::error::{Error, Result};
use crate::header::{Header, METADATA};
use crate::message::{COLUMNS, Topic, UNITS};
use crate::store::{ChannelInfo, Index, Store, Stored};
use crate::survey::{Lost, Step, Walk, survey};
use crate::writer::{Position, Writer};

/// Name of the metadata record of a file that was saved from a run that did not finish.
pub const RECOVERED: &str = "fusionline.recovered";

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

/// Copies the messages of a chunk into `writer`, but for those of unknown channels.
fn replay(
    store: &Store,
    writer: &mut Writer,
    channels: &BTreeMap<u16, ChannelInfo>,
    messages: &[Stored],
) -> Result<u64> {
    let mut done = 0;
    for message in messages {
        let Some(info) = channels.get(&message.channel) else {
            continue;
        };
        let topic = topic_of(store, info)?;
        writer.admit(&topic, message.log_time)?;
        writer.put(&topic.channel, message.log_time, &message.data)?;
        done += 1;
    }
    writer.end_chunk()?;
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
        let mut step = walk.next_chunk()?;
        header.must_equal(&header_of(&store, &walk.index)?, &old)?;
        let mut writer = Self::begin(path, beside(path, ".part.resumed"), header)?;
        let mut done = 0;
        while done < position.messages {
            // What is lost here cannot be taken up: the bytes would be others.
            let Step::Whole(chunk) = step else { break };
            done += replay(&store, &mut writer, &walk.index.channels, &chunk.messages)?;
            step = walk.next_chunk()?;
        }
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

/// What was saved of a file that was never finished or is damaged.
#[derive(Debug, Clone, PartialEq)]
pub struct Saved {
    /// Messages in whole chunks.
    pub messages: u64,
    /// Bytes behind the last record that has an end, which are lost.
    pub lost_bytes: u64,
    /// What is lost before.
    pub lost: Vec<Lost>,
}

/// Writes all that is whole in `from` to `to` as a finished file, whose metadata record
/// [`RECOVERED`] says so. The file `from` stays as it is.
///
/// # Errors
/// When `from` has no readable header or no whole chunk, or `to` cannot be written.
pub fn recover(from: &Path, to: &Path) -> Result<Saved> {
    let store = Store::open(from)?;
    let found = survey(&store)?;
    let index = &found.index;
    let header = header_of(&store, index)?;
    if index.chunks.iter().all(|chunk| chunk.times.is_empty()) {
        let mut what = "no message is whole: nothing can be saved".to_owned();
        for lost in &found.lost {
            what += &format!("\n  {lost}");
        }
        return Err(store.damaged("the data", what));
    }
    // Not `to`.part: that may be the very file that is saved.
    let mut writer = Writer::begin(to, beside(to, ".part.recovered"), &header)?;
    let mut messages = 0;
    for chunk in &index.chunks {
        let stored = store.chunk(chunk.offset, chunk.length, |_| ())?;
        messages += replay(&store, &mut writer, &index.channels, &stored)?;
    }
    let mut note = BTreeMap::from([
        ("messages".to_owned(), messages.to_string()),
        ("lost_bytes".to_owned(), found.lost_bytes.to_string()),
    ]);
    if !found.lost.is_empty() {
        note.insert("lost_chunks".to_owned(), found.lost.len().to_string());
    }
    writer.note(RECOVERED, note)?;
    writer.finish()?;
    Ok(Saved {
        messages,
        lost_bytes: found.lost_bytes,
        lost: found.lost,
    })
}
