//! Where a solution leaves its tables: what is told, what is a warning, what is refused.

use arcfvm::assemble::{GasFile, assemble};
use arcfvm::beyond::Told;
use arcfvm::scene::Scene;
use arcfvm::settings::Settings;
use arcfvm::solver::Arc;
use serde_json::{Value, json};

/// End of the table \[K\], and its pressure \[Pa\].
const END: f64 = 9000.0;
const PRESSURE: f64 = 2e5;

fn table() -> GasFile {
    let column =
        |name: &str, values: [f64; 3]| json!({"name": name, "unit": "u", "values": values});
    let columns = [
        column("temperature_k", [300.0, 5000.0, END]),
        column("density_kg_m3", [1.6, 0.1, 0.05]),
        column("specific_heat_j_kg_k", [520.0, 600.0, 2000.0]),
        column("viscosity_pa_s", [2e-5, 1e-4, 2e-4]),
        column("thermal_conductivity_w_m_k", [0.02, 0.2, 1.0]),
        column("electric_conductivity_s_m", [1e-5, 10.0, 2000.0]),
        column("net_emission_w_m3", [0.0, 1e3, 1e6]),
    ];
    serde_json::from_value(json!({"pressure_pa": PRESSURE, "columns": columns})).unwrap()
}

/// Gas of 200 cells over a plate of 10 columns.
fn arc(beyond: &str) -> Arc {
    arc_of(&json!({
        "title": "gas over a plate",
        "domain": {"r_m": [0, 0.01], "z_m": [-0.001, 0.02]}, "grid": {"r": 0.001, "z": 0.001},
        "gas": {"table": {"beyond_table": beyond}},
        "bodies": {"plate": {
            "shape": {"ring": {"r_m": [0, 0.01], "z_m": [-0.001, 0]}},
            "material": {"density_kg_m3": 7800, "specific_heat_j_kg_k": 600,
                "thermal_conductivity_w_m_k": {"t_k": [300, 1800], "value": [60, 30]}},
            "anode": {"work_function_v": 4.5, "emissivity": 0}
        }},
        "flow": {"edges": {"top": [{"pressure_pa": 0}]}},
        "heat": {"edges": {"top": [{"temperature_k": 300}]}},
        "start": {"temperature_k": 5000}
    }))
}

fn arc_of(scene: &Value) -> Arc {
    let scene: Scene = serde_json::from_value(scene.clone()).unwrap();
    let case = assemble(&scene, Some(&table())).unwrap();
    let mut arc = Arc::new(case, Settings::from(&scene.iterate));
    let plate = |k: &usize| arc.case.material[*k] != 0;
    let plate: Vec<usize> = (0..arc.case.grid.len()).filter(plate).collect();
    let heat = arc.heating.as_mut().unwrap();
    plate
        .iter()
        .for_each(|k| heat.energy.temperature[*k] = 1000.0);
    arc
}

/// Sets `count` cells of the row `row` from the axis on.
fn heat(arc: &mut Arc, row: usize, count: usize, t: f64) {
    for i in 0..count {
        let k = arc.case.grid.cell(i % 10, row + i / 10);
        arc.heating.as_mut().unwrap().energy.temperature[k] = t;
    }
}

fn told(arc: &Arc) -> Vec<Told> {
    arc.beyond().unwrap()
}

#[test]
fn more_than_a_hundredth_of_the_hot_cells_beyond_the_table_matters() {
    let mut arc = arc("extend");
    assert_eq!(told(&arc), []);
    // All 200 gas cells are hotter than half of the table's end.
    heat(&mut arc, 8, 2, 1.5 * END);
    let [few] = told(&arc).try_into().unwrap();
    assert!(
        !few.matters && few.text.contains("2 of 200 hot gas cells"),
        "{few:?}"
    );
    heat(&mut arc, 8, 3, 1.5 * END);
    let [many] = told(&arc).try_into().unwrap();
    assert!(many.matters);
    for part in [
        "gas table gas",
        "temperature_k",
        "9000 K",
        "up to 13500 K at cell",
        "3 of 200",
    ] {
        assert!(many.text.contains(part), "{part} is not in {}", many.text);
    }
    // The rest cold: three hot cells are then all that there is of an arc.
    heat(&mut arc, 1, 200, 400.0);
    heat(&mut arc, 8, 1, 1.5 * END);
    let [only] = told(&arc).try_into().unwrap();
    assert!(only.matters && only.text.contains("1 of 1 hot"), "{only:?}");
}

