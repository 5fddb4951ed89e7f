//! From a file of frames to a file of mean fields.
#![allow(clippy::unwrap_used, reason = "a test may fail")]

use std::path::Path;

use artefact::{Frame, GRID, Header, Precision, RECORD, Reader, Table, Version, Writer};
use avg::assemble::{AverageError, Plan};
use avg::average::Averaging;
use avg::fields;
use avg::scene::Scene;
use serde_json::json;

/// Particle diameter \[m\].
const D: f64 = 0.5e-3;
/// Speed of the source \[m/s\].
const SPEED: f64 = 5e-3;
/// Droplet period \[s\].
const PERIOD: f64 = 0.01;

/// Any JSON.
const SCHEMA: (&str, &str) = ("test", "{}");

fn header(kind: &str) -> Header {
    Header {
        kind: kind.to_owned(),
        version: Version::new(1, 0),
        tool: "test".to_owned(),
        tool_version: "0".to_owned(),
        scene: json!({}),
        inputs: std::collections::BTreeMap::new(),
    }
}

/// A block of liquid metal that the source crosses; `field(x, y', z, phase)` is the velocity
/// relative to the source and the temperature, y' counts from the source.
fn frame(place: f64, phase: f64, field: &impl Fn([f64; 3], f64) -> ([f64; 3], f64)) -> Frame {
    let mut position = Vec::new();
    for i in -6..6 {
        for j in -20..20 {
            for k in -8..0 {
                position.push([i, j, k].map(|n: i32| (f64::from(n) + 0.5) * D));
            }
        }
    }
    let seen = |p: &[f64; 3]| field([p[0], p[1] - place, p[2]], phase);
    let velocity: Vec<[f64; 3]> = position
        .iter()
        .map(|p| seen(p).0)
        .map(|u| [u[0], u[1] + SPEED, u[2]])
        .collect();
    let temperature: Vec<f64> = position.iter().map(|p| seen(p).1).collect();
    Frame::new(Precision::F64)
        .positions(position.iter().copied())
        .vector("velocity", "m/s", velocity)
        .scalar("temperature", "K", temperature)
        .flag("molten", vec![1; position.len()])
}

/// Four phases of `drops` periods. The particles stand on their lattice while the field moves over
/// them with the source.
fn write(path: &Path, drops: u32, field: &impl Fn([f64; 3], f64) -> ([f64; 3], f64)) {
    let mut writer = Writer::create(path, &header("particle-frames")).unwrap();
    let plate = json!({"spacing_m": D, "particle_volume_m3": D * D * D});
    writer.json("/plate", 0.0, SCHEMA, &plate).unwrap();
    for n in 0..4 * drops {
        let time = f64::from(n) * PERIOD / 4.0;
        let phase = f64::from(n % 4) / 4.0;
        let place = SPEED * time;
        let source = json!({"time_s": time, "x_m": 0.0, "y_m": place, "z_m": 0.0,
            "phase": phase, "droplet": n / 4});
        writer.json("/source", time, SCHEMA, &source).unwrap();
        let seen = frame(place, phase, field);
        writer.frame("/pool", time, &seen).unwrap();
    }
    writer.finish().unwrap();
}

fn scene() -> Scene {
    serde_json::from_value(cut()).unwrap()
}

fn cut() -> serde_json::Value {
    json!({
        "follow": {}, "phases": {"count": 4},
        "sections": [
            {"name": "section_x0", "first_m": [-2e-3, 2e-3], "second_m": [-2.5e-3, 0.5e-3],
             "cut": {"plane": {"normal": "x", "half_thickness_m": D}}},
            {"name": "surface", "first_m": [-1e-3, 1e-3], "second_m": [-2e-3, 2e-3],
             "cut": {"surface": {"layer_m": 0.6 * D}}},
        ]
    })
}

fn average(from: &Path, to: &Path, scene: &Scene) -> Result<Reader, AverageError> {
    let reader = Reader::open(from)?;
    let plan = Plan::new(scene, &reader)?;
    let mut averaging = Averaging::new(&plan);
    for place in 0..plan.frames.len() {
        let seen = averaging.read(&reader, place)?;
        averaging.take(&seen);
    }
    let mut writer = Writer::create(to, &header("mean-fields"))?;
    for (channel, time, table) in fields::tables(&plan, &averaging.finish()) {
        writer.table(&channel, time, &table)?;
    }
    writer.finish()?;
    Ok(Reader::open(to)?)
}

