//! The program `artefact` as a user meets it: what it prints, and its exit codes.

#![allow(clippy::unwrap_used, reason = "a test may fail")]

use std::path::{Path, PathBuf};
use std::process::Command;

use artefact::{Frame, Header, Precision, Record, Table, Version, Writer, beside};
use tempfile::TempDir;

/// What a call printed and how it ended.
struct Told {
    code: i32,
    out: String,
    err: String,
}

fn artefact<S: AsRef<std::ffi::OsStr>>(arguments: &[S]) -> Told {
    let output = Command::new(env!("CARGO_BIN_EXE_artefact"))
        .args(arguments)
        .output()
        .unwrap();
    Told {
        code: output.status.code().unwrap(),
        out: String::from_utf8(output.stdout).unwrap(),
        err: String::from_utf8(output.stderr).unwrap(),
    }
}

fn scene() -> serde_json::Value {
    serde_json::json!({
        "kind": "poolsph.scene", "version": 2, "title": "A drop", "spacing_m": 5e-4,
        "time": {"step_s": 1e-4, "end_s": 2.0}
    })
}

fn header() -> Header {
    Header {
        kind: "particle-frames".to_owned(),
        version: Version::new(1, 0),
        tool: "poolsph".to_owned(),
        tool_version: "0.1.0".to_owned(),
        scene: scene(),
        inputs: [("arc".to_owned(), artefact::sha256(b"arc bytes"))].into(),
    }
}

/// A small file: two frames whose second is hotter by `more` at particle 1, a table, two records.
fn sample(folder: &Path, name: &str, more: f64) -> PathBuf {
    let path = folder.join(name);
    let mut writer = Writer::create(&path, &header()).unwrap();
    fill(&mut writer, more);
    writer.finish().unwrap();
    path
}

fn fill(writer: &mut Writer, more: f64) {
    for (time, hot) in [(0.0, 0.0), (0.5, more)] {
        let frame = Frame::new(Precision::F64)
            .positions([[0.0, 0.0, 0.0], [1e-3, 0.0, 0.0]])
            .scalar("temperature", "K", [300.0, 400.0 + hot])
            .id("id", [0, 1]);
        writer.frame("/particles", time, &frame).unwrap();
        let record = Record::new().with("mass_kg", "kg", 0.25);
        writer.record("/balance", time, &record).unwrap();
    }
    let table = Table::new(2).column("radius_m", "m", [0.0, 1e-3]);
    writer.table("/surface", 0.0, &table).unwrap();
}

fn folder() -> TempDir {
    tempfile::tempdir().unwrap()
}

fn text(path: &Path) -> &str {
    path.to_str().unwrap()
}

#[test]
fn info_tells_who_wrote_what_with_units_and_ranges() {
    let folder = folder();
    let told = artefact(&["info", text(&sample(folder.path(), "a.mcap", 50.0))]);
    assert_eq!(told.code, 0, "{}", told.err);
    for line in [
        "kind        particle-frames 1.0",
        "tool        poolsph 0.1.0",
        "title       A drop",
        &format!("scene       sha256 {}", header().scene_sha256()),
        &format!("input       arc sha256 {}", artefact::sha256(b"arc bytes")),
        "/particles  foxglove.PointCloud  2 messages, 0 s to 0.5 s",
        "  last: 2 points",
        "  temperature                      K        f64  300 .. 450",
        "  mass_kg                          kg       f64  0.25",
        "/surface  fusionline.table.v1  1 message, at 0 s",
    ] {
        assert!(told.out.lines().any(|l| l == line), "{line}\n{}", told.out);
    }
    let told = artefact(&["info", "--scene", text(&folder.path().join("a.mcap"))]);
    let found: serde_json::Value = serde_json::from_str(&told.out).unwrap();
    assert_eq!(found, scene());
}

#[test]
fn ls_lists_messages_in_order_of_time() {
    let folder = folder();
    let told = artefact(&["ls", text(&sample(folder.path(), "a.mcap", 0.0))]);
    assert_eq!(told.code, 0, "{}", told.err);
    let words: Vec<Vec<&str>> = told
        .out
        .lines()
        .map(|l| l.split_whitespace().collect())
        .collect();
    assert_eq!(
        words,
        [
            ["0", "/balance", "0", "1", "values"],
            ["0", "/particles", "0", "2", "points"],
            ["0", "/surface", "0", "2", "rows"],
            ["0.5", "/balance", "1", "1", "values"],
            ["0.5", "/particles", "1", "2", "points"],
        ]
    );
}

