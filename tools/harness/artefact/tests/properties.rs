//! What must hold for any content: files read back as written, any cut leaves a whole prefix, any
//! flipped bit is found, and a resumed file has the bytes of an undisturbed one.

#![allow(clippy::unwrap_used, reason = "a test may fail")]

use std::fs::File;
use std::os::unix::fs::FileExt;
use std::path::Path;

use artefact::{
    Checkpoint, Error, Frame, Header, Precision, Reader, Record, Table, Values, Version, Writer,
    beside, recover, sha256_file,
};
use proptest::prelude::*;

fn header() -> Header {
    Header {
        kind: "particle-frames".to_owned(),
        version: Version::new(1, 0),
        tool: "poolsph".to_owned(),
        tool_version: "0.1.0".to_owned(),
        scene: serde_json::json!({"kind": "poolsph.scene", "version": 2, "spacing_m": 5e-4}),
        inputs: [("arc".to_owned(), "ab".repeat(32))].into(),
    }
}

/// A message that a tool may write.
#[derive(Debug, Clone, PartialEq)]
enum Message {
    Frame(Vec<[f64; 3]>),
    Record(f64),
    Table(Vec<f64>),
    Grid([f64; 6]),
}

impl Message {
    fn write(&self, writer: &mut Writer, time_s: f64) {
        match self {
            Self::Frame(x) => writer.frame("/particles", time_s, &frame(x)).unwrap(),
            Self::Record(x) => {
                let record = Record::new().with("mass_kg", "kg", *x);
                writer.record("/balance", time_s, &record).unwrap();
            }
            Self::Table(x) => {
                let table = Table::new(x.len()).column("heat_w", "W", x.iter().copied());
                writer.table("/surface", time_s, &table).unwrap();
            }
            Self::Grid(x) => {
                let table = Table::grid(&[
                    ("y_m", "m", &[-0.5e-3, 0.0, 0.5e-3]),
                    ("z_m", "m", &[0.0, 0.5e-3]),
                ]);
                let table = table.column("velocity_m_s", "m/s", *x);
                writer.table("/section", time_s, &table).unwrap();
            }
        }
    }
}

fn frame(positions: &[[f64; 3]]) -> Frame {
    let n = positions.len();
    Frame::new(Precision::F64)
        .positions(positions.iter().copied())
        .flag("molten", (0..n).map(|i| (i % 2) as u8))
        .id("id", 0..n as u32)
}

fn number() -> impl Strategy<Value = f64> {
    use proptest::num::f64::{NEGATIVE, NORMAL, POSITIVE, SUBNORMAL, ZERO};
    POSITIVE | NEGATIVE | NORMAL | SUBNORMAL | ZERO
}

fn message() -> impl Strategy<Value = Message> {
    let vector = [number(), number(), number()];
    prop_oneof![
        prop::collection::vec(vector, 0..30).prop_map(Message::Frame),
        number().prop_map(Message::Record),
        prop::collection::vec(number(), 0..30).prop_map(Message::Table),
        prop::array::uniform6(number()).prop_map(Message::Grid),
    ]
}

fn messages() -> impl Strategy<Value = Vec<Message>> {
    prop::collection::vec(message(), 1..12)
}

fn time(i: usize) -> f64 {
    0.125 * i as f64
}

fn write(path: &Path, messages: &[Message]) {
    let mut writer = Writer::create(path, &header()).unwrap();
    for (i, message) in messages.iter().enumerate() {
        message.write(&mut writer, time(i));
    }
    writer.finish().unwrap();
}

fn grid(table: &Table) -> artefact::Result<[f64; 6]> {
    Ok(table.values("velocity_m_s")?.try_into().unwrap())
}

