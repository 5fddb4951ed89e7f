//! Columns as VTK sees them: three columns `velocity_x`, `_y`, `_z` are one vector.

use artefact::{Column, Values};

/// An array of one or three components.
pub(super) struct Field<'a> {
    pub(super) name: String,
    pub(super) unit: &'a str,
    pub(super) parts: Vec<&'a Values>,
}

/// All columns, components joined where all three stand there with one type and unit.
pub(super) fn fields<'a>(columns: &[&'a Column]) -> Vec<Field<'a>> {
    let mut joined = vec![false; columns.len()];
    let mut fields = Vec::new();
    for i in 0..columns.len() {
        if joined[i] {
            continue;
        }
        let column = columns[i];
        let triple = triple(columns, i);
        for &k in triple.iter().flat_map(|(_, triple)| triple) {
            joined[k] = true;
        }
        let (name, parts) = match triple {
            Some((name, triple)) => (name, triple.map(|k| &columns[k].values).to_vec()),
            None => (column.name.clone(), vec![&column.values]),
        };
        fields.push(Field {
            name,
            unit: &column.unit,
            parts,
        });
    }
    fields
}

/// Name of the vector whose first component is column `i`, and its three columns.
fn triple(columns: &[&Column], i: usize) -> Option<(String, [usize; 3])> {
    let first = columns[i];
    let parts: Vec<&str> = first.name.split('_').collect();
    let at = parts.iter().position(|part| *part == "x")?;
    if at == 0 {
        return None;
    }
    let with = |axis: Option<&str>| -> String {
        let mut parts: Vec<&str> = parts.clone();
        match axis {
            Some(axis) => parts[at] = axis,
            None => drop(parts.remove(at)),
        }
        parts.join("_")
    };
    let find = |axis: &str| {
        let name = with(Some(axis));
        columns.iter().position(|c| {
            c.name == name
                && c.unit == first.unit
                && c.values.type_name() == first.values.type_name()
        })
    };
    Some((with(None), [i, find("y")?, find("z")?]))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn column(name: &str) -> Column {
        Column {
            name: name.to_owned(),
            unit: "m/s".to_owned(),
            values: Values::F64(vec![0.0]),
        }
    }

    #[test]
    fn components_are_joined_and_lone_ones_are_not() {
        let names = [
            "velocity_x_m_s",
            "velocity_y_m_s",
            "velocity_z_m_s",
            "flux_x",
            "flux_y",
            "temperature",
        ];
        let columns: Vec<Column> = names.iter().map(|n| column(n)).collect();
        let fields = fields(&columns.iter().collect::<Vec<_>>());
        let found: Vec<_> = fields
            .iter()
            .map(|f| (f.name.as_str(), f.parts.len()))
            .collect();
        let expected = [
            ("velocity_m_s", 3),
            ("flux_x", 1),
            ("flux_y", 1),
            ("temperature", 1),
        ];
        assert_eq!(found, expected);
    }
}
