//! Each field against an exact solution, from the scene's text to the converged fields.

#![allow(clippy::unwrap_used, reason = "a test may fail")]

use std::f64::consts::PI;

use arcfvm::assemble::assemble;
use arcfvm::current::magnetic::MU0;
use arcfvm::scene::Scene;
use arcfvm::settings::Settings;
use arcfvm::solver::Arc;
use run::scene::{Expected, parse};

/// Iterates the scene to its tolerance.
fn solve(body: &str) -> Arc {
    solve_by(r#""solver": "multigrid""#, body)
}

/// The same with other ways of iterating.
fn solve_by(way: &str, body: &str) -> Arc {
    let text = format!(
        r#"{{"kind": "arcfvm.scene", "version": 1, "title": "exact", {body},
            "iterate": {{{way}, "tolerance": 1e-10, "most": 3000}}}}"#
    );
    let expected = Expected {
        kind: "arcfvm.scene",
        version: 1,
        migrations: &[],
    };
    let scene: Scene = parse::<Scene>(&text, expected).unwrap().scene;
    let mut arc = Arc::new(
        assemble(&scene, None).unwrap(),
        Settings::from(&scene.iterate),
    );
    for _ in 0..scene.iterate.most {
        if arc
            .iterate(&mut ())
            .unwrap()
            .within(scene.iterate.tolerance)
            && arc.iteration > 2
        {
            arc.settle();
            return arc;
        }
    }
    panic!("not converged");
}

const BOX: &str =
    r#""domain": {"r_m": [0, 0.01], "z_m": [0, 0.02]}, "grid": {"r": 0.001, "z": 0.001}"#;

#[test]
fn current_through_two_layers_is_that_of_resistors_in_series() {
    let arc = solve(&format!(
        r#"{BOX}, "gas": {{"given": {{"electric_conductivity_s_m": 100}}}},
        "bodies": {{"plate": {{"shape": {{"ring": {{"r_m": [0, 0.01], "z_m": [0, 0.008]}}}},
            "material": {{"electric_conductivity_s_m": 1e6}}}}}},
        "current": {{"edges": {{"bottom": [{{"voltage_v": 0}}],
            "top": [{{"total_current_a": 300}}]}}}}"#
    ));
    let electric = arc.electric.as_ref().unwrap();
    let density = 300.0 / (PI * 1e-4);
    let want = density * (0.012 / 100.0 + 0.008 / 1e6);
    assert!((electric.potential.drive - want).abs() < 1e-6 * want);
    let grid = &arc.case.grid;
    for (i, j) in [(0, 3), (7, 3), (7, 15)] {
        let found = electric.magnetic.at_centre(grid, &electric.potential, i, j);
        assert!((found.current_axial + density).abs() < 1e-6 * density);
        // Downward current: the field is mu0 j r / 2, negative, and its force is inward.
        let field = -0.5 * MU0 * density * grid.rc[i];
        assert!((found.field - field).abs() < 1e-6 * field.abs());
        assert!((found.force_radial + density * field.abs()).abs() < 1e-6 * density * field.abs());
    }
    let joule: f64 = electric.potential.joule.iter().sum();
    assert!((joule - 300.0 * want).abs() < 1e-6 * joule);
}

#[test]
fn heat_through_two_layers_falls_as_their_resistances() {
    let arc = solve(&format!(
        r#"{BOX}, "gas": {{"given": {{"thermal_conductivity_w_m_k": 0.5, "specific_heat_j_kg_k": 1000}}}},
        "bodies": {{"plate": {{"shape": {{"ring": {{"r_m": [0, 0.01], "z_m": [0, 0.008]}}}},
            "material": {{"thermal_conductivity_w_m_k": 20, "specific_heat_j_kg_k": 600}}}}}},
        "heat": {{"edges": {{"bottom": [{{"temperature_k": 300}}], "top": [{{"flux_w_m2": 1e4}}]}}}}"#
    ));
    let t = arc.temperature();
    let grid = &arc.case.grid;
    let rise = |z: f64| 1e4 * (z.min(0.008) / 20.0 + (z - 0.008).max(0.0) / 0.5);
    for k in [0, 45, 120, grid.len() - 1] {
        let want = 300.0 + rise(grid.zc[k / grid.nr]);
        assert!((t[k] - want).abs() < 1e-4, "{} {want}", t[k]);
    }
}