#[test]
fn a_name_of_any_length_is_listed() {
    let folder = folder();
    let path = folder.path().join("long.mcap");
    let mut writer = Writer::create(&path, &header()).unwrap();
    let name = format!("/{}", "long".repeat(20_000));
    let record = Record::new().with("mass_kg", "kg", 0.25);
    writer.record(&name, 0.0, &record).unwrap();
    writer.record("/short", 0.0, &record).unwrap();
    writer.finish().unwrap();
    for command in ["ls", "info", "validate"] {
        let told = artefact(&[command, text(&path)]);
        assert_eq!(told.code, 0, "{command}: {}", told.err);
    }
}

#[test]
fn diff_measures_what_differs_and_says_where() {
    let folder = folder();
    let a = sample(folder.path(), "a.mcap", 0.0);
    let same = sample(folder.path(), "same.mcap", 0.0);
    let told = artefact(&["diff", text(&a), text(&same)]);
    assert_eq!(told.code, 0, "{}", told.err);
    assert!(
        told.out.ends_with("messages: equal; bytes: equal\n"),
        "{}",
        told.out
    );

    let b = sample(folder.path(), "b.mcap", 3.0);
    let told = artefact(&["diff", text(&a), text(&b)]);
    assert_eq!(told.code, 1);
    assert!(
        told.out
            .ends_with("messages: different; bytes: different\n")
    );
    let row = told
        .out
        .lines()
        .find(|l| l.contains("temperature"))
        .unwrap();
    let words: Vec<&str> = row.split_whitespace().collect();
    // 3 K at one of four entries; the squares of A add up to 2 (300^2 + 400^2) K^2.
    assert_eq!(
        words[2..],
        ["3.0000e0", "1.5000e0", "4.2426e-3", "1", "0.5,", "1"],
        "{row}"
    );
    assert!(told.out.contains("/surface: equal (1 messages)"));
}

#[test]
fn diff_refuses_a_channel_that_neither_file_has() {
    let folder = folder();
    let a = sample(folder.path(), "a.mcap", 0.0);
    let b = sample(folder.path(), "b.mcap", 3.0);
    let told = artefact(&["diff", text(&a), text(&b), "--channel", "/nope"]);
    assert_eq!(told.code, 2, "{}", told.out);
    assert!(
        told.err.contains("'/nope'") && !told.out.contains("equal"),
        "{}",
        told.err
    );
}

#[test]
fn a_depth_lies_below_the_surface_and_a_temperature_is_no_place() {
    let folder = folder();
    let file = folder.path().join("arc.mcap");
    let mut writer = Writer::create(&file, &header()).unwrap();
    let grid = |axes: &[(&str, &str, &[f64])]| {
        Table::grid(axes).column("value", "1", (0..6).map(|n| 1000.0 + f64::from(n)))
    };
    let force = grid(&[
        ("radius_m", "m", &[0.0, 1.0]),
        ("depth_m", "m", &[0.5, 1.0, 3.0]),
    ]);
    writer.table("/lorentz", 0.0, &force).unwrap();
    let gas = grid(&[
        ("temperature_k", "K", &[300.0, 400.0]),
        ("iron", "1", &[0.0, 0.5, 1.0]),
    ]);
    writer.table("/gas", 0.0, &gas).unwrap();
    writer.finish().unwrap();
    let out = folder.path().join("out");
    let told = artefact(&["export", text(&file), "--to", "vtu", "--out", text(&out)]);
    assert_eq!(told.code, 0, "{}", told.err);
    let bytes = std::fs::read(out.join("lorentz/lorentz_00000.vtr")).unwrap();
    let at = |values: &[f64]| {
        let wanted: Vec<u8> = values.iter().flat_map(|v| v.to_le_bytes()).collect();
        bytes.windows(wanted.len()).any(|w| w == wanted)
    };
    assert!(at(&[-3.0, -1.0, -0.5]) && !at(&[0.5, 1.0, 3.0]));
    // From the deepest nodes upwards, the radius fastest.
    assert!(at(&[1002.0, 1005.0, 1001.0, 1004.0, 1000.0, 1003.0]));
    assert!(out.join("gas/gas_00000.csv").is_file());
}

