//! Short runs of whole scenes: the books close, and bits depend on nothing but the scene.

#![allow(clippy::unwrap_used, reason = "a test may fail")]

mod beside;
mod judged;
mod lengths;
mod soundless;
mod soundless_beside;

use artefact::{Checkpoint, Header, Version};
use jetsph::assemble::{Assembled, assemble};
use jetsph::balance::Balance;
use jetsph::matter::solid::fracture::BROKEN;
use jetsph::resume;
use jetsph::scene::{KIND, Scene};
use jetsph::state::{State, VELOCITY};
use particles::POSITION;
use run::scene::{Expected, parse};

/// A bar in space that is held at one end, loaded at the other and pushed.
const BAR: &str = r#"{
    "kind": "jetsph.scene", "version": 1, "dimensions": 3,
    "time": {"end_s": 1},
    "solids": [{
        "name": "bar", "body": {"box": {"min_m": [0, 0, 0], "max_m": [0.04, 0.02, 0.02]}},
        "spacing_m": 0.005, "density_kg_m3": 1000,
        "elastic": {"youngs_modulus_pa": 2e6, "poisson_ratio": 0.4},
        "velocity_m_s": [0, {"expr": "10*x"}, 0.1],
        "clamps": [{"on": ["x-"]}],
        "loads": [{"on": ["x+"], "traction_pa": [0, 0, 500]}]
    }],
    "output": {"frames_interval_s": 1}
}"#;
/// A ring in the plane that flies and turns, by a turned lattice.
const RING: &str = r#"{
    "kind": "jetsph.scene", "version": 1, "dimensions": 2,
    "time": {"end_s": 1},
    "solids": [{
        "name": "ring", "spacing_m": 0.005, "lattice": {"turned_deg": 20},
        "body": {"difference": [{"disc": {"centre_m": [0, 0], "radius_m": 0.04}}, {"disc": {"centre_m": [0, 0], "radius_m": 0.02}}]},
        "density_kg_m3": 1000, "elastic": {"bulk_modulus_pa": 3e6, "shear_modulus_pa": 1e6},
        "velocity_m_s": [{"expr": "1 - 20*y + 30*x"}, {"expr": "20*x"}]
    }],
    "output": {"frames_interval_s": 1}
}"#;

