//! Iron vapour against exact solutions, from the scene's text to the converged fields.

#![allow(clippy::unwrap_used, reason = "a test may fail")]

use arcfvm::assemble::{GasFile, assemble};
use arcfvm::scene::Scene;
use arcfvm::settings::Settings;
use arcfvm::solver::Arc;
use run::scene::{Expected, parse};

fn scene(body: &str) -> Scene {
    let text = format!(
        r#"{{"kind": "arcfvm.scene", "version": 1, "title": "exact", {body},
            "iterate": {{"tolerance": 1e-10, "most": 3000}}}}"#
    );
    let expected = Expected {
        kind: "arcfvm.scene",
        version: 1,
        migrations: &[],
    };
    parse::<Scene>(&text, expected).unwrap().scene
}

/// Iterates the scene to its tolerance.
fn solve(body: &str, gas: Option<&GasFile>) -> Arc {
    let scene = scene(body);
    let case = assemble(&scene, gas).unwrap();
    let mut arc = Arc::new(case, Settings::from(&scene.iterate));
    let mut last = None;
    for _ in 0..scene.iterate.most {
        let found = arc.iterate(&mut ()).unwrap();
        if found.within(scene.iterate.tolerance) && arc.iteration > 2 {
            arc.settle();
            return arc;
        }
        last = Some(found);
    }
    panic!("not converged: {last:?}");
}

/// Mass fractions along the axis, from `row` up.
fn axis(arc: &Arc, row: usize) -> Vec<f64> {
    let grid = &arc.case.grid;
    let iron = &arc.vapour.as_ref().unwrap().iron;
    (row..grid.nz).map(|j| iron[grid.cell(0, j)]).collect()
}

const BOX: &str =
    r#""domain": {"r_m": [0, 0.002], "z_m": [0, 0.01]}, "grid": {"r": 0.001, "z": 0.0005}"#;

#[test]
fn iron_at_rest_lies_on_the_line_between_two_edges() {
    let arc = solve(
        &format!(
            r#"{BOX}, "gas": {{"given": {{"density_kg_m3": 0.2, "iron_diffusion_m2_s": 0.01,
            "molar_mass_kg_mol": 0.04}}}},
        "vapour": {{"edges": {{"bottom": [{{"iron_mass_fraction": 0.3}}],
            "top": [{{"iron_mass_fraction": 0.1}}]}}}}"#
        ),
        None,
    );
    for (j, y) in axis(&arc, 0).iter().enumerate() {
        let want = 0.3 - 20.0 * arc.case.grid.zc[j];
        assert!((y - want).abs() < 1e-9, "{y} {want}");
    }
    let balance = arc.iron_balance().unwrap();
    assert!(balance.closure().abs() < 1e-9 * balance.size);
}

/// Iron evaporating at the bottom of a tube of 8 mm whose open end is free of it.
fn tube(mass: &str, spacing: f64, heat: &str) -> String {
    format!(
        r#""domain": {{"r_m": [0, 0.002], "z_m": [-0.002, 0.008]}},
        "grid": {{"r": 0.001, "z": {spacing}}},
        "gas": {{"given": {{"density_kg_m3": 0.2, "viscosity_pa_s": 1e-3, "iron_diffusion_m2_s": 0.01,
            "thermal_conductivity_w_m_k": 1, "specific_heat_j_kg_k": 1000, "molar_mass_kg_mol": 0.04}}}},
        "bodies": {{"metal": {{"shape": {{"ring": {{"r_m": [0, 0.002], "z_m": [-0.002, 0]}}}},
            "material": {{"density_kg_m3": 7000, "specific_heat_j_kg_k": 800, "thermal_conductivity_w_m_k": 30}},
            "anode": {{"work_function_v": 4.5, "emissivity": 0, "evaporation": {{"boiling_k": 3084,
                "latent_heat_j_kg": 6.1e6, "molar_mass_kg_mol": 0.055845,
                "saturation": {{"a": 6.347, "b_k": 19574}}}}}}}}}},
        "flow": {{"edges": {{"outer": [{{"slip": true}}], "top": [{{"pressure_pa": 0}}]}}}},
        "vapour": {{"mass": "{mass}", "edges": {{"top": [{{"iron_mass_fraction": 0}}]}}}},
        "start": {{"temperature_k": 2950}}{heat}"#
    )
}

