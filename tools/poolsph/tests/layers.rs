//! Two liquids that do not mix.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on fails")]

use std::path::Path;
use std::process::Command;

use artefact::{Frame, Reader};
use serde_json::{Value, json};

/// Runs a scene; what it says, its exit code, and its last frame if there is one.
fn run(folder: &Path, scene: &Value, more: &[&str]) -> (String, Option<i32>, Option<Frame>) {
    let at = |name: &str| folder.join(name);
    std::fs::write(at("layers.json"), scene.to_string()).unwrap();
    let mut command = Command::new(env!("CARGO_BIN_EXE_poolsph"));
    command.arg("run").arg(at("layers.json")).arg("--out");
    let output = command
        .arg(at("layers.mcap"))
        .arg("-q")
        .args(more)
        .output()
        .unwrap();
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    let reader = Reader::open(at("layers.mcap")).ok();
    let frame = reader.map(|reader| {
        let last = reader.count("/particles") - 1;
        reader.frame("/particles", last).unwrap()
    });
    (said, output.status.code(), frame)
}

/// Metal of 5 mm under slag of 4 mm, between walls and periodic faces; lengths times `scale`, the lattice shaken by the formula of the velocity.
fn basin(scale: f64, down: usize) -> Value {
    let mut corner = [6.0, 6.0, 6.0].map(|x| 1e-3 * scale * x);
    corner[down] = 1e-2 * scale;
    let upto = |level: f64| {
        let mut top = corner;
        top[down] = 1e-3 * scale * level;
        top
    };
    let mut between = [0.0; 3];
    between[down] = 5e-3 * scale;
    let mut gravity = [0.0; 3];
    gravity[down] = -9.81 * scale;
    let names = ["x", "y", "z"];
    let sides: Vec<&str> = (0..3).filter(|k| *k != down).map(|k| names[k]).collect();
    json!({
        "kind": "poolsph.scene", "version": 2, "title": "Slag upon metal", "spacing_m": 1e-3 * scale,
        "time": {"step_s": 1e-3, "end_s": 0.05}, "density_kg_m3": 7000,
        "bodies": [
            {"shape": {"box": {"min_m": [0, 0, 0], "max_m": upto(5.0)}}, "state": "liquid"},
            {"shape": {"box": {"min_m": between, "max_m": upto(9.0)}}, "state": "liquid", "material": "slag"}
        ],
        "faces": {"min_m": [0, 0, 0], "max_m": corner, "periodic": sides, "wall": [{"face": format!("{}-", names[down])}]},
        "flow": {"viscosity_pa_s": 0.006 * scale * scale, "gravity_m_s2": gravity},
        "slag": {"density_kg_m3": 2700, "viscosity_pa_s": 0.05 * scale * scale},
        "output": {"particles_interval_s": 0.05, "precision": "f64"}
    })
}

#[test]
fn layers_at_rest_stay_at_rest_under_their_exact_pressure_at_any_scale_and_turned() {
    for (scale, down) in [(1.0, 2), (1.0, 0), (1e-2, 2), (100.0, 1)] {
        let folder = tempfile::tempdir().unwrap();
        let (said, code, frame) = run(folder.path(), &basin(scale, down), &[]);
        assert_eq!(code, Some(0), "{said}");
        let frame = frame.unwrap();
        let (places, velocities) = (
            frame.position_vectors().unwrap(),
            frame.vectors("velocity").unwrap(),
        );
        let (pressures, slag) = (frame.f64("pressure").unwrap(), frame.u8("slag").unwrap());
        assert_eq!(slag.iter().filter(|mark| **mark == 1).count(), 6 * 6 * 4);
        for (a, x) in places.iter().enumerate() {
            let z = x[down] / scale;
            let exact = 9.81
                * scale
                * scale
                * if slag[a] == 1 {
                    2700.0 * (9e-3 - z)
                } else {
                    2700.0 * 4e-3 + 7000.0 * (5e-3 - z)
                };
            assert!(
                (pressures[a] / exact - 1.0).abs() < 1e-5,
                "{scale} {down}: {} {exact}",
                pressures[a]
            );
            assert!(
                velocities[a].iter().all(|u| u.abs() < 1e-7 * scale),
                "{:?}",
                velocities[a]
            );
        }
    }
}

/// A basin whose interface has a hump, with tension.
fn hump() -> Value {
    let mut scene = basin(1.0, 2);
    scene["bodies"][0]["velocity_m_s"] =
        json!([{"expr": "0.05*sin(1047.19755*x)"}, 0, {"expr": "-0.05*cos(1047.19755*x)*z/0.005"}]);
    scene["slag"]["interface_tension_n_m"] = json!(0.5);
    scene["time"]["step_s"] = json!(2e-4);
    scene
}

