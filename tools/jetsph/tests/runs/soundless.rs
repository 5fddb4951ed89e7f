//! Water without sound.

use super::{begun, parsed};
use jetsph::assemble::{Assembled, assemble};
use jetsph::balance::Balance;
use jetsph::state::VELOCITY;
use particles::POSITION;

/// A jet that pulses, leans and moves, falls on a plate beside a post, and leaves.
pub(super) const JET: &str = r#"{
    "kind": "jetsph.scene", "version": 1, "dimensions": 2,
    "time": {"end_s": 1},
    "water": {
        "density_kg_m3": 1000, "spacing_m": 0.001, "method": "divergence_free",
        "bodies": [{"body": {"box": {"min_m": [-0.004, 0], "max_m": [0.004, 0.003]}}}],
        "nozzles": [{"name": "jet", "exit_m": [0, 0.008], "direction": [0.2, -1], "width_m": 0.004,
                     "speed_m_s": {"expr": "5 + sin(2000*t)"}, "profile": {"expr": "1 - 0.5*r^2"}, "traverse_m_s": [0.5, 0]}],
        "outlets": [{"name": "around", "beyond": {"box": {"min_m": [-0.006, -1], "max_m": [0.006, 1]}}}]
    },
    "gravity_m_s2": [0, -9.81],
    "walls": [{"name": "plate", "body": {"half_space": {"point_m": [0, 0], "normal": [0, 1]}}},
              {"name": "post", "body": {"box": {"min_m": [0.006, 0], "max_m": [0.008, 0.002]}},
               "repulsion": {"strength_m2_s2": 25}}],
    "output": {"frames_interval_s": 1}
}"#;
/// A jet that meets nothing.
const ALONE: &str = r#"{
    "kind": "jetsph.scene", "version": 1, "dimensions": 2,
    "time": {"end_s": 1},
    "water": {
        "density_kg_m3": 1000, "spacing_m": 0.001, "method": "divergence_free",
        "nozzles": [{"name": "jet", "exit_m": [0, 0], "direction": [3, -4], "width_m": 0.0073, "speed_m_s": 5}]
    },
    "output": {"frames_interval_s": 1}
}"#;
/// Two blocks of water that meet in the air.
const CLASH: &str = r#"{
    "kind": "jetsph.scene", "version": 1, "dimensions": 3,
    "time": {"end_s": 1},
    "water": {
        "density_kg_m3": 1000, "spacing_m": 0.001, "method": "divergence_free",
        "bodies": [{"body": {"box": {"min_m": [0, 0, 0], "max_m": [0.006, 0.006, 0.006]}}, "velocity_m_s": [0, 0, 2]},
                   {"body": {"box": {"min_m": [0.001, 0.002, 0.008], "max_m": [0.006, 0.006, 0.012]}}, "velocity_m_s": [0, 0.5, -2]}]
    },
    "output": {"frames_interval_s": 1}
}"#;

/// Steps within all limits, as a run takes them.
fn march(run: &mut Assembled, n: usize) {
    for _ in 0..n {
        let limit = run.march.limit(&run.state);
        let dt = limit.map_or(5e-5, |limit| limit.seconds.min(5e-5));
        run.march
            .step(&mut run.state, dt, &mut |_, work| work())
            .unwrap();
        run.state.time += dt;
    }
}

#[test]
fn a_jet_that_meets_nothing_keeps_its_speed_to_the_last_bit() {
    let mut run = begun(ALONE);
    let dt = 0.1 * 0.001 / 5.0;
    for _ in 0..600 {
        run.march
            .step(&mut run.state, dt, &mut |_, work| work())
            .unwrap();
        run.state.time += dt;
    }
    let set = &run.state.sets[0];
    let told = set.column(&VELOCITY)[0].map(f64::to_bits);
    assert!(set.len() > 400, "{}", set.len());
    assert!(
        set.column(&VELOCITY)
            .iter()
            .all(|u| u.map(f64::to_bits) == told)
    );
    let flown = set.column(&POSITION).iter().map(|x| x[0].hypot(x[1]));
    assert!(flown.fold(0.0, f64::max) > 0.055);
}

#[test]
fn water_without_sound_comes_and_leaves_and_the_books_close() {
    let mut run = begun(JET);
    let start = Balance::of(&run.state, &run.march);
    march(&mut run, 900);
    let now = Balance::of(&run.state, &run.march);
    assert!(
        now.entry.mass.abs() > 0.05 * start.mass,
        "nothing came or left: {now:?}"
    );
    assert!(now.mass_error(&start).abs() < 1e-12, "{now:?}");
    assert!(
        now.momentum_error(&start) < 1e-8,
        "{}",
        now.momentum_error(&start)
    );
    assert!(now.energy_error(&start).abs() < 0.02, "{now:?} {start:?}");
}

