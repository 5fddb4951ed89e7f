//! What a person probably meant: the nearest known key, the same key in SI.

use artefact::unit_of_key;
use serde_json::Value;

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

/// What to say of an unknown key, with the value converted where only the unit is another.
pub(crate) fn instead_of(key: &str, value: Option<&Value>, known: &[&str]) -> Option<String> {
    for (ending, si, factor, offset) in FOREIGN {
        let Some(stem) = key.strip_suffix(ending) else {
            continue;
        };
        let meant = format!("{stem}{si}");
        if known.contains(&meant.as_str()) {
            let unit = unit_of_key(&meant).unwrap_or("SI");
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
    let stem = |key: &str| unit_of_key(key).map_or(0, |_| 1);
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
