//! Maps of outcomes over two parameters, as SVG.

use serde::Deserialize;

use crate::html::escape;

/// Width of a cell at most, and its height.
const CELL: [f64; 2] = [96.0, 34.0];
/// Width of a map at most, without the names of its rows.
const WIDTH: f64 = 640.0;
/// Room for the names of the columns and of the x axis.
const FOOT: f64 = 46.0;
/// Width of a letter of the names.
const LETTER: f64 = 7.4;
/// Width of a letter in a cell.
const SMALL: f64 = 6.3;

/// How runs may end: the name in the record, what stands in the cell, and its colour. The words
/// differ too, so that nobody needs to tell colours apart.
const OUTCOMES: [(&str, &str, &str); 5] = [
    ("stable", "stable", "#009e73"),
    ("substepped", "sub-stepped", "#56b4e9"),
    ("refused", "refused", "#e69f00"),
    ("diverged-detected", "detected", "#cc79a7"),
    ("failed", "failed", "#d55e00"),
];

/// An axis: what it is and its values, in order.
#[derive(Debug, Clone, Deserialize)]
pub(super) struct Scale {
    pub(super) name: String,
    pub(super) values: Vec<String>,
}

/// The axes of a map.
#[derive(Debug, Clone, Deserialize)]
pub(super) struct Scales {
    pub(super) x: Scale,
    #[serde(default)]
    pub(super) y: Option<Scale>,
}

/// How the run at a column and row ended, and whether it may.
#[derive(Debug, Clone, Copy)]
pub(super) struct Cell<'a> {
    pub(super) at: [usize; 2],
    pub(super) outcome: &'a str,
    pub(super) holds: bool,
}

/// The map; the first row stands at the bottom.
pub(super) fn svg(scales: &Scales, cells: &[Cell]) -> String {
    let alone = Scale {
        name: String::new(),
        values: vec![String::new()],
    };
    let rows = scales.y.as_ref().unwrap_or(&alone);
    let letters = rows.values.iter().map(|v| shown(v).chars().count()).max();
    let left = 34.0 + LETTER * letters.unwrap_or(0) as f64;
    let columns = scales.x.values.len().max(1) as f64;
    let wide = (WIDTH / columns).min(CELL[0]);
    let corner = |[i, j]: [usize; 2]| {
        let up = rows.values.len().saturating_sub(j + 1) as f64;
        [left + i as f64 * wide, up * CELL[1]]
    };
    let (width, height) = (left + columns * wide, rows.values.len() as f64 * CELL[1]);
    let mut out = format!(
        "<svg class=\"plot\" viewBox=\"0 0 {:.1} {:.1}\" style=\"max-width:{:.0}px\" role=\"img\" \
         aria-label=\"ends of runs over {} and {}\" font-family=\"system-ui, sans-serif\" font-size=\"13\" \
         fill=\"currentColor\">\n",
        width + 2.0,
        height + FOOT,
        width + 2.0,
        escape(&scales.x.name),
        escape(&rows.name)
    );
    for cell in cells {
        out += &drawn(cell, corner(cell.at), wide);
    }
    for (i, value) in scales.x.values.iter().enumerate() {
        let [x, _] = corner([i, 0]);
        out += &text([x + 0.5 * wide, height + 17.0], "middle", &shown(value));
    }
    for (j, value) in rows.values.iter().enumerate() {
        let [_, y] = corner([0, j]);
        out += &text([left - 8.0, y + 0.5 * CELL[1] + 4.5], "end", &shown(value));
    }
    out += &text(
        [left + 0.5 * columns * wide, height + 38.0],
        "middle",
        &scales.x.name,
    );
    out += &format!(
        "<text transform=\"translate(14 {:.1}) rotate(-90)\" text-anchor=\"middle\">{}</text>\n",
        0.5 * height,
        escape(&rows.name)
    );
    out + "</svg>\n"
}

/// A number without a train of zeros.
fn shown(value: &str) -> String {
    let small = |v: f64| v != 0.0 && !(1e-3..1e5).contains(&v.abs());
    match value.parse::<f64>() {
        Ok(number) if small(number) => format!("{number:e}").replace('-', "\u{2212}"),
        _ => value.replace('-', "\u{2212}"),
    }
}

fn drawn(cell: &Cell, [x, y]: [f64; 2], wide: f64) -> String {
    let known = OUTCOMES.iter().find(|(name, ..)| *name == cell.outcome);
    let (_, word, hue) = known.copied().unwrap_or(OUTCOMES[4]);
    let mut out = format!(
        "<rect x=\"{x:.1}\" y=\"{y:.1}\" width=\"{:.1}\" height=\"{:.1}\" rx=\"3\" fill=\"{hue}\" fill-opacity=\"0.55\"/>\n",
        wide - 2.0,
        CELL[1] - 2.0
    );
    let middle = [x + 0.5 * wide - 1.0, y + 0.5 * CELL[1] + 3.5];
    // A narrow cell has room for the first letters only.
    let room = ((wide - 6.0) / SMALL) as usize;
    let word: String = word.chars().take(room.max(1)).collect();
    out += &text(middle, "middle", &word);
    if !cell.holds {
        out += &format!(
            "<rect x=\"{:.1}\" y=\"{:.1}\" width=\"{:.1}\" height=\"{:.1}\" rx=\"3\" fill=\"none\" \
             stroke=\"currentColor\" stroke-width=\"2.5\"/>\n",
            x + 1.0,
            y + 1.0,
            wide - 4.0,
            CELL[1] - 4.0
        );
        out += &text([x + 5.0, y + 13.0], "start", "\u{2717}");
    }
    out
}

fn text(at: [f64; 2], anchor: &str, words: &str) -> String {
    format!(
        "<text x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"{anchor}\">{}</text>\n",
        at[0],
        at[1],
        escape(words)
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_row_stands_at_the_bottom_and_a_failure_is_crossed() {
        let scales: Scales = serde_json::from_value(serde_json::json!({
            "x": {"name": "step over limit", "values": ["0.5", "1000000"]},
            "y": {"name": "Biot number", "values": ["0.01", "1"]}}))
        .unwrap();
        let cell = |at, outcome, holds| Cell { at, outcome, holds };
        let cells = [
            cell([0, 0], "stable", true),
            cell([1, 1], "diverged-detected", false),
        ];
        let map = svg(&scales, &cells);
        let lower = format!("y=\"{:.1}\"", CELL[1]);
        assert!(map.contains(&lower) && map.contains(">stable<"));
        assert!(map.contains(">detected<") && map.contains(">1e6<"));
        assert_eq!(map.matches('\u{2717}').count(), 1);
    }
}