/// A jet that pulses, leans and moves, and leaves.
const JET: &str = r#"{
    "kind": "jetsph.scene", "version": 1, "dimensions": 2,
    "time": {"end_s": 1},
    "water": {
        "density_kg_m3": 1000, "spacing_m": 0.001, "reference_speed_m_s": 6, "viscosity_pa_s": 0.001,
        "artificial_viscosity": {"linear": 0.02, "quadratic": 0.1}, "density_diffusion": {"form": "antuono"},
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

/// A block that breaks under a jet, on a plate.
const CUT: &str = r#"{
    "kind": "jetsph.scene", "version": 1, "dimensions": 2,
    "time": {"end_s": 1},
    "solids": [{
        "name": "block", "body": {"box": {"min_m": [-0.012, 0], "max_m": [0.012, 0.012]}}, "spacing_m": 0.002,
        "density_kg_m3": 940, "elastic": {"youngs_modulus_pa": 1e5, "poisson_ratio": 0.3},
        "artificial_viscosity": {"linear": 1, "quadratic": 1}, "fracture": {"equivalent_strain": 0.1}
    }],
    "contact": {"damping": 0.2},
    "water": {
        "density_kg_m3": 1000, "spacing_m": 0.001,
        "artificial_viscosity": {"linear": 0.05}, "density_diffusion": {"form": "molteni"},
        "nozzles": [{"name": "jet", "exit_m": [0, 0.014], "direction": [0, -1], "width_m": 0.004, "speed_m_s": 10}],
        "outlets": [{"name": "around", "beyond": {"box": {"min_m": [-0.03, -1], "max_m": [0.03, 0.03]}}}]
    },
    "walls": [{"name": "plate", "body": {"half_space": {"point_m": [0, 0], "normal": [0, 1]}}}],
    "output": {"frames_interval_s": 1}
}"#;
/// Water flies at a free block of four times its spacing, in space, turned about z.
const MEETING: &str = r#"{
    "kind": "jetsph.scene", "version": 1, "dimensions": 3,
    "time": {"end_s": 1},
    "solids": [{
        "name": "block", "spacing_m": 0.004, "density_kg_m3": 940, "elastic": {"youngs_modulus_pa": 1e6, "poisson_ratio": 0.3},
        "body": {"turned": {"shape": {"box": {"min_m": [-0.008, -0.008, -0.008], "max_m": [0.008, 0.008, 0]}}, "angle_deg": 30}}
    }],
    "water": {
        "density_kg_m3": 1000, "spacing_m": 0.001, "artificial_viscosity": {"linear": 0.05, "quadratic": 0.1},
        "bodies": [{"body": {"box": {"min_m": [-0.003, -0.003, 0.0005], "max_m": [0.003, 0.003, 0.0055]}}, "velocity_m_s": [1, 0, -5]}]
    },
    "output": {"frames_interval_s": 1}
}"#;
/// A notched plate that a slow pull tears by the energy of its crack.
const TEAR: &str = r#"{
    "kind": "jetsph.scene", "version": 1, "dimensions": 2,
    "time": {"end_s": 1},
    "solids": [{
        "name": "plate", "spacing_m": 0.002, "density_kg_m3": 1000, "elastic": {"youngs_modulus_pa": 1e5, "poisson_ratio": 0.3},
        "body": {"difference": [{"box": {"min_m": [0, -0.012], "max_m": [0.024, 0.012]}},
                                {"box": {"min_m": [-0.001, -0.002], "max_m": [0.008, 0.002]}}]},
        "artificial_viscosity": {"linear": 1}, "fracture": {"energy_release_j_m2": 1},
        "clamps": [{"on": ["y-"], "velocity_m_s": [0, -0.08]}, {"on": ["y+"], "velocity_m_s": [0, 0.08]}]
    }],
    "output": {"frames_interval_s": 1}
}"#;
/// A block of metal that a rising pressure makes flow.
const METAL: &str = r#"{
    "kind": "jetsph.scene", "version": 1, "dimensions": 3,
    "time": {"end_s": 1},
    "solids": [{
        "name": "block", "spacing_m": 0.005, "density_kg_m3": 7800, "elastic": {"youngs_modulus_pa": 2e11, "poisson_ratio": 0.3},
        "body": {"box": {"min_m": [0, 0, 0], "max_m": [0.03, 0.015, 0.015]}},
        "plasticity": {"yield_stress_pa": 2e8, "hardening_pa": 2e9},
        "clamps": [{"on": ["x-"]}], "loads": [{"on": ["x+"], "pressure_pa": 4e8, "rise_s": 5e-5}]
    }],
    "output": {"frames_interval_s": 1}
}"#;

/// A ring in the updated form that flies, stretches and turns.
const UPDATED: &str = r#"{
    "kind": "jetsph.scene", "version": 1, "dimensions": 2,
    "time": {"end_s": 1},
    "solids": [{
        "name": "ring", "spacing_m": 0.0025, "updated_form": {}, "artificial_viscosity": {"linear": 1},
        "body": {"difference": [{"disc": {"centre_m": [0, 0], "radius_m": 0.04}}, {"disc": {"centre_m": [0, 0], "radius_m": 0.02}}]},
        "density_kg_m3": 1000, "elastic": {"bulk_modulus_pa": 3e6, "shear_modulus_pa": 1e6},
        "velocity_m_s": [{"expr": "1 - 20*y + 30*x"}, {"expr": "20*x"}]
    }],
    "output": {"frames_interval_s": 1}
}"#;

fn parsed(text: &str) -> Scene {
    let expected = Expected {
        kind: KIND.0,
        version: KIND.1,
        migrations: &[],
    };
    parse::<Scene>(text, expected).unwrap().scene
}

fn begun(text: &str) -> Assembled {
    let mut run = assemble(&parsed(text)).unwrap();
    run.march.begin(&mut run.state).unwrap();
    run
}