/// All messages of a file in order of time.
fn read(reader: &Reader) -> artefact::Result<Vec<Message>> {
    let mut found = Vec::new();
    for channel in reader.channels() {
        let name = channel.name.as_str();
        for (index, time) in reader.times(name)?.into_iter().enumerate() {
            let message = match name {
                "/particles" => Message::Frame(reader.frame(name, index)?.position_vectors()?),
                "/balance" => Message::Record(reader.record_at(name, index)?.get("mass_kg")?),
                "/section" => Message::Grid(grid(&reader.table_at(name, index)?)?),
                _ => Message::Table(reader.table_at(name, index)?.values("heat_w")?.to_vec()),
            };
            found.push((time, message));
        }
    }
    found.sort_by(|a, b| a.0.total_cmp(&b.0));
    Ok(found.into_iter().map(|(_, message)| message).collect())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(32))]

    #[test]
    fn columns_of_every_type_read_back_bit_for_bit(
        rows in prop::collection::vec((any::<u8>(), any::<u32>(), number(), -1e30_f32..1e30), 0..80),
        time_ns in 0_u64..1_000_000_000_000,
    ) {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("a.mcap");
        let columns = [
            Values::U8(rows.iter().map(|r| r.0).collect()),
            Values::U32(rows.iter().map(|r| r.1).collect()),
            Values::F64(rows.iter().map(|r| r.2).collect()),
            Values::F32(rows.iter().map(|r| r.3).collect()),
        ];
        let mut frame = Frame::new(Precision::F32);
        for (i, values) in columns.iter().enumerate() {
            frame = frame.column(&format!("column{i}"), "m", values.clone());
        }
        let time_s = time_ns as f64 / 1e9;
        let mut writer = Writer::create(&file, &header()).unwrap();
        writer.frame("/particles", time_s, &frame).unwrap();
        writer.finish().unwrap();
        let found = Reader::open(&file).unwrap().frame("/particles", 0).unwrap();
        prop_assert_eq!(found.columns(), frame.columns());
        prop_assert!((found.time_s - time_s).abs() < 1e-9);
    }

    #[test]
    fn messages_read_back_as_written_and_equal_content_has_equal_bytes(messages in messages()) {
        let folder = tempfile::tempdir().unwrap();
        let (a, b) = (folder.path().join("a.mcap"), folder.path().join("b.mcap"));
        write(&a, &messages);
        write(&b, &messages);
        prop_assert_eq!(std::fs::read(&a).unwrap(), std::fs::read(&b).unwrap());
        let reader = Reader::open_kind(&a, "particle-frames", 1).unwrap();
        reader.scrub().unwrap();
        prop_assert_eq!(reader.header(), &header());
        prop_assert_eq!(read(&reader).unwrap(), messages);
    }

    #[test]
    fn any_cut_of_a_partial_file_leaves_a_whole_prefix(
        messages in messages(),
        cut in 0.0..1.0_f64,
    ) {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("a.mcap");
        let part = beside(&file, ".part");
        let mut writer = Writer::create(&file, &header()).unwrap();
        for (i, message) in messages.iter().enumerate() {
            message.write(&mut writer, time(i));
        }
        drop(writer);
        let bytes = std::fs::read(&part).unwrap();
        let kept = (cut * bytes.len() as f64) as usize;
        std::fs::write(&part, &bytes[..kept]).unwrap();
        match recover(&part, &file) {
            Ok(saved) => {
                let reader = Reader::open(&file).unwrap();
                reader.scrub().unwrap();
                let found = read(&reader).unwrap();
                prop_assert_eq!(found.len() as u64, saved.messages);
                prop_assert_eq!(&found[..], &messages[..found.len()]);
            }
            // Not even the header is whole, or no chunk.
            Err(e) => {
                prop_assert!(!file.exists());
                let first = first_chunk(&bytes);
                let limit = match &e {
                    Error::NoStart { .. } | Error::Foreign { .. } => first,
                    Error::Damaged { what, .. } if what.contains("nothing can be saved") => {
                        let length = bytes[first + 1..first + 9].try_into().unwrap();
                        first + 9 + u64::from_le_bytes(length) as usize
                    }
                    other => return Err(TestCaseError::fail(other.to_string())),
                };
                prop_assert!(kept < limit, "{} of {} bytes: {}", kept, limit, e);
            }
        }
        prop_assert_eq!(std::fs::read(&part).unwrap(), &bytes[..kept], "the part stays");
    }

    #[test]
    fn any_flipped_bit_of_a_finished_file_is_found(
        messages in messages(),
        place in 0.0..1.0_f64,
        bit in 0..8_u8,
    ) {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("a.mcap");
        write(&file, &messages);
        let mut bytes = std::fs::read(&file).unwrap();
        let at = (place * bytes.len() as f64) as usize;
        bytes[at] ^= 1 << bit;
        std::fs::write(&file, &bytes).unwrap();
        let found = Reader::open(&file).and_then(|reader| {
            reader.scrub()?;
            read(&reader)
        });
        prop_assert!(found.is_err(), "bit {} of byte {} of {}", bit, at, bytes.len());
    }

    #[test]
    fn a_resumed_file_has_the_bytes_of_an_undisturbed_one(
        messages in messages(),
        kept in 0_usize..12,
        lost in 0_usize..4,
        cut in 0_usize..200,
    ) {
        let folder = tempfile::tempdir().unwrap();
        let (straight, file) = (folder.path().join("a.mcap"), folder.path().join("b.mcap"));
        write(&straight, &messages);
        let kept = kept.min(messages.len());
        let mut writer = Writer::create(&file, &header()).unwrap();
        for (i, message) in messages.iter().enumerate().take(kept) {
            message.write(&mut writer, time(i));
        }
        let position = writer.position().unwrap();
        let part = beside(&file, ".part");
        let whole = std::fs::metadata(&part).unwrap().len();
        prop_assert_eq!(position.total(), kept as u64);
        for (i, message) in messages.iter().enumerate().skip(kept).take(lost) {
            message.write(&mut writer, time(i));
        }
        drop(writer);
        // The crash tears off what was not synced with the checkpoint, perhaps in mid-record.
        let length = std::fs::metadata(&part).unwrap().len();
        let torn = length.saturating_sub(cut as u64).max(whole);
        std::fs::OpenOptions::new().write(true).open(&part).unwrap().set_len(torn).unwrap();
        let mut writer = Writer::resume(&file, &header(), &position).unwrap();
        for (i, message) in messages.iter().enumerate().skip(kept) {
            message.write(&mut writer, time(i));
        }
        writer.finish().unwrap();
        prop_assert!(std::fs::read(&straight).unwrap() == std::fs::read(&file).unwrap());
    }

    #[test]
    fn a_checkpoint_reads_back_bit_for_bit_and_any_flipped_bit_is_found(
        values in prop::collection::vec(any::<f64>(), 0..50),
        ids in prop::collection::vec(any::<u64>(), 0..50),
        flags in prop::collection::vec(any::<u8>(), 0..50),
        place in 0.0..1.0_f64,
        bit in 0..8_u8,
    ) {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("a.mcap.checkpoint");
        let mut checkpoint = Checkpoint::new(&header());
        checkpoint.put_f64("temperature", &values);
        checkpoint.put_u64("id", &ids);
        checkpoint.put_u8("molten", &flags);
        checkpoint.put_json("step", &17).unwrap();
        checkpoint.write(&file).unwrap();
        let mut found = Checkpoint::read(&file, &header()).unwrap();
        let bits = |values: &[f64]| values.iter().map(|x| x.to_bits()).collect::<Vec<_>>();
        prop_assert_eq!(bits(&found.f64("temperature").unwrap()), bits(&values));
        prop_assert_eq!(found.u64("id").unwrap(), ids);
        prop_assert_eq!(found.u8("molten").unwrap(), flags);
        prop_assert_eq!(found.json::<u64>("step").unwrap(), 17);
        let mut bytes = std::fs::read(&file).unwrap();
        let at = (place * bytes.len() as f64) as usize;
        bytes[at] ^= 1 << bit;
        std::fs::write(&file, &bytes).unwrap();
        prop_assert!(Checkpoint::read(&file, &header()).is_err());
        std::fs::write(&file, &bytes[..at]).unwrap();
        prop_assert!(Checkpoint::read(&file, &header()).is_err());
    }
}

