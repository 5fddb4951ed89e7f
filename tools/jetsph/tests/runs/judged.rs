//! What of the water of a scene is put right, refused, or told at the end.

use super::{begun, parsed};
use jetsph::assemble::{Assembled, assemble};
use jetsph::state::MASS;

/// A scene with bodies of water, and with more of water and of all else.
fn scene(bodies: &str, water: &str, more: &str) -> String {
    format!(
        r#"{{"kind": "jetsph.scene", "version": 1, "dimensions": 2, "time": {{"end_s": 1}},
            "water": {{"density_kg_m3": 1000, "spacing_m": 0.001, "bodies": [{bodies}]{water}}},
            "output": {{"frames_interval_s": 1}}{more}}}"#
    )
}

/// A body of water between corners \[mm\].
fn body(low: [i32; 2], high: [i32; 2], more: &str) -> String {
    let [a, b, c, d] = [low[0], low[1], high[0], high[1]].map(|x| f64::from(x) * 1e-3);
    format!(r#"{{"body": {{"box": {{"min_m": [{a}, {b}], "max_m": [{c}, {d}]}}}}{more}}}"#)
}

const SOUND: &str = r#", "sound_speed_m_s": 20"#;

fn mass(run: &Assembled) -> f64 {
    run.state.sets[0].column(&MASS).iter().sum()
}

/// What is said of a scene that is refused.
fn refused(text: &str) -> String {
    let faults = assemble(&parsed(text)).err().unwrap();
    faults.iter().map(ToString::to_string).collect()
}

fn close(found: f64, exact: f64) -> bool {
    (found / exact - 1.0).abs() < 1e-12
}

#[test]
fn bodies_that_overlap_hold_the_water_of_both_together() {
    let two = [body([0, 0], [8, 4], ""), body([4, 0], [12, 6], "")].join(", ");
    let run = assemble(&parsed(&scene(&two, SOUND, ""))).unwrap();
    // 8 x 4 and 8 x 6 square millimetres less 4 x 4.
    assert!(close(mass(&run), 1000.0 * 64e-6), "{}", mass(&run));
    assert!(run.notes[0].contains("16 of 48 particles are left out"));
    let beside = [body([0, 0], [8, 4], ""), body([8, 0], [12, 4], "")].join(", ");
    let run = assemble(&parsed(&scene(&beside, SOUND, ""))).unwrap();
    assert!(run.notes.is_empty() && close(mass(&run), 1000.0 * 48e-6));
}

#[test]
fn water_leaves_room_for_nozzles_walls_and_solids() {
    let nozzle = r#", "sound_speed_m_s": 20, "nozzles": [{"name": "jet", "exit_m": [0, 0], "direction": [0, -1],
        "width_m": 0.004, "speed_m_s": 2}]"#;
    let across = scene(&body([-6, -4], [6, 10], ""), nozzle, "");
    let run = assemble(&parsed(&across)).unwrap();
    assert!(close(mass(&run), 1000.0 * 168e-6), "{}", mass(&run));
    let post = r#"{"box": {"min_m": [-0.001, 0], "max_m": [0.001, 0.005]}}"#;
    let water = body([-6, 0], [6, 10], "");
    for more in [
        format!(r#", "walls": [{{"name": "post", "body": {post}}}]"#),
        format!(
            r#", "solids": [{{"name": "post", "body": {post}, "spacing_m": 0.001, "density_kg_m3": 1000,
                "elastic": {{"youngs_modulus_pa": 1e6, "poisson_ratio": 0.3}}}}]"#
        ),
    ] {
        let run = assemble(&parsed(&scene(&water, SOUND, &more))).unwrap();
        let set = run.state.sets.iter().find(|set| set.name() == "water");
        let mass: f64 = set.unwrap().column(&MASS).iter().sum();
        assert!(close(mass, 1000.0 * 110e-6), "{mass}");
    }
}