fn steps(run: &mut Assembled, n: usize) {
    let dt = 0.5 * run.march.limit(&run.state).unwrap().seconds;
    for _ in 0..n {
        run.march
            .step(&mut run.state, dt, &mut |_, work| work())
            .unwrap();
        run.state.time += dt;
    }
}

fn bits(state: &State) -> Vec<u64> {
    let columns = [
        state.sets[0].column(&POSITION),
        state.sets[0].column(&VELOCITY),
    ];
    columns
        .iter()
        .flat_map(|c| c.as_flattened())
        .map(|x| x.to_bits())
        .collect()
}

/// They took all memory.
#[test]
fn nozzles_of_too_many_particles_are_refused() {
    for (from, to) in [
        ("\"width_m\": 0.004", "\"width_m\": 4e9"),
        ("\"spacing_m\": 0.001", "\"spacing_m\": 5e-16"),
    ] {
        let scene: Scene = parsed(&JET.replace(from, to));
        let told: Vec<String> = scene.faults().iter().map(ToString::to_string).collect();
        let told = told.join("\n");
        assert!(told.contains("/water/nozzles/0/width_m"), "{told}");
    }
}

#[test]
fn energy_and_momentum_close() {
    for (scene, energy) in [(BAR, 1e-3), (RING, 1e-3)] {
        let mut run = begun(scene);
        let start = Balance::of(&run.state, &run.march);
        steps(&mut run, 300);
        let now = Balance::of(&run.state, &run.march);
        assert!(now.energy_error(&start).abs() < energy, "{now:?} {start:?}");
        let stored = now.entry.stored - start.entry.stored;
        assert!(
            stored.abs() > 1e-3 * start.kinetic,
            "nothing happened: {now:?}"
        );
    }
    let mut free = begun(RING);
    let start = Balance::of(&free.state, &free.march);
    steps(&mut free, 300);
    let error = Balance::of(&free.state, &free.march).momentum_error(&start);
    assert!(error < 1e-12, "{error}");
}

#[test]
fn the_updated_form_keeps_momentum_and_gains_nothing() {
    let mut ring = begun(UPDATED);
    let start = Balance::of(&ring.state, &ring.march);
    steps(&mut ring, 300);
    let now = Balance::of(&ring.state, &ring.march);
    let error = now.momentum_error(&start);
    assert!(error < 1e-12, "{error}");
    let stored = now.entry.stored - start.entry.stored;
    assert!(stored > 1e-3 * start.kinetic, "nothing happened: {now:?}");
    assert!(now.energy_error(&start).abs() < 0.02, "{now:?} {start:?}");
}

#[test]
fn water_comes_and_leaves_and_the_books_close() {
    let mut run = begun(JET);
    let start = Balance::of(&run.state, &run.march);
    steps(&mut run, 600);
    let now = Balance::of(&run.state, &run.march);
    assert!(
        now.entry.mass.abs() > 0.05 * start.mass,
        "nothing came or left: {now:?}"
    );
    assert!(
        now.mass_error(&start).abs() < 1e-12,
        "{}",
        now.mass_error(&start)
    );
    assert!(
        now.momentum_error(&start) < 1e-8,
        "{}",
        now.momentum_error(&start)
    );
    assert!(now.energy_error(&start).abs() < 0.02, "{now:?} {start:?}");
}

#[test]
fn a_jet_breaks_a_block_and_the_books_close() {
    let mut run = begun(CUT);
    let start = Balance::of(&run.state, &run.march);
    steps(&mut run, 1500);
    let now = Balance::of(&run.state, &run.march);
    let broken = run.state.sets[0].column(&BROKEN);
    assert!(
        broken.contains(&1) && broken.contains(&0),
        "nothing, or all, broke"
    );
    assert!(
        now.mass_error(&start).abs() < 1e-12,
        "{}",
        now.mass_error(&start)
    );
    assert!(
        now.momentum_error(&start) < 1e-8,
        "{}",
        now.momentum_error(&start)
    );
    assert!(now.energy_error(&start).abs() < 0.02, "{now:?} {start:?}");
}

