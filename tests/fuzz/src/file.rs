//! Artefacts that are no longer what they were: bytes, records with checksums that fit, and contents.

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::io::Cursor;
use std::sync::Arc;

use mcap::records::{MessageHeader, Metadata, op};
use mcap::{Channel, Compression, MessageStream, WriteOptions};
use serde_json::Value;

use crate::chance::Chance;
use crate::json;
use crate::records::{join, split};

/// What was done to a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Depth {
    /// Bytes were changed behind the back of the checksums: nothing of it may be read as good.
    Bytes,
    /// Records were changed and put together again: what is left may mean something.
    Records,
    /// What the file holds was changed, and written as a writer would.
    Contents,
}

/// A changed file; `donor` is another one.
pub(crate) fn change(bytes: &[u8], donor: &[u8], chance: &mut Chance) -> (Vec<u8>, Depth) {
    let times = 1 + chance.below(3);
    match chance.below(3) {
        0 => {
            let mut own = bytes.to_vec();
            (0..times).for_each(|_| spoil(&mut own, donor, chance));
            (own, Depth::Bytes)
        }
        1 => (shuffled(bytes, donor, times, chance), Depth::Records),
        _ => {
            let written = rewritten(bytes, times, chance);
            // What no writer would take is as good as an empty file.
            (written.unwrap_or_default(), Depth::Contents)
        }
    }
}

fn spoil(bytes: &mut Vec<u8>, donor: &[u8], chance: &mut Chance) {
    let n = bytes.len();
    let at = chance.below(n);
    let some = (1 + chance.below(64)).min(n - at.min(n));
    match chance.below(7) {
        0 if n > 0 => bytes[at] ^= 1 << chance.below(8),
        1 => bytes.truncate(at),
        2 => bytes[at..at + some].fill([0, 0xff][chance.below(2)]),
        3 => drop(bytes.drain(at..at + some)),
        4 => bytes.extend_from_within(at..),
        5 => {
            let from = chance.below(donor.len());
            let part = donor[from..(from + some).min(donor.len())].to_vec();
            bytes.splice(at..at + some, part);
        }
        _ if n > 0 => bytes[at] = chance.next() as u8,
        _ => {}
    }
}

/// Records dropped, doubled, exchanged, taken from elsewhere, or with another number in them.
fn shuffled(bytes: &[u8], donor: &[u8], times: usize, chance: &mut Chance) -> Vec<u8> {
    let mut records = split(bytes);
    let others = split(donor);
    for _ in 0..times {
        let i = chance.below(records.len());
        let j = chance.below(records.len());
        match chance.below(8) {
            0 if records.len() > 1 => drop(records.remove(i)),
            1 => {
                let twice = records[i].clone();
                records.insert(j, twice);
            }
            2 => records.swap(i, j),
            3 => {
                if let Some(other) = chance.pick(&others) {
                    records[i] = other.clone();
                }
            }
            4 => records[i].claims = Some(extreme(chance)),
            5 => {
                records[i].opcode =
                    [op::CHUNK, op::METADATA, op::CHANNEL, 0, 0x7f, 0xff][chance.below(6)]
            }
            _ => word(&mut records[i].body, chance),
        }
    }
    join(records)
}

/// Another number somewhere in a record: a length, a place, a count.
fn word(body: &mut [u8], chance: &mut Chance) {
    let width = [2, 4, 8][chance.below(3)];
    if body.len() >= width {
        // Lengths stand near the start.
        let reach = body.len() - width + 1;
        let at = if chance.one_in(2) {
            chance.below(reach.min(48))
        } else {
            chance.below(reach)
        };
        body[at..at + width].copy_from_slice(&extreme(chance).to_le_bytes()[..width]);
    }
}

fn extreme(chance: &mut Chance) -> u64 {
    let ends = [
        0,
        1,
        7,
        255,
        1 << 16,
        (1 << 32) - 1,
        1 << 32,
        1 << 40,
        u64::MAX,
    ];
    *chance.pick(&ends).unwrap_or(&0)
}

/// A message with its channel.
struct Held {
    channel: Channel<'static>,
    header: MessageHeader,
    data: Vec<u8>,
}

/// The file with other contents, written as a writer would.
fn rewritten(bytes: &[u8], times: usize, chance: &mut Chance) -> Option<Vec<u8>> {
    let mut metadata: Vec<Metadata> = split(bytes)
        .iter()
        .filter(|r| r.opcode == op::METADATA)
        .filter_map(|r| match mcap::parse_record(op::METADATA, &r.body) {
            Ok(mcap::records::Record::Metadata(m)) => Some(m),
            _ => None,
        })
        .collect();
    let mut messages: Vec<Held> = MessageStream::new(bytes)
        .ok()?
        .filter_map(Result::ok)
        .map(|m| Held {
            channel: owned(&m.channel),
            header: MessageHeader {
                channel_id: m.channel.id,
                sequence: m.sequence,
                log_time: m.log_time,
                publish_time: m.publish_time,
            },
            data: m.data.into_owned(),
        })
        .collect();
    for _ in 0..times {
        let n = messages.len();
        match chance.below(6) {
            0 => {
                let i = chance.below(metadata.len());
                entry(&mut metadata.get_mut(i)?.metadata, chance);
            }
            1 if n > 0 => declare(&mut messages, chance),
            2 if n > 1 => drop(messages.remove(chance.below(n))),
            3 if n > 0 => messages[chance.below(n)].header.log_time = extreme(chance) >> 1,
            _ if n > 0 => {
                let i = chance.below(n);
                content(&mut messages[i], chance);
            }
            _ => {}
        }
    }
    write(&metadata, &messages)
}

