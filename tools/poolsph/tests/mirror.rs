//! Half of a symmetric scene beside a mirror is the half of it: grains that meet their images, and light on half a cavity.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on fails")]

use std::path::Path;
use std::process::{Command, Output};

use artefact::Reader;
use serde_json::{Value, json};

type Vector = [f64; 3];

fn run(scene: &Value, out: &Path) -> Output {
    let path = out.with_extension("scene.json");
    std::fs::write(&path, scene.to_string()).unwrap();
    let mut command = Command::new(env!("CARGO_BIN_EXE_poolsph"));
    command.arg("run").arg(&path).arg("--out").arg(out);
    command.args(["--progress", "none"]).output().unwrap()
}

/// The last values of a column of grains, whose number is a multiple of that of the half.
fn last(scene: &Value, out: &Path, column: &str) -> Vec<f64> {
    let output = run(scene, out);
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(0), "{said}");
    let reader = Reader::open(out).unwrap();
    let frame = reader
        .frame("/grains", reader.count("/grains") - 1)
        .unwrap();
    match column {
        "position" => frame.position_vectors().unwrap().concat(),
        _ => frame.f64(column).unwrap(),
    }
}

fn mirror() -> Value {
    json!({"shape": {"half_space": {"point_m": [0, 0, 0], "normal": [1, 0, 0]}}, "mirror": true})
}

/// A heap of grains that runs into its image, each with a velocity and a spin of its own.
fn heap(law: &Value, sides: &[f64]) -> Value {
    let grains = (0..12).flat_map(|k| {
        let turn = |phase: f64| (3.7 * f64::from(k) + phase).sin();
        let place = [
            0.6e-3 + 1.1e-3 * f64::from(k % 3),
            1.05e-3 * f64::from(k / 3),
            2e-4 * turn(0.3),
        ];
        let velocity = [-0.4 + 0.1 * turn(1.0), 0.1 * turn(2.0), 0.1 * turn(3.0)];
        let spin = [50.0 * turn(4.0), 50.0 * turn(5.0), 50.0 * turn(6.0)];
        sides.iter().map(move |side| {
            let seen = |v: Vector| [side * v[0], v[1], v[2]];
            json!({"places_m": [seen(place)], "radius_m": 5e-4, "velocity_m_s": seen(velocity),
                   "spin_rad_s": [spin[0], side * spin[1], side * spin[2]]})
        })
    });
    json!({
        "kind": "poolsph.scene", "version": 2, "title": "A heap and its image",
        "time": {"step_s": 1e-4, "end_s": 0.01},
        "grains": {
            "density_kg_m3": 2500,
            "contact": {"law": law, "restitution": 0.6, "friction": 0.4, "rolling": {"coefficient": 0.1}},
            "bodies": grains.collect::<Vec<_>>()
        },
        "output": {"particles_interval_s": 1e-3, "precision": "f64"}
    })
}

#[test]
fn half_of_a_heap_moves_as_the_half_of_the_whole() {
    let folder = tempfile::tempdir().unwrap();
    for law in [
        json!({"linear": {"stiffness_n_m": 200, "tangential_ratio": 0.8}}),
        json!({"hertz": {"youngs_modulus_pa": 1e6, "poisson_ratio": 0.3}}),
    ] {
        let whole = last(
            &heap(&law, &[1.0, -1.0]),
            &folder.path().join("whole.mcap"),
            "position",
        );
        let mut scene = heap(&law, &[1.0]);
        let free = last(&scene, &folder.path().join("free.mcap"), "position");
        scene["grains"]["walls"] = json!([mirror()]);
        let half = last(&scene, &folder.path().join("half.mcap"), "position");
        let apart = |k: usize, other: &[f64], stride: usize| {
            let own = &half[3 * k..3 * k + 3];
            let other = &other[3 * stride * k..3 * stride * k + 3];
            (0..3).fold(0.0, |far, i| f64::max(far, (own[i] - other[i]).abs()))
        };
        for k in 0..12 {
            let far = apart(k, &whole, 2);
            assert!(far < 1e-12, "{law}: grain {k} is {far:e} m off");
        }
        let turned = (0..12).filter(|k| apart(*k, &free, 1) > 1e-4).count();
        assert!(turned > 3, "only {turned} grains met the mirror");
    }
}

