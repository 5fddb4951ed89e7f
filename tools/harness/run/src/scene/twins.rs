//! Names that two entries of a list share, where names become columns or channels.

use serde_json::Value;

use super::walk;
use crate::fault::Fault;

/// Keys of lists whose entries are told by their names in what a run writes.
const TOLD: [&str; 7] = [
    "probes",
    "lines",
    "monitors",
    "boundaries",
    "nozzles",
    "outlets",
    "places",
];

/// Entries with the name of an earlier one.
pub(super) fn faults(scene: &Value) -> Vec<Fault> {
    let mut found = Vec::new();
    walk::keys(scene, &mut |path, key, value| {
        if let (true, Value::Array(list)) = (TOLD.contains(&key), value) {
            found.extend(twins(path, list));
        }
    });
    found
}

fn twins(path: &str, list: &[Value]) -> Vec<Fault> {
    let name = |i: usize| list[i].get("name").and_then(Value::as_str);
    let twin = |i: usize| {
        let own = name(i)?;
        let first = (0..i).find(|j| name(*j) == Some(own))?;
        let what = format!("'{own}' is the name of {path}/{first} too: their results would be one");
        Some(Fault::at(&format!("{path}/{i}/name"), what))
    };
    (0..list.len()).filter_map(twin).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn entries_of_one_name_are_found_where_names_are_columns() {
        let named = |names: [&str; 3]| names.map(|name| json!({"name": name}));
        let scene = json!({
            "boundaries": named(["a", "b", "a"]), "materials": named(["steel", "steel", "steel"]),
            "output": {"monitors": [{"name": "m"}, {}, {}], "probes": named(["p", "p", "p"])}
        });
        let found = faults(&scene);
        let paths: Vec<&str> = found.iter().map(Fault::path).collect();
        assert_eq!(
            paths,
            [
                "/boundaries/2/name",
                "/output/probes/1/name",
                "/output/probes/2/name"
            ]
        );
        assert!(
            found[0]
                .to_string()
                .contains("'a' is the name of /boundaries/0 too")
        );
    }
}