/// Mass fraction at the surface and flux through `length` of gas, by halving.
fn series(adds: bool, length: f64) -> (f64, f64) {
    let (t, iron, gas) = (2950.0_f64, 0.055_845, 0.04);
    let saturation = 101_325.0 * 10_f64.powf(6.347 - 19_574.0 / t);
    let kinetic = (iron / (std::f64::consts::TAU * 8.314_462_618 * t)).sqrt();
    let mole = |y: f64| (y / iron) / (y / iron + (1.0 - y) / gas);
    let flux = |y: f64| {
        let conductance = 0.2 * 0.01 / length;
        conductance * if adds { -(1.0 - y).ln() } else { y }
    };
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..200 {
        let y = 0.5 * (low + high);
        if kinetic * (saturation - mole(y) * 101_325.0) > flux(y) {
            low = y;
        } else {
            high = y;
        }
    }
    (low, flux(low))
}

#[test]
fn a_tube_that_evaporates_follows_stefan() {
    let (surface, flux) = series(true, 0.008);
    let error = |spacing: f64| {
        let arc = solve(&tube("added", spacing, ""), None);
        let grid = &arc.case.grid;
        let row = grid.row_of(1e-6);
        let vapour = &arc.vapour.as_ref().unwrap();
        for (j, y) in axis(&arc, row).iter().enumerate() {
            let part = 1.0 - grid.zc[row + j] / 0.008;
            let want = 1.0 - (1.0 - surface).powf(part);
            assert!((y - want).abs() < 2e-3, "{y} {want}");
        }
        let out: f64 = arc.flowing.as_ref().unwrap().flow.mass_axial[grid.axial_face(0, grid.nz)..]
            .iter()
            .sum();
        let iron = arc.iron_balance().unwrap();
        // What flows out at the open end is iron alone: the gas in the tube is at rest.
        assert!((out / iron.surfaces - 1.0).abs() < 1e-6);
        assert!(iron.closure().abs() < 1e-8 * iron.size, "{iron:?}");
        (vapour.passed[0].flux / flux - 1.0).abs()
    };
    let (coarse, fine) = (error(5e-4), error(2.5e-4));
    assert!(
        coarse < 2e-3 && (coarse / fine).log2() > 1.8,
        "{coarse} {fine}"
    );
}

#[test]
fn a_tube_whose_vapour_takes_the_place_of_gas_is_linear() {
    let (surface, flux) = series(false, 0.008);
    let arc = solve(&tube("exchanged", 5e-4, ""), None);
    let grid = &arc.case.grid;
    let row = grid.row_of(1e-6);
    for (j, y) in axis(&arc, row).iter().enumerate() {
        let want = surface * (1.0 - grid.zc[row + j] / 0.008);
        assert!((y - want).abs() < 1e-8, "{y} {want}");
    }
    let passed = arc.vapour.as_ref().unwrap().passed[0];
    assert!((passed.flux / flux - 1.0).abs() < 1e-8);
    assert!((passed.surface / surface - 1.0).abs() < 1e-8);
    assert!(
        arc.flowing
            .as_ref()
            .unwrap()
            .flow
            .axial
            .iter()
            .all(|w| w.abs() < 1e-12)
    );
}

#[test]
fn boiling_metal_fills_the_tube_and_vents_the_rest() {
    // At 3300 K iron boils: its vapour alone is at the surface, and the line ends at 1 there.
    let boiling = |mass: &str| {
        let body = tube(mass, 5e-4, "").replace("2950", "3300");
        solve(&body, None)
    };
    let arc = boiling("vented");
    let grid = &arc.case.grid;
    let row = grid.row_of(1e-6);
    for (j, y) in axis(&arc, row).iter().enumerate() {
        let want = 1.0 - grid.zc[row + j] / 0.008;
        assert!((y - want).abs() < 1e-8, "{y} {want}");
    }
    let passed = arc.vapour.as_ref().unwrap().passed[0];
    let diffused = 0.2 * 0.01 / 0.008;
    assert!((passed.flux / diffused - 1.0).abs() < 1e-8);
    let excess = 101_325.0 * (10_f64.powf(6.347 - 19_574.0 / 3300.0) - 1.0);
    let root = (0.055_845 / (std::f64::consts::TAU * 8.314_462_618 * 3300.0)).sqrt();
    assert!((passed.off() / (root * excess) - 1.0).abs() < 1e-8);
    let iron = arc.iron_balance().unwrap();
    let area = std::f64::consts::PI * 0.002 * 0.002;
    assert!((iron.vented / (area * passed.vented) - 1.0).abs() < 1e-9);
    assert!(iron.closure().abs() < 1e-8 * iron.size);
    // Where nothing is vented, the gas holds the same.
    let held = boiling("exchanged");
    assert_eq!(axis(&held, row), axis(&arc, row));
    assert!(held.iron_balance().unwrap().vented.abs() < 1e-15);
}

