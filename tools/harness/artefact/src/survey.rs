//! What is whole of a file that was never finished or is damaged, and what is lost of it.

use std::collections::BTreeMap;
use std::fmt;

use mcap::MAGIC;
use mcap::records::{Record, op};

use crate::error::{Error, Result};
use crate::header::METADATA;
use crate::message::time_s;
use crate::record::{PREFIX, record};
use crate::store::{ChannelInfo, ChunkPlace, Index, Store, Stored};

/// A chunk that was found whole, with its messages.
pub(crate) struct Whole {
    pub(crate) place: (u64, u64),
    pub(crate) messages: Vec<Stored>,
}

/// A chunk that was cut or overwritten, with the times of its messages as far as they are known.
#[derive(Debug, Default)]
struct Broken {
    offset: u64,
    why: String,
    times: BTreeMap<u16, Vec<u64>>,
}

/// What stands at the next place where a chunk begins.
pub(crate) enum Step {
    Whole(Whole),
    Broken,
    End,
}

/// Walks over the records from the start and stops at the first that has no end.
pub(crate) struct Walk<'a> {
    store: &'a Store,
    offset: u64,
    pub(crate) index: Index,
    broken: Vec<Broken>,
    /// Whether the last chunk was broken: the message indices that follow are its own.
    after_broken: bool,
}

impl<'a> Walk<'a> {
    pub(crate) fn new(store: &'a Store) -> Self {
        Self {
            store,
            offset: MAGIC.len() as u64,
            index: Index::default(),
            broken: Vec::new(),
            after_broken: false,
        }
    }

    /// The next chunk; metadata and channels are learnt on the way, and of a broken chunk what the
    /// message indices behind it tell.
    pub(crate) fn next_chunk(&mut self) -> Result<Step> {
        while let Some((opcode, length)) = self.store.prefix_at(self.offset)? {
            let (at, size) = (self.offset, PREFIX + length);
            match opcode {
                op::CHUNK => {
                    self.offset += size;
                    return Ok(self.chunk(at, size));
                }
                op::METADATA | op::MESSAGE_INDEX => {
                    let Some((_, body)) = self.store.record_at(at)? else {
                        return Ok(Step::End);
                    };
                    match record(opcode, &body) {
                        Ok(Record::MessageIndex(m)) if self.after_broken => {
                            if let Some(broken) = self.broken.last_mut() {
                                let times = m.records.iter().map(|r| r.log_time).collect();
                                broken.times.insert(m.channel_id, times);
                            }
                        }
                        Ok(metadata @ Record::Metadata(_)) => {
                            self.index.learn(metadata);
                        }
                        _ => {}
                    }
                }
                op::DATA_END => return Ok(Step::End),
                op::HEADER..=op::DATA_END => {}
                _ => return Ok(Step::End),
            }
            self.offset += size;
        }
        Ok(Step::End)
    }

    fn chunk(&mut self, offset: u64, size: u64) -> Step {
        let index = &mut self.index;
        let chunk = self.store.chunk(offset, size, |record| index.learn(record));
        self.after_broken = chunk.is_err();
        match chunk {
            Ok(messages) => Step::Whole(Whole {
                place: (offset, size),
                messages,
            }),
            Err(e) => {
                self.broken.push(Broken {
                    offset,
                    why: e.to_string(),
                    ..Broken::default()
                });
                Step::Broken
            }
        }
    }
}

/// Messages that cannot be saved although the file goes on behind them.
#[derive(Debug, Clone, PartialEq)]
pub struct Lost {
    /// Where their chunk begins \[byte\].
    pub offset: u64,
    /// Why they are lost.
    pub why: String,
    /// Number of lost messages by channel, as far as it is known.
    pub messages: BTreeMap<String, usize>,
    /// Simulated time of the first and the last of them \[s\], where it is known.
    pub span_s: Option<(f64, f64)>,
}

