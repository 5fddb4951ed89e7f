//! After warm-up a step allocates nothing that grows with the problem: what each step needs is
//! kept from the step before.

#![allow(
    clippy::unwrap_used,
    clippy::print_stderr,
    reason = "a test may fail, and says what it found"
)]

use std::alloc::System;
use std::collections::BTreeMap;
use std::path::Path;
use std::sync::{Mutex, MutexGuard, PoisonError};

use poolsph::stage::StageError;
use rayon::ThreadPoolBuilder;
use run::Inputs;
use run::scene::{Expected, parse};
use serde_json::{Value, json};
use stats_alloc::{INSTRUMENTED_SYSTEM, Region, StatsAlloc};
use verification::bell::WELD;

#[global_allocator]
static COUNTED: &StatsAlloc<System> = &INSTRUMENTED_SYSTEM;

/// The counters are of the whole process: one test at a time.
fn alone() -> MutexGuard<'static, ()> {
    static ALONE: Mutex<()> = Mutex::new(());
    ALONE.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Steps before the count, and steps counted.
const WARM: usize = 100;
const STEPS: usize = 40;
/// Most allocations of a step: what the thread pool and a few lists of the stages may take.
const MOST: f64 = 64.0;
/// Most bytes of a step, or of a step and element where that is more: lists of moving particles grow
/// now and then; a column made anew takes 8 bytes per element and step.
const MOST_BYTES: f64 = 16_384.0;
const MOST_BYTES_EACH: f64 = 2.0;

/// Allocations and bytes per step after warm-up, on two threads.
fn spent(mut step: impl FnMut() + Send) -> (f64, f64) {
    let pool = ThreadPoolBuilder::new().num_threads(2).build().unwrap();
    pool.install(|| {
        (0..WARM).for_each(|_| step());
        let region = Region::new(COUNTED);
        (0..STEPS).for_each(|_| step());
        let change = region.change();
        let calls = change.allocations + change.reallocations;
        let bytes = change.bytes_allocated + change.bytes_reallocated.unsigned_abs();
        [calls, bytes].map(|n| n as f64 / STEPS as f64).into()
    })
}

#[track_caller]
fn must_be_quiet(name: &str, size: usize, spent: (f64, f64)) {
    let (calls, bytes) = spent;
    eprintln!("{name} of {size}: {calls:.1} allocations, {bytes:.0} bytes per step");
    let most_bytes = MOST_BYTES.max(MOST_BYTES_EACH * size as f64);
    assert!(
        calls <= MOST && bytes <= most_bytes,
        "{name} of {size}: {calls:.1} allocations and {bytes:.0} bytes per step"
    );
}

/// A pool of `scene`, ready to step.
fn pool_step(name: &str, scene: &Value, inputs: &Inputs) {
    let expected = Expected {
        kind: "poolsph.scene",
        version: 2,
        migrations: &[],
    };
    let scene = parse::<poolsph::scene::Scene>(&scene.to_string(), expected);
    let assembled = poolsph::assemble::assemble(&scene.unwrap().scene, inputs).unwrap();
    let (mut march, mut state) = (assembled.march, assembled.state);
    let size = state.len();
    let (mut taken, mut stages) = (0, BTreeMap::<&str, [usize; 2]>::new());
    let spent = spent(|| {
        let timed = |name, work: &mut dyn FnMut() -> Result<(), StageError>| {
            let region = Region::new(COUNTED);
            work()?;
            if taken >= WARM {
                let (change, stage) = (region.change(), stages.entry(name).or_default());
                stage[0] += change.allocations + change.reallocations;
                stage[1] += change.bytes_allocated + change.bytes_reallocated.unsigned_abs();
            }
            Ok(())
        };
        march.step(&mut state, u64::MAX, timed).unwrap();
        taken += 1;
    });
    let (calls, bytes) = spent;
    for (stage, [all_calls, all_bytes]) in stages {
        let found = [all_calls, all_bytes].map(|n| n as f64 / STEPS as f64);
        if found[0] > 0.0 {
            let [calls, bytes] = found;
            eprintln!("    {stage}: {calls:.1} allocations, {bytes:.0} bytes per step");
        }
    }
    must_be_quiet(name, size, (calls, bytes));
}

/// A tank of liquid `edge` particles wide, deep and high.
fn tank(edge: u32) -> Value {
    let length = 5e-4 * f64::from(edge);
    let hollow =
        json!({"min_m": [0, 0, 0], "max_m": [length, length, 1.5 * length], "thickness_m": 1e-3});
    json!({
        "kind": "poolsph.scene", "version": 2, "spacing_m": 5e-4,
        "time": {"step_s": 1e-4, "end_s": 1.0}, "density_kg_m3": 7850,
        "bodies": [
            {"shape": {"container": hollow}, "state": "wall"},
            {"shape": {"box": {"min_m": [0, 0, 0], "max_m": [length, length, length]}}, "state": "liquid"}
        ],
        "flow": {"method": "projection", "viscosity_pa_s": 0.004, "gravity_m_s2": [0, 0, -9.8]},
        "tension": {"surface_tension_n_m": 1.0},
        "output": {"particles_interval_s": 0.1}
    })
}

