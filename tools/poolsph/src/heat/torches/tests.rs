//! Power of torches, and a point source against its exact solution.

use std::sync::Arc as Shared;

use super::*;
use crate::heat::Caloric;
use crate::heat::caloric::tests::plain;
use crate::state::{ENTHALPY, Particle, phase};
use crate::surface::Surface;

const DEEP: &str = r#"{"double_ellipsoid": {"half_width_m": 0.003, "depth_m": 0.002, "front_m": 0.002, "rear_m": 0.004}}"#;
const DISC: &str = r#"{"gaussian": {"radius_m": 0.003}}"#;

fn torch(shape: &str, more: &str) -> Torch {
    let text = format!(
        r#"{{"power_w": 1000, "efficiency": 0.6, "shape": {shape},
        "path": {{"points_m": [[0.01, 0.008, 0.01], [0.01, 0.012, 0.01]], "speed_m_s": 0.02}}{more}}}"#
    );
    serde_json::from_str(&text).unwrap()
}

/// A block of 20 x 20 x 10 mm with its top at z = 10 mm, at rest.
fn block(spacing: f64, caloric: &Caloric) -> State {
    plates(spacing, caloric, &[([0.0; 3], [0.02, 0.02, 0.01])])
}

/// Plates at rest, each of a corner and its edges.
fn plates(spacing: f64, caloric: &Caloric, plates: &[([f64; 3], [f64; 3])]) -> State {
    let metal = Matter {
        density: 1000.0,
        spacing,
        smoothing_length: spacing,
    };
    let mut state = State::new(metal);
    state.metal.declare(&TEMPERATURE);
    state.metal.declare(&ENTHALPY);
    patch::declare(&mut state.metal);
    for (corner, edges) in plates {
        let n = edges.map(|edge| (edge / spacing).round() as usize);
        for i in 0..n[0] * n[1] * n[2] {
            let index = [i % n[0], i / n[0] % n[1], i / (n[0] * n[1])];
            state.push(Particle {
                position: [0, 1, 2].map(|k| corner[k] + (index[k] as f64 + 0.5) * spacing),
                velocity: [0.0; 3],
                phase: phase::SOLID,
                droplet: false,
                wall: false,
                temperature: 300.0,
                enthalpy: caloric.enthalpy(300.0),
            });
        }
    }
    state.gather();
    Surface::new(metal).advance(&mut state, 1e-3).unwrap();
    state
}

fn heated(torch: Torch, spacing: f64, times: &[f64]) -> (f64, Torches) {
    let caloric = Shared::new(plain(30.0, 500.0, None));
    let mut state = block(spacing, &caloric);
    let before: f64 = state.metal.column(&ENTHALPY).iter().sum();
    let mut stage = Torches::new(
        &[torch],
        Substances::of(caloric, state.metal.matter),
        state.metal.matter,
    )
    .unwrap();
    for time in times {
        state.time = *time;
        stage.advance(&mut state, 0.01).unwrap();
    }
    let gained = state.metal.column(&ENTHALPY).iter().sum::<f64>() - before;
    (gained * state.metal.matter.mass(), stage)
}

#[test]
fn power_is_exact_at_every_spacing() {
    for shape in [DEEP, DISC] {
        for spacing in [0.002, 0.001] {
            let (gained, stage) = heated(torch(shape, ""), spacing, &[0.0, 0.01]);
            // 600 W for two steps of 10 ms.
            assert!(
                (gained / 12.0 - 1.0).abs() < 1e-9,
                "{shape} {spacing} {gained}"
            );
            let put = stage.figures()[2].value;
            assert!((put / gained - 1.0).abs() < 1e-9);
            assert!(stage.warnings().is_empty(), "{:?}", stage.warnings());
        }
    }
}

#[test]
fn the_arc_burns_from_its_start_to_its_end_within_steps() {
    let mut short = torch(DEEP, "");
    short.path.start_s = 0.004;
    short.path.end_s = Some(0.013);
    let (gained, _) = heated(short, 0.002, &[0.0, 0.01, 0.02]);
    assert!((gained / (600.0 * 0.009) - 1.0).abs() < 1e-9, "{gained}");
}