#[test]
fn gas_that_flows_carries_what_heats_it() {
    // 0.01 kg/s of 1000 J/(kg K), heated by 300 W: it leaves 30 K warmer.
    let area = PI * 1e-4;
    let speed = 0.01 / area;
    let source = 300.0 / (area * 0.02);
    let scene = format!(
        r#"{BOX}, "gas": {{"given": {{"density_kg_m3": 1, "viscosity_pa_s": 1e-3,
            "thermal_conductivity_w_m_k": 1e-6, "specific_heat_j_kg_k": 1000}}}},
        "flow": {{"edges": {{"bottom": [{{"velocity_m_s": [0, {speed}]}}],
            "outer": [{{"slip": true}}], "top": [{{"pressure_pa": 0}}]}}}},
        "heat": {{"edges": {{"bottom": [{{"temperature_k": 300}}]}}, "source_w_m3": {source}}}"#
    );
    // The paper's way, and ours.
    for way in [
        r#""solver": "sor", "coupling": "simple""#,
        r#""solver": "multigrid""#,
    ] {
        let mut arc = solve_by(way, &scene);
        let grid = &arc.case.grid;
        let top = arc.temperature()[grid.cell(4, grid.nz - 1)];
        assert!((top - 330.0).abs() < 1e-3, "{top}");
        let balance = arc.settle().unwrap();
        assert!((balance.flow + 300.0).abs() < 1e-4, "{balance:?}");
        assert!(balance.closure().abs() < 1e-6 * 300.0);
    }
}

#[test]
fn a_pinch_at_rest_holds_its_pressure() {
    let arc = solve(&format!(
        r#"{BOX}, "gas": {{"given": {{"density_kg_m3": 1, "viscosity_pa_s": 1e-2,
            "electric_conductivity_s_m": 1000}}}},
        "current": {{"edges": {{"bottom": [{{"voltage_v": 0}}],
            "top": [{{"total_current_a": 300}}]}}}}, "flow": {{}}"#
    ));
    let (grid, flow) = (&arc.case.grid, &arc.flowing.as_ref().unwrap().flow);
    let density = 300.0 / (PI * 1e-4);
    let pressure = |i: usize| flow.pressure[grid.cell(i, 9)];
    let want = 0.25 * MU0 * density * density * (grid.rc[8].powi(2) - grid.rc[1].powi(2));
    assert!((pressure(1) - pressure(8) - want).abs() < 1e-6 * want);
    assert!(flow.axial.iter().all(|w| w.abs() < 1e-6));
}

#[test]
fn a_strong_pinch_of_thin_gas_comes_to_rest() {
    // All sides of some cells let the gas out before its mass is balanced.
    let arc = solve_by(
        r#""solver": "sor""#,
        r#""domain": {"r_m": [0, 0.005], "z_m": [0, 0.004]}, "grid": {"r": 0.0005, "z": 0.001},
        "gas": {"given": {"density_kg_m3": 1, "viscosity_pa_s": 1e-4,
            "electric_conductivity_s_m": {"expr": "1000*(1 + 2*(r/0.005)^2)"}}},
        "current": {"edges": {"bottom": [{"voltage_v": 0}], "top": [{"total_current_a": 1000}]}},
        "flow": {"edges": {"bottom": [{"slip": true}], "top": [{"slip": true}]}}"#,
    );
    let flow = &arc.flowing.as_ref().unwrap().flow;
    let speed = |u: &[f64]| u.iter().fold(0.0_f64, |most, u| most.max(u.abs()));
    // Of mu0 I / (4 pi R) / sqrt(density mu0), 20 m/s, which the pressure could drive.
    assert!(speed(&flow.axial).max(speed(&flow.radial)) < 1e-4);
}