#[test]
fn diff_tells_scenes_apart_and_does_not_count_them() {
    let folder = folder();
    let a = sample(folder.path(), "a.mcap", 0.0);
    let b = folder.path().join("b.mcap");
    let mut other = header();
    other.scene["time"]["end_s"] = 3.0.into();
    let mut writer = Writer::create(&b, &other).unwrap();
    fill(&mut writer, 0.0);
    writer.finish().unwrap();
    let told = artefact(&["diff", text(&a), text(&b)]);
    assert_eq!(told.code, 0, "{}", told.out);
    assert!(
        told.out.contains("scene time.end_s: 2 | 3\n"),
        "{}",
        told.out
    );
    assert!(told.out.ends_with("messages: equal; bytes: different\n"));
}

#[test]
fn diff_finds_a_particle_by_its_id() {
    let folder = folder();
    let mut files = Vec::new();
    for (name, order) in [("a.mcap", [0_u32, 1, 2]), ("b.mcap", [2, 0, 1])] {
        let path = folder.path().join(name);
        let mut writer = Writer::create(&path, &header()).unwrap();
        let frame = Frame::new(Precision::F64)
            .scalar("temperature", "K", order.map(|id| 300.0 + f64::from(id)))
            .id("id", order);
        writer.frame("/particles", 0.0, &frame).unwrap();
        writer.finish().unwrap();
        files.push(path);
    }
    let told = artefact(&["diff", text(&files[0]), text(&files[1])]);
    assert_eq!(told.code, 0, "{}", told.out);
    assert!(told.out.ends_with("messages: equal; bytes: different\n"));
}

#[test]
fn what_a_killed_run_left_is_saved_and_read_as_it_is() {
    let folder = folder();
    let path = folder.path().join("pool.mcap");
    let mut writer = Writer::create(&path, &header()).unwrap();
    fill(&mut writer, 0.0);
    drop(writer);
    let part = beside(&path, ".part");
    assert!(part.exists() && !path.exists());

    let told = artefact(&["info", text(&part)]);
    assert_eq!(told.code, 0, "{}", told.err);
    assert!(told.err.contains("not finished"), "{}", told.err);

    let told = artefact(&["recover", text(&part)]);
    assert_eq!(told.code, 0, "{}", told.err);
    // The records and the table behind the last frame waited for their chunk and are gone.
    assert!(told.out.contains("3 messages saved"), "{}", told.out);
    let saved = folder.path().join("pool.recovered.mcap");
    assert!(part.exists(), "the partial file stays");
    let told = artefact(&["validate", text(&saved)]);
    assert_eq!(told.code, 0, "{}", told.out);
    let told = artefact(&["info", text(&saved)]);
    assert!(
        told.out
            .contains("recovered   from a run that did not finish: 3 messages saved")
    );

    let told = artefact(&["recover", text(&part)]);
    assert_eq!(told.code, 2, "never writes over a file unasked");
    assert!(told.err.contains("--force"), "{}", told.err);
    let told = artefact(&["recover", text(&part), "--out", text(&part)]);
    assert_eq!(told.code, 2, "never writes over its source");
    // Under its final name, whose partial file is the source itself.
    let told = artefact(&["recover", text(&part), "--out", text(&path)]);
    assert_eq!(told.code, 0, "{}", told.err);
    assert!(part.exists(), "the partial file stays");
}

/// Where each chunk begins, and how long it is.
fn chunks(bytes: &[u8]) -> Vec<(usize, usize)> {
    let mut found = Vec::new();
    let mut at = 8;
    while at + 9 < bytes.len() {
        let length = u64::from_le_bytes(bytes[at + 1..at + 9].try_into().unwrap()) as usize;
        if bytes[at] == 6 {
            found.push((at, 9 + length));
        }
        at += 9 + length;
    }
    found
}

