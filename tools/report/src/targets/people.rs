//! Values of targets as people read them.

use super::Target;

/// Most digits behind the point.
const MOST: i32 = 9;

/// Factor, unit and digits for people: wires and plates move by the minute, gas by the second. There are so many digits that the
/// tolerance has one that counts; without a tolerance the value has one, or two where the unit has no digits behind the point.
pub(super) fn people(target: &Target) -> (f64, &str, usize) {
    let (factor, unit, digits) = usual(target);
    let of = |value: f64, count: i32| {
        let size = (factor * value).abs();
        let behind = count - 1 - size.log10().floor() as i32;
        if size > 0.0 {
            behind.clamp(0, MOST) as usize
        } else {
            0
        }
    };
    let needed = match target.tolerance {
        Some(tolerance) => of(tolerance, 1),
        None => of(target.value, if digits == 0 { 2 } else { 1 }),
    };
    (factor, unit, digits.max(needed))
}

/// Factor, unit and digits of a unit.
fn usual(target: &Target) -> (f64, &str, usize) {
    match target.unit.as_str() {
        "m" => (1e3, "mm", 1),
        "m2" => (1e6, "mm\u{b2}", 1),
        "m/s" if target.value.abs() < 1.0 => (60.0, "m/min", 2),
        "m/s" => (1.0, "m/s", 0),
        "W" => (1.0, "W", 0),
        "V" => (1.0, "V", 1),
        "deg" => (1.0, "\u{b0}", 1),
        "1" => (1.0, "", 2),
        other => (1.0, other, 2),
    }
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    fn digits(unit: &str, value: f64, tolerance: Option<f64>) -> usize {
        let told = json!({"measure": "a", "title": "a", "value": value, "unit": unit, "source": "a", "kind": "experiment",
            "tolerance": tolerance});
        people(&serde_json::from_value(told).unwrap()).2
    }

    #[test]
    fn digits_show_the_tolerance_and_are_else_as_usual() {
        assert_eq!(digits("m", 2.9e-3, Some(0.5e-3)), 1);
        assert_eq!(digits("m", 4e-5, Some(2e-5)), 2);
        assert_eq!(digits("m/s", 300.0, Some(100.0)), 0);
        assert_eq!(digits("m/s", 1.4, None), 1);
        assert_eq!(digits("kg/s", 3e-6, None), 6);
        assert_eq!(digits("W", 4100.0, None), 0);
        assert_eq!(digits("1", 0.0, None), 2);
    }
}