/// Grains at rest around half a ball, or a quarter of it, in the light.
fn cavity(low: f64, power: f64, walls: &[Value]) -> Value {
    let ball = json!({"sphere": {"centre_m": [0, 0, 0], "radius_m": 3e-3}});
    let mut all = vec![
        json!({"shape": {"intersection": [ball, {"half_space": {"point_m": [0, 0, 0], "normal": [0, 0, -1]}}]},
               "light": {"power_w": power, "from_m": [0, 0, 1e-3], "emissivity": 0.8, "surroundings_k": 300}}),
    ];
    all.extend_from_slice(walls);
    let shell = json!({"difference": [{"box": {"min_m": [low, -5e-3, 0], "max_m": [5e-3, 5e-3, 5e-3]}}, ball]});
    json!({
        "kind": "poolsph.scene", "version": 2, "title": "Light in a cavity",
        "time": {"step_s": 1e-4, "end_s": 0.005},
        "grains": {
            "density_kg_m3": 3230,
            "contact": {"law": {"linear": {"stiffness_n_m": 75}}, "restitution": 0.75},
            "bodies": [{"shape": shell, "radius_m": 2.5e-4, "driven_m_s": [0, 0, 0], "temperature_k": 600}],
            "walls": all,
            "heat": {"thermal_conductivity_w_m_k": 20.2, "specific_heat_j_kg_k": 1000}
        },
        "output": {"particles_interval_s": 0.005, "precision": "f64"}
    })
}

#[test]
fn half_a_cavity_is_lit_as_the_half_of_the_whole() {
    let folder = tempfile::tempdir().unwrap();
    let sums = |scene: &Value, name: &str| {
        let out = folder.path().join(name);
        let temperature = last(scene, &out, "temperature");
        let x = last(scene, &out, "position");
        let (mut near, mut all) = (0.0, 0.0);
        for (a, t) in temperature
            .iter()
            .enumerate()
            .filter(|(a, _)| x[3 * a] > 0.0)
        {
            all += t - 600.0;
            if x[3 * a] < 1e-3 {
                near += t - 600.0;
            }
        }
        [all, near]
    };
    let whole = sums(&cavity(-5e-3, 1000.0, &[]), "whole.mcap");
    let half = sums(&cavity(0.0, 500.0, &[mirror()]), "half.mcap");
    for (half, whole) in half.iter().zip(whole) {
        assert!(
            (half / whole - 1.0).abs() < 0.01,
            "{half} K instead of {whole} K"
        );
    }
}

#[test]
fn a_mirror_is_a_plane_and_nothing_else() {
    let folder = tempfile::tempdir().unwrap();
    let refused = |key: &str, value: Value| {
        let mut wall = mirror();
        wall[key] = value;
        let output = run(
            &cavity(0.0, 500.0, &[wall]),
            &folder.path().join("none.mcap"),
        );
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(2), "{said}");
        assert!(said.contains("/grains/walls/1/mirror"), "{said}");
        said
    };
    assert!(refused("friction", json!(0.3)).contains("'friction'"));
    assert!(refused("velocity_m_s", json!([0, 0, 1])).contains("'velocity_m_s'"));
    let ball = json!({"sphere": {"centre_m": [0, 0, -1], "radius_m": 1e-3}});
    assert!(refused("shape", ball).contains("half_space"));
}

#[test]
fn a_mirror_of_the_flow_that_is_none_for_grains_is_told() {
    let folder = tempfile::tempdir().unwrap();
    let mut scene = cavity(0.0, 500.0, &[mirror()]);
    scene["time"]["end_s"] = json!(1e-4);
    scene["grains"].as_object_mut().unwrap().remove("heat");
    scene["grains"]["walls"][0]
        .as_object_mut()
        .unwrap()
        .remove("light");
    scene["spacing_m"] = json!(5e-4);
    scene["density_kg_m3"] = json!(7850);
    let plate = json!({"box": {"min_m": [0, -2e-3, -2e-3], "max_m": [4e-3, 2e-3, 0]}});
    scene["bodies"] = json!([{"shape": plate, "state": "solid"}]);
    scene["flow"] = json!({"method": "projection", "viscosity_pa_s": 0.006});
    scene["faces"] =
        json!({"min_m": [0, -0.01, -0.01], "max_m": [0.01, 0.01, 0.01], "mirror": ["x-"]});
    let told = |scene: &Value, name: &str| {
        let output = run(scene, &folder.path().join(name));
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        (
            output.status.code(),
            said.contains("is none for grains"),
            said,
        )
    };
    let (code, says, said) = told(&scene, "both.mcap");
    assert!(code == Some(0) && !says, "{said}");
    scene["grains"]["walls"].as_array_mut().unwrap().pop();
    let (code, says, said) = told(&scene, "one.mcap");
    assert!(code == Some(3) && says, "{said}");
}
