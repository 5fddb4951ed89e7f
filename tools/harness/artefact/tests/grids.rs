//! Grids in both encodings: the same to a reader, and what is wrong with one is named with its place.

#![allow(clippy::unwrap_used, reason = "a test may fail")]

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::Command;

use artefact::{GRID, Header, METADATA, Reader, TABLE, Table, Version, Writer, beside};
use tempfile::TempDir;

fn header() -> Header {
    Header {
        kind: "mean-fields".to_owned(),
        version: Version::new(1, 1),
        tool: "avg".to_owned(),
        tool_version: "0.1.0".to_owned(),
        scene: serde_json::json!({"kind": "avg.scene", "version": 1}),
        inputs: BTreeMap::new(),
    }
}

/// Means in a plane at x = 0.25 mm; even axes, or not.
fn means(phase: f64, last: f64) -> Table {
    let along: Vec<f64> = (-3..3).map(|i| f64::from(i) * 0.0003).collect();
    let axes = [
        ("y_m", "m", along.as_slice()),
        ("z_m", "m", &[-3e-4, 0.0, last]),
    ];
    Table::grid(&axes)
        .column(
            "velocity_y_m_s",
            "m/s",
            (0..18).map(|i| 0.1 * f64::from(i) + phase),
        )
        .column("temperature_k", "K", (0..18).map(|i| 1800.0 + f64::from(i)))
        .column("frames_liquid", "1", (0..18).map(|i| f64::from(i % 2)))
        .attribute("phase", "1", phase)
        .attribute("x_m", "m", 2.5e-4)
        .in_frame("source")
}

/// A grid of equal cells, and one whose cells differ.
fn even(phase: f64) -> Table {
    means(phase, 3e-4)
}

fn uneven(phase: f64) -> Table {
    means(phase, 4e-4)
}

/// Two phases in both encodings.
fn sample(folder: &Path, name: &str) -> PathBuf {
    let path = folder.join(name);
    let mut writer = Writer::create(&path, &header()).unwrap();
    fill(&mut writer);
    writer.finish().unwrap();
    path
}

fn fill(writer: &mut Writer) {
    for phase in [0.0, 0.5] {
        writer.table("/section", phase, &even(phase)).unwrap();
        writer.table("/stretched", phase, &uneven(phase)).unwrap();
    }
}

/// Writes `from` again with each message changed by `change`, checksums right.
fn rewritten(from: &Path, change: impl Fn(&str, &mut Vec<u8>)) -> PathBuf {
    copied(from, header().to_metadata(), |topic, data| {
        change(topic, data);
        true
    })
}

/// Writes `from` again under other metadata, with the messages that `keep` keeps and may change.
fn copied(
    from: &Path,
    metadata: BTreeMap<String, String>,
    keep: impl Fn(&str, &mut Vec<u8>) -> bool,
) -> PathBuf {
    let bytes = std::fs::read(from).unwrap();
    let mut out = std::io::Cursor::new(Vec::new());
    let mut writer = mcap::Writer::new(&mut out).unwrap();
    let name = METADATA.to_owned();
    let metadata = mcap::records::Metadata { name, metadata };
    writer.write_metadata(&metadata).unwrap();
    for message in mcap::MessageStream::new(&bytes).unwrap() {
        let mut message = message.unwrap();
        let mut data = message.data.to_vec();
        if keep(&message.channel.topic, &mut data) {
            message.data = data.into();
            writer.write(&message).unwrap();
        }
    }
    writer.finish().unwrap();
    drop(writer);
    let to = from.with_file_name("rewritten.mcap");
    std::fs::write(&to, out.into_inner()).unwrap();
    to
}

/// Replaces the first `from`, which must stand there.
fn replace(data: &mut [u8], from: &[u8], to: &[u8]) {
    let at = data.windows(from.len()).position(|w| w == from).unwrap();
    data[at..at + to.len()].copy_from_slice(to);
}

/// Exit code and all that was printed.
fn artefact(arguments: &[&str]) -> (i32, String) {
    let output = Command::new(env!("CARGO_BIN_EXE_artefact"))
        .args(arguments)
        .output()
        .unwrap();
    let text = [output.stdout, output.stderr].concat();
    (
        output.status.code().unwrap(),
        String::from_utf8(text).unwrap(),
    )
}

fn folder() -> TempDir {
    tempfile::tempdir().unwrap()
}

fn text(path: &Path) -> &str {
    path.to_str().unwrap()
}

