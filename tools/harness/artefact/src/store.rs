//! The records of an MCAP file: its index, and single chunks with their checksums checked.

use std::collections::BTreeMap;
use std::fs::File;
use std::os::unix::fs::FileExt;
use std::path::{Path, PathBuf};

use mcap::records::{self, Record, op};
use mcap::sans_io::{LinearReadEvent, LinearReader, LinearReaderOptions};
use mcap::{MAGIC, McapError};

use crate::error::{Error, Result, io_error};
use crate::header::hexadecimal;
use crate::json;
use crate::record::{PREFIX, record, split_record, unfolded};

/// Footer record with its prefix \[byte\].
const FOOTER: u64 = PREFIX + 20;

/// A channel as the file describes it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct ChannelInfo {
    pub(crate) name: String,
    pub(crate) schema: String,
    pub(crate) schema_encoding: String,
    pub(crate) schema_data: Vec<u8>,
    pub(crate) metadata: BTreeMap<String, String>,
}

/// Where a chunk is, and when each of its messages was, by channel.
#[derive(Debug, Clone)]
pub(crate) struct ChunkPlace {
    pub(crate) offset: u64,
    pub(crate) length: u64,
    pub(crate) times: BTreeMap<u16, Vec<u64>>,
}

/// A message of a decompressed chunk.
#[derive(Debug, Clone)]
pub(crate) struct Stored {
    pub(crate) channel: u16,
    pub(crate) log_time: u64,
    pub(crate) data: Vec<u8>,
}

/// All that is known of a file without decompressing it.
#[derive(Debug, Default)]
pub(crate) struct Index {
    pub(crate) metadata: BTreeMap<String, BTreeMap<String, String>>,
    pub(crate) channels: BTreeMap<u16, ChannelInfo>,
    pub(crate) chunks: Vec<ChunkPlace>,
    schemas: BTreeMap<u16, (records::SchemaHeader, Vec<u8>)>,
}

impl Index {
    /// Takes a schema or channel record in.
    pub(crate) fn learn(&mut self, record: Record<'_>) {
        match record {
            Record::Schema { header, data } => {
                self.schemas.insert(header.id, (header, data.into_owned()));
            }
            Record::Channel(c) => {
                let (schema, schema_encoding, schema_data) = match self.schemas.get(&c.schema_id) {
                    Some((header, data)) => {
                        (header.name.clone(), header.encoding.clone(), data.clone())
                    }
                    None => Default::default(),
                };
                let info = ChannelInfo {
                    name: c.topic,
                    schema,
                    schema_encoding,
                    schema_data,
                    metadata: c.metadata,
                };
                self.channels.insert(c.id, info);
            }
            Record::Metadata(m) => {
                self.metadata.insert(m.name, m.metadata);
            }
            _ => {}
        }
    }
}

/// An open file.
#[derive(Debug)]
pub(crate) struct Store {
    pub(crate) path: PathBuf,
    file: File,
    pub(crate) bytes: u64,
}

impl Store {
    /// Opens a file that begins as an MCAP file does.
    pub(crate) fn open(path: &Path) -> Result<Self> {
        let found = std::fs::metadata(path).map_err(io_error(path, "open"))?;
        if !found.is_file() {
            // To open a pipe would wait for ever.
            let what = if found.is_dir() {
                "it is a folder"
            } else {
                "it is no regular file"
            };
            return Err(io_error(path, "open")(std::io::Error::other(what)));
        }
        let file = File::open(path).map_err(io_error(path, "open"))?;
        let bytes = found.len();
        let store = Self {
            path: path.to_owned(),
            file,
            bytes,
        };
        let head = store.read(0, bytes.min(MAGIC.len() as u64))?;
        if head != MAGIC {
            if !head.is_empty() && MAGIC.starts_with(&head) {
                return Err(store.truncated());
            }
            if let Some(json) = json::mistaken(path) {
                return Err(json);
            }
            return Err(Error::Foreign {
                path: path.to_owned(),
                found: if head.is_empty() {
                    "nothing (it is empty)".to_owned()
                } else {
                    hexadecimal(&head)
                },
                expected: hexadecimal(MAGIC),
            });
        }
        Ok(store)
    }