/// Calls `each` with y', z and the index of the grid points well inside the metal.
fn inside(table: &Table, mut each: impl FnMut(f64, f64, usize)) {
    let (y, z) = (table.axis("y_m").unwrap(), table.axis("z_m").unwrap());
    let mut count = 0;
    for (i, y) in y.iter().enumerate() {
        for (k, z) in z.iter().enumerate() {
            if *z < -2.1 * D && *z > -5.9 * D {
                each(*y, *z, i * table.shape[1] + k);
                count += 1;
            }
        }
    }
    assert!(count > 20, "{count} points");
}

#[test]
fn a_linear_field_comes_back_in_the_moving_frame() {
    let folder = tempfile::tempdir().unwrap();
    let (from, to) = (folder.path().join("a.mcap"), folder.path().join("b.mcap"));
    let velocity = |x: [f64; 3]| [0.0, 40.0 * x[2] - 10.0 * x[1], 5.0 * x[1]];
    let temperature = |x: [f64; 3]| 2000.0 + 1e4 * x[1] + 2e4 * x[2];
    write(&from, 3, &|x, _| (velocity(x), temperature(x)));
    let mean = average(&from, &to, &scene()).unwrap();
    let table = mean.table("/section_x0/time_mean").unwrap();
    let [uy, uz] = ["velocity_y_m_s", "velocity_z_m_s"].map(|n| table.values(n).unwrap());
    let t = table.values("temperature_k").unwrap();
    // The source is between lattice points in most frames: a kernel mean of a linear field is off
    // by the asymmetry of the lattice, at most a few hundredths of a diameter times the gradient.
    inside(&table, |y, z, i| {
        let exact = velocity([0.0, y, z]);
        assert!(
            (uy[i] - exact[1]).abs() < 0.03 * D * 50.0,
            "{} {}",
            uy[i],
            exact[1]
        );
        assert!((uz[i] - exact[2]).abs() < 0.03 * D * 5.0);
        assert!((t[i] - temperature([0.0, y, z])).abs() < 0.03 * D * 3e4);
    });
    assert!((table.scalar("frames").unwrap() - 12.0).abs() < 1e-12);
    assert!((table.scalar("drops").unwrap() - 3.0).abs() < 1e-12);
    assert!((table.scalar("period_s").unwrap() - PERIOD).abs() < 1e-12);
    // Packed, in the frame of reference of the source, at the place of the cut.
    for channel in mean.channels() {
        let scalars = channel.name.ends_with("/attributes");
        let expected = if scalars { RECORD } else { GRID };
        assert_eq!(channel.schema, expected, "{}", channel.name);
    }
    assert_eq!(table.frame_id(), "source");
    assert!(table.scalar("x_m").unwrap().abs() < 1e-15);
}

#[test]
fn each_phase_takes_its_own_frames_alone() {
    let folder = tempfile::tempdir().unwrap();
    let (from, to) = (folder.path().join("a.mcap"), folder.path().join("b.mcap"));
    write(&from, 2, &|_, phase| {
        ([phase, 0.0, -2.0 * phase], 1800.0 + 400.0 * phase)
    });
    let mut scene = scene();
    scene.phases.as_mut().unwrap().origin = 0.25;
    let mean = average(&from, &to, &scene).unwrap();
    assert_eq!(mean.count("/section_x0"), 4);
    for k in 0..4 {
        let table = mean.table_at("/section_x0", k).unwrap();
        // Phase 0 of the averages is phase 0.25 of the file.
        let phase = (k as f64 / 4.0 + 0.25).fract();
        let (u, w) = (
            table.values("velocity_x_m_s").unwrap(),
            table.values("velocity_z_m_s").unwrap(),
        );
        let t = table.values("temperature_k").unwrap();
        inside(&table, |_, _, i| {
            assert!((u[i] - phase).abs() < 1e-12, "{} in phase {k}", u[i]);
            assert!((w[i] + 2.0 * phase).abs() < 1e-12);
            assert!((t[i] - 1800.0 - 400.0 * phase).abs() < 1e-9);
        });
        assert!((table.scalar("frames").unwrap() - 2.0).abs() < 1e-12);
        assert!((table.scalar("drops").unwrap() - 2.0).abs() < 1e-12);
    }
    let time = mean.table("/surface/time_mean").unwrap();
    let middle = time.len() / 2;
    assert!((time.values("velocity_x_m_s").unwrap()[middle] - 0.375).abs() < 1e-12);
    assert!((time.values("height_m").unwrap()[middle] + 0.5 * D).abs() < 1e-12);
}

