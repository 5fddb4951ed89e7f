//! The numbers of a plot as a file inside the page.

use super::line::Line;
use crate::csv::{Csv, number, rounded};

/// Digits of a number: a plot shows fewer.
const DIGITS: usize = 7;

/// A link that saves the numbers as CSV.
pub(super) fn link(x_title: &str, y_title: &str, lines: &[Line]) -> String {
    let name = format!("{y_title} over {x_title}").to_lowercase();
    let letters = |c: char| if c.is_ascii_alphanumeric() { c } else { ' ' };
    let without = name.split(['[', ']']).step_by(2).collect::<String>();
    let words: String = without.chars().map(letters).collect();
    let file = words.split_whitespace().collect::<Vec<_>>().join("-");
    format!(
        "<a class=\"data\" download=\"{file}.csv\" href=\"data:text/csv;charset=utf-8,{}\">CSV</a>\n",
        inside(table(x_title, y_title, lines).text())
    )
}

/// A text inside an address.
fn inside(text: &str) -> String {
    let mut out = String::with_capacity(text.len() + text.len() / 8);
    for letter in text.chars() {
        match letter {
            '%' | '#' | '"' | '&' | '<' | '>' | ' ' | '\n' => {
                out += &format!("%{:02X}", u32::from(letter));
            }
            other => out.push(other),
        }
    }
    out
}

/// A column for each line where all run over the same places; otherwise a row for each point, which names its line.
fn table(x_title: &str, y_title: &str, lines: &[Line]) -> Csv {
    let mut csv = Csv::default();
    let [first, others @ ..] = lines else {
        return csv;
    };
    let places = |line: &Line| {
        line.points
            .iter()
            .map(|p| p[0].to_bits())
            .collect::<Vec<_>>()
    };
    let shared = places(first);
    if others.iter().all(|line| places(line) == shared) {
        let title = |line: &Line| match (line.name.as_str(), y_title.split_once('[')) {
            ("", _) => y_title.to_owned(),
            (name, Some((_, unit))) => format!("{name} [{unit}"),
            (name, None) => name.to_owned(),
        };
        csv.line(std::iter::once(x_title.to_owned()).chain(lines.iter().map(title)));
        for (i, point) in first.points.iter().enumerate() {
            let values = lines.iter().map(|line| line.points[i][1]);
            csv.line(std::iter::once(point[0]).chain(values).map(short));
        }
        return csv;
    }
    csv.line(["line", x_title, y_title]);
    for line in lines {
        for point in &line.points {
            csv.line([line.name.clone(), short(point[0]), short(point[1])]);
        }
    }
    csv
}

fn short(value: f64) -> String {
    number(rounded(value, DIGITS))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_over_the_same_places_are_columns_with_their_unit() {
        let lines = [
            Line::new("total", vec![[0.0, 1.0 / 3.0], [0.5, 2.0]]),
            Line::new("ions, all", vec![[0.0, 1.0], [0.5, 1e9]]),
        ];
        assert_eq!(
            table("radius r [mm]", "heat flux [W/mm\u{b2}]", &lines).text(),
            "radius r [mm],total [W/mm\u{b2}],\"ions, all [W/mm\u{b2}]\"\n0,0.3333333,1\n0.5,2,1e9\n"
        );
    }

    #[test]
    fn lines_over_other_places_name_themselves() {
        let lines = [
            Line::new("a", vec![[0.0, 1.0]]),
            Line::new("b", vec![[2.0, 3.0]]),
        ];
        let text = "line,time [s],x [m]\na,0,1\nb,2,3\n";
        assert_eq!(table("time [s]", "x [m]", &lines).text(), text);
        let link = link("time [s]", "speed, 5 % [m/s]", &lines[..1]);
        assert!(
            link.contains("download=\"speed-5-over-time.csv\""),
            "{link}"
        );
        assert!(
            link.contains("utf-8,time%20[s],a%20[m/s]%0A0,1%0A"),
            "{link}"
        );
    }
}