#[test]
fn what_creeps_at_absurd_speeds_at_first_comes_to_those_that_inertia_allows() {
    // Without inertia the pinch below the electrode would drive the gas at more than 1e5 m/s, which no gas reaches.
    let arc = solve(
        r#""domain": {"r_m": [0, 0.005], "z_m": [0, 0.005]}, "grid": {"r": 0.0005, "z": 0.0005},
        "gas": {"given": {"density_kg_m3": 0.02, "viscosity_pa_s": 2e-4, "electric_conductivity_s_m": 1000}},
        "current": {"edges": {"bottom": [{"voltage_v": 0}],
            "top": [{"over_m": [0, 0.001], "total_current_a": 6000}]}},
        "flow": {}"#,
    );
    let flow = &arc.flowing.as_ref().unwrap().flow;
    let fastest = flow.axial.iter().fold(0.0_f64, |most, w| most.max(w.abs()));
    // sqrt(mu0 / (2 rho)) I / (pi a): what the pressure of the pinch gives the gas.
    let driven = (0.5 * MU0 / 0.02_f64).sqrt() * 6000.0 / (PI * 1e-3);
    assert!(
        (0.05..1.0).contains(&(fastest / driven)),
        "{fastest} of {driven} m/s"
    );
}

#[test]
fn warm_gas_in_a_closed_box_rests_under_its_weight() {
    let arc = solve(&format!(
        r#"{BOX}, "gas": {{"given": {{"density_kg_m3": {{"expr": "480/T"}}, "viscosity_pa_s": 1e-2}}}},
        "flow": {{"gravity_m_s2": 10}}, "start": {{"temperature_k": {{"expr": "300 + 1e4*z"}}}}"#
    ));
    let (grid, flow) = (&arc.case.grid, &arc.flowing.as_ref().unwrap().flow);
    // dp/dz = -g (rho - rho(300 K)), summed between cell centres.
    let rho = |j: usize| 480.0 / (300.0 + 1e4 * grid.zc[j]);
    let step =
        |j: usize| -10.0 * (0.5 * (rho(j) + rho(j + 1)) - 1.6) * (grid.zc[j + 1] - grid.zc[j]);
    let want: f64 = (0..grid.nz - 1).map(step).sum();
    let found = flow.pressure[grid.cell(4, grid.nz - 1)] - flow.pressure[grid.cell(4, 0)];
    assert!((found - want).abs() < 1e-6 * want.abs(), "{found} {want}");
}

#[test]
fn a_scene_that_contradicts_itself_names_every_place() {
    let text = r#"{"kind": "arcfvm.scene", "version": 1, "title": "wrong",
        "domain": {"r_m": [0, 0.01], "z_m": [0, 0.02]}, "grid": {"r": 0.001, "z": 0.001},
        "gas": {"given": {}}, "heat": {"edges": {"top": [{"temperature_k": 1, "flux_w_m2": 2}]}},
        "current": {"edges": {"top": [{"total_current_a": 3}]}}}"#;
    let expected = Expected {
        kind: "arcfvm.scene",
        version: 1,
        migrations: &[],
    };
    let scene = parse::<Scene>(text, expected).unwrap().scene;
    let told = assemble(&scene, None).unwrap_err().to_string();
    for place in [
        "/gas/given/thermal_conductivity_w_m_k",
        "/gas/given/electric_conductivity_s_m",
        "/current/edges",
        "/heat/edges/top/0",
    ] {
        assert!(told.contains(place), "{place} is not in:\n{told}");
    }
}

