//! Drops that meet in an electric field.

use artefact::Reader;
use serde_json::{Value, json};

use super::{bytes, column, resumed, run};

const EPS0: f64 = 8.854_187_812_8e-12;
const TENSION: f64 = 0.072;
const DENSITY: f64 = 1000.0;
const RADIUS: f64 = 1e-3;

/// eps0 E^2 R/gamma = 0.05.
fn field() -> f64 {
    (0.05 * TENSION / (EPS0 * RADIUS)).sqrt()
}

/// Two drops that approach each other along a field, 3 spacings in the radius of the larger one, for some times of sqrt(rho R^3/gamma).
fn pair(electric: Value, times: f64) -> Value {
    let ball = |z: f64, part: f64| json!({"sphere": {"centre_m": [0, 0, z * RADIUS], "radius_m": part * RADIUS}});
    let time = (DENSITY * RADIUS.powi(3) / TENSION).sqrt();
    json!({"kind": "emfield.scene", "version": 1, "geometry": "space",
        "liquid": {"shape": {"union": [ball(-1.1, 1.0), ball(1.0, 0.8)]}, "groups": {},
            "density_kg_m3": DENSITY, "surface_tension_n_m": TENSION, "electric": electric,
            "viscosity_pa_s": 0.2 * (DENSITY * TENSION * RADIUS).sqrt(),
            "velocity_m_s": [0, 0, {"expr": "if(z, -0.3, 0.2)"}],
            "march": {"end_s": times * time}},
        "points": {"spacing_m": RADIUS / 3.0}, "output": {"precision": "f64"}})
}

/// The sum of the energies, without the work of the field, never rises, over the first of it.
fn rises(reader: &Reader) -> f64 {
    let [kinetic, surface, work] =
        ["kinetic_energy", "surface_energy", "field_work"].map(|name| column(reader, name));
    let first = kinetic[0].1 + surface[0].1;
    let (mut least, mut most) = (first, 0.0_f64);
    for ((k, s), w) in kinetic.iter().zip(&surface).zip(&work) {
        let energy = k.1 + s.1 - w.1;
        least = least.min(energy);
        most = most.max(energy - least);
    }
    most / first
}

#[test]
fn charged_drops_that_meet_keep_their_charge_and_go_with_the_field() {
    let folder = tempfile::tempdir().unwrap();
    let charge = 4e-12;
    let scene = pair(
        json!({"field_v_m": [0, 0, field()], "charge_c": charge}),
        0.3,
    );
    let reader = run(folder.path(), &scene);
    let frames = [0, reader.count("/groups") - 1].map(|i| reader.frame("/groups", i).unwrap());
    let charges = frames.map(|frame| frame.f64("charge").unwrap());
    let cubes = [1.0, 0.8_f64.powi(3)];
    for (found, cube) in charges[0].iter().zip(cubes) {
        let wanted = charge * cube / (cubes[0] + cubes[1]);
        assert!((found / wanted - 1.0).abs() < 1e-2, "{found:e} {wanted:e}");
    }
    let [one] = charges[1][..] else {
        panic!("{charges:?}")
    };
    assert!((one / charge - 1.0).abs() < 1e-12, "{one:e}");
    let volume = column(&reader, "volume");
    assert!(
        volume
            .iter()
            .all(|v| (v.1 / volume[0].1 - 1.0).abs() < 1e-9)
    );
    // The drops pull at each other by forces that are opposite, so that all go as the field says.
    let moves = column(&reader, "velocity_z");
    let rate = charge * field() / (DENSITY * volume[0].1);
    let (end, last) = moves.last().unwrap();
    assert!((last - moves[0].1 - rate * end).abs() < 1e-6 * rate * end);
    assert!(rises(&reader) < 2e-3, "{:e}", rises(&reader));
    // The field draws them together. What they become grows shorter against its pull.
    let drops = column(&reader, "drops").into_iter();
    let work: Vec<f64> = column(&reader, "field_work").iter().map(|w| w.1).collect();
    let both = drops.filter(|d| d.1 > 1.5).count();
    assert!(both > 1 && work[both - 1] > 0.0, "{work:?}");
    assert!(work.last().unwrap() < &work[both - 1], "{work:?}");
}

#[test]
fn drops_in_a_field_know_neither_threads_nor_a_break() {
    let folder = tempfile::tempdir().unwrap();
    for electric in [
        json!({"field_v_m": [0, 0, field()]}),
        json!({"field_v_m": [0, 0, field()], "relative_permittivity": 80}),
    ] {
        let scene = pair(electric, 0.2);
        // The resumed one has two threads.
        let straight = bytes(folder.path(), &scene, "1");
        assert!(straight == resumed(folder.path(), &scene));
    }
}