#[test]
fn a_flipped_byte_in_the_first_chunk_costs_that_chunk_alone() {
    let folder = folder();
    let path = sample(folder.path(), "pool.mcap", 0.0);
    let whole = std::fs::read(&path).unwrap();
    let (at, length) = chunks(&whole)[0];
    let mut bytes = whole.clone();
    bytes[at + length - 5] ^= 0x40;
    let path = folder.path().join("bad.mcap");
    std::fs::write(&path, &bytes).unwrap();
    let all = artefact::Reader::open(folder.path().join("pool.mcap")).unwrap();

    let told = artefact(&["recover", text(&path)]);
    assert_eq!(told.code, 0, "{}", told.err);
    let saved = folder.path().join("bad.recovered.mcap");
    let words = format!("lost: the chunk at byte {at} with 1 of /particles, 0 s to 0 s");
    assert!(told.out.contains(&words), "{}", told.out);
    assert_eq!(artefact(&["validate", text(&saved)]).code, 0);
    let reader = artefact::Reader::open(&saved).unwrap();
    assert_eq!(reader.count("/particles") + 1, all.count("/particles"));
    for channel in ["/balance", "/surface"] {
        assert_eq!(reader.count(channel), all.count(channel), "{channel}");
    }
    let told = artefact(&["info", text(&saved)]);
    assert!(told.out.contains("1 damaged chunks"), "{}", told.out);

    let out = folder.path().join("csv");
    let told = artefact(&["export", text(&path), "--to", "csv", "--out", text(&out)]);
    assert_eq!(told.code, 1, "{}{}", told.out, told.err);
    assert!(told.err.contains("warning: "), "{}", told.err);
    assert!(told.err.contains(&words), "{}", told.err);
    for name in ["particles/particles_00000.csv", "balance.csv"] {
        assert!(out.join(name).exists(), "{name}: {}", told.out);
    }

    // Without the end, too: then the indices behind the third chunk tell what was in it.
    let (next, more) = chunks(&whole)[2];
    let part = folder.path().join("cut.mcap.part");
    let mut bytes = whole[..whole.len() - 20].to_vec();
    bytes[next + more - 5] ^= 0x40;
    std::fs::write(&part, &bytes).unwrap();
    let told = artefact(&["recover", text(&part)]);
    assert_eq!(told.code, 0, "{}", told.err);
    let words = format!("lost: the chunk at byte {next} with 1 of /particles, 0.5 s to 0.5 s");
    assert!(told.out.contains(&words), "{}", told.out);
    assert!(told.out.contains("4 messages saved"), "{}", told.out);
}

#[test]
fn unknown_kinds_and_newer_majors_are_refused_by_every_command() {
    let folder = folder();
    let of = |name: &str, kind: &str, version: Version| {
        let path = folder.path().join(name);
        let kind = kind.to_owned();
        let header = Header {
            kind,
            version,
            ..header()
        };
        let mut writer = Writer::create(&path, &header).unwrap();
        fill(&mut writer, 0.0);
        writer.finish().unwrap();
        path
    };
    let good = of("good.mcap", "particle-frames", Version::new(1, 7));
    assert_eq!(artefact(&["info", text(&good)]).code, 0, "a newer minor");
    let sauce = of("sauce.mcap", "arc-sauce", Version::new(1, 0));
    let newer = of("newer.mcap", "particle-frames", Version::new(2, 0));
    let out = folder.path().join("out");
    for (path, words) in [
        (&sauce, "is of kind 'arc-sauce', known are arc-source"),
        (&newer, "is of version 2.0, this program reads version 1.x"),
    ] {
        for arguments in [
            vec!["info", text(path)],
            vec!["ls", text(path)],
            vec!["validate", text(path)],
            vec!["diff", text(&good), text(path)],
            vec!["export", text(path), "--to", "csv", "--out", text(&out)],
        ] {
            let told = artefact(&arguments);
            assert_eq!(told.code, 1, "{arguments:?}: {}{}", told.out, told.err);
            let said = format!("{}{}", told.out, told.err);
            assert!(said.contains(words), "{arguments:?}: {said}");
        }
    }
}

#[test]
fn a_checksum_of_zero_is_none() {
    let folder = folder();
    let path = sample(folder.path(), "a.mcap", 0.0);
    let mut bytes = std::fs::read(&path).unwrap();
    // The last record before the summary: opcode 15, length 4, the checksum.
    let end = [15, 4, 0, 0, 0, 0, 0, 0, 0];
    let at = bytes.windows(9).rposition(|w| w == end).unwrap();
    bytes[at + 9..at + 13].fill(0);
    std::fs::write(&path, &bytes).unwrap();
    let told = artefact(&["validate", text(&path)]);
    assert_eq!(told.code, 0, "{}", told.out);
    bytes[at + 9] = 1;
    std::fs::write(&path, &bytes).unwrap();
    let told = artefact(&["validate", text(&path)]);
    assert_eq!(told.code, 1, "{}", told.out);
}