/// A rod above a plate, both at given temperatures at their far ends, in gas that conducts heat and 80 A.
fn between_metals(electrons: &str) -> Arc {
    solve(&format!(
        r#"{BOX}, "gas": {{"given": {{"electric_conductivity_s_m": 3000,
            "thermal_conductivity_w_m_k": 1.5, "specific_heat_j_kg_k": 1000}}}},
        "bodies": {{
            "plate": {{"shape": {{"ring": {{"r_m": [0, 0.01], "z_m": [0, 0.004]}}}},
                "material": {{"electric_conductivity_s_m": 1e6, "thermal_conductivity_w_m_k": 90,
                    "specific_heat_j_kg_k": 600}},
                "anode": {{"work_function_v": 4.5, "emissivity": 0.4}}}},
            "rod": {{"shape": {{"ring": {{"r_m": [0, 0.003], "z_m": [0.012, 0.02]}}}},
                "material": {{"electric_conductivity_s_m": 1e6, "thermal_conductivity_w_m_k": 90,
                    "specific_heat_j_kg_k": 600}},
                "cathode": {{"work_function_v": 2.6, "ionisation_voltage_v": 15.7,
                    "richardson_a_m2_k2": 3e4, "emissivity": 0.4}}}}}},
        "current": {{"edges": {{"bottom": [{{"voltage_v": 0}}],
            "top": [{{"over_m": [0, 0.003], "total_current_a": -80}}]}}}},
        "heat": {{"edges": {{"bottom": [{{"temperature_k": 300}}], "outer": [{{"temperature_k": 300}}],
            "top": [{{"temperature_k": 2500}}]}} {electrons}}}"#
    ))
}

#[test]
fn electrons_carry_heat_from_a_hot_cathode_to_a_cold_anode() {
    let mut still = between_metals("");
    let mut moving = between_metals(r#", "electrons": "enthalpy""#);
    let [without, with] = [&mut still, &mut moving].map(|arc| arc.settle().unwrap());
    assert!(without.electrons.is_none());
    assert!(without.closure().abs() < 1e-6 * without.joule);
    assert!(
        with.closure().abs() < 1e-6 * with.joule,
        "{}",
        with.closure()
    );
    // From one metal to the other: 80 A of 5/2 k/e between their temperatures.
    let grid = &moving.case.grid;
    let beside = |arc: &Arc, z: f64| arc.temperature()[grid.cell(0, grid.row_of(z))];
    let brought = with.electrons.unwrap();
    let [cathode, anode] = [0.0125, 0.0035].map(|z| beside(&moving, z));
    let scale = 80.0 * arcfvm::heat::electrons::ENTHALPY;
    assert!(
        (brought - scale * (cathode - anode)).abs() < 0.1 * brought.abs(),
        "{brought} {cathode} {anode}"
    );
    // They leave a hot rod for a cold plate: gas is warmer all the way.
    for z in [0.0045, 0.0085, 0.0115] {
        assert!(beside(&moving, z) > 1.01 * beside(&still, z), "{z}");
    }
    // The plate takes up by conduction what they lose on their way.
    assert!(with.electrodes[0].convection > without.electrodes[0].convection);
}

#[test]
fn electrons_at_rest_carry_nothing() {
    let column = |electrons: &str| {
        let arc = solve(&format!(
            r#"{BOX}, "gas": {{"given": {{"electric_conductivity_s_m": 100,
                "thermal_conductivity_w_m_k": 0.5, "specific_heat_j_kg_k": 1000}}}},
            "current": {{"edges": {{"bottom": [{{"voltage_v": 0}}], "top": [{{"voltage_v": 0}}]}}}},
            "heat": {{"edges": {{"bottom": [{{"temperature_k": 300}}], "top": [{{"temperature_k": 900}}]}},
                "source_w_m3": 1e6 {electrons}}}"#
        ));
        arc.temperature().to_vec()
    };
    assert_eq!(column(""), column(r#", "electrons": "enthalpy""#));
}
