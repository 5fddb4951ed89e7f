//! The file `NAME.part` while it is written: metadata, channels, messages, and its end.

use std::collections::BTreeMap;
use std::fs::File;
use std::io::BufWriter;
use std::path::{Path, PathBuf};

use mcap::records::{MessageHeader, Metadata};
use mcap::{Compression, McapError, WriteOptions};

use crate::atomic::rename_synced;
use crate::error::{Error, Result, io_error};
use crate::header::{Header, METADATA};
use crate::message::Topic;

/// zstd level: speed matters more than the last per cent.
const LEVEL: u32 = 1;

type Output = mcap::Writer<BufWriter<File>>;

/// An open partial file. Dropping it leaves all whole chunks and writes no end record.
pub(crate) struct Part {
    path: PathBuf,
    out: Option<Output>,
    sync: File,
}

impl std::fmt::Debug for Part {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Part").field("path", &self.path).finish()
    }
}

impl Drop for Part {
    fn drop(&mut self) {
        if let Some(writer) = self.out.take() {
            drop(writer.into_inner());
        }
    }
}

impl Part {
    /// Begins the file with its metadata record.
    pub(crate) fn create(path: PathBuf, header: &Header) -> Result<Self> {
        let file = File::create(&path).map_err(io_error(&path, "create"))?;
        let sync = file.try_clone().map_err(io_error(&path, "create"))?;
        let options = WriteOptions::new()
            .compression(Some(Compression::Zstd))
            .compression_level(LEVEL)
            // Without worker threads: the bytes must not depend on the machine.
            .compression_threads(0)
            .chunk_size(None)
            .library("fusionline");
        let out = options
            .create(BufWriter::with_capacity(1 << 16, file))
            .map_err(refused(&path))?;
        let mut part = Self {
            path,
            out: Some(out),
            sync,
        };
        part.metadata(METADATA, header.to_metadata())?;
        part.flush()?;
        Ok(part)
    }

    /// Writes a metadata record.
    pub(crate) fn metadata(
        &mut self,
        name: &str,
        metadata: BTreeMap<String, String>,
    ) -> Result<()> {
        let name = name.to_owned();
        self.with(|out| out.write_metadata(&Metadata { name, metadata }))
    }

    /// Makes a channel known and gives its number.
    pub(crate) fn channel(&mut self, topic: &Topic) -> Result<u16> {
        self.with(|out| {
            let schema =
                out.add_schema(&topic.schema, topic.schema_encoding(), &topic.schema_data())?;
            out.add_channel(
                schema,
                &topic.channel,
                topic.message_encoding(),
                &topic.metadata(),
            )
        })
    }

    /// Writes a message into the open chunk.
    pub(crate) fn message(&mut self, header: &MessageHeader, data: &[u8]) -> Result<()> {
        self.with(|out| out.write_to_known_channel(header, data))
    }

    /// Ends the open chunk and hands it to the system.
    pub(crate) fn flush(&mut self) -> Result<()> {
        self.with(mcap::Writer::flush)
    }

    /// Waits until all that was flushed is on the disk.
    pub(crate) fn sync(&mut self) -> Result<()> {
        self.flush()?;
        self.sync.sync_data().map_err(io_error(&self.path, "sync"))
    }

    /// Gives the file another name and goes on writing it.
    pub(crate) fn rename(&mut self, to: PathBuf) -> Result<()> {
        rename_synced(&self.path, &to)?;
        self.path = to;
        Ok(())
    }

    /// Writes the index and the end record, syncs, and gives the file its final name.
    pub(crate) fn finish(mut self, to: &Path) -> Result<()> {
        self.with(|out| out.finish().map(|_| ()))?;
        let writer = self.out.take().ok_or_else(|| closed(&self.path))?;
        let file = writer
            .into_inner()
            .into_inner()
            .map_err(|e| io_error(&self.path, "write")(e.into_error()))?;
        file.sync_all().map_err(io_error(&self.path, "sync"))?;
        rename_synced(&self.path, to)
    }

    fn with<T>(
        &mut self,
        work: impl FnOnce(&mut Output) -> std::result::Result<T, McapError>,
    ) -> Result<T> {
        let out = self.out.as_mut().ok_or_else(|| closed(&self.path))?;
        work(out).map_err(refused(&self.path))
    }
}

/// The error for a writer that is no longer open: our own invariant.
fn closed(path: &Path) -> Error {
    Error::Damaged {
        path: path.to_owned(),
        place: "writer".to_owned(),
        what: "already closed".to_owned(),
    }
}

/// An error of the MCAP writer with the file it concerns.
fn refused(path: &Path) -> impl Fn(McapError) -> Error {
    let path = path.to_owned();
    move |error| Error::Io {
        path: path.clone(),
        action: "write",
        source: match error {
            McapError::Io(source) => source,
            other => std::io::Error::other(other),
        },
    }
}
