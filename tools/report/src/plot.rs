//! Line plots as SVG that takes the colours of the page around it.
//!
//! Ink is `currentColor` and the ground is transparent, so that a plot reads on a light and on a
//! dark page. Series differ in colour (Okabe and Ito's, which the colour-blind tell apart), and in
//! the shape of their marks or, without marks, in their dashes.

mod data;
mod frame;
mod line;

pub(crate) use line::Line;

use crate::html::escape;
use frame::Frame;

const COLOURS: [&str; 7] = [
    "#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#8f7f3f",
];
/// Of lines without marks, in the order of their colours.
const DASHES: [&str; 7] = [
    "",
    "9 3",
    "3 2.5",
    "10 3 2 3",
    "16 4",
    "6 2 2 2 2 2",
    "1.5 3",
];
const WIDTH: f64 = 640.0;
const HEIGHT: f64 = 380.0;
/// Left, right, top, bottom.
const MARGIN: [f64; 4] = [80.0, 18.0, 14.0, 50.0];
/// Height of a row of the legend.
const ROW: f64 = 18.0;

/// How an axis runs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Run {
    /// Linear.
    Even,
    /// By powers of ten.
    Log,
}

/// A plot of lines.
#[derive(Debug, Clone)]
pub(crate) struct Plot {
    x_title: String,
    y_title: String,
    run: [Run; 2],
    lines: Vec<Line>,
    /// Ranges that must be seen.
    least: [Option<f64>; 2],
}

impl Plot {
    /// An empty plot with linear axes.
    pub(crate) fn new(x_title: &str, y_title: &str) -> Self {
        Self {
            x_title: x_title.to_owned(),
            y_title: y_title.to_owned(),
            run: [Run::Even, Run::Even],
            lines: Vec::new(),
            least: [None, None],
        }
    }

    /// With logarithmic axes; points that are not positive are left out.
    pub(crate) fn log_log(mut self) -> Self {
        self.run = [Run::Log, Run::Log];
        self
    }

    /// With a logarithmic y axis; points below 0 are left out.
    pub(crate) fn log_y(mut self) -> Self {
        self.run[1] = Run::Log;
        self
    }

    /// With the y axis through `value`.
    pub(crate) fn through(mut self, value: f64) -> Self {
        self.least[1] = Some(value);
        self
    }

    /// Adds a line; nothing if no point of it can be shown.
    pub(crate) fn add(&mut self, mut line: Line) {
        line.points.retain(|p| self.shows(*p));
        line.spans
            .retain(|[from, to, y]| self.shows([*from, *y]) && self.shows([*to, *y]));
        if !line.points.is_empty() {
            self.lines.push(line);
        }
    }

    fn shows(&self, point: [f64; 2]) -> bool {
        (0..2).all(|k| point[k].is_finite() && (self.run[k] == Run::Even || point[k] > 0.0))
    }

    /// Whether there is nothing to show.
    pub(crate) fn is_empty(&self) -> bool {
        self.lines.is_empty()
    }

    /// The plot as SVG, and below it its numbers as a file to be saved; nothing if it is empty.
    pub(crate) fn html(&self) -> String {
        if self.lines.is_empty() {
            return String::new();
        }
        self.svg() + &data::link(&self.x_title, &self.y_title, &self.lines)
    }

    fn svg(&self) -> String {
        let rows = self.legend_rows();
        let top = MARGIN[2] + rows.len() as f64 * ROW;
        let frame = Frame {
            left: MARGIN[0],
            right: WIDTH - MARGIN[1],
            top,
            bottom: top + HEIGHT - MARGIN[2] - MARGIN[3],
            x: self.range(0),
            y: self.range(1),
            run: self.run,
        };
        let total = frame.bottom + MARGIN[3];
        let mut out = format!(
            "<svg class=\"plot\" viewBox=\"0 0 {WIDTH} {total}\" role=\"img\" aria-label=\"{} over {}\" \
             font-family=\"system-ui, sans-serif\" font-size=\"13\" fill=\"currentColor\">\n",
            escape(&self.y_title),
            escape(&self.x_title)
        );
        out += &self.legend(&rows);
        out += &frame.grid(&self.x_title, &self.y_title);
        let mut colour = 0;
        for line in &self.lines {
            out += &draw(line, &frame, colour);
            colour += usize::from(!line.guide);
        }
        out + "</svg>\n"
    }

