//! Water without sound beside solids: it gives them what it loses, enters no whole one, and its start with a bar is that of both.

use super::{begun, parsed, steps};
use jetsph::assemble::assemble;
use jetsph::balance::Balance;
use jetsph::state::{MASS, State, VELOCITY};
use particles::POSITION;

/// A block that breaks under a jet, on a plate.
pub(super) const CUT: &str = r#"{
    "kind": "jetsph.scene", "version": 1, "dimensions": 2,
    "time": {"end_s": 1},
    "solids": [{
        "name": "block", "body": {"box": {"min_m": [-0.012, 0], "max_m": [0.012, 0.012]}}, "spacing_m": 0.002,
        "density_kg_m3": 940, "elastic": {"youngs_modulus_pa": 1e5, "poisson_ratio": 0.3},
        "artificial_viscosity": {"linear": 1, "quadratic": 1}, "fracture": {"equivalent_strain": 0.1}
    }],
    "contact": {"damping": 0.2},
    "water": {
        "density_kg_m3": 1000, "spacing_m": 0.001, "method": "divergence_free",
        "nozzles": [{"name": "jet", "exit_m": [0, 0.02], "direction": [0, -1], "width_m": 0.004, "speed_m_s": 10}],
        "outlets": [{"name": "around", "beyond": {"box": {"min_m": [-0.03, -1], "max_m": [0.03, 0.03]}}}]
    },
    "walls": [{"name": "plate", "body": {"half_space": {"point_m": [0, 0], "normal": [0, 1]}}}],
    "output": {"frames_interval_s": 1}
}"#;
/// Water flies at a free block of twice its spacing, in space, turned about z.
const MEETING: &str = r#"{
    "kind": "jetsph.scene", "version": 1, "dimensions": 3,
    "time": {"end_s": 1},
    "solids": [{
        "name": "block", "spacing_m": 0.002, "density_kg_m3": 940, "elastic": {"youngs_modulus_pa": 1e6, "poisson_ratio": 0.3},
        "body": {"turned": {"shape": {"box": {"min_m": [-0.006, -0.006, -0.006], "max_m": [0.006, 0.006, 0]}}, "angle_deg": 30}}
    }],
    "water": {
        "density_kg_m3": 1000, "spacing_m": 0.001, "method": "divergence_free",
        "bodies": [{"body": {"box": {"min_m": [-0.003, -0.003, 0.0005], "max_m": [0.003, 0.003, 0.0055]}}, "velocity_m_s": [1, 0, -5]}]
    },
    "output": {"frames_interval_s": 1}
}"#;

/// Momentum of a set \[N s\].
fn momentum(state: &State, set: usize) -> [f64; 3] {
    let set = &state.sets[set];
    let each = set.column(&MASS).iter().zip(set.column(&VELOCITY));
    each.fold([0.0; 3], |sum, (m, u)| {
        [0, 1, 2].map(|k: usize| sum[k] + m * u[k])
    })
}

/// The solid lacked what was under way where steps changed.
#[test]
fn a_solid_gets_what_the_water_loses_in_steps_of_any_length() {
    let mut run = begun(MEETING);
    let start = Balance::of(&run.state, &run.march);
    let before = [0, 1].map(|set| momentum(&run.state, set));
    let dt = 0.4 * run.march.limit(&run.state).unwrap().seconds;
    for k in 0..400 {
        // Steps that change by up to a factor of four.
        let dt = dt * [1.0, 0.5, 0.25, 0.8][k % 4];
        run.march
            .step(&mut run.state, dt, &mut |_, work| work())
            .unwrap();
        run.state.time += dt;
    }
    let now = Balance::of(&run.state, &run.march);
    assert!(now.momentum_error(&start) < 1e-12, "{now:?}");
    assert!(now.energy_error(&start).abs() < 0.02, "{now:?} {start:?}");
    // The momenta themselves, without any book.
    let after = [0, 1].map(|set| momentum(&run.state, set));
    let scale = before[1][2].abs();
    for k in 0..3 {
        let change: f64 = (0..2).map(|set| after[set][k] - before[set][k]).sum();
        assert!(change.abs() < 1e-12 * scale, "{before:?} {after:?}");
    }
    let lost = after[1][2] - before[1][2];
    assert!(lost > 0.3 * scale, "{lost} of {before:?}");
    for x in run.state.sets[1].column(&POSITION) {
        for y in run.state.sets[0].column(&POSITION) {
            let square: f64 = (0..3).map(|k| (x[k] - y[k]).powi(2)).sum();
            assert!(
                square.sqrt() > 0.0007,
                "water at {x:?} is within the cell at {y:?}"
            );
        }
    }
}

#[test]
fn water_without_sound_cuts_and_the_books_close() {
    let mut run = begun(CUT);
    let start = Balance::of(&run.state, &run.march);
    steps(&mut run, 1500);
    let now = Balance::of(&run.state, &run.march);
    let broken = run.state.sets[0].column(&jetsph::matter::solid::fracture::BROKEN);
    assert!(broken.iter().any(|b| *b > 0), "nothing broke");
    assert!(now.momentum_error(&start) < 1e-8, "{now:?}");
    assert!(now.energy_error(&start).abs() < 0.05, "{now:?} {start:?}");
}

#[test]
fn what_water_without_sound_lacks_beside_solids_is_named_with_what_to_do() {
    let updated = CUT.replace(
        r#""artificial_viscosity""#,
        r#""updated_form": {}, "artificial_viscosity""#,
    );
    let viscous = CUT.replace(r#""method""#, r#""viscosity_pa_s": 0.001, "method""#);
    for (text, place, advice) in [
        (updated, "/water/method", "leave 'updated_form' out"),
        (
            viscous,
            "/water/viscosity_pa_s",
            "leave this or 'method' out",
        ),
    ] {
        let faults = assemble(&parsed(&text)).err().unwrap();
        let said: String = faults.iter().map(ToString::to_string).collect();
        assert!(said.contains(place) && said.contains(advice), "{said}");
    }
    let alone = r#"{"kind": "jetsph.scene", "version": 1, "dimensions": 2, "time": {"end_s": 1},
        "water": {"density_kg_m3": 1000, "spacing_m": 0.001, "method": "divergence_free", "tension": "full",
            "bodies": [{"body": {"box": {"min_m": [0, 0], "max_m": [0.01, 0.01]}}}]},
        "output": {"frames_interval_s": 1}}"#;
    let faults = assemble(&parsed(alone)).err().unwrap();
    assert!(faults.iter().any(|fault| fault.path() == "/water/tension"));
}