/// Slag behind the source, which flows, and powder ahead of it, at rest.
fn write_grains(path: &Path) {
    let mut writer = Writer::create(path, &header("particle-frames")).unwrap();
    for n in 0..3 {
        let time = f64::from(n) * PERIOD;
        let place = SPEED * time;
        let source = json!({"time_s": time, "x_m": 0.0, "y_m": place, "z_m": 0.0, "phase": 0.0, "droplet": n});
        writer.json("/source", time, SCHEMA, &source).unwrap();
        let metal = frame(place, 0.0, &|_, _| ([0.0; 3], 300.0));
        let (places, count) = (metal.position_vectors().unwrap(), metal.len());
        let slag = |x: &[f64; 3]| x[1] < place;
        let velocity = places.iter().map(|x| match slag(x) {
            true => [0.0, SPEED - 0.02, 0.01],
            false => [0.0; 3],
        });
        let heap = Frame::new(Precision::F64)
            .positions(places.iter().copied())
            .vector("velocity", "m/s", velocity)
            .scalar("radius", "m", vec![0.5 * D; count])
            .scalar(
                "temperature",
                "K",
                places.iter().map(|x| if slag(x) { 2600.0 } else { 600.0 }),
            )
            .flag("state", places.iter().map(|x| u8::from(slag(x))));
        writer.frame("/grains", time, &heap).unwrap();
    }
    writer.finish().unwrap();
}

#[test]
fn flux_and_slag_come_back_in_the_moving_frame() {
    let folder = tempfile::tempdir().unwrap();
    let (from, to) = (folder.path().join("a.mcap"), folder.path().join("b.mcap"));
    write_grains(&from);
    let of = |states: serde_json::Value| {
        let mut scene = cut();
        scene["channel"] = json!("/grains");
        scene.as_object_mut().unwrap().remove("phases");
        scene["states"] = states;
        let scene: Scene = serde_json::from_value(scene).unwrap();
        let mean = average(&from, &to, &scene).unwrap();
        mean.table("/section_x0/time_mean").unwrap()
    };
    for (states, ahead, wanted) in [
        (json!(["slag"]), false, [-0.02, 0.01, 2600.0]),
        (json!(["powder"]), true, [-SPEED, 0.0, 600.0]),
        (json!(null), true, [-SPEED, 0.0, 600.0]),
    ] {
        let table = of(states);
        let [uy, uz, t] = ["velocity_y_m_s", "velocity_z_m_s", "temperature_k"]
            .map(|name| table.values(name).unwrap());
        let mut seen = 0;
        inside(&table, |y, _, i| {
            let own = if ahead { y > 2.2 * D } else { y < -2.2 * D };
            if own {
                assert!((uy[i] - wanted[0]).abs() < 1e-12, "{} at {y}", uy[i]);
                assert!((uz[i] - wanted[1]).abs() < 1e-12);
                assert!((t[i] - wanted[2]).abs() < 1e-9);
                seen += 1;
            }
        });
        assert!(seen > 0, "nothing was looked at");
    }
    let mut scene = cut();
    scene["channel"] = json!("/grains");
    scene["landed"] = json!({"link_m": D});
    let scene: Scene = serde_json::from_value(scene).unwrap();
    let said = average(&from, &to, &scene).unwrap_err().to_string();
    assert!(said.contains("landed"), "{said}");
}

