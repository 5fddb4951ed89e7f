//! An MCAP file as a list of records that can be put together again with places and checksums that fit, so that
//! what is wrong in them is met behind the checksums.

use std::collections::BTreeMap;

use mcap::MAGIC;
use mcap::records::op;

/// A record as it stood in the file.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Raw {
    /// Where it stood \[byte\].
    pub(crate) at: u64,
    pub(crate) opcode: u8,
    pub(crate) body: Vec<u8>,
    /// Length that it claims to have, where that is not its length.
    pub(crate) claims: Option<u64>,
}

/// The records of a whole file.
pub(crate) fn split(bytes: &[u8]) -> Vec<Raw> {
    let mut records = Vec::new();
    let mut at = MAGIC.len();
    while let Some((&opcode, rest)) = bytes.get(at..).and_then(<[u8]>::split_first) {
        let Some((length, rest)) = rest.split_first_chunk::<8>() else {
            break;
        };
        let length = u64::from_le_bytes(*length) as usize;
        let Some(body) = rest.get(..length) else {
            break;
        };
        records.push(Raw {
            at: at as u64,
            opcode,
            body: body.to_vec(),
            claims: None,
        });
        at += 9 + length;
    }
    records
}

/// The file of these records, with the places that they name and the checksums over them made to fit.
pub(crate) fn join(mut records: Vec<Raw>) -> Vec<u8> {
    let mut moved = BTreeMap::new();
    let mut at = MAGIC.len() as u64;
    for record in &records {
        moved.insert(record.at, at);
        at += 9 + record.body.len() as u64;
    }
    let summary = records
        .iter()
        .position(|r| r.opcode == op::DATA_END)
        .map_or(0, |end| end + 1);
    for record in &mut records {
        refer(record, &moved);
    }
    let mut bytes = MAGIC.to_vec();
    let mut summary_at = 0;
    for (i, record) in records.iter_mut().enumerate() {
        if i == summary {
            summary_at = bytes.len();
        }
        if record.opcode == op::DATA_END && record.body.len() == 4 {
            let crc = crc32fast::hash(&bytes);
            record.body.copy_from_slice(&crc.to_le_bytes());
        }
        let footer = record.opcode == op::FOOTER && record.body.len() == 20;
        bytes.push(record.opcode);
        let length = record.claims.unwrap_or(record.body.len() as u64);
        bytes.extend(length.to_le_bytes());
        if footer {
            bytes.extend(&record.body[..16]);
            let crc = crc32fast::hash(&bytes[summary_at.min(bytes.len())..]);
            bytes.extend(crc.to_le_bytes());
        } else {
            bytes.extend(&record.body);
        }
    }
    bytes.extend(MAGIC);
    bytes
}

/// Turns the places that a record names to where their records stand now.
fn refer(record: &mut Raw, moved: &BTreeMap<u64, u64>) {
    let mut turn = |at: usize| {
        let Some(field) = record.body.get_mut(at..at + 8) else {
            return;
        };
        let mut word = [0; 8];
        word.copy_from_slice(field);
        if let Some(new) = moved.get(&u64::from_le_bytes(word)) {
            field.copy_from_slice(&new.to_le_bytes());
        }
    };
    match record.opcode {
        // Start and end of time, then the place and the length; then a map from channels to places.
        op::CHUNK_INDEX => {
            turn(16);
            for entry in 0..map_entries(&record.body, 32) {
                // Each entry: channel (2 bytes), place (8 bytes).
                let at = 36 + 10 * entry + 2;
                let Some(field) = record.body.get_mut(at..at + 8) else {
                    break;
                };
                let mut word = [0; 8];
                word.copy_from_slice(field);
                if let Some(new) = moved.get(&u64::from_le_bytes(word)) {
                    field.copy_from_slice(&new.to_le_bytes());
                }
            }
        }
        op::METADATA_INDEX => turn(0),
        op::SUMMARY_OFFSET => turn(1),
        op::FOOTER => {
            turn(0);
            turn(8);
        }
        _ => {}
    }
}

/// Entries of the map of channels whose length in bytes stands at `at`.
fn map_entries(body: &[u8], at: usize) -> usize {
    let length = body
        .get(at..at + 4)
        .map_or(0, |l| u32::from_le_bytes([l[0], l[1], l[2], l[3]]) as usize);
    (length / 10).min(body.len() / 10)
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;

    /// A small file with all that ours have.
    pub(crate) fn small() -> Vec<u8> {
        let header = artefact::Header {
            kind: "arc-source".to_owned(),
            version: artefact::Version::new(1, 0),
            tool: "arcfvm".to_owned(),
            tool_version: "0.1.0".to_owned(),
            scene: serde_json::json!({"kind": "arcfvm.scene", "version": 1}),
            inputs: BTreeMap::new(),
        };
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("small.mcap");
        let mut writer = artefact::Writer::create(&path, &header).unwrap();
        let table = artefact::Table::new(3).column("radius_m", "m", [0.0, 1e-3, 2e-3]);
        let frame = artefact::Frame::new(artefact::Precision::F64)
            .positions((0..20).map(|i| [f64::from(i), 0.0, 0.0]))
            .scalar("temperature", "K", (0..20).map(f64::from));
        for step in 0..3 {
            writer.table("/surface", f64::from(step), &table).unwrap();
            writer.frame("/points", f64::from(step), &frame).unwrap();
        }
        writer.finish().unwrap();
        std::fs::read(&path).unwrap()
    }

    #[test]
    fn a_file_taken_apart_and_put_together_is_the_same() {
        let bytes = small();
        let records = split(&bytes);
        assert!(records.len() > 8);
        assert_eq!(join(records), bytes);
    }

    #[test]
    fn a_record_in_between_leaves_the_file_readable() {
        let mut records = split(&small());
        let unknown = Raw {
            at: u64::MAX,
            opcode: 0x90,
            body: vec![1, 2, 3],
            claims: None,
        };
        records.insert(1, unknown);
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("more.mcap");
        std::fs::write(&path, join(records)).unwrap();
        let reader = artefact::Reader::open(&path).unwrap();
        reader.scrub().unwrap();
        assert!(reader.table("/surface").is_ok());
    }
}
