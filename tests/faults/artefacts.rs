//! Files that are damaged, cut, foreign, of another kind, newer, or hold what is no number.

use std::path::Path;

use artefact::{Error, Header, Reader, Version, Writer};
use mcap::records::Metadata;

use crate::workplace::{Place, fill, header, program, tell, told};

/// What stood at the output before must stand there after a failed run.
fn keeps_the_old_output(place: &Place, frames: &Path, words: &[&str]) {
    let old = place.file("mean.mcap", "an older result");
    let told = place.average(frames);
    told.must(1, words);
    told.must(1, &[frames.to_str().unwrap()]);
    assert_eq!(std::fs::read(old).unwrap(), b"an older result");
}

#[test]
fn a_sound_file_is_averaged_and_found_good() {
    let place = Place::new();
    let frames = place.frames("pool.mcap", &header());
    tell("artefact", &["validate".as_ref(), frames.as_os_str()]).must(0, &["good"]);
    let told = place.average(&frames);
    assert!([0, 3].contains(&told.code), "{}", told.err);
    let out = place.path("mean.mcap");
    tell("artefact", &["validate".as_ref(), out.as_os_str()]).must(0, &["good: mean-fields"]);
}

#[test]
fn a_flipped_byte_is_found_by_its_checksum() {
    let place = Place::new();
    let whole = std::fs::read(place.frames("whole.mcap", &header())).unwrap();
    // In the compressed points of the first chunk.
    let mut bytes = whole.clone();
    bytes[1200] ^= 0x40;
    let frames = place.file("pool.mcap", &bytes);
    let validate = ["validate".as_ref(), frames.as_os_str()];
    tell("artefact", &validate).must(1, &["damaged: CRC of the data", "recorded is"]);
    keeps_the_old_output(&place, &frames, &["damaged", "CRC of the data"]);
    // `check` reads no frame, and finds it all the same.
    let mut check = std::process::Command::new(program("avg"));
    let input = format!("frames={}", frames.display());
    check.arg("check").arg(place.scene());
    check.args(["--input", &input]);
    told(&mut check).must(1, &["damaged", "CRC of the data"]);
    // In the index at the end.
    let mut bytes = whole.clone();
    let at = bytes.len() - 100;
    bytes[at] ^= 0x40;
    let frames = place.file("pool.mcap", &bytes);
    tell("artefact", &validate).must(1, &["damaged: CRC of the summary"]);
    keeps_the_old_output(&place, &frames, &["damaged", "summary"]);
    // Without its index nothing can be exported; what is advised saves all of it.
    let out = place.path("csv");
    let mut export = std::process::Command::new(program("artefact"));
    export.arg("export").arg(&frames).args(["--to", "csv"]);
    let advice = format!("'artefact recover {}' saves", frames.display());
    told(export.arg("--out").arg(&out)).must(1, &["CRC of the summary", &advice]);
    tell("artefact", &["recover".as_ref(), frames.as_os_str()]).must(0, &["10 messages saved"]);
}

#[test]
fn a_truncated_file_says_how_to_save_it_and_can_be_saved() {
    let place = Place::new();
    let whole = std::fs::read(place.frames("whole.mcap", &header())).unwrap();
    let frames = place.file("pool.mcap", &whole[..whole.len() / 2]);
    keeps_the_old_output(&place, &frames, &["truncated", "artefact recover"]);
    let validate = ["validate".as_ref(), frames.as_os_str()];
    tell("artefact", &validate).must(1, &["truncated", "artefact recover"]);
    tell("artefact", &["recover".as_ref(), frames.as_os_str()]).must(0, &["messages saved"]);
    let saved = place.path("pool.recovered.mcap");
    tell("artefact", &["validate".as_ref(), saved.as_os_str()]).must(0, &["good"]);
    assert!(Reader::open(saved).unwrap().count("/pool") >= 1);
}

#[test]
fn a_foreign_file_is_called_foreign() {
    let place = Place::new();
    let text = place.file("pool.mcap", "time, x, y\n0, 1, 2\n");
    keeps_the_old_output(
        &place,
        &text,
        &["not an artefact", "an MCAP file begins with"],
    );
    let empty = place.file("pool.mcap", "");
    keeps_the_old_output(&place, &empty, &["not an artefact", "it is empty"]);
    let absent = place.path("absent.mcap");
    place
        .average(&absent)
        .must(2, &["absent.mcap", "no such file"]);
}

#[test]
fn an_mcap_file_that_no_tool_of_ours_wrote_is_told_apart() {
    let place = Place::new();
    let path = place.path("pool.mcap");
    let file = std::fs::File::create(&path).unwrap();
    let mut writer = mcap::Writer::new(std::io::BufWriter::new(file)).unwrap();
    writer.finish().unwrap();
    keeps_the_old_output(&place, &path, &["not one of ours", "'fusionline'"]);
}

#[test]
fn another_kind_is_refused_with_both_names() {
    let place = Place::new();
    let arc = Header {
        kind: "arc-source".to_owned(),
        tool: "arcfvm".to_owned(),
        scene: serde_json::json!({"kind": "arcfvm.scene", "version": 1}),
        ..header()
    };
    let path = place.frames("arc.mcap", &arc);
    keeps_the_old_output(&place, &path, &["'arc-source'", "'particle-frames'"]);
    // What contradicts itself is refused for that.
    let both = Header {
        kind: "arc-source".to_owned(),
        ..header()
    };
    let path = place.frames("both.mcap", &both);
    keeps_the_old_output(&place, &path, &["of kind 'arc-source' by 'poolsph'"]);
}

