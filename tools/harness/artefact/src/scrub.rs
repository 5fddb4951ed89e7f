//! Checks every byte of a finished file against the checksums that it carries.

use mcap::parse_record;
use mcap::records::{Record, op};

use crate::error::{Error, Result};
use crate::store::{PREFIX, Store};

/// Bytes read at a time.
const BLOCK: u64 = 1 << 20;

/// Compares the data section with its checksum; the summary was compared when the file was opened.
pub(crate) fn scrub(store: &Store) -> Result<()> {
    let end = data_end(store)?;
    let Some((_, body)) = store.record_at(end)? else {
        return Err(store.truncated());
    };
    let expected = match parse_record(op::DATA_END, &body) {
        // A longer record of this kind could hide bytes that no checksum covers.
        Ok(Record::DataEnd(record)) if body.len() == 4 => record.data_section_crc,
        _ => return Err(store.damaged(format!("byte {end}"), "the end of data cannot be read")),
    };
    // In MCAP a checksum of 0 says that there is none; chunks have their own.
    if expected == 0 {
        return Ok(());
    }
    let mut hasher = crc32fast::Hasher::new();
    let mut at = 0;
    while at < end {
        let n = BLOCK.min(end - at);
        hasher.update(&store.read(at, n)?);
        at += n;
    }
    let found = hasher.finalize();
    if expected == found {
        Ok(())
    } else {
        Err(Error::Crc {
            path: store.path.clone(),
            place: format!("the data, bytes 0 to {end}"),
            expected,
            found,
        })
    }
}

/// Where the record stands that ends the data.
fn data_end(store: &Store) -> Result<u64> {
    let mut at = mcap::MAGIC.len() as u64;
    while let Some((opcode, length)) = store.prefix_at(at)? {
        match opcode {
            op::DATA_END => return Ok(at),
            op::FOOTER => break,
            _ => at += PREFIX + length,
        }
    }
    Err(store.damaged(format!("byte {at}"), "the data has no end record"))
}
