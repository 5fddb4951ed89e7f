//! A record of an MCAP file, read only after every length in it was compared with its bytes: what a file claims is
//! never asked of the memory.

use mcap::parse_record;
use mcap::records::{Record, op};

/// Opcode and length before each record \[byte\].
pub(crate) const PREFIX: u64 = 9;

/// What a record is made of, in order. More may follow: newer versions of the format only add.
#[derive(Debug, Clone, Copy)]
enum Part {
    /// So many bytes.
    Fixed(usize),
    /// A length of 4 bytes and as many bytes: a text, a list of entries of equal size.
    Sized,
    /// The same, and in it texts one after another: a map from texts to texts.
    Texts,
}

use Part::{Fixed, Sized, Texts};

/// The parts of a record with lengths in it, by the specification of the format.
fn parts(opcode: u8) -> &'static [Part] {
    match opcode {
        op::HEADER => &[Sized, Sized],
        op::SCHEMA => &[Fixed(2), Sized, Sized, Sized],
        op::CHANNEL => &[Fixed(4), Sized, Sized, Texts],
        op::CHUNK => &[Fixed(28), Sized],
        op::MESSAGE_INDEX => &[Fixed(2), Sized],
        op::CHUNK_INDEX => &[Fixed(32), Sized, Fixed(8), Sized, Fixed(16)],
        op::ATTACHMENT => &[Fixed(16), Sized, Sized],
        op::ATTACHMENT_INDEX => &[Fixed(40), Sized, Sized],
        op::STATISTICS => &[Fixed(42), Sized],
        op::METADATA => &[Sized, Texts],
        op::METADATA_INDEX => &[Fixed(16), Sized],
        _ => &[],
    }
}

/// The bytes of a [`Sized`] at the start, and what follows it.
fn sized(bytes: &[u8]) -> Option<(&[u8], &[u8])> {
    let (length, rest) = bytes.split_first_chunk::<4>()?;
    rest.split_at_checked(usize::try_from(u32::from_le_bytes(*length)).ok()?)
}

/// Whether every length in a record is within it.
fn is_within(opcode: u8, body: &[u8]) -> bool {
    let mut rest = Some(body);
    for part in parts(opcode) {
        rest = rest.and_then(|bytes| match part {
            Fixed(n) => bytes.get(*n..),
            Sized => Some(sized(bytes)?.1),
            Texts => {
                let (mut texts, rest) = sized(bytes)?;
                while !texts.is_empty() {
                    texts = sized(texts)?.1;
                }
                Some(rest)
            }
        });
    }
    rest.is_some()
}

/// The record of an opcode and a body.
///
/// # Errors
/// With what is wrong with it.
pub(crate) fn record(opcode: u8, body: &[u8]) -> Result<Record<'_>, String> {
    if !is_within(opcode, body) {
        return Err("a length in it reaches beyond its end".to_owned());
    }
    parse_record(opcode, body).map_err(|e| e.to_string())
}

/// Opcode and body of the first record, and what follows it.
pub(crate) fn split_record(bytes: &[u8]) -> Option<(u8, &[u8], &[u8])> {
    let (&opcode, rest) = bytes.split_first()?;
    let (length, rest) = rest.split_first_chunk::<8>()?;
    let length = usize::try_from(u64::from_le_bytes(*length)).ok()?;
    let body = rest.get(..length)?;
    Some((opcode, body, &rest[length..]))
}

/// Bytes that any chunk may unfold to.
const ALWAYS: u64 = 64 << 20;
/// Above that, how many times as long as it is.
const TIMES: u64 = 1000;

/// Length that a chunk of `bytes` says it unfolds to, if it may.
///
/// # Errors
/// With what is wrong with it.
pub(crate) fn unfolded(bytes: &[u8]) -> Result<u64, &'static str> {
    let Some((op::CHUNK, body, [])) = split_record(bytes) else {
        return Err("it is not there");
    };
    match record(op::CHUNK, body) {
        Ok(Record::Chunk { header, data }) => {
            let most = ALWAYS.max((data.len() as u64).saturating_mul(TIMES));
            if header.uncompressed_size > most {
                return Err("it claims to unfold to more than its bytes can hold");
            }
            Ok(header.uncompressed_size)
        }
        _ => Err("its header cannot be read"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_length_beyond_the_record_is_refused_before_memory_is_asked_for() {
        // A channel: number, schema, then a name of 4 GB.
        let channel = [&[0, 0, 0, 0][..], &u32::MAX.to_le_bytes(), b"/pool"].concat();
        assert!(record(op::CHANNEL, &channel).is_err());
        // A map whose second text is longer than the map.
        let text = |t: &[u8]| [&(t.len() as u32).to_le_bytes()[..], t].concat();
        let map = [text(b"units"), u32::MAX.to_le_bytes().to_vec()].concat();
        let metadata = [text(b"fusionline"), text(&map)].concat();
        assert!(record(op::METADATA, &metadata).is_err());
        let map = [text(b"kind"), text(b"arc-source")].concat();
        let metadata = [text(b"fusionline"), text(&map)].concat();
        let Ok(Record::Metadata(found)) = record(op::METADATA, &metadata) else {
            panic!("not read");
        };
        assert_eq!(found.metadata["kind"], "arc-source");
    }

    #[test]
    fn a_chunk_cannot_claim_to_unfold_to_much_more_than_its_bytes() {
        let chunk = |claimed: u64, data: usize| {
            let mut body = [[0; 16].as_slice(), &claimed.to_le_bytes(), &[0; 4]].concat();
            body.extend(4_u32.to_le_bytes());
            body.extend(b"zstd");
            body.extend((data as u64).to_le_bytes());
            body.extend(vec![0; data]);
            [&[op::CHUNK][..], &(body.len() as u64).to_le_bytes(), &body].concat()
        };
        assert_eq!(unfolded(&chunk(1 << 20, 100)), Ok(1 << 20));
        assert!(unfolded(&chunk(1 << 30, 100)).is_err());
        assert_eq!(unfolded(&chunk(1 << 30, 2 << 20)), Ok(1 << 30));
    }
}