#[test]
fn sections_without_metal_are_named() {
    let folder = tempfile::tempdir().unwrap();
    let from = folder.path().join("a.mcap");
    write(&from, 1, &|_, _| ([0.0; 3], 300.0));
    let empty = |at: f64, first: [f64; 2]| {
        let mut scene = cut();
        scene["profile"] = json!({"radius_m": 2e-3});
        scene["sections"][0]["cut"]["plane"]["at_m"] = json!(at);
        scene["sections"][1]["first_m"] = json!(first);
        let scene: Scene = serde_json::from_value(scene).unwrap();
        let reader = Reader::open(&from).unwrap();
        let plan = Plan::new(&scene, &reader).unwrap();
        let mut averaging = Averaging::new(&plan);
        for place in 0..plan.frames.len() {
            let seen = averaging.read(&reader, place).unwrap();
            averaging.take(&seen);
        }
        averaging.finish().empty(&plan).join(" ")
    };
    let over = [-1e-3, 1e-3];
    assert_eq!(empty(0.0, over), "");
    // Millimetres meant.
    assert_eq!(empty(5.0, over), "section_x0");
    assert_eq!(empty(0.0, [5.0, 5.001]), "surface");
}

#[test]
fn a_span_without_frames_is_an_error_that_names_both() {
    let folder = tempfile::tempdir().unwrap();
    let (from, to) = (folder.path().join("a.mcap"), folder.path().join("b.mcap"));
    write(&from, 1, &|_, _| ([0.0; 3], 300.0));
    let mut scene = scene();
    scene.time = Some(serde_json::from_value(json!({"from_s": 8.0, "to_s": 10.0})).unwrap());
    let said = average(&from, &to, &scene).unwrap_err().to_string();
    assert!(said.contains("8 s") && said.contains("0.0075 s"), "{said}");
}

#[test]
fn at_rest_nothing_is_asked_of_a_source() {
    let folder = tempfile::tempdir().unwrap();
    let (from, to) = (folder.path().join("a.mcap"), folder.path().join("b.mcap"));
    write(&from, 1, &|_, _| ([0.0, 0.5, 0.0], 300.0));
    let mut scene = scene();
    (scene.follow, scene.phases) = (None, None);
    let mean = average(&from, &to, &scene).unwrap();
    assert!(!mean.has("/section_x0"));
    let table = mean.table("/section_x0/time_mean").unwrap();
    let uy = table.values("velocity_y_m_s").unwrap();
    inside(&table, |_, _, i| {
        assert!((uy[i] - 0.5 - SPEED).abs() < 1e-12)
    });
    assert!(table.scalar("period_s").is_err());
    assert_eq!(table.frame_id(), "world");
}

/// All tables as text, by channel.
fn told(reader: &Reader) -> std::collections::BTreeMap<String, Vec<String>> {
    let tables = reader.channels().into_iter().map(|c| c.name);
    let tables = tables.filter(|name| !name.ends_with("/attributes"));
    let all = |name: String| {
        let each = (0..reader.count(&name)).map(|k| reader.table_at(&name, k).unwrap());
        let each = each.map(|table| format!("{table:?}")).collect();
        (name, each)
    };
    tables.map(all).collect()
}

#[test]
fn a_profile_is_a_channel_more_and_changes_no_other() {
    let folder = tempfile::tempdir().unwrap();
    let (from, to) = (folder.path().join("a.mcap"), folder.path().join("b.mcap"));
    write(&from, 1, &|_, _| ([0.0; 3], 300.0));
    let plain = told(&average(&from, &to, &scene()).unwrap());
    let mut scene = scene();
    scene.profile = Some(serde_json::from_value(json!({"radius_m": 2e-3})).unwrap());
    let more = average(&from, &to, &scene).unwrap();
    assert!(!plain.contains_key("/profile") && plain.len() == 4);
    let mut rest = told(&more);
    assert!(rest.remove("/profile").is_some());
    assert!(rest == plain, "other tables than without a profile");
    // The block is level, 4 mm thick, and as wide as the profile on all sides of the source.
    let table = more.table("/profile").unwrap();
    assert_eq!((table.len(), table.frame_id()), (4, "source"));
    for (height, share) in [("height_m", 0.0), ("metal_share", 1.0)] {
        for found in table.values(height).unwrap() {
            assert!((found - share).abs() < 0.01 * D, "{height} {found}");
        }
    }
    assert!((table.scalar("frames").unwrap() - 4.0).abs() < 1e-12);
}