/// Where the first chunk begins: behind magic, header and metadata record.
fn first_chunk(bytes: &[u8]) -> usize {
    let mut at = 8;
    while at + 9 <= bytes.len() && bytes[at] != 6 {
        at += 9 + u64::from_le_bytes(bytes[at + 1..at + 9].try_into().unwrap()) as usize;
    }
    at
}

/// A small file of JSON and frames in several chunks, and what it holds.
fn small(file: &Path) -> (Vec<u8>, Vec<Message>) {
    let messages = vec![
        Message::Record(1.5),
        Message::Record(2.5),
        Message::Frame(vec![[0.5, 1.0, -2.0]; 3]),
        Message::Frame(vec![[0.25, 1.0, -2.0]; 2]),
        Message::Grid([0.5, 1.0, -2.0, 0.0, 3.5, 4.5]),
    ];
    write(file, &messages);
    (std::fs::read(file).unwrap(), messages)
}

/// Changes each byte of a small file in turn by the bits of `flip` there, and lets `look` at it and what was written.
fn each_byte(flip: impl Fn(usize) -> u8, look: impl Fn(&Path, &[Message], &str)) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.mcap");
    let (whole, messages) = small(&path);
    let file = File::options().write(true).open(&path).unwrap();
    for (at, byte) in whole.iter().enumerate() {
        file.write_all_at(&[byte ^ flip(at)], at as u64).unwrap();
        look(&path, &messages, &format!("byte {at} of {}", whole.len()));
        file.write_all_at(&[*byte], at as u64).unwrap();
    }
}