#[test]
fn one_cell_beside_an_electrode_matters() {
    let mut arc = arc("extend");
    heat(&mut arc, 1, 1, 1.01 * END);
    let [one] = told(&arc).try_into().unwrap();
    assert!(
        one.matters && one.text.contains("1 of 10 beside electrodes"),
        "{one:?}"
    );
}

#[test]
fn the_column_that_is_guessed_most_is_named_and_a_held_one_is_not_guessed() {
    let mut extended = arc("extend");
    heat(&mut extended, 8, 1, 2.0 * END);
    let [one] = told(&extended).try_into().unwrap();
    // 1e6 W/m3 at the end and 999e3 over the last 4000 K: 3.2 times as much 9000 K farther.
    assert!(
        one.text
            .contains("net_emission_w_m3 is extended there to 3.25"),
        "{}",
        one.text
    );
    let mut held = arc("hold");
    heat(&mut held, 8, 1, 2.0 * END);
    let [one] = told(&held).try_into().unwrap();
    assert!(one.text.contains("every column is held"), "{}", one.text);
    let mut strict = arc("error");
    heat(&mut strict, 8, 1, 2.0 * END);
    let refused = strict.beyond().unwrap_err().to_string();
    assert!(
        refused.contains("18000 K is outside of gas table gas"),
        "{refused}"
    );
}

#[test]
fn gas_colder_than_its_table_begins_is_told() {
    let mut arc = arc("extend");
    heat(&mut arc, 15, 10, 293.0);
    let [cool] = told(&arc).try_into().unwrap();
    assert!(
        !cool.matters
            && cool
                .text
                .contains("10 of 200 gas cells are colder, down to 293 K")
    );
    heat(&mut arc, 15, 3, 200.0);
    let [cold] = told(&arc).try_into().unwrap();
    assert!(
        cold.matters && cold.text.contains("begins at 300 K"),
        "{cold:?}"
    );
}

#[test]
fn a_pressure_off_that_of_the_table_by_a_twentieth_matters() {
    for (pressure, matters) in [(0.049, false), (0.051, true), (-0.051, true)] {
        let mut arc = arc("extend");
        let k = arc.case.grid.cell(2, 3);
        arc.flowing.as_mut().unwrap().flow.pressure[k] = pressure * PRESSURE;
        let all = told(&arc);
        assert_eq!(!all.is_empty(), matters, "{pressure} {all:?}");
        for one in all {
            assert!(
                one.matters && one.text.contains("density_kg_m3") && one.text.contains("200000 Pa")
            );
        }
    }
}

#[test]
fn a_table_of_the_scene_that_is_not_to_be_extrapolated_is_not() {
    let mut arc = arc("extend");
    let k = arc.case.grid.cell(4, 0);
    for (t, good) in [
        (1800.0, true),
        (1801.0, false),
        (300.0, true),
        (299.0, false),
    ] {
        arc.heating.as_mut().unwrap().energy.temperature[k] = t;
        let found = arc.beyond();
        assert_eq!(found.is_ok(), good, "{t} {found:?}");
        if let Err(refused) = found {
            let text = refused.to_string();
            assert!(
                text.contains("/bodies/plate/material/thermal_conductivity_w_m_k"),
                "{text}"
            );
            assert!(text.contains("300 K to 1800 K"), "{text}");
        }
    }
}