#[test]
fn two_liquids_give_the_same_bytes_on_any_number_of_threads() {
    let frames = ["1", "2"].map(|threads| {
        let folder = tempfile::tempdir().unwrap();
        let (said, code, frame) = run(folder.path(), &hump(), &["--threads", threads]);
        assert_eq!(code, Some(0), "{said}");
        frame.unwrap().position_vectors().unwrap()
    });
    assert!(
        frames[0]
            .iter()
            .flatten()
            .zip(frames[1].iter().flatten())
            .all(|(a, b)| a.to_bits() == b.to_bits())
    );
}

#[test]
fn mass_and_momentum_are_those_of_both_liquids() {
    // A ball of metal with a cap of slag, alone and without weight, is driven by its tensions.
    let mut scene = hump();
    scene["faces"] = json!(null);
    scene["flow"] = json!({"viscosity_pa_s": 0.006});
    scene["tension"] = json!({"surface_tension_n_m": 1.2});
    scene["slag"]["surface_tension_n_m"] = json!(0.4);
    scene["bodies"] = json!([
        {"shape": {"intersection": [
            {"sphere": {"centre_m": [0, 0, 0], "radius_m": 0.004}},
            {"half_space": {"point_m": [0, 0, 0.001], "normal": [0, 0, 1]}}
        ]}, "state": "liquid", "velocity_m_s": [0.1, 0, 0], "lattice_m": [0, 0, 0]},
        {"shape": {"intersection": [
            {"sphere": {"centre_m": [0, 0, 0], "radius_m": 0.004}},
            {"half_space": {"point_m": [0, 0, 0.001], "normal": [0, 0, -1]}}
        ]}, "state": "liquid", "material": "slag", "velocity_m_s": [0.1, 0, 0], "lattice_m": [0, 0, 0]}
    ]);
    scene["time"]["end_s"] = json!(0.004);
    scene["output"]["balance_interval_s"] = json!(0.002);
    scene
        .as_object_mut()
        .unwrap()
        .retain(|_, value| !value.is_null());
    let folder = tempfile::tempdir().unwrap();
    let (said, code, frame) = run(folder.path(), &scene, &[]);
    assert!(code == Some(3) && said.contains("not balanced"), "{said}");
    let frame = frame.unwrap();
    let slag = frame.u8("slag").unwrap();
    let light = slag.iter().filter(|mark| **mark == 1).count() as f64;
    let mass = 1e-9 * (7000.0 * (slag.len() as f64 - light) + 2700.0 * light);
    let reader = Reader::open(folder.path().join("layers.mcap")).unwrap();
    let records = reader.records("/balance").unwrap();
    for (_, record) in &records {
        let held = record.get("mass_kg").unwrap();
        let moved = record.get("momentum_x").unwrap();
        assert!((held / mass - 1.0).abs() < 1e-12, "{held} {mass}");
        assert!((moved / (0.1 * mass) - 1.0).abs() < 1e-10, "{moved} {mass}");
        for other in ["momentum_y", "momentum_z"] {
            assert!(
                record.get(other).unwrap().abs() < 1e-10 * 0.1 * mass,
                "{other}"
            );
        }
    }
}

/// Half a ball of a liquid, three particles in radius, that sticks out of a pool of metal, with all tensions.
fn lens(slag: &Value) -> Value {
    let mut scene = basin(1.0, 2);
    scene["faces"]["max_m"] = json!([16e-3, 16e-3, 30e-3]);
    scene["faces"].as_object_mut().unwrap().remove("periodic");
    scene["faces"]["mirror"] = json!(["x-", "x+", "y-", "y+"]);
    scene["bodies"] = json!([
        {"shape": {"sphere": {"centre_m": [8e-3, 8e-3, 7e-3], "radius_m": 3e-3}}, "state": "liquid", "material": "slag", "lattice_m": [0, 0, 0]},
        {"shape": {"box": {"min_m": [0, 0, 0], "max_m": [16e-3, 16e-3, 7e-3]}}, "state": "liquid", "lattice_m": [0, 0, 0]}
    ]);
    scene["time"] = json!({"step_s": 1e-4, "end_s": 0.04});
    scene["tension"] = json!({"surface_tension_n_m": 1.2});
    scene["slag"] = slag.clone();
    scene
}