#[test]
fn a_grid_reads_the_same_whichever_its_encoding() {
    let folder = folder();
    let reader = Reader::open(sample(folder.path(), "a.mcap")).unwrap();
    let schemas: Vec<(String, String)> = reader
        .channels()
        .into_iter()
        .map(|c| (c.name, c.schema))
        .collect();
    let expected = [
        ("/section", GRID),
        ("/section/attributes", artefact::RECORD),
        ("/stretched", TABLE),
    ];
    assert_eq!(schemas, expected.map(|(a, b)| (a.to_owned(), b.to_owned())));
    for (index, phase) in [0.0, 0.5].into_iter().enumerate() {
        for (channel, written) in [("/section", even(phase)), ("/stretched", uneven(phase))] {
            let found = reader.table_at(channel, index).unwrap();
            assert_eq!(found.shape, written.shape);
            assert_eq!(found.axes, written.axes, "to the last bit");
            assert_eq!(found.columns, written.columns);
            assert_eq!(found.attributes, written.attributes);
            assert_eq!(found.frame_id(), "source");
            assert!((found.scalar("phase").unwrap() - phase).abs() < 1e-15);
            let said = found.values("pressure_pa").unwrap_err().to_string();
            assert!(
                said.contains(channel) && said.contains("pressure_pa"),
                "{said}"
            );
        }
    }
}

#[test]
fn a_grid_that_an_older_writer_made_json_is_still_read() {
    let folder = folder();
    let path = folder.path().join("old.mcap");
    let mut old = header();
    old.version = Version::new(1, 0);
    let mut writer = Writer::create(&path, &old).unwrap();
    let schema = include_str!("../../../../schemas/table.v1.json");
    writer
        .json("/section", 0.5, (TABLE, schema), &even(0.5))
        .unwrap();
    writer.finish().unwrap();
    let found = Reader::open_kind(&path, "mean-fields", 1)
        .unwrap()
        .table("/section")
        .unwrap();
    assert_eq!(
        (found.axes, found.columns),
        (even(0.5).axes, even(0.5).columns)
    );
    assert_eq!(found.attributes, even(0.5).attributes);
}

#[test]
fn the_record_of_the_header_names_the_unit_of_every_column() {
    let folder = folder();
    let path = folder.path().join("a.mcap");
    let mut writer = Writer::create(&path, &header()).unwrap();
    fill(&mut writer);
    let frame = artefact::Frame::new(artefact::Precision::F32)
        .positions([[0.0; 3]])
        .scalar("temperature", "K", [300.0]);
    writer.frame("/particles", 0.5, &frame).unwrap();
    writer.finish().unwrap();
    let reader = Reader::open(&path).unwrap();
    let record = reader.metadata(METADATA).unwrap();
    let units: BTreeMap<String, BTreeMap<String, String>> =
        serde_json::from_str(&record["units"]).unwrap();
    assert_eq!(units["/particles"]["temperature"], "K");
    for channel in ["/section", "/stretched"] {
        for (column, unit) in [
            ("velocity_y_m_s", "m/s"),
            ("temperature_k", "K"),
            ("y_m", "m"),
            ("phase", "1"),
        ] {
            assert_eq!(units[channel][column], unit, "{channel} {column}");
        }
    }
    for (key, value) in header().to_metadata() {
        assert_eq!(record[&key], value, "{key}");
    }
    for channel in reader.channels() {
        assert_eq!(units[&channel.name], channel.units);
    }
}

#[test]
fn units_that_are_not_those_of_the_channels_are_named() {
    let folder = folder();
    let whole = sample(folder.path(), "a.mcap");
    let reader = Reader::open(&whole).unwrap();
    let mut record = reader.metadata(METADATA).unwrap().clone();
    let units = record.get_mut("units").unwrap();
    *units = units.replacen("\"temperature_k\":\"K\"", "\"temperature_k\":\"C\"", 1);
    let path = copied(&whole, record, |_, _| true);
    let (code, said) = artefact(&["validate", text(&path)]);
    assert_eq!(code, 1);
    let what = "units: channel '/section', column 'temperature_k': 'C', the channel says 'K'";
    assert!(said.contains(what), "{said}");
    // A file that says it in the channels alone.
    let path = rewritten(&whole, |_, _| ());
    assert_eq!(artefact(&["validate", text(&path)]).0, 0);
}

