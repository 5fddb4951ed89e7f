//! Units that keys state: a key that tells a dimensional number ends in its unit.

/// Endings of keys with their unit.
pub const KEY_UNITS: [(&str, &str); 71] = [
    ("w_m2_k", "W/(m2 K)"),
    ("w_m_k", "W/(m K)"),
    ("j_kg_k", "J/(kg K)"),
    ("n_m_k", "N/(m K)"),
    ("m2_k_w", "m2 K/W"),
    ("a_m2_k2", "A/(m2 K2)"),
    ("kg_m3_s", "kg/(m3 s)"),
    ("mol_m_s", "mol/(m s)"),
    ("j_mol_k", "J/(mol K)"),
    ("w_m3", "W/m3"),
    ("w_m2", "W/m2"),
    ("w_m", "W/m"),
    ("w_k", "W/K"),
    ("j_kg", "J/kg"),
    ("j_mol", "J/mol"),
    ("j_m3", "J/m3"),
    ("j_m2", "J/m2"),
    ("j_m", "J/m"),
    ("j_k", "J/K"),
    ("kg_m3", "kg/m3"),
    ("kg_m2_s", "kg/(m2 s)"),
    ("kg_m2", "kg/m2"),
    ("kg_mol", "kg/mol"),
    ("kg_s", "kg/s"),
    ("mol_m3", "mol/m3"),
    ("m3_s", "m3/s"),
    ("m2_s2", "m2/s2"),
    ("m2_s", "m2/s"),
    ("m_s2", "m/s2"),
    ("m_s", "m/s"),
    ("a_m3", "A/m3"),
    ("a_m2", "A/m2"),
    ("a_m", "A/m"),
    ("c_m3", "C/m3"),
    ("c_m2", "C/m2"),
    ("n_m3", "N/m3"),
    ("n_m2", "N/m2"),
    ("n_m", "N/m"),
    ("v_m", "V/m"),
    ("wb_m", "Wb/m"),
    ("pa_s", "Pa s"),
    ("pa_m", "Pa/m"),
    ("s_m", "S/m"),
    ("h_m", "H/m"),
    ("f_m", "F/m"),
    ("rad_s", "rad/s"),
    ("k_s", "K/s"),
    ("k_m", "K/m"),
    ("1_k", "1/K"),
    ("1_s", "1/s"),
    ("1_m3", "1/m3"),
    ("1_m", "1/m"),
    ("m3", "m3"),
    ("m2", "m2"),
    ("m", "m"),
    ("s", "s"),
    ("kg", "kg"),
    ("k", "K"),
    ("pa", "Pa"),
    ("hz", "Hz"),
    ("rad", "rad"),
    ("deg", "deg"),
    ("percent", "%"),
    ("j", "J"),
    ("w", "W"),
    ("a", "A"),
    ("v", "V"),
    ("n", "N"),
    ("t", "T"),
    ("c", "C"),
    ("mol", "mol"),
];

/// The unit that a key states: `spacing_m` is in m, `density_kg_m3` in kg/m3. The longest ending counts; nothing where the key
/// ends in none.
#[must_use]
pub fn unit_of_key(key: &str) -> Option<&'static str> {
    let states = |ending: &str| {
        let before = key.strip_suffix(ending).and_then(|b| b.strip_suffix('_'));
        before.is_some_and(|name| !name.is_empty())
    };
    let found = KEY_UNITS.iter().filter(|(ending, _)| states(ending));
    found
        .max_by_key(|(ending, _)| ending.len())
        .map(|&(_, unit)| unit)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Path;

    use serde_json::Value;

    fn root() -> std::path::PathBuf {
        Path::new(env!("CARGO_MANIFEST_DIR")).join("../../..")
    }

    /// Every key of a schema that states a unit, with it.
    fn stated(schema: &Value, all: &mut Vec<(String, String)>) {
        match schema {
            Value::Object(map) => {
                let properties = map.get("properties").and_then(Value::as_object);
                for (key, value) in properties.into_iter().flatten() {
                    if let Some(unit) = value["x-unit"].as_str() {
                        all.push((key.clone(), unit.to_owned()));
                    }
                }
                map.values().for_each(|inner| stated(inner, all));
            }
            Value::Array(items) => items.iter().for_each(|inner| stated(inner, all)),
            _ => {}
        }
    }

    #[test]
    fn every_key_of_every_schema_states_the_unit_of_the_schema() {
        let mut all = Vec::new();
        for entry in std::fs::read_dir(root().join("schemas")).unwrap() {
            let path = entry.unwrap().path();
            if path.extension().is_some_and(|e| e == "json") {
                let text = std::fs::read_to_string(path).unwrap();
                stated(&serde_json::from_str(&text).unwrap(), &mut all);
            }
        }
        assert!(all.len() > 200);
        let wrong: Vec<_> = all
            .iter()
            .filter(|(key, unit)| {
                key.contains('_') && unit != "1" && unit_of_key(key) != Some(unit)
            })
            .collect();
        assert!(wrong.is_empty(), "{wrong:?}");
    }

    #[test]
    fn the_longest_ending_counts_and_a_name_is_no_unit() {
        for (key, unit) in [
            ("density_kg_m3", Some("kg/m3")),
            ("volume_m3", Some("m3")),
            ("wire_feed_m_s", Some("m/s")),
            ("a", None),
            ("m_s", Some("s")),
            ("dilution", None),
            ("outcome", None),
        ] {
            assert_eq!(unit_of_key(key), unit, "{key}");
        }
    }

    #[test]
    fn the_python_package_knows_the_same_endings() {
        let path = root().join("tools/python/fusionline/message.py");
        let text = std::fs::read_to_string(path).unwrap();
        let begin = text.split_once("_ENDINGS = {").unwrap().1;
        let body = begin.split_once("\n}").unwrap().0;
        let pairs = body
            .lines()
            .filter_map(|line| line.trim().trim_end_matches(',').split_once(": "));
        let theirs: Vec<(&str, &str)> = pairs
            .map(|(a, b)| (a.trim_matches('"'), b.trim_matches('"')))
            .collect();
        assert_eq!(theirs.len(), KEY_UNITS.len());
        for (ending, unit) in KEY_UNITS {
            assert!(theirs.contains(&(ending, unit)), "{ending}");
        }
    }
}