#[test]
fn energy_that_is_lost_by_a_hundredth_is_told_with_both_figures() {
    let lit = |lost: f64| {
        let mut lit = Lit {
            torch: torch(DEEP, r#", "beyond": "lost""#),
            put: Sum::default(),
            lost: Sum::default(),
            least: 0.96,
            most: 1.0,
        };
        lit.put.add(300.0 - lost);
        lit.lost.add(lost);
        lit.little()
    };
    assert_eq!(lit(2.9), None);
    let told = lit(12.0).unwrap();
    assert!(
        told.contains("3.0000e2 J the metal takes 2.8800e2 J"),
        "{told}"
    );
}

#[test]
fn what_lies_outside_is_lost_where_it_is_asked_for_and_told() {
    let mut aside = torch(DEEP, r#", "beyond": "lost""#);
    for corner in &mut aside.path.points_m {
        corner[0] = 0.0;
    }
    let (gained, stage) = heated(aside.clone(), 0.001, &[0.0]);
    assert!((gained / 3.0 - 1.0).abs() < 2e-3, "{gained}");
    let lost = stage.figures()[3].value;
    assert!((gained + lost - 6.0).abs() < 1e-9 && stage.warnings()[0].contains("lost"));
    aside.beyond = Beyond::Inside;
    let (gained, stage) = heated(aside, 0.001, &[0.0]);
    assert!((gained / 6.0 - 1.0).abs() < 1e-9, "{gained}");
    assert!(stage.warnings()[0].contains("given to it too"));
}

/// What a torch that leans by 45 degrees gives to plates, by the height up to which they lie \[J\].
fn leaning(bodies: &[([f64; 3], [f64; 3])], below: f64) -> (f64, f64, Torches) {
    let leans = torch(DISC, r#", "points_to": [1, 0, -1]"#);
    let caloric = Shared::new(plain(30.0, 500.0, None));
    let mut state = plates(0.001, &caloric, bodies);
    let mut stage = Torches::new(
        &[leans],
        Substances::of(caloric.clone(), state.metal.matter),
        state.metal.matter,
    )
    .unwrap();
    stage.advance(&mut state, 0.01).unwrap();
    let gained = state.metal.column(&ENTHALPY).iter();
    let gained = gained.map(|h| (h - caloric.enthalpy(300.0)) * state.metal.matter.mass());
    let places = state.metal.column(&POSITION);
    let (mut low, mut all) = (0.0, 0.0);
    for (x, gained) in places.iter().zip(gained) {
        all += gained;
        low += if x[2] < below { gained } else { 0.0 };
    }
    (low, all, stage)
}

#[test]
fn a_torch_that_leans_sees_all_of_a_plate_and_nothing_behind_one() {
    let plate = ([0.0; 3], [0.02, 0.02, 0.01]);
    let (_, all, stage) = leaning(&[plate], 0.01);
    assert!((all / 6.0 - 1.0).abs() < 1e-9, "{all}");
    assert!(stage.warnings().is_empty(), "{:?}", stage.warnings());
    // 4 mm above it, on the way of the torch, and so wide that it takes the whole.
    let screen = ([-0.006, -0.01, 0.014], [0.024, 0.04, 0.002]);
    let (low, all, stage) = leaning(&[plate, screen], 0.01);
    assert!((all / 6.0 - 1.0).abs() < 1e-9, "{all}");
    assert!(low < 1e-3 * all, "{low} of {all}");
    assert!(stage.warnings().is_empty(), "{:?}", stage.warnings());
}

#[test]
fn half_a_plate_beside_its_mirror_takes_half_of_a_torch_upon_it() {
    let faces = r#"{"min_m": [0.01, -1, -1], "max_m": [1, 1, 1], "mirror": ["x-"]}"#;
    let faces: crate::faces::Parameters = serde_json::from_str(faces).unwrap();
    let caloric = Shared::new(plain(30.0, 500.0, None));
    for more in ["", r#", "beyond": "lost""#] {
        let mut half = plates(0.001, &caloric, &[([0.01, 0.0, 0.0], [0.01, 0.02, 0.01])]);
        half.faces = faces.faces(0.002, true).unwrap();
        let torch = torch(DEEP, more);
        let mut stage = Torches::new(
            &[torch],
            Substances::of(caloric.clone(), half.metal.matter),
            half.metal.matter,
        )
        .unwrap();
        stage.advance(&mut half, 0.01).unwrap();
        let [power, inside, put, lost] = [0, 1, 2, 3].map(|k| stage.figures()[k].value);
        assert!((put + lost - 3.0).abs() < 1e-9, "{put} {lost}");
        assert!(
            (power * 0.01 - put).abs() < 1e-9 && inside > 0.99,
            "{power} {inside}"
        );
        assert!(
            lost.abs() < 0.03 && stage.warnings().is_empty(),
            "{:?}",
            stage.warnings()
        );
    }
}

#[test]
fn a_torch_that_weaves_across_a_mirror_gives_half() {
    let faces = r#"{"min_m": [0.01, -1, -1], "max_m": [1, 1, 1], "mirror": ["x-"]}"#;
    let faces: crate::faces::Parameters = serde_json::from_str(faces).unwrap();
    let caloric = Shared::new(plain(30.0, 500.0, None));
    let mut half = plates(0.001, &caloric, &[([0.01, 0.0, 0.0], [0.01, 0.02, 0.01])]);
    half.faces = faces.faces(0.002, true).unwrap();
    let mut weaves = torch(DISC, "");
    let weave = r#"{"amplitude_m": 0.001, "frequency_hz": 50}"#;
    weaves.path.weave = serde_json::from_str(weave).unwrap();
    let mut stage = Torches::new(
        &[weaves],
        Substances::of(caloric, half.metal.matter),
        half.metal.matter,
    )
    .unwrap();
    stage.advance(&mut half, 0.01).unwrap();
    assert!((stage.figures()[2].value - 3.0).abs() < 1e-9);
}

#[test]
fn metal_behind_a_torch_takes_no_more_than_the_whole_power() {
    let mut sunk = torch(DEEP, r#", "beyond": "lost""#);
    for corner in &mut sunk.path.points_m {
        corner[2] -= 0.002;
    }
    let (gained, stage) = heated(sunk, 0.001, &[0.0]);
    assert!((gained / 6.0 - 1.0).abs() < 1e-9, "{gained}");
    assert!(stage.figures()[3].value.abs() < 1e-12);
    let told = stage.warnings();
    assert!(told.len() == 1 && told[0].contains("no more"), "{told:?}");
}

#[test]
fn particles_that_widen_a_torch_are_told() {
    let narrow = r#"{"gaussian": {"radius_m": 0.0005}}"#;
    let (gained, stage) = heated(torch(narrow, ""), 0.001, &[0.0]);
    assert!((gained / 6.0 - 1.0).abs() < 1e-9, "{gained}");
    assert!(stage.warnings().last().unwrap().contains("spacing_m"));
}

#[test]
fn a_resumed_stage_has_its_sums() {
    let (_, stage) = heated(torch(DISC, ""), 0.002, &[0.0]);
    let caloric = Shared::new(plain(30.0, 500.0, None));
    let mut other = Torches::new(
        &[torch(DISC, "")],
        Substances::of(caloric, stage.metal),
        stage.metal,
    )
    .unwrap();
    other.restore(&stage.save());
    assert_eq!(other.save(), stage.save());
}

#[test]
fn a_fast_torch_is_followed_within_a_step() {
    let mut fast = torch(DEEP, "");
    fast.path.speed_m_s = Some(0.4);
    let (gained, stage) = heated(fast, 0.001, &[0.0]);
    assert_eq!(stage.parts(), 8);
    assert!((gained / 6.0 - 1.0).abs() < 1e-9);
}