    fn range(&self, k: usize) -> [f64; 2] {
        let values = self
            .lines
            .iter()
            .flat_map(|l| l.points.iter().map(|p| p[k]));
        let bars = self.lines.iter().flat_map(|l| l.spans.iter());
        let ends = bars.flat_map(|s| if k == 0 { [s[0], s[1]] } else { [s[2], s[2]] });
        let all = values.chain(ends).chain(self.least[k]);
        let (low, high) = all.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| {
            (l.min(v), h.max(v))
        });
        match self.run[k] {
            Run::Log if high > low * 1.5 => [low / 1.4, high * 1.4],
            Run::Log => [low / 3.0, high * 3.0],
            Run::Even if high > low => {
                let pad = if k == 0 { 0.0 } else { 0.05 * (high - low) };
                [low - pad, high + pad]
            }
            Run::Even => [
                low - 0.5 * low.abs().max(1e-9),
                high + 0.5 * high.abs().max(1e-9),
            ],
        }
    }

    /// Indices of lines by row of the legend.
    fn legend_rows(&self) -> Vec<Vec<usize>> {
        let mut rows: Vec<Vec<usize>> = Vec::new();
        let mut width = f64::INFINITY;
        for (i, line) in self
            .lines
            .iter()
            .enumerate()
            .filter(|(_, l)| !l.name.is_empty())
        {
            let own = entry_width(&line.name);
            if width + own > WIDTH - MARGIN[0] {
                rows.push(Vec::new());
                width = 0.0;
            }
            if let Some(row) = rows.last_mut() {
                row.push(i);
            }
            width += own;
        }
        rows
    }

    fn legend(&self, rows: &[Vec<usize>]) -> String {
        let mut out = String::new();
        for (r, row) in rows.iter().enumerate() {
            let y = MARGIN[2] + r as f64 * ROW;
            let mut x = MARGIN[0];
            for &i in row {
                let line = &self.lines[i];
                let colour = self.lines[..i].iter().filter(|l| !l.guide).count();
                out += &stroke(line, &format!("M{x:.1} {y:.1}h20"), colour);
                if line.marks {
                    out += &mark(colour, [x + 10.0, y]);
                }
                out += &text([x + 26.0, y + 4.5], "start", &line.name);
                x += entry_width(&line.name);
            }
        }
        out
    }
}

fn entry_width(name: &str) -> f64 {
    44.0 + 7.1 * name.chars().count() as f64
}

/// Text; a trailing `^n` becomes a superscript.
fn text(at: [f64; 2], anchor: &str, words: &str) -> String {
    let body = match words.split_once("\u{200a}^") {
        Some((base, power)) => format!(
            "{}<tspan dy=\"-5\" font-size=\"10\">{}</tspan>",
            escape(base),
            escape(power)
        ),
        None => escape(words),
    };
    format!(
        "<text x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"{anchor}\">{body}</text>\n",
        at[0], at[1]
    )
}

fn draw(line: &Line, frame: &Frame, colour: usize) -> String {
    let mut path = String::new();
    for (i, point) in line.points.iter().enumerate() {
        let [x, y] = frame.pixel(*point);
        path += &format!("{}{x:.1} {y:.1}", if i == 0 { "M" } else { "L" });
    }
    let mut out = stroke(line, &path, colour);
    for [from, to, y] in &line.spans {
        let ([x0, y], [x1, _]) = (frame.pixel([*from, *y]), frame.pixel([*to, *y]));
        let hue = COLOURS[colour % COLOURS.len()];
        out += &format!("<path d=\"M{x0:.1} {y:.1}H{x1:.1}\" stroke=\"{hue}\"/>\n");
    }
    if line.marks {
        for point in &line.points {
            out += &mark(colour, frame.pixel(*point));
        }
    }
    out
}

fn stroke(line: &Line, path: &str, colour: usize) -> String {
    if line.guide {
        let (width, dash) = if line.dots {
            (2.0, "2 3")
        } else {
            (1.2, "5 4")
        };
        return format!(
            "<path d=\"{path}\" fill=\"none\" stroke=\"currentColor\" stroke-opacity=\"0.6\" \
             stroke-width=\"{width}\" stroke-dasharray=\"{dash}\"/>\n"
        );
    }
    let hue = COLOURS[colour % COLOURS.len()];
    let round = colour / COLOURS.len();
    let dash = if line.marks { round } else { colour + round };
    let dash = DASHES[dash % DASHES.len()];
    format!(
        "<path d=\"{path}\" fill=\"none\" stroke=\"{hue}\" stroke-width=\"2\" stroke-dasharray=\"{dash}\" \
         stroke-linejoin=\"round\"/>\n"
    )
}

fn mark(colour: usize, [x, y]: [f64; 2]) -> String {
    let hue = COLOURS[colour % COLOURS.len()];
    let path = match colour % 4 {
        0 => format!(
            "M{:.1} {y:.1}a4.2 4.2 0 1 0 8.4 0a4.2 4.2 0 1 0 -8.4 0z",
            x - 4.2
        ),
        1 => format!("M{:.1} {:.1}h7.6v7.6h-7.6z", x - 3.8, y - 3.8),
        2 => format!("M{x:.1} {:.1}l4.8 8.4h-9.6z", y - 5.4),
        _ => format!("M{x:.1} {:.1}l5 5l-5 5l-5 -5z", y - 5.0),
    };
    format!("<path d=\"{path}\" fill=\"{hue}\"/>\n")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_to_show_is_nothing() {
        let mut plot = Plot::new("x", "y").log_log();
        plot.add(Line::new(
            "a",
            vec![[0.0, 1.0], [1.0, f64::NAN], [-1.0, 2.0]],
        ));
        assert!(plot.is_empty() && plot.html().is_empty());
    }
}
