//! Drops that meet and part.

use artefact::Reader;
use serde_json::{Value, json};

use super::{column, run, said};

/// Energy that may come back, which is rounding, volume and momentum that may be lost.
const ENERGY: f64 = 1e-12;
const VOLUME: f64 = 1e-3;
const MOMENTUM: f64 = 1e-8;

/// What fills a shape moves at a velocity along z for some times of sqrt(rho R^3/gamma), R of 3.2 spacings, Ohnesorge number 0.2.
fn moving(radius: f64, shape: &Value, velocity: &str, times: f64) -> Value {
    let (density, tension) = (1000.0_f64, 0.072_f64);
    let time = (density * radius.powi(3) / tension).sqrt();
    json!({"kind": "emfield.scene", "version": 1, "geometry": "space",
        "liquid": {"shape": shape, "groups": {},
            "density_kg_m3": density, "surface_tension_n_m": tension,
            "viscosity_pa_s": 0.2 * (density * tension * radius).sqrt(),
            "velocity_m_s": [0, 0, {"expr": velocity}],
            "march": {"end_s": times * time}},
        "points": {"spacing_m": radius / 3.2}, "output": {"precision": "f64"}})
}

/// Two spheres that approach each other at `weber`, of the closing speed and the diameter.
fn pair(radius: f64, weber: f64, times: f64) -> Value {
    let apart = 1.12 * radius;
    let speed = 0.5 * (weber * 0.072 / (1000.0 * 2.0 * radius)).sqrt();
    let ball = |z: f64| json!({"sphere": {"centre_m": [0, 0, z], "radius_m": radius}});
    let shape = json!({"union": [ball(-apart), ball(apart)]});
    let velocity = format!("if(z, {:e}, {speed:e})", -speed);
    moving(radius, &shape, &velocity, times)
}

/// How many drops there are over time.
fn counted(reader: &Reader) -> Vec<(f64, u32)> {
    let drops = column(reader, "drops").into_iter();
    drops.map(|(t, n)| (t, n as u32)).collect()
}

/// What all has, over what it began with.
fn keeps(reader: &Reader, speed: f64) {
    let [kinetic, surface, volume] =
        ["kinetic_energy", "surface_energy", "volume"].map(|name| column(reader, name));
    let energy = kinetic.iter().zip(&surface).map(|(k, s)| k.1 + s.1);
    let first = kinetic[0].1 + surface[0].1;
    let mut least = first;
    for e in energy {
        least = least.min(e);
        assert!(e - least < ENERGY * first, "{:e}", (e - least) / first);
    }
    for (_, v) in &volume {
        let lost = v / volume[0].1 - 1.0;
        assert!(lost.abs() < VOLUME, "{lost:e}");
    }
    for axis in ["x", "y", "z"] {
        let moves = column(reader, &format!("velocity_{axis}"));
        for (_, u) in &moves {
            assert!((u - moves[0].1).abs() < MOMENTUM * speed, "{axis} {u:e}");
        }
    }
}

#[test]
fn two_drops_become_one_at_any_scale() {
    let folder = tempfile::tempdir().unwrap();
    let mut met = Vec::new();
    for radius in [1e-3, 3.5e-5] {
        let reader = run(folder.path(), &pair(radius, 4.0, 0.5));
        keeps(&reader, (4.0 * 0.072 / (2000.0 * radius)).sqrt());
        let drops = counted(&reader);
        assert_eq!([drops[0].1, drops.last().unwrap().1], [2, 1]);
        let time = drops.iter().find(|d| d.1 == 1).unwrap().0;
        met.push(time / (1000.0 * radius.powi(3) / 0.072).sqrt());
        let last = reader
            .frame("/groups", reader.count("/groups") - 1)
            .unwrap();
        assert_eq!(last.len(), 1);
        let group = reader.frame("/points", 0).unwrap();
        assert!(group.u32("group").unwrap().contains(&1));
        // Without a field nothing is told of one.
        let row = &reader.records("/liquid").unwrap()[0].1;
        assert!(row.get("field_work").is_err() && !last.has("charge"));
    }
    assert!((met[0] - met[1]).abs() < 1e-3, "{met:?}");
}

#[test]
fn the_pressure_of_drops_that_have_met_is_that_of_their_tension() {
    let radius = 1e-3;
    let ball = |z: f64| json!({"sphere": {"centre_m": [0, 0, z], "radius_m": radius}});
    let shape = json!({"union": [ball(-1.15e-3), ball(1.12e-3)]});
    let mut scene = moving(radius, &shape, "if(z, -0.2, 0.2)", 0.1);
    // So few points that what a short step takes away is large.
    scene["points"]["spacing_m"] = json!(3.1e-4);
    scene["liquid"]["march"]["end_s"] = json!(8e-4);
    let folder = tempfile::tempdir().unwrap();
    let reader = run(folder.path(), &scene);
    assert_eq!(counted(&reader).last().unwrap().1, 1);
    let met = reader
        .frame("/points", reader.count("/points") - 1)
        .unwrap();
    let alone = 2.0 * 0.072 / radius;
    for p in met.f64("pressure").unwrap() {
        assert!(p.abs() < 3.0 * alone, "{p}");
    }
}