#[test]
fn a_lens_of_slag_throws_nothing_off_and_two_liquids_that_are_alike_move_as_one() {
    let slag = json!({"density_kg_m3": 2700, "viscosity_pa_s": 0.05, "interface_tension_n_m": 0.8, "surface_tension_n_m": 0.4});
    let alike = json!({"density_kg_m3": 7000, "viscosity_pa_s": 0.006});
    let mut one = lens(&alike);
    one.as_object_mut().unwrap().remove("slag");
    one["bodies"][0].as_object_mut().unwrap().remove("material");
    let ends = [lens(&slag), lens(&alike), one].map(|scene| {
        let folder = tempfile::tempdir().unwrap();
        let (said, _, frame) = run(folder.path(), &scene, &[]);
        let frame = frame.expect(&said);
        let places = frame.position_vectors().unwrap();
        let velocities = frame.vectors("velocity").unwrap();
        let highest = places.iter().fold(0.0, |most: f64, x| most.max(x[2]));
        let squares = velocities.iter().flatten().map(|u| u * u).sum::<f64>();
        (highest, (squares / places.len() as f64).sqrt())
    });
    // The half ball reaches up to 10 mm at the start.
    assert!(ends.iter().all(|end| end.0 < 10e-3), "{ends:?}");
    let [_, alike, one] = ends;
    assert!((alike.1 / one.1 - 1.0).abs() < 0.3, "{alike:?} {one:?}");
}

#[test]
fn no_metal_begins_within_a_drop_of_slag_on_another_lattice() {
    let mut scene = basin(1.0, 2);
    // The middle of the drop is one of the places of the box.
    scene["bodies"] = json!([
        {"shape": {"sphere": {"centre_m": [4.5e-3, 4.5e-3, 4.5e-3], "radius_m": 3e-3}}, "state": "liquid", "material": "slag"},
        {"shape": {"box": {"min_m": [0, 0, 0], "max_m": [9e-3, 9e-3, 9e-3]}}, "state": "liquid"}
    ]);
    scene.as_object_mut().unwrap().remove("faces");
    scene["time"] = json!({"step_s": 1e-5, "end_s": 1e-5});
    scene["output"] = json!({"particles_interval_s": 1e-5, "precision": "f64"});
    let folder = tempfile::tempdir().unwrap();
    let (said, _, frame) = run(folder.path(), &scene, &[]);
    let frame = frame.expect(&said);
    let places = frame.position_vectors().unwrap();
    for (x, slag) in places.iter().zip(frame.u8("slag").unwrap()) {
        let far = x.iter().map(|x| (x - 4.5e-3).powi(2)).sum::<f64>().sqrt();
        assert!(*slag == 1 || far > 2.9e-3, "{x:?}");
    }
}

#[test]
fn slag_that_cannot_be_is_refused_by_name() {
    let refused = |change: fn(&mut Value), told: &str| {
        let mut scene = basin(1.0, 2);
        change(&mut scene);
        let folder = tempfile::tempdir().unwrap();
        let (said, code, _) = run(folder.path(), &scene, &[]);
        assert_eq!(code, Some(2), "{said}");
        assert!(said.contains(told), "{said}");
    };
    refused(
        |scene| scene["flow"]["method"] = json!("projection"),
        "/flow/method",
    );
    refused(
        |scene| scene["slag"]["density_kg_m3"] = json!(1.0),
        "/slag/density_kg_m3",
    );
    refused(
        |scene| scene["bodies"][1]["state"] = json!("solid"),
        "/bodies/1/state",
    );
    refused(
        |scene| scene["bodies"][1]["material"] = json!("metal"),
        "no body is slag",
    );
    refused(
        |scene| drop(scene.as_object_mut().unwrap().remove("slag")),
        "/bodies/1/material",
    );
    let angles = |scene: &mut Value| {
        scene["slag"]["interface_tension_n_m"] = json!(0.5);
        scene["faces"]["contact_angles"] = json!([{"face": "z-", "angle_deg": 60}]);
    };
    refused(angles, "/faces/contact_angles");
    let warm = |scene: &mut Value| scene["heat"] = metal_heat();
    refused(warm, "/slag/heat");
    let alone = |scene: &mut Value| scene["slag"]["heat"] = slag_heat();
    refused(alone, "/slag/heat");
    let cold = |scene: &mut Value| {
        (scene["heat"], scene["slag"]["heat"]) = (metal_heat(), slag_heat());
        scene["flow"]["on_cold_metal"] = json!("sticks");
    };
    refused(cold, "/flow/on_cold_metal");
    let steep = |scene: &mut Value| {
        (scene["heat"], scene["slag"]["heat"]) = (metal_heat(), slag_heat());
        scene["slag"]["viscosity_pa_s"] = json!({"t_k": [300, 2000], "value": [1.0, -0.1]});
    };
    refused(steep, "/slag/viscosity_pa_s");
}

