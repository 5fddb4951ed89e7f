//! What a person probably meant: the nearest known key, the same key in SI.

use serde_json::Value;

/// Endings of keys with their unit, longest first among those that overlap.
const UNITS: [(&str, &str); 38] = [
    ("_w_m2_k", "W/(m2 K)"),
    ("_w_m_k", "W/(m K)"),
    ("_j_kg_k", "J/(kg K)"),
    ("_n_m_k", "N/(m K)"),
    ("_w_m3", "W/m3"),
    ("_w_m2", "W/m2"),
    ("_j_kg", "J/kg"),
    ("_kg_m3", "kg/m3"),
    ("_kg_s", "kg/s"),
    ("_m3_s", "m3/s"),
    ("_m2_s", "m2/s"),
    ("_m_s2", "m/s2"),
    ("_m_s", "m/s"),
    ("_a_m2", "A/m2"),
    ("_n_m3", "N/m3"),
    ("_n_m", "N/m"),
    ("_v_m", "V/m"),
    ("_pa_s", "Pa s"),
    ("_s_m", "S/m"),
    ("_1_k", "1/K"),
    ("_k_s", "K/s"),
    ("_k_m", "K/m"),
    ("_j_m3", "J/m3"),
    ("_1_s", "1/s"),
    ("_1_m", "1/m"),
    ("_m3", "m3"),
    ("_m2", "m2"),
    ("_rad", "rad"),
    ("_pa", "Pa"),
    ("_hz", "Hz"),
    ("_kg", "kg"),
    ("_m", "m"),
    ("_s", "s"),
    ("_k", "K"),
    ("_a", "A"),
    ("_v", "V"),
    ("_w", "W"),
    ("_j", "J"),
];

/// Endings that are not SI: the SI ending, factor and offset that lead to it.
const FOREIGN: [(&str, &str, f64, f64); 27] = [
    ("_mm_s", "_m_s", 1e-3, 0.0),
    ("_cm_min", "_m_s", 1e-2 / 60.0, 0.0),
    ("_m_min", "_m_s", 1.0 / 60.0, 0.0),
    ("_l_min", "_m3_s", 1e-3 / 60.0, 0.0),
    ("_g_cm3", "_kg_m3", 1e3, 0.0),
    ("_a_mm2", "_a_m2", 1e6, 0.0),
    ("_w_mm2", "_w_m2", 1e6, 0.0),
    ("_mpa_s", "_pa_s", 1e-3, 0.0),
    ("_mn_m", "_n_m", 1e-3, 0.0),
    ("_mm", "_m", 1e-3, 0.0),
    ("_cm", "_m", 1e-2, 0.0),
    ("_um", "_m", 1e-6, 0.0),
    ("_ms", "_s", 1e-3, 0.0),
    ("_us", "_s", 1e-6, 0.0),
    ("_min", "_s", 60.0, 0.0),
    ("_degc", "_k", 1.0, 273.15),
    ("_c", "_k", 1.0, 273.15),
    ("_ka", "_a", 1e3, 0.0),
    ("_ma", "_a", 1e-3, 0.0),
    ("_kw", "_w", 1e3, 0.0),
    ("_mv", "_v", 1e-3, 0.0),
    ("_atm", "_pa", 101_325.0, 0.0),
    ("_bar", "_pa", 1e5, 0.0),
    ("_kpa", "_pa", 1e3, 0.0),
    ("_g", "_kg", 1e-3, 0.0),
    ("_deg", "_rad", std::f64::consts::PI / 180.0, 0.0),
    ("_khz", "_hz", 1e3, 0.0),
];

/// The unit that the ending of a key states.
pub(crate) fn unit_of(key: &str) -> Option<&'static str> {
    UNITS
        .iter()
        .find(|(ending, _)| key.ends_with(ending))
        .map(|&(_, unit)| unit)
}

/// What to say of an unknown key, with the value converted where only the unit is another.
pub(crate) fn instead_of(key: &str, value: Option<&Value>, known: &[&str]) -> Option<String> {
    for (ending, si, factor, offset) in FOREIGN {
        let Some(stem) = key.strip_suffix(ending) else {
            continue;
        };
        let meant = format!("{stem}{si}");
        if known.contains(&meant.as_str()) {
            let unit = unit_of(&meant).unwrap_or("SI");
            let converted = value
                .and_then(Value::as_f64)
                .map(|x| format!(": {}", shortest(x * factor + offset)));
            return Some(format!(
                "did you mean '{meant}' in {unit}{}?",
                converted.unwrap_or_default()
            ));
        }
    }
    nearest(key, known).map(|meant| format!("did you mean '{meant}'?"))
}

/// The known word nearest to a word, if one is near.
#[must_use]
pub fn nearest<'a>(word: &str, known: &[&'a str]) -> Option<&'a str> {
    let stem = |key: &str| unit_of(key).map_or(0, |_| 1);
    known
        .iter()
        .map(|&candidate| {
            (
                strsim::jaro_winkler(word, candidate),
                stem(candidate),
                candidate,
            )
        })
        .filter(|(likeness, ..)| *likeness >= 0.8)
        .max_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)))
        .map(|(.., candidate)| candidate)
}

/// A number without the noise of its conversion: 12 digits, trailing zeros removed.
fn shortest(x: f64) -> String {
    let rounded: f64 = format!("{x:.11e}").parse().unwrap_or(x);
    format!("{rounded}")
}
