//! Water beside solids: it rests where it should, and comes between no solid and the wall on which it stands.

use super::{begun, steps};
use jetsph::state::{ACCELERATION, VELOCITY};
use particles::POSITION;

/// Water at rest on both sides of a block that is held below and stands on the floor of a tank.
const TANK: &str = r#"{
    "kind": "jetsph.scene", "version": 1, "dimensions": 2,
    "time": {"end_s": 1},
    "gravity_m_s2": [0, -9.81],
    "solids": [{"name": "block", "body": {"box": {"min_m": [0.04, 0], "max_m": [0.06, 0.03]}}, "spacing_m": 0.005,
        "density_kg_m3": 1000, "elastic": {"youngs_modulus_pa": 1e5, "poisson_ratio": 0.3}, "clamps": [{"on": ["y-"]}],
        "damping_1_s": 20}],
    "water": {"density_kg_m3": 1000, "spacing_m": 0.005, "reference_speed_m_s": 1, "artificial_viscosity": {"linear": 0.1},
        "density_diffusion": {"form": "antuono"},
        "bodies": [{"body": {"box": {"min_m": [0, 0], "max_m": [0.1, 0.05]}}, "pressure_pa": {"expr": "9810*(0.05 - y)"}}]},
    "walls": [{"name": "floor", "body": {"half_space": {"point_m": [0, 0], "normal": [0, 1]}}},
              {"name": "left", "body": {"half_space": {"point_m": [0, 0], "normal": [1, 0]}}},
              {"name": "right", "body": {"half_space": {"point_m": [0.1, 0], "normal": [-1, 0]}}}],
    "output": {"frames_interval_s": 1}
}"#;

/// Water beside a face fell with a quarter of gravity: the solid had its own pressure above and below it.
#[test]
fn pressure_that_grows_along_a_face_pushes_nothing_along_it() {
    let run = begun(TANK);
    let water = &run.state.sets[1];
    let places = water.column(&POSITION).iter();
    let beside = places
        .zip(water.column(&ACCELERATION))
        .filter(|(x, _)| (x[0] - 0.0375).abs() < 1e-6 && x[1] > 0.011 && x[1] < 0.019);
    let pulls: Vec<f64> = beside.map(|(_, pull)| pull[1] / 9.81).collect();
    assert_eq!(pulls.len(), 2);
    assert!(pulls.iter().all(|pull| pull.abs() < 0.1), "{pulls:?}");
}

/// Water crept along the floor beneath the block.
#[test]
fn water_beside_a_block_on_the_floor_stays_out() {
    // The bits do not depend on threads, and so few particles take longer on several.
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build();
    let run = pool.unwrap().install(|| {
        let mut run = begun(TANK);
        steps(&mut run, 10_000);
        run
    });
    for x in run.state.sets[1].column(&POSITION) {
        let inside = x[0] > 0.043 && x[0] < 0.057 && x[1] < 0.027;
        assert!(!inside, "water at {x:?} is within the block or beneath it");
    }
    let water = &run.state.sets[1];
    let squares = water.column(&VELOCITY).iter().flatten().map(|u| u * u);
    let speed = (squares.sum::<f64>() / water.len() as f64).sqrt() / (9.81_f64 * 0.05).sqrt();
    assert!(speed < 3e-3, "{speed}");
}