    pub(crate) fn read(&self, offset: u64, length: u64) -> Result<Vec<u8>> {
        if offset
            .checked_add(length)
            .is_none_or(|end| end > self.bytes)
        {
            return Err(self.damaged(
                format!("byte {offset}"),
                format!("{length} bytes reach beyond the end"),
            ));
        }
        let mut data = vec![0; usize::try_from(length).unwrap_or(usize::MAX)];
        self.file
            .read_exact_at(&mut data, offset)
            .map_err(io_error(&self.path, "read"))?;
        Ok(data)
    }

    pub(crate) fn truncated(&self) -> Error {
        let (path, bytes) = (self.path.clone(), self.bytes);
        if self.has_start() {
            Error::Truncated { path, bytes }
        } else {
            Error::NoStart { path, bytes }
        }
    }

    /// Whether a metadata record is whole before the first chunk.
    fn has_start(&self) -> bool {
        let mut at = MAGIC.len() as u64;
        while let Ok(Some((opcode, length))) = self.prefix_at(at) {
            match opcode {
                op::METADATA => return true,
                op::HEADER => at += PREFIX + length,
                _ => return false,
            }
        }
        false
    }

    pub(crate) fn damaged(&self, place: impl Into<String>, what: impl ToString) -> Error {
        Error::Damaged {
            path: self.path.clone(),
            place: place.into(),
            what: what.to_string(),
        }
    }

    /// Opcode and body of the record at `offset`; `None` where the file ends before its end.
    pub(crate) fn record_at(&self, offset: u64) -> Result<Option<(u8, Vec<u8>)>> {
        let Some((opcode, length)) = self.prefix_at(offset)? else {
            return Ok(None);
        };
        Ok(Some((opcode, self.read(offset + PREFIX, length)?)))
    }

    /// Opcode and length of the body of the record at `offset`, if it is whole.
    pub(crate) fn prefix_at(&self, offset: u64) -> Result<Option<(u8, u64)>> {
        if offset + PREFIX > self.bytes {
            return Ok(None);
        }
        let prefix = self.read(offset, PREFIX)?;
        let mut length = [0; 8];
        length.copy_from_slice(&prefix[1..]);
        let length = u64::from_le_bytes(length);
        let whole = (offset + PREFIX)
            .checked_add(length)
            .is_some_and(|end| end <= self.bytes);
        Ok(whole.then_some((prefix[0], length)))
    }

    /// The index of a finished file, its checksum checked.
    pub(crate) fn index(&self) -> Result<Index> {
        let end = self.bytes.saturating_sub(MAGIC.len() as u64);
        if self.bytes < 2 * MAGIC.len() as u64 + FOOTER
            || self.read(end, MAGIC.len() as u64)? != MAGIC
        {
            return Err(self.truncated());
        }
        let footer_at = end - FOOTER;
        let Some((op::FOOTER, body)) = self.record_at(footer_at)? else {
            return Err(self.damaged(format!("byte {footer_at}"), "the footer is not there"));
        };
        let Ok(Record::Footer(footer)) = record(op::FOOTER, &body) else {
            return Err(self.damaged(format!("byte {footer_at}"), "the footer cannot be read"));
        };
        if footer.summary_start == 0 || footer.summary_start > footer_at {
            return Err(self.damaged("the footer", "it points to no summary"));
        }
        let mut summary = self.read(
            footer.summary_start,
            footer_at - footer.summary_start + FOOTER - 4,
        )?;
        let found = crc32fast::hash(&summary);
        // In MCAP a checksum of 0 says that there is none.
        if footer.summary_crc != 0 && found != footer.summary_crc {
            return Err(Error::Crc {
                path: self.path.clone(),
                place: "the summary".to_owned(),
                expected: footer.summary_crc,
                found,
            });
        }
        summary.truncate(usize::try_from(footer_at - footer.summary_start).unwrap_or(usize::MAX));
        self.parse_summary(&summary)
    }

