//! Voltage times current against all that leaves, for every closure of a cathode and both polarities.

use serde_json::{Value, json};

use super::{mirror, solve};

/// Two plates of unlike work functions, the upper one first driven positive; `cathode` is merged into both.
fn plates(current: f64, cathode: &Value) -> Value {
    let mut scene = mirror(current);
    for (name, work) in [("lower", 4.5), ("upper", 3.0)] {
        let electrode = scene["bodies"][name]["electrode"].as_object_mut().unwrap();
        electrode.insert("work_function_v".to_owned(), json!(work));
        for (key, value) in cathode.as_object().unwrap() {
            electrode.insert(key.clone(), value.clone());
        }
        electrode.retain(|_, value| !value.is_null());
    }
    scene
}

#[test]
fn what_leaves_is_voltage_times_current_and_what_ions_are_given() {
    let closures = [
        json!({}),
        json!({"ions": "whole"}),
        json!({"ions": "net"}),
        json!({"richardson_a_m2_k2": null, "fall_v": 15.0}),
        // A metal that emits so easily that the cathode lives on electrons in part.
        json!({"richardson_a_m2_k2": 1e9}),
    ];
    for current in [80.0, -80.0] {
        for closure in &closures {
            let mut arc = solve(&plates(current, closure));
            let balance = arc.settle().unwrap();
            let supply = arc.supply(&balance);
            let voltage = arc.voltage(Some(&supply)).unwrap();
            let power = 80.0 * voltage.all();
            // Counted here from what crosses the edges and shines off: the plates stand still, nothing flows or boils.
            let shines: f64 = balance.electrodes.iter().map(|e| e.emission).sum();
            let leaves = -balance.edges - shines;
            let [cathode, phi] = if current > 0.0 {
                [0, 1].map(f64::from)
            } else {
                [1.0, 0.0]
            };
            let work = [4.5, 3.0];
            let (cathode, anode) = (cathode as usize, phi as usize);
            let contact = work[anode] - work[cathode];
            assert!((voltage.contact - contact).abs() < 1e-9, "{voltage:?}");
            let ions = balance.electrodes[cathode].ungiven;
            let owed = leaves - power;
            assert!(
                (owed - ions).abs() < 1e-6 * power,
                "{closure} {current}: {owed} {ions}"
            );
            let free =
                closure.get("ions") == Some(&json!("net")) || closure.get("fall_v").is_some();
            assert_eq!(ions.abs() < 1e-9, free, "{closure}");
            assert_eq!(supply.unpaid.is_empty(), free);
            assert!(supply.closure().abs() < 1e-6 * power);
        }
    }
}

#[test]
fn ions_of_a_given_fall_are_not_to_be_chosen() {
    let closure = json!({"richardson_a_m2_k2": null, "fall_v": 15.0, "ions": "net"});
    let told = super::case(&plates(80.0, &closure)).unwrap_err();
    assert!(told.contains("/bodies/lower/electrode/ions"), "{told}");
}

#[test]
fn an_electrode_without_a_partner_owes_its_work_function() {
    let mut scene = mirror(80.0);
    let upper = scene["bodies"]["upper"].as_object_mut().unwrap();
    upper.remove("electrode");
    let mut arc = solve(&scene);
    let balance = arc.settle().unwrap();
    let supply = arc.supply(&balance);
    assert!(arc.voltage(Some(&supply)).unwrap().contact.abs() < 1e-15);
    let names: Vec<&str> = supply.unpaid.iter().map(|item| item.0.as_str()).collect();
    assert_eq!(names, ["ions_lower", "work_function_lower"]);
    assert!(supply.closure().abs() < 1e-6 * supply.electric());
}

/// 10 W that only pass through are the scale of what may be missing.
#[test]
fn without_a_current_heat_that_passes_is_the_scale() {
    let scene = json!({
        "kind": "arcfvm.scene", "version": 1, "title": "A cylinder", "domain": {"r_m": [0, 5e-3], "z_m": [0, 2e-3]},
        "grid": {"r": 5e-4, "z": 1e-3},
        "gas": {"given": {"thermal_conductivity_w_m_k": 1.5, "specific_heat_j_kg_k": 500, "density_kg_m3": 0.1, "net_emission_w_m3": 0}},
        "heat": {"edges": {"outer": [{"temperature_k": 1000}], "top": [{"over_m": [0, 2e-3], "flux_w_m2": 7.9577e5}]}},
        "start": {"temperature_k": 1000}, "iterate": {"tolerance": 1e-9}
    });
    let mut arc = solve(&scene);
    let balance = arc.settle().unwrap();
    let missing = arc.supply(&balance).closure() / arc.power(&balance);
    assert!(missing.abs() < 1e-3, "{missing}");
    assert!((arc.power(&balance) / 10.0 - 1.0).abs() < 1e-3);
}