impl Lost {
    fn of(broken: Broken, channels: &BTreeMap<u16, ChannelInfo>) -> Self {
        let mut messages: BTreeMap<String, usize> = BTreeMap::new();
        for (id, times) in &broken.times {
            let name = match channels.get(id) {
                Some(info) => info.name.clone(),
                None => format!("channel {id} of unknown name"),
            };
            *messages.entry(name).or_default() += times.len();
        }
        let all = broken.times.values().flatten();
        let span = all.clone().min().zip(all.max());
        Self {
            offset: broken.offset,
            why: broken.why,
            messages,
            span_s: span.map(|(&first, &last)| (time_s(first), time_s(last))),
        }
    }
}

impl fmt::Display for Lost {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "lost: the chunk at byte {}", self.offset)?;
        let mut before = " with ";
        for (channel, count) in &self.messages {
            write!(f, "{before}{count} of {channel}")?;
            before = ", ";
        }
        if let Some((first, last)) = self.span_s {
            write!(f, ", {first} s to {last} s")?;
        }
        write!(f, ": {}", self.why)
    }
}

/// All that is whole of a file.
pub(crate) struct Survey {
    pub(crate) index: Index,
    pub(crate) lost: Vec<Lost>,
    /// Bytes behind the last record that has an end.
    pub(crate) lost_bytes: u64,
}

/// What is whole of a file: by its index where that is whole, by its records where not.
pub(crate) fn survey(store: &Store) -> Result<Survey> {
    match store.index() {
        Ok(index) => Ok(sift(store, index)),
        Err(refused) => {
            let found = walk_over(store)?;
            match refused {
                Error::Truncated { .. } | Error::NoStart { .. }
                    if !found.index.metadata.contains_key(METADATA) =>
                {
                    Err(refused)
                }
                _ => Ok(found),
            }
        }
    }
}

/// Takes the broken chunks out of the index of a finished file.
fn sift(store: &Store, mut index: Index) -> Survey {
    let mut lost = Vec::new();
    for chunk in std::mem::take(&mut index.chunks) {
        match store.chunk(chunk.offset, chunk.length, |_| ()) {
            Ok(_) => index.chunks.push(chunk),
            Err(e) => {
                let broken = Broken {
                    offset: chunk.offset,
                    why: e.to_string(),
                    times: chunk.times,
                };
                lost.push(Lost::of(broken, &index.channels));
            }
        }
    }
    Survey {
        index,
        lost,
        lost_bytes: 0,
    }
}

/// What the records of a file say from the start on.
fn walk_over(store: &Store) -> Result<Survey> {
    let mut walk = Walk::new(store);
    let mut chunks = Vec::new();
    loop {
        let chunk = match walk.next_chunk()? {
            Step::Whole(chunk) => chunk,
            Step::Broken => continue,
            Step::End => break,
        };
        let mut times: BTreeMap<u16, Vec<u64>> = BTreeMap::new();
        let mut nameless: BTreeMap<u16, Vec<u64>> = BTreeMap::new();
        for message in &chunk.messages {
            let known = walk.index.channels.contains_key(&message.channel);
            let times = if known { &mut times } else { &mut nameless };
            let of_channel = times.entry(message.channel).or_default();
            of_channel.push(message.log_time);
        }
        let (offset, length) = chunk.place;
        if !nameless.is_empty() {
            walk.broken.push(Broken {
                offset,
                why: "what these messages are stood in a chunk that is lost".to_owned(),
                times: nameless,
            });
        }
        chunks.push(ChunkPlace {
            offset,
            length,
            times,
        });
    }
    let mut index = walk.index;
    index.chunks = chunks;
    let broken = walk.broken.into_iter();
    Ok(Survey {
        lost: broken.map(|b| Lost::of(b, &index.channels)).collect(),
        index,
        lost_bytes: store.bytes.saturating_sub(walk.offset),
    })
}