    fn parse_summary(&self, mut bytes: &[u8]) -> Result<Index> {
        let mut index = Index::default();
        let mut places = Vec::new();
        let mut counts = BTreeMap::new();
        while let Some((opcode, body, rest)) = split_record(bytes) {
            bytes = rest;
            match record(opcode, body).map_err(|e| self.damaged("the summary", e))? {
                Record::ChunkIndex(chunk) => places.push(chunk),
                Record::Statistics(statistics) => counts = statistics.channel_message_counts,
                Record::MetadataIndex(m) => {
                    if let Some((op::METADATA, body)) = self.record_at(m.offset)? {
                        index.learn(
                            record(op::METADATA, &body)
                                .map_err(|e| self.damaged("a metadata record", e))?,
                        );
                    }
                }
                other => index.learn(other),
            }
        }
        for chunk in places {
            index.chunks.push(ChunkPlace {
                times: self.times(&chunk)?,
                offset: chunk.chunk_start_offset,
                length: chunk.chunk_length,
            });
        }
        self.must_count(&index, &counts)?;
        Ok(index)
    }

    /// When each message of a chunk was, by channel.
    fn times(&self, chunk: &records::ChunkIndex) -> Result<BTreeMap<u16, Vec<u64>>> {
        let mut times = BTreeMap::new();
        for (&channel, &offset) in &chunk.message_index_offsets {
            let wrong = |what| Err(self.damaged(format!("message index at byte {offset}"), what));
            let Some((op::MESSAGE_INDEX, body)) = self.record_at(offset)? else {
                return wrong("it is not there");
            };
            match record(op::MESSAGE_INDEX, &body) {
                Ok(Record::MessageIndex(m)) if m.channel_id == channel => {
                    times.insert(channel, m.records.iter().map(|r| r.log_time).collect());
                }
                _ => return wrong("it cannot be read"),
            }
        }
        Ok(times)
    }

    /// Refuses message indices, which have no checksum of their own, that lost messages.
    fn must_count(&self, index: &Index, counts: &BTreeMap<u16, u64>) -> Result<()> {
        for (id, info) in &index.channels {
            let chunks = index.chunks.iter();
            let found: usize = chunks.filter_map(|c| Some(c.times.get(id)?.len())).sum();
            let expected = counts.get(id).copied().unwrap_or(0);
            if found as u64 != expected {
                return Err(self.damaged(
                    format!("channel '{}'", info.name),
                    format!("the index lists {found} messages, the summary counts {expected}"),
                ));
            }
        }
        Ok(())
    }

    /// Decompresses a chunk with its checksum checked before any message is given out; `learn`
    /// sees the schema and channel records in it.
    pub(crate) fn chunk(
        &self,
        offset: u64,
        length: u64,
        mut learn: impl FnMut(Record<'_>),
    ) -> Result<Vec<Stored>> {
        let bytes = self.read(offset, length)?;
        let place = || format!("chunk at byte {offset}");
        let whole = unfolded(&bytes).map_err(|what| self.damaged(place(), what))?;
        let longest = whole.max(bytes.len() as u64);
        let options = LinearReaderOptions::default()
            .with_skip_start_magic(true)
            .with_skip_end_magic(true)
            .with_record_length_limit(usize::try_from(longest).unwrap_or(usize::MAX))
            .with_prevalidate_chunk_crcs(true);
        let mut reader = LinearReader::new_with_options(options);
        let mut rest = bytes.as_slice();
        let mut messages = Vec::new();
        while let Some(event) = reader.next_event() {
            match event.map_err(|e| self.chunk_error(e, place()))? {
                LinearReadEvent::ReadRequest(need) => {
                    if rest.is_empty() {
                        break;
                    }
                    let n = need.min(rest.len());
                    reader.insert(n).copy_from_slice(&rest[..n]);
                    reader.notify_read(n);
                    rest = &rest[n..];
                }
                LinearReadEvent::Record { data, opcode } => {
                    match record(opcode, data).map_err(|e| self.damaged(place(), e))? {
                        Record::Message { header, data } => messages.push(Stored {
                            channel: header.channel_id,
                            log_time: header.log_time,
                            data: data.into_owned(),
                        }),
                        other => learn(other),
                    }
                }
            }
        }
        Ok(messages)
    }

    fn chunk_error(&self, error: McapError, place: String) -> Error {
        match error {
            McapError::BadChunkCrc { saved, calculated } => Error::Crc {
                path: self.path.clone(),
                place,
                expected: saved,
                found: calculated,
            },
            other => self.damaged(place, other),
        }
    }
}
