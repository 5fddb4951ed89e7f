//! A message of any schema as columns: what all commands look at.

use artefact::{
    Channel, Column, GRID, POINT_CLOUD, Precision, RECORD, Reader, Record, Result, Series, TABLE,
    Table, Values,
};
use serde_json::Value;

/// What a message is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Form {
    /// Columns over particles.
    Frame,
    /// Columns over one index.
    Table,
    /// Columns over axes.
    Grid,
    /// Scalars; a channel of them is a series over time.
    Scalars,
}

impl Form {
    /// One word for people.
    pub(crate) fn word(self) -> &'static str {
        match self {
            Self::Frame => "points",
            Self::Table => "rows",
            Self::Grid => "nodes",
            Self::Scalars => "values",
        }
    }
}

/// A message as columns.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Sheet {
    /// What it is.
    pub(crate) form: Form,
    /// Simulated time \[s\].
    pub(crate) time_s: f64,
    /// Length of each dimension; `[1]` for scalars.
    pub(crate) shape: Vec<usize>,
    /// Axes of a grid.
    pub(crate) axes: Vec<Column>,
    /// Columns of equal length.
    pub(crate) columns: Vec<Column>,
    /// Scalars that belong to a table or grid.
    pub(crate) attributes: Vec<Column>,
    /// Texts and truths of a JSON message, by path.
    pub(crate) texts: Vec<(String, String)>,
}

impl Sheet {
    /// Message `index` of a channel.
    pub(crate) fn read(reader: &Reader, channel: &Channel, index: usize) -> Result<Self> {
        let name = channel.name.as_str();
        let mut sheet = match channel.schema.as_str() {
            POINT_CLOUD => Self::frame(reader.frame(name, index)?),
            TABLE | GRID => Self::table(reader.table_at(name, index)?),
            RECORD => Self::record(reader.record_at(name, index)?),
            _ => Self::json(&reader.json_at(name, index)?),
        };
        sheet.time_s = reader.time(name, index)?;
        Ok(sheet)
    }

    fn empty(form: Form, shape: Vec<usize>) -> Self {
        Self {
            form,
            time_s: 0.0,
            shape,
            axes: Vec::new(),
            columns: Vec::new(),
            attributes: Vec::new(),
            texts: Vec::new(),
        }
    }

    fn frame(frame: artefact::Frame) -> Self {
        Self {
            columns: frame.columns().to_vec(),
            ..Self::empty(Form::Frame, vec![frame.len()])
        }
    }

    fn table(table: Table) -> Self {
        let form = if table.axes.is_empty() {
            Form::Table
        } else {
            Form::Grid
        };
        let precision = table.precision();
        let columns = table.columns.into_iter();
        let attributes = table.attributes.into_iter();
        Self {
            axes: table.axes.into_iter().map(series).collect(),
            columns: columns.map(|c| as_wide(series(c), precision)).collect(),
            attributes: attributes
                .map(|(name, q)| scalar(name, q.unit, q.value))
                .collect(),
            ..Self::empty(form, table.shape)
        }
    }

    fn record(record: Record) -> Self {
        let values = record.values.into_iter();
        Self {
            columns: values.map(|e| scalar(e.name, e.unit, e.value)).collect(),
            ..Self::empty(Form::Scalars, vec![1])
        }
    }

    /// The numbers and texts of any JSON value; names are paths joined by full stops.
    pub(crate) fn json(value: &Value) -> Self {
        let mut sheet = Self::empty(Form::Scalars, vec![1]);
        sheet.walk(String::new(), value);
        sheet
    }