#[test]
fn where_nothing_is_whole_nothing_is_written() {
    let folder = folder();
    let whole = std::fs::read(sample(folder.path(), "pool.mcap", 0.0)).unwrap();
    let (at, length) = chunks(&whole)[0];
    let mut bytes = whole[..at + length].to_vec();
    bytes[at + length - 5] ^= 0x40;
    let part = folder.path().join("bad.mcap.part");
    std::fs::write(&part, &bytes).unwrap();
    let told = artefact(&["recover", text(&part)]);
    assert_eq!(told.code, 1, "{}", told.out);
    assert!(told.err.contains("nothing can be saved"), "{}", told.err);
    assert!(!folder.path().join("bad.recovered.mcap").exists());

    // So short that it does not say what it is: nobody is sent to `recover` in vain.
    let stub = folder.path().join("stub.mcap");
    std::fs::write(&stub, &whole[..8]).unwrap();
    for command in ["info", "recover"] {
        let told = artefact(&[command, text(&stub)]);
        assert_eq!(told.code, 1, "{}", told.out);
        let words = "it ends after 8 bytes, before it says what it is";
        assert!(told.err.contains(words), "{command}: {}", told.err);
        assert!(!told.err.contains("'artefact recover'"), "{}", told.err);
    }
}

#[test]
fn verify_hash_compares_scene_patches_and_inputs() {
    let folder = folder();
    let path = sample(folder.path(), "a.mcap", 0.0);
    let file = |name: &str, text: &str| {
        let path = folder.path().join(name);
        std::fs::write(&path, text).unwrap();
        path
    };
    // Another order of keys and other spaces; a patch that leads to the scene that ran.
    let base = file(
        "scene.json",
        "{\"version\": 2,\n \"kind\": \"poolsph.scene\", \"title\": \"A drop\", \"spacing_m\": 5e-4,\n \"time\": {\"end_s\": 9, \"step_s\": 1e-4, \"x\": 1}}",
    );
    let patch = file("patch.json", "{\"time\": {\"end_s\": 2.0, \"x\": null}}");
    let arc = file("arc.mcap", "arc bytes");
    let input = format!("arc={}", text(&arc));
    let all = [
        "verify-hash",
        text(&path),
        "--scene",
        text(&base),
        "--patch",
        text(&patch),
        "--input",
        &input,
    ];
    let told = artefact(&all);
    assert_eq!(told.code, 0, "{}{}", told.out, told.err);
    let told = artefact(&all[..4]);
    assert_eq!(told.code, 1, "without the patch");
    assert!(told.out.contains("differs"), "{}", told.out);
    std::fs::write(&arc, "other bytes").unwrap();
    let told = artefact(&all);
    assert_eq!(told.code, 1, "with another input");
    let told = artefact(&[
        "verify-hash",
        text(&path),
        "--input",
        &format!("gas={}", text(&arc)),
    ]);
    assert_eq!(told.code, 1);
    assert!(told.out.contains("made without an input of this name"));
}

#[test]
fn a_scene_that_names_files_is_known_by_what_was_written() {
    let folder = folder();
    std::fs::create_dir(folder.path().join("materials")).unwrap();
    let sheet = folder.path().join("materials/steel.json");
    std::fs::write(&sheet, "a sheet").unwrap();
    let written = serde_json::json!({
        "kind": "poolsph.scene", "version": 2,
        "substances": {"steel": {"file": "materials/steel.json"}}, "density_kg_m3": "steel"
    });
    let base = folder.path().join("scene.json");
    std::fs::write(&base, written.to_string()).unwrap();
    let mut header = header();
    header.scene = serde_json::json!({
        "kind": "poolsph.scene", "version": 2, "density_kg_m3": 7850,
        "substances": {"steel": {"from": "materials/steel.json", "sha256": artefact::sha256(b"a sheet")}},
        "written_sha256": artefact::sha256(artefact::canonical(&written).as_bytes())
    });
    let path = folder.path().join("named.mcap");
    let mut writer = Writer::create(&path, &header).unwrap();
    fill(&mut writer, 0.0);
    writer.finish().unwrap();
    let all = ["verify-hash", text(&path), "--scene", text(&base)];
    let told = artefact(&all);
    assert_eq!(told.code, 0, "{}{}", told.out, told.err);
    assert!(told.out.contains("steel.json"), "{}", told.out);
    std::fs::write(&sheet, "another sheet").unwrap();
    let told = artefact(&all);
    assert_eq!(told.code, 1, "{}", told.out);
    assert!(told.out.contains("differs"), "{}", told.out);
}

