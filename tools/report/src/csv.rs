//! Tables of numbers as comma-separated values (RFC 4180), for other programs.

/// Lines of cells; the first one is the head, with units in brackets.
#[derive(Debug, Default, Clone)]
pub(crate) struct Csv {
    text: String,
}

impl Csv {
    /// Adds a line.
    pub(crate) fn line<C: AsRef<str>>(&mut self, cells: impl IntoIterator<Item = C>) {
        let cells = cells.into_iter().map(|cell| quoted(cell.as_ref()));
        self.text += &cells.collect::<Vec<_>>().join(",");
        self.text.push('\n');
    }

    /// The file.
    pub(crate) fn text(&self) -> &str {
        &self.text
    }
}

/// A cell; in quotes where it holds what separates cells.
fn quoted(cell: &str) -> String {
    if cell.contains([',', '"', '\n', '\r']) {
        return format!("\"{}\"", cell.replace('"', "\"\""));
    }
    cell.to_owned()
}

/// A number as short as it can be told without loss; nothing where it is none.
pub(crate) fn number(value: f64) -> String {
    let size = value.abs();
    if !value.is_finite() {
        String::new()
    } else if size > 0.0 && !(1e-4..1e7).contains(&size) {
        format!("{value:e}")
    } else {
        value.to_string()
    }
}

/// A number to so many digits.
pub(crate) fn rounded(value: f64, digits: usize) -> f64 {
    let text = format!("{value:.*e}", digits.saturating_sub(1));
    text.parse().unwrap_or(value)
}

/// The head of a column: its name and its unit, if it has one.
pub(crate) fn head(name: &str, unit: &str) -> String {
    match unit {
        "" | "1" => name.to_owned(),
        unit => format!("{name} [{unit}]"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_come_back_as_they_were() {
        let mut csv = Csv::default();
        csv.line([head("heat, total", "W"), head("share", "1")]);
        csv.line([number(1.5e-7), number(f64::NAN)]);
        assert_eq!(csv.text(), "\"heat, total [W]\",share\n1.5e-7,\n");
        assert_eq!(quoted("a \"b\""), "\"a \"\"b\"\"\"");
        assert_eq!(rounded(9.450000000000001, 15).to_bits(), 9.45_f64.to_bits());
        for value in [0.1, -3.0, 1e300, 123456.789, 4.9e-324] {
            let read: f64 = number(value).parse().unwrap();
            assert_eq!(read.to_bits(), value.to_bits());
        }
    }
}