#[test]
fn one_reading_gives_the_hash_of_the_file() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.mcap");
    small(&path);
    let hash = Reader::open(&path).unwrap().scrub_and_hash().unwrap();
    assert_eq!(hash, sha256_file(&path).unwrap());
}

#[test]
fn every_single_byte_of_a_file_is_guarded() {
    each_byte(
        |_| 0x10,
        |path, _, byte| {
            let found = Reader::open(path).and_then(|reader| reader.scrub());
            assert!(found.is_err(), "{byte}");
            let hash = Reader::open(path).and_then(|reader| reader.scrub_and_hash());
            assert!(hash.is_err(), "{byte}");
        },
    );
}

#[test]
fn a_reader_that_does_not_look_at_every_byte_still_never_reads_something_else() {
    each_byte(
        |at| 1 << (at % 8),
        |path, messages, byte| {
            if let Ok(found) = Reader::open(path).and_then(|reader| read(&reader)) {
                assert_eq!(found, messages, "{byte}");
            }
        },
    );
}

#[test]
fn two_moments_never_share_a_time() {
    let folder = tempfile::tempdir().unwrap();
    let mut writer = Writer::create(folder.path().join("a.mcap"), &header()).unwrap();
    Message::Record(1.0).write(&mut writer, 1e-9);
    Message::Frame(vec![[0.0; 3]]).write(&mut writer, 1.2e-9);
    let record = Record::new().with("mass_kg", "kg", 2.0);
    let error = writer.record("/balance", 1.2e-9, &record).unwrap_err();
    let text = error.to_string();
    assert!(text.contains("1e-9 s and 1.2e-9 s are both 1 ns"), "{text}");
}

#[test]
fn a_record_names_nothing_twice() {
    let folder = tempfile::tempdir().unwrap();
    let mut writer = Writer::create(folder.path().join("a.mcap"), &header()).unwrap();
    let record = Record::new().with("heat", "W", 1.0).with("heat", "W", 2.0);
    let error = writer.record("/balance", 0.0, &record).unwrap_err();
    assert!(error.to_string().contains("'heat' stands twice"), "{error}");
}