#[test]
fn a_tank_of_liquid() {
    let _alone = alone();
    for edge in [8, 16] {
        pool_step("tank", &tank(edge), &Inputs::none());
    }
}

/// The weld of the tests of resuming on a plate `edge` particles wide with a pool from the start;
/// without droplets, whose particles are new ones.
fn weld(edge: u32) -> Value {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("resume/weld.json");
    let mut scene: Value = serde_json::from_str(&std::fs::read_to_string(path).unwrap()).unwrap();
    let half = 2.5e-4 * f64::from(edge);
    let (low, high) = (json!([-half, -half, -half]), json!([half, half, 0]));
    let pool = json!({"ellipsoid": {"centre_m": [0, 0, 0], "semi_axes_m": [0.6 * half, 0.6 * half, 0.5 * half]}});
    let above = json!([{"point_m": [0, 0, 0], "normal": [0, 0, 1]}]);
    scene["bodies"] = json!([
        {"shape": pool, "cuts": above, "lattice_m": low, "state": "liquid", "temperature_k": 1900},
        {"shape": {"box": {"min_m": low, "max_m": high}}, "state": "solid", "temperature_k": 1600}
    ]);
    scene["heat"]["faces"]["min_m"] = low;
    scene["heat"]["faces"]["max_m"] = high;
    scene["source"]["start_m"] = json!([0, 0, 0]);
    scene["arc"] = json!({"parts": ["convection", "radiation"],
        "cathode": {"work_function_v": 3.85, "richardson_a_m2_k2": 1.2e6}});
    scene.as_object_mut().unwrap().shift_remove("droplets");
    scene
}

#[test]
fn a_weld() {
    let _alone = alone();
    let folder = tempfile::tempdir().unwrap();
    let arc = folder.path().join("arc.mcap");
    WELD.write(&arc).unwrap();
    let inputs = Inputs::of([("arc", arc.as_path())]).unwrap();
    for edge in [16, 32] {
        pool_step("weld", &weld(edge), &inputs);
    }
}

/// The arc of the study on a grid `coarse` times as coarse.
#[test]
fn an_arc() {
    let _alone = alone();
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap();
    let read = |path: &str| std::fs::read_to_string(root.join(path)).unwrap();
    let gas = serde_json::from_str(&read("pipelines/gases/argon-1atm.json")).unwrap();
    for coarse in [8.0, 4.0] {
        let mut scene: Value = serde_json::from_str(&read("pipelines/gmaw-300a/arc.json")).unwrap();
        for axis in ["r", "z"] {
            for spacing in scene["grid"][axis]["spacing_m"].as_array_mut().unwrap() {
                *spacing = json!(coarse * spacing.as_f64().unwrap());
            }
        }
        let steel = root.join("pipelines/materials/mild-steel-electrode.json");
        scene["substances"]["steel"]["file"] = json!(steel);
        let expected = Expected {
            kind: "arcfvm.scene",
            version: 1,
            migrations: &[],
        };
        let scene = parse::<arcfvm::scene::Scene>(&scene.to_string(), expected).unwrap();
        let case = arcfvm::assemble::assemble(&scene.scene, Some(&gas)).unwrap();
        let size = case.grid.len();
        let settings = arcfvm::settings::Settings::from(&scene.scene.iterate);
        let mut arc = arcfvm::solver::Arc::new(case, settings);
        let spent = spent(|| {
            arc.iterate(&mut ()).unwrap();
        });
        must_be_quiet("arc", size, spent);
    }
}

#[test]
fn a_search_for_neighbours() {
    let _alone = alone();
    for side in [16_u32, 32] {
        let points: Vec<[f64; 3]> = (0..side.pow(3))
            .map(|k| [k % side, k / side % side, k / side / side].map(f64::from))
            .collect();
        let mut grid = neighbours::Grid::new(1.0);
        let mut lists = neighbours::Lists::new();
        let spent = spent(|| {
            grid.bin(&points);
            lists.build(grid.search(&points, 2.0), |_| true, |_, _| true);
        });
        must_be_quiet("neighbours", points.len(), spent);
    }
}

#[test]
fn a_sweep_of_over_relaxation() {
    let _alone = alone();
    for side in [64, 256] {
        let mut equation = relax::FivePoint::new(side, side);
        let beside = |inside: bool| if inside { 1.0 } else { 0.0 };
        let mut fill = || {
            equation.fill(|i, j| relax::Coefficients {
                centre: 4.0,
                east: beside(i + 1 < side),
                west: beside(i > 0),
                north: beside(j + 1 < side),
                south: beside(j > 0),
                source: 1.0,
            });
        };
        fill();
        let mut x = vec![0.0; side * side];
        let solver = relax::Sor::new(1.9, 20, 0.0);
        let mut scratch = Vec::new();
        let spent = spent(|| {
            x.fill(0.0);
            let found = solver.solve(&equation, &mut x, &mut scratch);
            assert_eq!(found.steps, 5);
        });
        must_be_quiet("over-relaxation", side * side, spent);
    }
}
