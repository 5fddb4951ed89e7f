//! Comma-separated values, RFC 4180: names with units in the first line.

use std::fmt::Write;

use artefact::{Column, Values};

use super::series::Series;
use crate::program::sheet::Sheet;

/// A frame, table or grid: one row per point; axes come first. Scalars that belong to a table
/// follow as columns of one value each.
pub(super) fn sheet(sheet: &Sheet) -> Vec<u8> {
    let axes: Vec<Column> = (0..sheet.axes.len()).map(|d| spread(sheet, d)).collect();
    let attributes: Vec<Column> = sheet
        .attributes
        .iter()
        .map(|a| repeat(a, sheet.rows()))
        .collect();
    let columns: Vec<&Column> = axes
        .iter()
        .chain(&sheet.columns)
        .chain(&attributes)
        .collect();
    let mut text = String::new();
    let head: Vec<String> = columns.iter().map(|c| head(&c.name, &c.unit)).collect();
    line(&mut text, &head);
    for row in 0..sheet.rows() {
        for (i, column) in columns.iter().enumerate() {
            if i > 0 {
                text.push(',');
            }
            number(&mut text, &column.values, row);
        }
        text.push_str("\r\n");
    }
    text.into_bytes()
}

/// Scalars over time: time first, then one column each.
pub(super) fn series(series: &Series) -> Vec<u8> {
    let mut names = vec![head("log_time", "s")];
    names.extend(series.columns.iter().map(|(name, unit)| head(name, unit)));
    names.extend(series.texts.iter().map(|name| quoted(name)));
    let mut columns: Vec<Vec<String>> = vec![series.times().iter().map(f64::to_string).collect()];
    for (name, _) in &series.columns {
        let values = series.column(name).into_iter();
        columns.push(
            values
                .map(|x| x.map_or(String::new(), |x| x.to_string()))
                .collect(),
        );
    }
    for name in &series.texts {
        columns.push(series.text(name).into_iter().map(quoted).collect());
    }
    let mut text = String::new();
    line(&mut text, &names);
    for row in 0..columns[0].len() {
        let fields: Vec<&str> = columns.iter().map(|c| c[row].as_str()).collect();
        line(&mut text, &fields);
    }
    text.into_bytes()
}

fn head(name: &str, unit: &str) -> String {
    quoted(&format!("{name} [{unit}]"))
}

fn quoted(text: &str) -> String {
    if text.contains([',', '"', '\n', '\r']) {
        format!("\"{}\"", text.replace('"', "\"\""))
    } else {
        text.to_owned()
    }
}

fn line<T: AsRef<str>>(text: &mut String, fields: &[T]) {
    let fields: Vec<&str> = fields.iter().map(AsRef::as_ref).collect();
    text.push_str(&fields.join(","));
    text.push_str("\r\n");
}

/// The shortest digits that read back to the same number.
fn number(text: &mut String, values: &Values, row: usize) {
    // Writing to a string cannot fail.
    let _ = match values {
        Values::F32(v) => write!(text, "{}", v[row]),
        Values::F64(v) => write!(text, "{}", v[row]),
        Values::U8(v) => write!(text, "{}", v[row]),
        Values::U32(v) => write!(text, "{}", v[row]),
    };
}

/// Axis `dimension` with one value per node, the last axis fastest.
fn spread(sheet: &Sheet, dimension: usize) -> Column {
    let axis = &sheet.axes[dimension];
    let values = axis.values.to_f64();
    let below: usize = sheet.shape[dimension + 1..].iter().product();
    let at = |node: usize| values[node / below % values.len()];
    Column {
        name: axis.name.clone(),
        unit: axis.unit.clone(),
        values: Values::F64((0..sheet.rows()).map(at).collect()),
    }
}

fn repeat(attribute: &Column, rows: usize) -> Column {
    let value = attribute.values.to_f64()[0];
    Column {
        name: attribute.name.clone(),
        unit: attribute.unit.clone(),
        values: Values::F64(vec![value; rows]),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::program::sheet::Form;

    #[test]
    fn a_grid_becomes_rows_with_the_last_axis_fastest() {
        let column = |name: &str, values: &[f64]| Column {
            name: name.to_owned(),
            unit: "m".to_owned(),
            values: Values::F64(values.to_vec()),
        };
        let grid = Sheet {
            form: Form::Grid,
            time_s: 0.0,
            shape: vec![2, 2],
            axes: vec![column("a", &[0.0, 1.0]), column("b", &[0.0, 0.5])],
            columns: vec![column("c", &[1.0, 2.0, 3.0, 4e-9])],
            attributes: vec![column("d", &[7.0])],
            texts: Vec::new(),
        };
        let text = String::from_utf8(super::sheet(&grid)).unwrap();
        let expected =
            "a [m],b [m],c [m],d [m]\r\n0,0,1,7\r\n0,0.5,2,7\r\n1,0,3,7\r\n1,0.5,0.000000004,7\r\n";
        assert_eq!(text, expected);
    }

    #[test]
    fn a_series_leaves_a_gap_where_a_value_is_absent() {
        let mut series = Series::default();
        series.push(Sheet::json(
            &serde_json::json!({"x_m": 1.5, "what": "a, \"b\""}),
        ));
        series.push(Sheet::json(&serde_json::json!({"x_m": 2.0, "y_m": 3.0})));
        let text = String::from_utf8(super::series(&series)).unwrap();
        let expected = "log_time [s],x_m [m],y_m [m],what\r\n0,1.5,,\"a, \"\"b\"\"\"\r\n0,2,3,\r\n";
        assert_eq!(text, expected);
    }
}