#[test]
fn a_newer_major_version_is_refused_and_a_newer_minor_one_is_read() {
    let place = Place::new();
    let of = |major, minor| Header {
        version: Version::new(major, minor),
        ..header()
    };
    let newer = place.frames("pool.mcap", &of(2, 0));
    keeps_the_old_output(&place, &newer, &["version 2.0", "reads version 1.x"]);
    let minor = place.frames("pool.mcap", &of(1, 9));
    let told = place.average(&minor);
    assert!([0, 3].contains(&told.code), "{}", told.err);
}

#[test]
fn a_missing_channel_is_told_with_those_that_are_there() {
    let place = Place::new();
    let path = place.path("pool.mcap");
    let mut writer = Writer::create(&path, &header()).unwrap();
    let record = artefact::Record::new().with("mass_kg", "kg", 0.25);
    writer.record("/balance", 0.0, &record).unwrap();
    writer.finish().unwrap();
    place
        .average(&path)
        .must(1, &["no channel '/pool'", "it has /balance"]);
}

/// Writes `from` again with each message changed by `change`, checksums right.
fn rewritten(
    place: &Place,
    name: &str,
    change: impl Fn(&str, u64, &mut Vec<u8>),
) -> std::path::PathBuf {
    let from = std::fs::read(place.frames("whole.mcap", &header())).unwrap();
    let mut bytes = std::io::Cursor::new(Vec::new());
    let mut writer = mcap::Writer::new(&mut bytes).unwrap();
    let metadata = Metadata {
        name: artefact::METADATA.to_owned(),
        metadata: header().to_metadata(),
    };
    writer.write_metadata(&metadata).unwrap();
    for message in mcap::MessageStream::new(&from).unwrap() {
        let mut message = message.unwrap();
        let mut data = message.data.to_vec();
        change(&message.channel.topic, message.log_time, &mut data);
        message.data = data.into();
        writer.write(&message).unwrap();
    }
    writer.finish().unwrap();
    drop(writer);
    place.file(name, bytes.into_inner())
}

/// Replaces `from`, which must stand there, by `to` of the same length.
fn replace(data: &mut [u8], from: &[u8], to: &[u8]) {
    let at = data.windows(from.len()).position(|w| w == from).unwrap();
    data[at..at + to.len()].copy_from_slice(to);
}

#[test]
fn a_nan_in_a_frame_is_named_by_channel_time_column_and_row() {
    let place = Place::new();
    let path = rewritten(&place, "pool.mcap", |topic, time, data| {
        if topic == "/pool" && time == 500_000_000 {
            // The temperature of particle 17.
            replace(data, &1817.0_f32.to_le_bytes(), &f32::NAN.to_le_bytes());
        }
    });
    tell("artefact", &["validate".as_ref(), path.as_os_str()]).must(
        1,
        &["channel '/pool', t = 0.5 s, column 'temperature', row 17: NaN"],
    );
}

#[test]
fn what_is_no_number_in_a_table_is_named_by_column_and_row() {
    let place = Place::new();
    let path = rewritten(&place, "pool.mcap", |topic, _, data| {
        if topic == "/surface" {
            let text = String::from_utf8(data.clone()).unwrap();
            assert!(text.contains("0.002"), "{text}");
            *data = text.replace("0.002", "null").into_bytes();
        }
    });
    tell("artefact", &["validate".as_ref(), path.as_os_str()]).must(
        1,
        &["channel '/surface', t = 0 s, column 'radius_m', row 2: null"],
    );
    let path = rewritten(&place, "pool.mcap", |topic, _, data| {
        if topic == "/surface" {
            *data = String::from_utf8(data.clone())
                .unwrap()
                .replace("0.002", "1e999")
                .into_bytes();
        }
    });
    tell("artefact", &["validate".as_ref(), path.as_os_str()])
        .must(1, &["channel '/surface', message 0", "out of range"]);
}

#[test]
fn a_message_that_does_not_fit_its_schema_is_found() {
    let place = Place::new();
    let path = rewritten(&place, "pool.mcap", |topic, time, data| {
        if topic == "/balance" && time == 250_000_000 {
            replace(data, b"\"unit\"", b"\"Unit\"");
        }
    });
    tell("artefact", &["validate".as_ref(), path.as_os_str()])
        .must(1, &["channel '/balance', t = 0.25 s", "unit"]);
}

#[test]
fn a_run_is_not_taken_up_with_another_scene() {
    let place = Place::new();
    let path = place.path("pool.mcap");
    let mut writer = Writer::create(&path, &header()).unwrap();
    fill(&mut writer);
    let position = writer.position().unwrap();
    drop(writer);
    let mut other = header();
    other.scene["spacing_m"] = 1e-3.into();
    let part = artefact::beside(&path, ".part");
    let before = std::fs::read(&part).unwrap();
    let error = Writer::resume(&path, &other, &position).unwrap_err();
    assert!(
        matches!(&error, Error::NotSame { what, .. } if what == "scene"),
        "{error}"
    );
    assert_eq!(std::fs::read(&part).unwrap(), before);
    let newer = Header {
        tool_version: "0.2.0".to_owned(),
        ..header()
    };
    let error = Writer::resume(&path, &newer, &position).unwrap_err();
    assert!(
        error
            .to_string()
            .contains("tool version 0.1.0, this run has 0.2.0"),
        "{error}"
    );
}