#[test]
fn metal_that_does_not_evaporate_lies_under_the_gas_as_it_is() {
    let body = tube("exchanged", 5e-4, "");
    let (start, rest) = body.split_once(r#", "evaporation""#).unwrap();
    let (_, rest) = rest.split_once("19574}}").unwrap();
    let edges = r#""edges": {"outer": [{"iron_mass_fraction": 0.3}], "top": "#;
    let body = format!("{start}{rest}")
        .replace(r#""edges": {"top": [{"iron"#, &format!("{edges}[{{\"iron"));
    let arc = solve(&body, None);
    let (grid, vapour) = (&arc.case.grid, &arc.vapour.as_ref().unwrap());
    let row = grid.row_of(1e-6);
    for (i, passed) in vapour.passed.iter().enumerate() {
        let beside = vapour.iron[grid.cell(i, row)];
        assert!(
            (passed.surface - beside).abs() < 1e-15 && beside > 0.1,
            "{passed:?}"
        );
        assert!(passed.off().abs() < 1e-15);
    }
    assert_eq!(vapour.passed.len(), grid.nr);
}

#[test]
fn heat_goes_with_the_vapour_and_none_is_lost() {
    for (mass, bottom) in [
        ("added", 3200.0),
        ("exchanged", 3200.0),
        ("vented", 2900.0),
        ("vented", 5000.0),
    ] {
        let heat = format!(
            r#", "heat": {{"edges": {{"bottom": [{{"temperature_k": {bottom}}}],
                "top": [{{"temperature_k": 2500}}]}}}}"#
        );
        let mut arc = solve(&tube(mass, 5e-4, &heat), None);
        let balance = arc.settle().unwrap();
        let latent = balance.electrodes[0].vapour;
        let iron = arc.iron_balance().unwrap();
        let off = iron.surfaces + iron.vented;
        assert!((latent + 6.1e6 * off).abs() < 1e-9 * latent.abs());
        assert_eq!(iron.vented > 0.0, bottom > 4000.0, "{iron:?}");
        assert!(latent < -1.0 && balance.vapour > 0.0, "{balance:?}");
        let power = latent.abs();
        assert!(balance.closure().abs() < 1e-6 * power, "{mass} {balance:?}");
        // The surface is cooled by what evaporates: far below the temperature of the other side.
        let surface = arc.heating.unwrap().energy.surface_temperatures()[0];
        assert!(surface < 3150.0, "{surface}");
    }
}

/// A gas and iron whose enthalpies differ much, on two nodes of temperature.
fn unlike() -> GasFile {
    let (x, t) = ([0.0, 1.0], [300.0, 10_000.0]);
    let flat = |a: f64, b: f64| vec![a, a, b, b];
    let heat = |cp: f64| [0.0, 9700.0 * cp];
    let enthalpy = heat(4000.0).into_iter().chain(heat(500.0));
    let table =
        artefact::Table::grid(&[("iron_mole_fraction", "1", &x), ("temperature_k", "K", &t)])
            .column("density_kg_m3", "kg/m3", flat(0.2, 0.3))
            .column("specific_heat_j_kg_k", "J/(kg K)", flat(4000.0, 500.0))
            .column("enthalpy_j_kg", "J/kg", enthalpy)
            .column("viscosity_pa_s", "Pa s", flat(1e-3, 2e-3))
            .column("thermal_conductivity_w_m_k", "W/(m K)", flat(1.0, 1.0))
            .column("electric_conductivity_s_m", "S/m", flat(1.0, 1.0))
            .column("net_emission_w_m3", "W/m3", flat(0.0, 0.0))
            .column("iron_diffusion_m2_s", "m2/s", flat(0.01, 0.01))
            .attribute("pressure_pa", "Pa", 101_325.0)
            .attribute("gas_molar_mass_kg_mol", "kg/mol", 0.028)
            .attribute("iron_molar_mass_kg_mol", "kg/mol", 0.055_845);
    GasFile::from_table(&table).unwrap()
}

#[test]
fn gases_that_mix_without_heat_stay_as_warm_as_they_are() {
    // Gas flows in at the bottom against iron that diffuses down from the top, all at 5000 K.
    let arc = solve(
        &format!(
            r#"{BOX}, "gas": {{"table": {{}}}},
        "flow": {{"edges": {{"bottom": [{{"velocity_m_s": [0, 2]}}],
            "outer": [{{"slip": true}}], "top": [{{"pressure_pa": 0}}]}}}},
        "heat": {{"edges": {{"bottom": [{{"temperature_k": 5000}}], "top": [{{"temperature_k": 5000}}]}}}},
        "start": {{"temperature_k": 5000}},
        "vapour": {{"edges": {{"bottom": [{{"iron_mass_fraction": 0}}],
            "top": [{{"iron_mass_fraction": 0.6}}]}}}}"#
        ),
        Some(&unlike()),
    );
    let y = axis(&arc, 0);
    assert!(
        y[0] < 0.2 && y[y.len() - 1] > 0.55 && y.windows(2).all(|w| w[1] > w[0]),
        "{y:?}"
    );
    let furthest = arc
        .temperature()
        .iter()
        .map(|t| (t - 5000.0).abs())
        .fold(0.0, f64::max);
    assert!(furthest < 1e-3, "{furthest} K");
}