fn metal_heat() -> Value {
    json!({"thermal_conductivity_w_m_k": 30, "specific_heat_j_kg_k": 700, "melting": {"point_k": 1750, "latent_heat_j_kg": 2.5e5}})
}

fn slag_heat() -> Value {
    json!({"thermal_conductivity_w_m_k": 2, "specific_heat_j_kg_k": 1200, "melting": {"point_k": 1450, "latent_heat_j_kg": 4.5e5}})
}

/// Hot metal under cold slag that stiffens where it is cold, in a basin whose sides are mirrors.
fn warm(scale: f64) -> Value {
    let mut scene = basin(scale, 2);
    scene["faces"]["periodic"] = json!([]);
    scene["faces"]["mirror"] = json!(["x-", "x+", "y-", "y+"]);
    (scene["heat"], scene["slag"]["heat"]) = (metal_heat(), slag_heat());
    scene["slag"]["heat"]["thermal_conductivity_w_m_k"] = json!(20);
    scene["bodies"][0]["temperature_k"] = json!(1850);
    scene["bodies"][1]["temperature_k"] = json!(600);
    scene["slag"]["viscosity_pa_s"] = json!({"expr": "0.02 + 0.5*exp(-(T - 600)/400)"});
    scene["output"]["balance_interval_s"] = json!(0.05);
    scene
}

/// Heat stored \[J\], and errors of the mass and of the energy, at the end of a run.
fn balance(folder: &Path) -> [f64; 3] {
    let reader = Reader::open(folder.join("layers.mcap")).unwrap();
    let records = reader.records("/balance").unwrap();
    let of = |k: usize, name: &str| records[k].1.get(name).unwrap();
    let last = records.len() - 1;
    let [first, mass] = [0, last].map(|k| of(k, "mass_kg"));
    [
        of(last, "energy_stored_j"),
        mass / first - 1.0,
        of(last, "closure"),
    ]
}

#[test]
fn slag_and_metal_exchange_heat_and_none_is_lost() {
    let folder = tempfile::tempdir().unwrap();
    let (said, code, frame) = run(folder.path(), &warm(1.0), &["--threads", "2"]);
    assert_eq!(code, Some(0), "{said}");
    let frame = frame.unwrap();
    let (temperatures, slag) = (frame.f64("temperature").unwrap(), frame.u8("slag").unwrap());
    let most = |of: u8| {
        let own = temperatures
            .iter()
            .zip(slag)
            .filter(|(_, mark)| **mark == of);
        own.fold([f64::INFINITY, 0.0], |[low, high], (t, _)| {
            [t.min(low), t.max(high)]
        })
    };
    let ([coldest, hottest], [cold, hot]) = (most(0), most(1));
    assert!(coldest < 1849.0 && hottest <= 1850.0, "{coldest} {hottest}");
    assert!(cold >= 600.0 && hot > 601.0, "{cold} {hot}");
    let [stored, mass, energy] = balance(folder.path());
    let exchanged = 1e-9 * 6.0 * 6.0 * 4.0 * 2700.0 * 1200.0 * 50.0;
    assert!(
        stored.abs() < 1e-10 * exchanged && mass.abs() < 1e-12 && energy.abs() < 1e-10,
        "{stored}"
    );
    // The same bytes on one thread.
    let again = tempfile::tempdir().unwrap();
    let (_, _, other) = run(again.path(), &warm(1.0), &["--threads", "1"]);
    assert_eq!(temperatures, other.unwrap().f64("temperature").unwrap());
}

#[test]
fn what_a_torch_gives_to_slag_and_what_slag_radiates_is_balanced() {
    let mut scene = warm(1.0);
    scene["torches"] = json!([{
        "power_w": 500, "shape": {"gaussian": {"radius_m": 2e-3}}, "path": {"points_m": [[3e-3, 3e-3, 9e-3]]}, "efficiency": 1
    }]);
    scene["losses"] = json!({"emissivity": 0.8, "transfer_w_m2_k": 1e3, "surroundings_k": 300});
    let folder = tempfile::tempdir().unwrap();
    let (said, code, _) = run(folder.path(), &scene, &[]);
    assert!(matches!(code, Some(0 | 3)), "{said}");
    let [stored, mass, energy] = balance(folder.path());
    // 500 W over 50 ms, less what is radiated.
    assert!((5.0..25.0).contains(&stored), "{stored}");
    assert!(
        mass.abs() < 1e-12 && energy.abs() < 1e-10,
        "{mass} {energy}"
    );
}