#[test]
fn water_without_room_and_nozzles_within_each_other_are_refused() {
    let twice = [body([0, 0], [8, 4], ""), body([2, 1], [6, 3], "")].join(", ");
    let said = refused(&scene(&twice, SOUND, ""));
    assert!(
        said.contains("/water/bodies/1/body") && said.contains("no room"),
        "{said}"
    );
    let nozzle = |name: &str, x: f64| {
        format!(
            r#"{{"name": "{name}", "exit_m": [{x}, 0], "direction": [0, -1], "width_m": 0.004, "speed_m_s": 2}}"#
        )
    };
    let nozzles = |x: f64| {
        let both = [nozzle("left", 0.0), nozzle("right", x)].join(", ");
        scene(
            &body([0, -9], [8, -5], ""),
            &format!(r#", "nozzles": [{both}]"#),
            "",
        )
    };
    let said = refused(&nozzles(0.003));
    assert!(
        said.contains("/water/nozzles/1/exit_m") && said.contains("\"left\""),
        "{said}"
    );
    assert!(assemble(&parsed(&nozzles(0.004))).is_ok());
}

#[test]
fn pressures_that_the_water_cannot_bear_are_refused() {
    let pulled = body([0, 0], [8, 4], r#", "pressure_pa": -100"#);
    let said = refused(&scene(&pulled, SOUND, ""));
    assert!(
        said.contains("/water/bodies/0/pressure_pa: is -100 Pa"),
        "{said}"
    );
    let full = r#", "sound_speed_m_s": 20, "tension": "full""#;
    assert!(assemble(&parsed(&scene(&pulled, full, ""))).is_ok());
    // B = c^2 rho/7 = 57,143 Pa.
    let torn = body([0, 0], [8, 4], r#", "pressure_pa": -6e4"#);
    let said = refused(&scene(&torn, full, ""));
    assert!(said.contains("ends at -5.714e4 Pa"), "{said}");
}

#[test]
fn nozzles_that_never_run_are_refused_or_told() {
    let nozzle = |runs: &str| {
        let of = format!(
            r#", "sound_speed_m_s": 20, "nozzles": [{{"name": "jet", "exit_m": [0, 9], "direction": [0, -1], "width_m": 0.004,
                "speed_m_s": 2, {runs}}}]"#
        );
        scene(&body([0, 0], [8, 4], ""), &of, "")
    };
    let said = refused(&nozzle(r#""start_s": 0.5, "end_s": 0.5"#));
    assert!(said.contains("/water/nozzles/0/end_s"), "{said}");
    let told = |time: f64| {
        let mut run = assemble(&parsed(&nozzle(r#""start_s": 0.5"#))).unwrap();
        run.state.time = time;
        let stages = run.march.stages.iter();
        stages.filter_map(|stage| stage.warning(&run.state)).next()
    };
    assert!(told(0.4).unwrap().contains("brought no water"));
    assert_eq!(told(0.6), None);
}

#[test]
fn water_that_is_compressed_much_is_told() {
    let plate = r#", "walls": [{"name": "plate", "body": {"half_space": {"point_m": [0, 0], "normal": [0, 1]}}}]"#;
    let told = |sound: f64| {
        let block = body([-6, 0], [6, 12], r#", "velocity_m_s": [0, -5]"#);
        let mut run = begun(&scene(
            &block,
            &format!(r#", "sound_speed_m_s": {sound}"#),
            plate,
        ));
        while run.state.time < 2e-3 {
            let limit = run.march.limit(&run.state);
            let dt = limit.map_or(1e-5, |limit| limit.seconds.min(1e-5));
            run.march
                .step(&mut run.state, dt, &mut |_, work| work())
                .unwrap();
            run.state.time += dt;
        }
        let stages = run.march.stages.iter();
        stages.filter_map(|stage| stage.warning(&run.state)).next()
    };
    let slow = told(5.0).unwrap();
    assert!(
        slow.contains("the speed of sound of 5 m/s is too low"),
        "{slow}"
    );
    // Ten times as fast as the water: the rule of the source.
    assert_eq!(told(50.0), None);
}

/// Solids within each other burst apart, and water of a nozzle within a wall or a solid was put before it.
#[test]
fn solids_within_each_other_and_nozzles_within_anything_are_refused() {
    let solid = |name: &str, low: f64| {
        let high = low + 0.004;
        format!(
            r#"{{"name": "{name}", "spacing_m": 0.001, "density_kg_m3": 1000,
                "body": {{"box": {{"min_m": [{low}, 0], "max_m": [{high}, 0.004]}}}},
                "elastic": {{"youngs_modulus_pa": 1e6, "poisson_ratio": 0.3}}}}"#
        )
    };
    let both = |low: f64| {
        let both = [solid("left", 0.0), solid("right", low)].join(", ");
        scene(
            &body([0, 6], [8, 9], ""),
            SOUND,
            &format!(r#", "solids": [{both}]"#),
        )
    };
    let said = refused(&both(0.002));
    assert!(
        said.contains("/solids/1/body") && said.contains("8 of its 16"),
        "{said}"
    );
    assert!(assemble(&parsed(&both(0.004))).is_ok());
    let nozzle = |y: f64| {
        let nozzle = format!(
            r#", "nozzles": [{{"name": "jet", "exit_m": [0.002, {y}], "direction": [0, 1], "width_m": 0.002, "speed_m_s": 2}}]"#
        );
        scene(
            "",
            &nozzle,
            &format!(r#", "solids": [{}]"#, solid("left", 0.0)),
        )
    };
    let said = refused(&nozzle(0.002));
    assert!(
        said.contains("/water/nozzles/0/exit_m") && said.contains("\"left\""),
        "{said}"
    );
    assert!(assemble(&parsed(&nozzle(0.004))).is_ok());
}
