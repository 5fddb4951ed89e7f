//! Checks every byte of a finished file against the checksums that it carries.

use mcap::records::{Record, op};
use sha2::{Digest, Sha256};

use crate::error::{Error, Result};
use crate::header::hexadecimal;
use crate::reader::Reader;
use crate::record::{PREFIX, record};
use crate::store::Store;

/// Bytes read at a time.
const BLOCK: u64 = 1 << 20;

impl Reader {
    /// Compares every byte of a finished file with the checksums in it. That of the summary was compared when the file
    /// was opened.
    ///
    /// # Errors
    /// [`Error::Crc`] or [`Error::Damaged`], naming the place.
    pub fn scrub(&self) -> Result<()> {
        let seal = Seal::of(&self.store)?;
        if seal.crc == 0 {
            return Ok(());
        }
        let mut sum = crc32fast::Hasher::new();
        each_block(&self.store, seal.end, |_, block| sum.update(block))?;
        seal.compare(&self.store, sum)
    }

    /// [`Reader::scrub`] and [`crate::sha256_file`] in one reading of the file.
    ///
    /// # Errors
    /// As [`Reader::scrub`].
    pub fn scrub_and_hash(&self) -> Result<String> {
        let seal = Seal::of(&self.store)?;
        let (mut sum, mut digest) = (crc32fast::Hasher::new(), Sha256::new());
        each_block(&self.store, self.store.bytes, |at, block| {
            let data = seal.end.saturating_sub(at).min(block.len() as u64);
            sum.update(&block[..data as usize]);
            digest.update(block);
        })?;
        seal.compare(&self.store, sum)?;
        Ok(hexadecimal(&digest.finalize()))
    }
}

/// Shows the bytes before `end` to `look`, block by block, each with its place.
fn each_block(store: &Store, end: u64, mut look: impl FnMut(u64, &[u8])) -> Result<()> {
    let mut at = 0;
    while at < end {
        let n = BLOCK.min(end - at);
        look(at, &store.read(at, n)?);
        at += n;
    }
    Ok(())
}

/// What the data section should be.
struct Seal {
    /// Where it ends \[byte\].
    end: u64,
    /// Its checksum; 0 says in MCAP that there is none; chunks have their own.
    crc: u32,
}

impl Seal {
    fn of(store: &Store) -> Result<Self> {
        let end = data_end(store)?;
        let Some((_, body)) = store.record_at(end)? else {
            return Err(store.truncated());
        };
        match record(op::DATA_END, &body) {
            // A longer record of this kind could hide bytes that no checksum covers.
            Ok(Record::DataEnd(found)) if body.len() == 4 => Ok(Self {
                end,
                crc: found.data_section_crc,
            }),
            _ => Err(store.damaged(format!("byte {end}"), "the end of data cannot be read")),
        }
    }

    fn compare(&self, store: &Store, sum: crc32fast::Hasher) -> Result<()> {
        let found = sum.finalize();
        if self.crc == 0 || self.crc == found {
            return Ok(());
        }
        Err(Error::Crc {
            path: store.path.clone(),
            place: format!("the data, bytes 0 to {}", self.end),
            expected: self.crc,
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