#[test]
fn blocks_that_meet_in_the_air_keep_their_momentum_and_gain_nothing() {
    let mut run = begun(CLASH);
    let start = Balance::of(&run.state, &run.march);
    march(&mut run, 150);
    let now = Balance::of(&run.state, &run.march);
    assert!(
        now.momentum_error(&start) < 1e-12,
        "{}",
        now.momentum_error(&start)
    );
    assert!(
        now.kinetic < 0.9 * start.kinetic,
        "they did not meet: {now:?}"
    );
    assert!(now.energy_error(&start).abs() < 1e-9, "{now:?}");
}

/// A run with frames every 2 ms.
fn run_until(run: &mut Assembled, end: f64) {
    while run.state.time < end {
        let limit = run.march.limit(&run.state);
        let dt = limit.map_or(2e-3, |limit| limit.seconds.min(2e-3));
        run.march
            .step(&mut run.state, dt, &mut |_, work| work())
            .unwrap();
        run.state.time += dt;
    }
}

/// Water that the nozzle has brought \[kg/m\].
fn entered(run: &Assembled) -> f64 {
    let stages = run.march.stages.iter();
    let figures = stages.flat_map(|stage| stage.figures(&run.state));
    let entered = figures.filter(|figure| figure.name == "jet_entered");
    entered.map(|figure| figure.value).sum()
}

#[test]
fn a_pulse_that_is_over_between_two_frames_comes() {
    // 3 mm of water within 60 us, at a time that no even division of the run meets.
    let pulse = r#""speed_m_s": {"expr": "50*step(t - 0.00102)*step(0.00108 - t)"}"#;
    let mut run = begun(&ALONE.replace("\"speed_m_s\": 5", pulse));
    run_until(&mut run, 4e-3);
    let told = 1000.0 * 0.0073 * 3e-3;
    // Water comes a row of particles at a time, 1 mm.
    let row = 1000.0 * 0.0073 * 1e-3;
    assert!(
        (entered(&run) - told).abs() <= row,
        "{} of {told}",
        entered(&run)
    );
}

#[test]
fn a_jet_that_starts_late_comes_whole_and_stays_before_its_plate() {
    let late = ALONE
        .replace("\"speed_m_s\": 5", "\"speed_m_s\": 5, \"start_s\": 2e-3")
        .replace("\"direction\": [3, -4]", "\"direction\": [0, -1]")
        .replace(
            "\"output\"",
            r#""walls": [{"name": "plate", "body": {"half_space": {"point_m": [0, -0.01], "normal": [0, 1]}}}], "output""#,
        );
    let mut run = begun(&late);
    run_until(&mut run, 8e-3);
    let entered = entered(&run);
    let told = 1000.0 * 0.0073 * 5.0 * (run.state.time - 2e-3);
    assert!((entered / told - 1.0).abs() < 0.05, "{entered} of {told}");
    let lowest = run.state.sets[0].column(&POSITION).iter().map(|x| x[1]);
    let lowest = lowest.fold(f64::INFINITY, f64::min);
    // Shifts may take a particle a little behind the plate, until it is looked at anew.
    assert!(lowest > -0.01 - 0.1 * 0.001, "{lowest}");
}

#[test]
fn water_weighs_what_its_body_holds() {
    let weight = |body: &str, dimensions: u32, method: &str| {
        let velocity = &[1, 0, 0][..dimensions as usize];
        let text = format!(
            r#"{{"kind": "jetsph.scene", "version": 1, "dimensions": {dimensions}, "time": {{"end_s": 1}},
                "water": {{"density_kg_m3": 1000, "spacing_m": 0.001, "method": "{method}", "bodies": [{{"body": {body}, "velocity_m_s": {velocity:?}}}]}},
                "output": {{"frames_interval_s": 1}}}}"#
        );
        let Assembled { state, march, .. } = assemble(&parsed(&text)).unwrap();
        Balance::of(&state, &march).mass
    };
    for radius in [0.0023, 0.00371, 0.0052] {
        for method in ["divergence_free", "weakly_compressible"] {
            let disc = format!(r#"{{"disc": {{"centre_m": [0.0003, 0], "radius_m": {radius}}}}}"#);
            let exact = 1000.0 * std::f64::consts::PI * radius * radius;
            let off = weight(&disc, 2, method) / exact - 1.0;
            assert!(off.abs() < 5e-3, "disc of {radius} m: {off}");
            let ball =
                format!(r#"{{"sphere": {{"centre_m": [0, 0, 0.0004], "radius_m": {radius}}}}}"#);
            let exact = 4.0 / 3.0 * exact * radius;
            let off = weight(&ball, 3, method) / exact - 1.0;
            assert!(off.abs() < 5e-3, "ball of {radius} m: {off}");
        }
    }
    let fit = weight(
        r#"{"box": {"min_m": [0, 0], "max_m": [0.0053, 0.004]}}"#,
        2,
        "divergence_free",
    );
    assert!((fit / 0.0212 - 1.0).abs() < 1e-12, "{fit}");
}