#[test]
fn export_takes_the_channels_and_messages_asked_for() {
    let folder = folder();
    let path = sample(folder.path(), "a.mcap", 0.0);
    let out = folder.path().join("csv");
    let told = artefact(&[
        "export",
        text(&path),
        "--to",
        "csv",
        "--out",
        text(&out),
        "--channel",
        "/particles",
        "--every",
        "2",
    ]);
    assert_eq!(told.code, 0, "{}", told.err);
    let files: Vec<_> = std::fs::read_dir(out.join("particles"))
        .unwrap()
        .map(|e| e.unwrap().file_name())
        .collect();
    assert_eq!(files, ["particles_00000.csv"]);
    let rows = std::fs::read_to_string(out.join("particles/particles_00000.csv")).unwrap();
    assert_eq!(
        rows,
        "x [m],y [m],z [m],temperature [K],id [1]\r\n0,0,0,300,0\r\n0.001,0,0,400,1\r\n"
    );
    assert!(!out.join("balance.csv").exists());
}

#[test]
fn wrong_usage_is_told_apart_from_bad_files() {
    let folder = folder();
    let path = sample(folder.path(), "a.mcap", 0.0);
    let file = text(&path);
    let absent = folder.path().join("absent.mcap");
    for (arguments, code, hint) in [
        (vec!["inform", file], 2, "unrecognized subcommand"),
        (vec!["export", file, "--to", "xls", "--out", "o"], 2, "vtu"),
        (
            vec!["export", file, "--to", "csv", "--out", "o", "--every", "0"],
            2,
            "1..",
        ),
        (
            vec!["info", file, "--channel", "/plasma"],
            2,
            "it has /balance, /particles, /surface",
        ),
        (vec!["verify-hash", file, "--input", "arc"], 2, "NAME=FILE"),
        (vec!["info", text(&absent)], 1, "cannot open"),
    ] {
        let told = artefact(&arguments);
        assert_eq!(told.code, code, "{arguments:?}: {}", told.err);
        assert!(told.err.contains(hint), "{arguments:?}: {}", told.err);
        assert!(told.out.is_empty());
    }
}

#[test]
fn help_teaches_with_examples() {
    for command in [
        "info",
        "ls",
        "validate",
        "diff",
        "export",
        "recover",
        "verify-hash",
    ] {
        let told = artefact(&[command, "--help"]);
        assert_eq!(told.code, 0);
        assert!(
            told.out.contains(&format!("artefact {command} build/")),
            "{}",
            told.out
        );
    }
}

#[test]
fn a_gas_table_is_described_and_validated() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../..");
    let gas = root.join("pipelines/gases/argon-1atm.json");
    let told = artefact(&["validate", text(&gas)]);
    assert_eq!(told.code, 0, "{}", told.out);
    let told = artefact(&["info", text(&gas)]);
    assert!(
        told.out.contains("kind        gas-table 1.0"),
        "{}",
        told.out
    );
    assert!(told.out.contains("viscosity_pa_s"), "{}", told.out);

    let folder = folder();
    let bad = folder.path().join("gas.json");
    let mut table: serde_json::Value =
        serde_json::from_str(&std::fs::read_to_string(&gas).unwrap()).unwrap();
    table["columns"][1]["values"][3] = serde_json::Value::Null;
    table["columns"][2]["values"].as_array_mut().unwrap().pop();
    std::fs::write(&bad, table.to_string()).unwrap();
    let told = artefact(&["validate", text(&bad)]);
    assert_eq!(told.code, 1);
    let name = table["columns"][1]["name"].as_str().unwrap();
    assert!(
        told.out
            .contains(&format!("column '{name}', row 3: null is not")),
        "{}",
        told.out
    );
    assert!(
        told.out.contains("entries, 'temperature_k' has"),
        "{}",
        told.out
    );
}
