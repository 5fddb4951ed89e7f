//! What the cells do not hold, and what formulas are not: told or refused at the solution.

use arcfvm::sample::Sample;
use arcfvm::solver::Arc;
use serde_json::{Value, json};

use super::{case, mirror, pressed, read};
use arcfvm::settings::Settings;

/// The arc of a scene after so many iterations.
fn after(scene: &Value, iterations: usize) -> Arc {
    let settings = Settings::from(&read(scene).iterate);
    let mut arc = Arc::new(case(scene).unwrap(), settings);
    for _ in 0..iterations {
        arc.iterate(&mut ()).unwrap();
    }
    arc.settle();
    arc
}

fn unheld(scene: &Value) -> Vec<String> {
    after(scene, 3).unheld(&read(scene).sample)
}

#[test]
fn a_formula_below_zero_or_without_a_value_is_refused_where_it_is_taken() {
    let refused = |key: &str, formula: &str, t: f64| {
        let mut scene = mirror(80.0);
        scene["gas"]["given"][key] = json!({"expr": formula});
        scene["start"] = json!({"temperature_k": t});
        after(&scene, 0).beyond().err().map(|e| e.to_string())
    };
    let electric = "electric_conductivity_s_m";
    let said = refused(electric, "1.2*(T - 5000)^1.5", 300.0).unwrap();
    assert!(
        said.contains("/gas/given/electric_conductivity_s_m is NaN at 300 K"),
        "{said}"
    );
    let said = refused(electric, "100 - 0.1*T", 2000.0).unwrap();
    assert!(said.contains("is -100 at 2000 K"), "{said}");
    assert!(refused("net_emission_w_m3", "1e6 - 1e4*T", 300.0).is_some());
    assert_eq!(refused(electric, "0.5*(T - 300)", 300.0), None);
    let mut scene = mirror(80.0);
    scene["bodies"]["upper"]["material"]["thermal_conductivity_w_m_k"] =
        json!({"expr": "20 - 0.1*T"});
    let said = after(&scene, 0).beyond().unwrap_err().to_string();
    assert!(
        said.contains("/bodies/upper/material/thermal_conductivity_w_m_k is -10"),
        "{said}"
    );
}

#[test]
fn a_sheath_that_no_cell_holds_and_one_that_fills_the_gap_are_told() {
    // Cells of 1 mm between plates 12 mm apart.
    for (depth, wanted) in [
        (4e-4, Some("thinner than half of the cell")),
        (1e-3, None),
        (
            1.3e-2,
            Some("as thick as the gas where 100 % of the current"),
        ),
    ] {
        let mut scene = mirror(80.0);
        scene["current"]["sheath_m"] = json!(depth);
        let told = unheld(&scene);
        match wanted {
            None => assert!(told.is_empty(), "{told:?}"),
            Some(wanted) => assert!(told[0].contains(wanted), "{told:?}"),
        }
    }
}

#[test]
fn a_film_thicker_than_the_gas_is_told() {
    for (depth, count) in [(5e-4, 0), (1.3e-2, 1)] {
        let mut scene = mirror(80.0);
        scene["heat"]["film_m"] = json!(depth);
        let told = unheld(&scene);
        assert_eq!(told.len(), count, "{told:?}");
        assert!(
            told.iter()
                .all(|text| text.contains("thicker than the gas on 100 %"))
        );
    }
}

#[test]
fn heights_of_samples_beyond_the_gas_are_told() {
    // 12 mm of gas in cells of 0.5 mm over a level plate, and over one that slopes.
    let level = json!({"r_m": [0.005], "z_m": [0.004]});
    let slope = json!({"r_m": [0, 0.01], "z_m": [0.002, 0.006]});
    for top in [level, slope] {
        let mut scene = pressed(&top);
        let arc = after(&scene, 1);
        assert!(arc.unheld(&read(&scene).sample).is_empty());
        scene["sample"] = json!({"temperature_height_m": 9e-5, "velocity_height_m": 0.02});
        let sample: Sample = read(&scene).sample;
        let told = arc.unheld(&sample);
        assert!(
            told[0].starts_with("sample/velocity_height_m of 2.00e-2 m"),
            "{told:?}"
        );
        assert!(!told[0].contains("temperature"), "{told:?}");
    }
}

#[test]
fn a_body_moves_in_as_warm_as_its_edge_is_at_the_start() {
    let mut scene = mirror(80.0);
    scene["start"] = json!({"temperature_k": 600});
    scene["bodies"]["lower"]["moving"] = json!({"speed_m_s": 0.005, "ahead_m": 0.004});
    let beyond = |scene: &Value| case(scene).unwrap().heat.unwrap().plates[0].beyond.clone();
    assert_eq!(beyond(&scene), [600.0; 20]);
    scene["heat"]["edges"]["outer"] = json!([{"temperature_k": 350}]);
    assert_eq!(beyond(&scene), [350.0; 20]);
}