#[test]
fn what_vapour_lacks_is_told_with_its_place() {
    let told = |body: &str| assemble(&scene(body), None).unwrap_err().to_string();
    let gas = r#""gas": {"given": {"density_kg_m3": 1, "iron_diffusion_m2_s": 1e-3, "molar_mass_kg_mol": 0.04}}"#;
    let found = told(&format!(
        r#"{BOX}, "gas": {{"given": {{}}}}, "vapour": {{}}"#
    ));
    for place in ["iron_diffusion_m2_s", "density_kg_m3", "molar_mass_kg_mol"] {
        assert!(found.contains(place), "{place} is not in:\n{found}");
    }
    let found = told(&format!(r#"{BOX}, {gas}, "vapour": {{"mass": "added"}}"#));
    assert!(found.contains("/vapour/mass"), "{found}");
    let found = told(&format!(r#"{BOX}, {gas}, "vapour": {{"start": 1.5}}"#));
    assert!(found.contains("/vapour/start"), "{found}");
    let edges = r#"{"bottom": [{"iron_mass_fraction": -0.1}]}"#;
    let found = told(&format!(r#"{BOX}, {gas}, "vapour": {{"edges": {edges}}}"#));
    assert!(
        found.contains("/vapour/edges/bottom/0/iron_mass_fraction"),
        "{found}"
    );
    let found = told(&format!(
        r#"{BOX}, {gas}, "vapour": {{"ionisation_voltage_v": 7.9}}"#
    ));
    assert!(found.contains("/vapour/ionisation_voltage_v"), "{found}");
    let found = told(&format!(
        r#"{BOX}, {gas}, "vapour": {{"ionisation_by": "mass"}}"#
    ));
    assert!(found.contains("/vapour/ionisation_by"), "{found}");
    let metal = tube("exchanged", 5e-4, "").replace("\"vapour\": {", "\"sample\": {");
    let metal = metal.replace(
        r#""mass": "exchanged", "edges": {"top": [{"iron_mass_fraction": 0}]}"#,
        r#""velocity_height_m": 1e-4, "temperature_height_m": 1e-4"#,
    );
    assert!(told(&metal).contains("evaporation/saturation wants vapour"));
}

#[test]
fn metals_of_other_vapours_than_that_of_the_gas_are_refused() {
    let one = tube("added", 5e-4, "");
    let metal = &one[one.find("{\"shape\"").unwrap()..one.find("},\n        \"flow\"").unwrap()];
    let lid = metal
        .replace("[-0.002, 0]", "[0.006, 0.008]")
        .replace("0.055845", "0.207");
    let both = one.replace(metal, &format!("{metal}, \"lid\": {lid}"));
    let told = assemble(&scene(&both), None).unwrap_err().to_string();
    // The bodies come in the order of their names.
    assert!(
        told.contains("/bodies/metal/anode/evaporation/molar_mass_kg_mol"),
        "{told}"
    );
    // One metal alone may be any.
    let case = assemble(&scene(&one.replace("0.055845", "0.207")), None).unwrap();
    assert!((case.vapour.unwrap().molar.iron - 0.207).abs() < 1e-15);
}

#[test]
fn a_scene_without_vapour_holds_nothing_of_it() {
    let gas = r#""gas": {"given": {"density_kg_m3": 1, "viscosity_pa_s": 1e-3, "thermal_conductivity_w_m_k": 1,
        "specific_heat_j_kg_k": 1000}}"#;
    let scene = scene(&format!(r#"{BOX}, {gas}, "flow": {{}}, "heat": {{}}"#));
    let case = assemble(&scene, None).unwrap();
    let mut arc = Arc::new(case, Settings::from(&scene.iterate));
    let residuals = arc.iterate(&mut ()).unwrap();
    assert!(arc.vapour.is_none() && arc.iron_balance().is_none());
    assert!(residuals.named().all(|(name, _)| name != "residual_iron"));
    let properties = &arc.properties;
    assert!(properties.iron.is_empty() && properties.iron_diffusion.is_empty());
    assert!(arc.flowing.as_ref().unwrap().flow.mass_source.is_empty());
}