#[test]
fn what_does_not_fit_is_refused_by_the_writer() {
    let folder = folder();
    let mut writer = Writer::create(folder.path().join("a.mcap"), &header()).unwrap();
    let mut table = even(0.0);
    table.columns[1].values[7] = f64::NAN;
    let said = writer.table("/section", 0.0, &table).unwrap_err();
    assert!(
        said.to_string()
            .contains("channel '/section', column 'temperature_k', entry 7: NaN"),
        "{said}"
    );
    let mut table = even(0.0);
    table.columns[1].values.pop();
    let said = writer.table("/section", 0.0, &table).unwrap_err();
    assert!(said.to_string().contains("17 entries"), "{said}");
    writer.table("/section", 0.0, &even(0.0)).unwrap();
    let mut table = even(0.5);
    for y in &mut table.axes[0].values {
        *y += 3e-4;
    }
    let said = writer.table("/section", 0.5, &table).unwrap_err();
    assert!(said.to_string().contains("axes"), "{said}");
    let said = writer.table("/section", 0.5, &uneven(0.5)).unwrap_err();
    assert!(said.to_string().contains("'/section'"), "{said}");
    writer.table("/section", 0.5, &even(0.5)).unwrap();
}

#[test]
fn a_spoilt_grid_is_named_by_file_channel_and_message() {
    let folder = folder();
    let whole = sample(folder.path(), "a.mcap");
    let bytes = |stride: u32| [vec![0x35], stride.to_le_bytes().to_vec()].concat();
    type Change<'a> = &'a dyn Fn(&mut Vec<u8>);
    let cases: [(Change<'_>, &str); 3] = [
        (
            &|data| replace(data, &bytes(72), &bytes(71)),
            "a row of 71 bytes is not 3 cells of 24 bytes",
        ),
        (&|data| data.truncate(data.len() - 1), "not a grid"),
        (&Vec::clear, "0 columns, the second axis has 3 entries"),
    ];
    for (change, what) in cases {
        let path = rewritten(&whole, |topic, data| {
            if topic == "/section" {
                change(data);
            }
        });
        let said = Reader::open(&path).unwrap().table("/section").unwrap_err();
        let said = said.to_string();
        assert!(said.contains("rewritten.mcap"), "{said}");
        assert!(said.contains("channel '/section', message 0: "), "{said}");
        assert!(said.contains(what), "{said}");
        for command in ["validate", "info"] {
            let (code, said) = artefact(&[command, text(&path)]);
            assert_eq!(code, 1, "{said}");
            assert!(said.contains(what), "{command}: {said}");
        }
    }
}

#[test]
fn scalars_that_lost_their_grid_are_named() {
    let folder = folder();
    let whole = sample(folder.path(), "a.mcap");
    let path = copied(&whole, header().to_metadata(), |topic, _| {
        topic != "/section/attributes"
    });
    let said = Reader::open(&path).unwrap().table("/section").unwrap_err();
    assert!(
        said.to_string()
            .contains("no channel '/section/attributes'"),
        "{said}"
    );
}

#[test]
fn a_nan_from_elsewhere_survives_and_is_named() {
    let folder = folder();
    let whole = sample(folder.path(), "a.mcap");
    let path = rewritten(&whole, |topic, data| {
        if topic == "/section" {
            replace(data, &1805.0_f64.to_le_bytes(), &f64::NAN.to_le_bytes());
        }
    });
    let table = Reader::open(&path).unwrap().table("/section").unwrap();
    let found = table.values("temperature_k").unwrap();
    assert!(found[5].is_nan() && found.iter().filter(|x| x.is_nan()).count() == 1);
    let (code, said) = artefact(&["validate", text(&path)]);
    assert_eq!(code, 1);
    let what = "channel '/section', t = 0.5 s, column 'temperature_k', row 5: NaN";
    assert!(said.contains(what), "{said}");
    let (code, said) = artefact(&["diff", text(&whole), text(&path)]);
    assert_eq!(code, 1);
    assert!(
        said.contains("temperature_k") && said.contains("NaN"),
        "{said}"
    );
    let out = folder.path().join("csv");
    let arguments = ["export", text(&path), "--to", "csv", "--out", text(&out)];
    assert_eq!(artefact(&arguments).0, 0);
    let rows = std::fs::read_to_string(out.join("section/section_00000.csv")).unwrap();
    assert_eq!(rows.matches("NaN").count(), 1, "{rows}");
}

#[test]
fn every_command_knows_both_encodings() {
    let folder = folder();
    let (a, b) = (
        sample(folder.path(), "a.mcap"),
        sample(folder.path(), "b.mcap"),
    );
    assert_eq!(std::fs::read(&a).unwrap(), std::fs::read(&b).unwrap());
    let (code, said) = artefact(&["info", text(&a)]);
    assert_eq!(code, 0, "{said}");
    for line in [
        "/section  foxglove.Grid  2 messages, 0 s to 0.5 s",
        "/stretched  fusionline.table.v1  2 messages, 0 s to 0.5 s",
        "  last: 6 x 3 nodes",
        "  temperature_k                    K        f64  1800 .. 1817",
        "  phase                            1        f64  0.5",
    ] {
        assert!(said.lines().any(|l| l == line), "{line}\n{said}");
    }
    let (code, said) = artefact(&["ls", text(&a), "--channel", "/section"]);
    assert_eq!((code, said.matches("18 nodes").count()), (0, 2), "{said}");
    let (code, said) = artefact(&["validate", text(&a)]);
    assert_eq!(code, 0, "{said}");
    let (code, said) = artefact(&["diff", text(&a), text(&b), "--all"]);
    assert_eq!(code, 0, "{said}");
    assert!(said.ends_with("messages: equal; bytes: equal\n"), "{said}");
    assert_eq!(artefact(&["verify-hash", text(&a)]).0, 0);

    let mut exported = BTreeMap::new();
    for (to, suffixes) in [
        ("vtu", ["vti", "vtr"]),
        ("npz", ["npz", "npz"]),
        ("csv", ["csv", "csv"]),
    ] {
        let out = folder.path().join(to);
        let (code, said) = artefact(&["export", text(&a), "--to", to, "--out", text(&out)]);
        assert_eq!(code, 0, "{said}");
        for (name, suffix) in ["section", "stretched"].into_iter().zip(suffixes) {
            let file = out.join(format!("{name}/{name}_00001.{suffix}"));
            exported.insert((to, name), std::fs::read(file).unwrap());
        }
    }
    let rows = String::from_utf8(exported[&("csv", "section")].clone()).unwrap();
    let expected = "y_m [m],z_m [m],velocity_y_m_s [m/s],temperature_k [K],frames_liquid [1],phase [1],x_m [m]";
    assert_eq!(rows.lines().next().unwrap(), expected);
    assert_eq!(rows.lines().count(), 19);
    let vti = String::from_utf8_lossy(&exported[&("vtu", "section")]).into_owned();
    assert!(vti.contains("WholeExtent=\"0 0 0 5 0 2\""), "{vti}");
}

#[test]
fn diff_compares_a_grid_with_the_same_grid_as_an_older_writer_stored_it() {
    let folder = folder();
    let a = sample(folder.path(), "a.mcap");
    let old = folder.path().join("old.mcap");
    let mut writer = Writer::create(&old, &header()).unwrap();
    let schema = include_str!("../../../../schemas/table.v1.json");
    let json = (TABLE, schema);
    writer.json("/section", 0.0, json, &even(0.0)).unwrap();
    writer.json("/section", 0.5, json, &even(0.25)).unwrap();
    writer.finish().unwrap();
    let only = ["diff", text(&a), text(&old), "--channel", "/section"];
    let (code, said) = artefact(&only);
    assert_eq!(code, 1, "{said}");
    let holds = "holds foxglove.Grid in A, fusionline.table.v1 in B";
    assert!(said.contains(holds), "{said}");
    let row = |name: &str| said.lines().find(|l| l.contains(name)).map(str::to_owned);
    assert!(
        row("velocity_y_m_s").unwrap().contains(" 2.5000e-1 "),
        "{said}"
    );
    assert_eq!(row("temperature_k"), None, "{said}");
}

#[test]
fn a_grid_is_saved_with_its_scalars_from_a_run_that_was_killed() {
    let folder = folder();
    let path = folder.path().join("mean.mcap");
    let mut writer = Writer::create(&path, &header()).unwrap();
    fill(&mut writer);
    drop(writer);
    let part = beside(&path, ".part");
    let (code, said) = artefact(&["recover", text(&part)]);
    assert_eq!(code, 0, "{said}");
    // Two grids, the two records beside them, and the table that was written before the second.
    assert!(said.contains("5 messages saved"), "{said}");
    let saved = folder.path().join("mean.recovered.mcap");
    assert_eq!(artefact(&["validate", text(&saved)]).0, 0);
    let reader = Reader::open(&saved).unwrap();
    let found = reader.table_at("/section", 1).unwrap();
    assert_eq!(found.attributes, even(0.5).attributes);
    assert_eq!(found.columns, even(0.5).columns);
    assert_eq!(found.frame_id(), "source");
}