fn owned(channel: &Arc<Channel<'_>>) -> Channel<'static> {
    Channel {
        id: channel.id,
        topic: channel.topic.clone(),
        schema: channel.schema.as_ref().map(|s| {
            Arc::new(mcap::Schema {
                id: s.id,
                name: s.name.clone(),
                encoding: s.encoding.clone(),
                data: Cow::Owned(s.data.to_vec()),
            })
        }),
        message_encoding: channel.message_encoding.clone(),
        metadata: channel.metadata.clone(),
    }
}

/// Another value, or none, of an entry that is often JSON itself.
fn entry(map: &mut BTreeMap<String, String>, chance: &mut Chance) {
    let keys: Vec<String> = map.keys().cloned().collect();
    let Some(key) = chance.pick(&keys) else {
        return;
    };
    let old = map.remove(key).unwrap_or_default();
    if chance.one_in(5) {
        return;
    }
    let new = match serde_json::from_str::<Value>(&old) {
        Ok(mut value) => {
            json::change(&mut value, &Value::Null, chance);
            json::text(&value)
        }
        Err(_) => String::from_utf8_lossy(&json::spoilt(&old, chance)).into_owned(),
    };
    map.insert(key.clone(), new);
}

/// Says another thing of a channel: its name, its schema, its metadata.
fn declare(messages: &mut [Held], chance: &mut Chance) {
    let id = messages[chance.below(messages.len())].channel.id;
    let mut seed = chance.clone();
    for held in messages.iter_mut().filter(|m| m.channel.id == id) {
        // The same for all of them.
        let mut chance = seed.clone();
        match chance.below(4) {
            0 => {
                held.channel.topic =
                    String::from_utf8_lossy(&json::spoilt(&held.channel.topic, &mut chance))
                        .into_owned()
            }
            1 => held.channel.schema = None,
            _ => entry(&mut held.channel.metadata, &mut chance),
        }
    }
    seed.next();
    *chance = seed;
}

/// Another content of a message.
fn content(held: &mut Held, chance: &mut Chance) {
    match serde_json::from_slice::<Value>(&held.data) {
        Ok(mut value) => {
            let donor = value.clone();
            json::change(&mut value, &donor, chance);
            held.data = json::text(&value).into_bytes();
        }
        Err(_) if chance.one_in(4) => {
            let n = chance.below(held.data.len());
            held.data.truncate(n);
        }
        Err(_) => word(&mut held.data, chance),
    }
}

fn write(metadata: &[Metadata], messages: &[Held]) -> Option<Vec<u8>> {
    let mut out = Cursor::new(Vec::new());
    let options = WriteOptions::new()
        .compression(Some(Compression::Zstd))
        .compression_threads(0)
        .library("fusionline");
    let mut writer = options.create(&mut out).ok()?;
    for record in metadata {
        writer.write_metadata(record).ok()?;
    }
    for held in messages {
        let c = &held.channel;
        let schema = match &c.schema {
            Some(s) => writer.add_schema(&s.name, &s.encoding, &s.data).ok()?,
            None => 0,
        };
        let id = writer
            .add_channel(schema, &c.topic, &c.message_encoding, &c.metadata)
            .ok()?;
        let header = MessageHeader {
            channel_id: id,
            ..held.header
        };
        writer.write_to_known_channel(&header, &held.data).ok()?;
    }
    writer.finish().ok()?;
    drop(writer);
    Some(out.into_inner())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_depth_changes_a_file_and_leaves_many_that_open() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("arc.mcap");
        let bytes = crate::records::tests::small();
        let (mut changed, mut open) = (BTreeMap::new(), BTreeMap::new());
        for trial in 0..300 {
            let (own, depth) = change(&bytes, &bytes, &mut Chance::of(5, trial));
            let name = format!("{depth:?}");
            *changed.entry(name.clone()).or_insert(0) += usize::from(own != bytes);
            std::fs::write(&path, own).unwrap();
            *open.entry(name).or_insert(0) += usize::from(artefact::Reader::open(&path).is_ok());
        }
        assert!(
            changed.len() == 3 && changed.values().all(|n| *n > 70),
            "{changed:?}"
        );
        assert!(open["Contents"] > 40 && open["Records"] > 20, "{open:?}");
    }
}