    fn walk(&mut self, path: String, value: &Value) {
        let below = |key: &str| {
            if path.is_empty() {
                key.to_owned()
            } else {
                format!("{path}.{key}")
            }
        };
        match value {
            Value::Object(map) => map.iter().for_each(|(key, v)| self.walk(below(key), v)),
            Value::Array(items) => {
                for (i, v) in items.iter().enumerate() {
                    self.walk(below(&i.to_string()), v);
                }
            }
            Value::Number(number) => {
                let x = number.as_f64().unwrap_or(f64::NAN);
                let unit = unit_of(&path).to_owned();
                self.columns.push(scalar(path, unit, x));
            }
            Value::String(text) => self.texts.push((path, text.clone())),
            other => self.texts.push((path, other.to_string())),
        }
    }

    /// Number of entries of each column.
    pub(crate) fn rows(&self) -> usize {
        self.shape.iter().product()
    }

    /// Axes, columns and attributes.
    pub(crate) fn all(&self) -> impl Iterator<Item = &Column> {
        self.axes
            .iter()
            .chain(&self.columns)
            .chain(&self.attributes)
    }
}

fn series(series: Series) -> Column {
    Column {
        name: series.name,
        unit: series.unit,
        values: Values::F64(series.values),
    }
}

/// A column as wide as it stands in the file.
#[allow(
    clippy::cast_possible_truncation,
    reason = "the values were read from f32"
)]
fn as_wide(column: Column, precision: Precision) -> Column {
    let values = match precision {
        Precision::F32 => {
            let wide = column.values.to_f64();
            Values::F32(wide.into_iter().map(|x| x as f32).collect())
        }
        Precision::F64 => column.values,
    };
    Column { values, ..column }
}

fn scalar(name: String, unit: String, value: f64) -> Column {
    Column {
        name,
        unit,
        values: Values::F64(vec![value]),
    }
}

/// Unit that the last part of a path states that is no number; `1` where it states none.
fn unit_of(path: &str) -> &'static str {
    let key = path.rsplit('.').find(|k| k.parse::<usize>().is_err());
    key.and_then(artefact::unit_of_key).unwrap_or("1")
}

/// A number for people: six digits, a power of ten where it is very small or large.
pub(crate) fn short(x: f64) -> String {
    let size = x.abs();
    if size > 0.0 && !(1e-4..1e7).contains(&size) {
        let text = format!("{x:.5e}");
        return match text.split_once('e') {
            Some((digits, power)) if digits.contains('.') => {
                let digits = digits.trim_end_matches('0').trim_end_matches('.');
                format!("{digits}e{power}")
            }
            _ => text,
        };
    }
    let text = format!("{x:.5e}");
    text.parse::<f64>()
        .map_or(text, |rounded| rounded.to_string())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_for_people_have_six_digits() {
        let cases = [
            (0.0, "0"),
            (0.00169560000000002, "0.0016956"),
            (-4.596542261792e-12, "-4.59654e-12"),
            (2e9, "2e9"),
            (4715.466136120171, "4715.47"),
            (52000.0, "52000"),
            (f64::NAN, "NaN"),
        ];
        for (x, text) in cases {
            assert_eq!(short(x), text);
        }
    }

    #[test]
    fn json_becomes_columns_named_by_path() {
        let value = serde_json::json!({
            "time_s": 0.5, "min_m": [1.0, 2.0], "name": "plate", "wet": true,
            "metal": {"density_kg_m3": 7000.0, "slope_n_m_k": [[1.0]], "count": 3}
        });
        let sheet = Sheet::json(&value);
        let names: Vec<_> = sheet
            .columns
            .iter()
            .map(|c| (c.name.as_str(), c.unit.as_str()))
            .collect();
        assert_eq!(
            names,
            [
                ("time_s", "s"),
                ("min_m.0", "m"),
                ("min_m.1", "m"),
                ("metal.density_kg_m3", "kg/m3"),
                ("metal.slope_n_m_k.0.0", "N/(m K)"),
                ("metal.count", "1"),
            ]
        );
        assert_eq!(sheet.columns[2].values, Values::F64(vec![2.0]));
        let texts: Vec<_> = sheet.texts.iter().map(|(_, t)| t.as_str()).collect();
        assert_eq!(texts, ["plate", "true"]);
    }
}
