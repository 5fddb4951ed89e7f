//! Ranges that belong to a quantity and not to a key: they hold in the scenes of all tools.

use serde_json::Value;

use super::walk;
use crate::fault::Fault;

/// Endings of keys that state a temperature on the absolute scale. Other keys in K state differences, which may be
/// negative.
const TEMPERATURES: [&str; 8] = [
    "temperature_k",
    "ambient_k",
    "surroundings_k",
    "point_k",
    "reference_k",
    "boiling_k",
    "from_k",
    "to_k",
];
/// Key of the temperatures of a table.
const OF_TABLE: &str = "t_k";
/// 0 degrees Celsius \[K\].
const CELSIUS: f64 = 273.15;

/// Values that their quantity cannot have.
pub(super) fn faults(scene: &Value) -> Vec<Fault> {
    let mut found = Vec::new();
    let is_temperature =
        |key: &str| key == OF_TABLE || TEMPERATURES.iter().any(|ending| key.ends_with(ending));
    walk::numbers(scene, &is_temperature, &mut |at, number| {
        let kelvin = number.as_f64().unwrap_or(f64::NAN);
        if kelvin < 0.0 {
            let meant = kelvin + CELSIUS;
            let hint = if meant >= 0.0 {
                format!("; {kelvin} degrees Celsius are {meant:.2} K")
            } else {
                String::new()
            };
            let what = format!("{number} K is out of range: at least 0 K{hint}");
            found.push(Fault::at(at, what));
        }
    });
    found
}

/// Ending of keys that state a density, and what solids and liquids have \[kg/m3\].
const DENSITY: &str = "density_kg_m3";
const CONDENSED: [f64; 2] = [30.0, 30_000.0];

/// Values that their quantity can have and hardly has.
pub(crate) fn doubts(scene: &Value) -> Vec<String> {
    let mut found = Vec::new();
    let is_density = |key: &str| key.ends_with(DENSITY);
    walk::numbers(scene, &is_density, &mut |at, number| {
        let density = number.as_f64().unwrap_or(f64::NAN);
        let [low, high] = CONDENSED;
        // 1 is the unit of who reckons without units.
        if density > 0.0 && density < low && (density - 1.0).abs() > f64::EPSILON {
            let meant = 1e3 * density;
            found.push(format!(
                "{at}: {number} kg/m3 is the density of a gas; {number} g/cm3 are {meant} kg/m3"
            ));
        } else if density > high {
            let meant = 1e-3 * density;
            found.push(format!(
                "{at}: {number} kg/m3 is more than any matter has; a thousandth is {meant} kg/m3"
            ));
        }
    });
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn densities_off_by_a_thousand_are_doubted_wherever_they_stand() {
        let scene = json!({
            "density_kg_m3": 7.85,
            "materials": [{"density_kg_m3": {"t_k": [300, 1800], "value": [7800, 7e6]}}, {"density_kg_m3": 1}],
            "water": {"density_kg_m3": 1000}, "current_density_a_m2": 5
        });
        let found = doubts(&scene);
        assert_eq!(found.len(), 2, "{found:?}");
        assert!(
            found[0].starts_with("/density_kg_m3: 7.85 kg/m3") && found[0].contains("7850 kg/m3")
        );
        assert!(found[1].starts_with("/materials/0/density_kg_m3/value/1:"));
    }

    #[test]
    fn temperatures_below_zero_are_found_wherever_they_stand() {
        let scene = json!({
            "initial_temperature_k": -40,
            "faces": [{"ambient_k": {"t_s": [-1, 0], "value": [300, -5]}}, {"surroundings_k": 0}],
            "density_kg_m3": {"t_k": [-1, 300], "value": [-1, -2]},
            "step_k": -3,
            "velocity_m_s": -2
        });
        let found = faults(&scene);
        let paths: Vec<&str> = found.iter().map(Fault::path).collect();
        let expected = [
            "/initial_temperature_k",
            "/faces/0/ambient_k/value/1",
            "/density_kg_m3/t_k/0",
        ];
        assert_eq!(paths, expected);
        let text = found[1].to_string();
        assert!(
            text.contains("-5 K is out of range: at least 0 K; -5 degrees Celsius are 268.15 K"),
            "{text}"
        );
    }
}