#[test]
fn what_grows_in_each_step_grows_slowly_in_short_ones() {
    let radius = 1e-3;
    let ball = |z: f64, r: f64| json!({"sphere": {"centre_m": [0, 0, z], "radius_m": r}});
    let shape = json!({"union": [ball(-1.15e-3, radius), ball(1e-3, 0.85e-3)]});
    let mut scene = moving(radius, &shape, "if(z, -0.2, 0.2)", 0.1);
    scene["points"]["spacing_m"] = json!(3.1e-4);
    // A step of its own choice would be 2.7e-4 s.
    scene["liquid"]["march"] = json!({"end_s": 2.4e-4, "step_s": 1e-5});
    let folder = tempfile::tempdir().unwrap();
    let reader = run(folder.path(), &scene);
    let last = reader.count("/points") - 1;
    let end = reader.frame("/points", last).unwrap();
    for u in end.f64("velocity_z").unwrap() {
        assert!((u.abs() - 0.2).abs() < 2e-3, "{u}");
    }
}

#[test]
fn a_drop_that_is_pulled_apart_becomes_two() {
    let radius = 1e-3;
    let tip = |z: f64| {
        json!({"ellipsoid": {"centre_m": [0, 0, z * radius],
            "semi_axes_m": [0.8 * radius, 0.8 * radius, 1.2 * radius]}})
    };
    let shape = json!({"union": [tip(-1.12), tip(1.12)]});
    let folder = tempfile::tempdir().unwrap();
    let (code, text, out) = said(folder.path(), &moving(radius, &shape, "600*z", 0.4), "2");
    // On so few points caps have more surface than the neck that they close.
    assert!(code == 0 || text.contains("energies"), "{code} {text}");
    assert!(!text.contains("ended"), "{text}");
    let reader = Reader::open_kind(&out, "point-fields", 1).unwrap();
    let drops = counted(&reader);
    assert_eq!([drops[0].1, drops.last().unwrap().1], [1, 2]);
    let volume = column(&reader, "volume");
    let lost = volume.last().unwrap().1 / volume[0].1 - 1.0;
    assert!(lost.abs() < VOLUME, "{lost:e}");
    let moves = column(&reader, "velocity_z");
    assert!(moves.iter().all(|u| (u.1 - moves[0].1).abs() < MOMENTUM));
}

#[test]
fn drops_that_leave_each_other_stay_two() {
    let folder = tempfile::tempdir().unwrap();
    let mut scene = pair(1e-3, 4.0, 0.2);
    let speed = (4.0 * 0.072 / 2.0_f64).sqrt();
    scene["liquid"]["velocity_m_s"][2] = json!({"expr": format!("if(z, {speed}, {})", -speed)});
    let reader = run(folder.path(), &scene);
    assert!(counted(&reader).iter().all(|d| d.1 == 2));
}

#[test]
fn without_groups_nothing_is_told_of_them() {
    let folder = tempfile::tempdir().unwrap();
    let mut scene = pair(1e-3, 4.0, 0.02);
    scene["liquid"]["shape"] = json!({"sphere": {"centre_m": [0, 0, 0], "radius_m": 1e-3}});
    scene["liquid"]["velocity_m_s"] = Value::Null;
    scene["liquid"]["groups"] = Value::Null;
    let reader = run(folder.path(), &scene);
    let row = &reader.records("/liquid").unwrap()[0].1;
    assert!(row.get("drops").is_err() && !reader.has("/groups"));
    assert!(!reader.frame("/points", 0).unwrap().has("group"));
}

#[test]
fn what_drops_that_meet_cannot_have_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let coil = json!({"loop": {"centre_m": [0, 0, -0.005], "radius_m": 0.004, "wire_radius_m": 5e-4, "current_a": 200}});
    for (key, value) in [
        (
            "magnetic",
            json!({"conductivity_s_m": 1e7, "frequency_hz": 3e4, "coils": [coil]}),
        ),
        (
            "heat",
            json!({"temperature_k": 300, "thermal_conductivity_w_m_k": 1, "specific_heat_j_kg_k": 1000}),
        ),
    ] {
        let mut scene = pair(1e-3, 4.0, 0.1);
        scene["liquid"][key] = value;
        let (code, text, _) = said(folder.path(), &scene, "1");
        let told = text.contains("/liquid/groups") && text.contains(&format!("\"{key}\""));
        assert!(code == 2 && told, "{text}");
    }
    let mut scene = pair(1e-3, 4.0, 0.1);
    scene["liquid"]["groups"] = json!({"part_below": 3.0});
    let (code, text, _) = said(folder.path(), &scene, "1");
    assert!(
        code == 2 && text.contains("/liquid/groups/part_below"),
        "{text}"
    );
    // A drop of a spacing and a half has too few points.
    let mut scene = pair(1e-3, 4.0, 0.1);
    scene["points"]["spacing_m"] = json!(6.7e-4);
    let (code, text, _) = said(folder.path(), &scene, "1");
    assert!(code == 2 && text.contains("/points/spacing_m"), "{text}");
}