#[test]
fn a_profile_of_no_ring_or_too_many_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let (from, to) = (folder.path().join("a.mcap"), folder.path().join("b.mcap"));
    write(&from, 1, &|_, _| ([0.0; 3], 300.0));
    for radius in [0.9 * D, 1e3] {
        let mut scene = scene();
        scene.profile = Some(serde_json::from_value(json!({"radius_m": radius})).unwrap());
        let said = average(&from, &to, &scene).unwrap_err().to_string();
        assert!(said.contains("one ring at least"), "{said}");
    }
}

#[test]
fn the_means_are_as_wide_as_the_frames() {
    let folder = tempfile::tempdir().unwrap();
    let mut scene = scene();
    (scene.follow, scene.phases, scene.spacing_m) = (None, None, Some(D));
    for precision in [Precision::F32, Precision::F64] {
        let (from, to) = (folder.path().join("a.mcap"), folder.path().join("b.mcap"));
        let mut writer = Writer::create(&from, &header("particle-frames")).unwrap();
        let block = frame(0.0, 0.0, &|_, _| ([0.0, 1.0 / 3.0, 0.0], 300.0));
        let frame = Frame::new(precision)
            .positions(block.position_vectors().unwrap())
            .vector("velocity", "m/s", vec![[0.0, 1.0 / 3.0, 0.0]; block.len()])
            .flag("molten", vec![1; block.len()]);
        writer.frame("/pool", 0.0, &frame).unwrap();
        writer.finish().unwrap();
        let mean = average(&from, &to, &scene).unwrap();
        let table = mean.table("/section_x0/time_mean").unwrap();
        assert_eq!(table.precision(), precision);
        let most = table.values("velocity_y_m_s").unwrap();
        let most = most.iter().copied().fold(0.0, f64::max);
        assert!((most - 1.0 / 3.0).abs() < 1e-7, "{most}");
    }
}

#[test]
fn the_schema_in_the_repository_is_what_the_program_prints() {
    use avg::program::Avg;
    use run::Tool;
    let expected = run::scene::Expected {
        kind: Avg::SCENE_KIND,
        version: Avg::SCENE_VERSION,
        migrations: &[],
    };
    let printed = run::scene::schema_text(&run::scene::schema_of::<Scene>(expected));
    let stored = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../schemas/avg.scene.v1.json");
    assert_eq!(std::fs::read_to_string(stored).unwrap(), printed);
}

#[test]
fn the_scenes_of_the_studies_are_valid_as_they_are_and_patched() {
    use avg::program::Avg;
    use run::Tool;
    let expected = run::scene::Expected {
        kind: Avg::SCENE_KIND,
        version: Avg::SCENE_VERSION,
        migrations: &[],
    };
    let schema = run::scene::schema_of::<Scene>(expected);
    let studies = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../pipelines");
    let whole = studies.join("gmaw-300a/avg.json");
    let quick = studies.join("gmaw-quick/avg.patch.json");
    let profile = studies.join("gmaw-two-pass/avg.patch.json");
    for (patches, from_s) in [
        (vec![], 8.0),
        (vec![quick.clone()], 0.6),
        (vec![quick, profile], 0.6),
    ] {
        let scene: Scene = run::scene::load(&whole, &patches, &schema, expected)
            .unwrap()
            .scene;
        assert_eq!(scene.profile.is_some(), patches.len() == 2);
        assert!(scene.faults().is_empty());
        assert!((scene.time.unwrap().from_s - from_s).abs() < 1e-12);
    }
}

#[test]
fn what_the_schema_cannot_say_is_refused_before_any_file_is_opened() {
    use avg::program::Avg;
    use run::{Inputs, Tool};
    let mut scene = scene();
    scene.follow = None;
    let said = Avg::prepare(scene, Inputs::none()).unwrap_err().to_string();
    assert!(
        said.contains("/phases") && said.contains("'follow'"),
        "{said}"
    );
}