#[test]
fn a_crack_gains_nothing_and_metal_flows_and_its_books_close() {
    let mut tear = begun(TEAR);
    let start = Balance::of(&tear.state, &tear.march);
    steps(&mut tear, 600);
    let now = Balance::of(&tear.state, &tear.march);
    let broken = tear.state.sets[0].column(&BROKEN);
    assert!(broken.contains(&1) && broken.contains(&0));
    assert!(now.momentum_error(&start) < 1e-8, "{now:?} {start:?}");
    // Nothing may be gained; case `fracture-energy` judges what is lost.
    assert!(now.energy_error(&start) < 0.01, "{now:?} {start:?}");
    let mut metal = begun(METAL);
    let start = Balance::of(&metal.state, &metal.march);
    steps(&mut metal, 600);
    let now = Balance::of(&metal.state, &metal.march);
    assert!(
        now.entry.spent > 0.2 * now.entry.stored.abs(),
        "nothing flowed"
    );
    assert!(now.energy_error(&start).abs() < 0.02, "{now:?} {start:?}");
}

#[test]
fn water_and_solid_push_each_other_alike_and_part() {
    let mut run = begun(MEETING);
    let start = Balance::of(&run.state, &run.march);
    steps(&mut run, 300);
    let now = Balance::of(&run.state, &run.march);
    assert!(
        now.momentum_error(&start) < 1e-12,
        "{}",
        now.momentum_error(&start)
    );
    assert!(now.energy_error(&start).abs() < 0.02, "{now:?} {start:?}");
    let block = run.state.sets[0].column(&VELOCITY);
    assert!(block.iter().any(|u| u[2] < -0.1), "the block was not met");
    // No water within the block: nearer than its half spacing to the middle of a cell.
    for x in run.state.sets[1].column(&POSITION) {
        for y in run.state.sets[0].column(&POSITION) {
            let square: f64 = (0..3).map(|k| (x[k] - y[k]).powi(2)).sum();
            assert!(
                square.sqrt() > 0.0015,
                "water at {x:?} is within the cell at {y:?}"
            );
        }
    }
}

#[test]
fn bits_do_not_depend_on_threads() {
    for scene in [
        BAR,
        JET,
        CUT,
        TEAR,
        METAL,
        UPDATED,
        soundless::JET,
        soundless_beside::CUT,
    ] {
        bits_are_the_same(scene);
    }
}

fn bits_are_the_same(scene: &str) {
    let after = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .unwrap();
        pool.install(|| {
            let mut run = begun(scene);
            steps(&mut run, 300);
            bits(&run.state)
        })
    };
    assert_eq!(after(1), after(3));
}

#[test]
fn a_run_taken_up_goes_on_with_the_same_bits() {
    for scene in [
        BAR,
        JET,
        CUT,
        TEAR,
        METAL,
        UPDATED,
        soundless::JET,
        soundless_beside::CUT,
    ] {
        is_taken_up(scene);
    }
}

fn is_taken_up(scene: &str) {
    let header = Header {
        kind: "jet-frames".to_owned(),
        version: Version::new(1, 0),
        tool: "jetsph".to_owned(),
        tool_version: "0".to_owned(),
        scene: serde_json::json!({}),
        inputs: std::collections::BTreeMap::new(),
    };
    let mut straight = begun(scene);
    let start = Balance::of(&straight.state, &straight.march);
    steps(&mut straight, 300);
    let mut checkpoint = Checkpoint::new(&header);
    resume::save(&mut checkpoint, &straight.state, &straight.march, &start).unwrap();
    let mut other = begun(scene);
    let found = resume::restore(&mut checkpoint, &mut other.state, &mut other.march).unwrap();
    steps(&mut straight, 300);
    steps(&mut other, 300);
    assert_eq!(bits(&straight.state), bits(&other.state));
    assert_eq!(found.save().len(), start.save().len());
    let books = |run: &Assembled| Balance::of(&run.state, &run.march).save();
    let same = books(&straight)
        .iter()
        .zip(books(&other))
        .all(|(a, b)| a.to_bits() == b.to_bits());
    assert!(same, "{:?} {:?}", books(&straight), books(&other));
}
