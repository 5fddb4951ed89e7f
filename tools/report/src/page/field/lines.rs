//! Fields along lines, beside an exact solution where there is one.

use run::Failure;

use super::Run;
use crate::field::columns::{Columns, QUANTITIES, Quantity, prefixed};
use crate::field::lines;
use crate::html::{Rows, escape, figure, paragraph, side_by_side};
use crate::picture::field::symbol;
use crate::plot::{Line, Plot};
use crate::records::figure as digits;

/// A line of the scene, and what is known of the fields along it.
struct Along<'a> {
    name: String,
    found: Columns,
    exact: Option<&'a Columns>,
    /// Places \[m\].
    places: Vec<f64>,
}

/// The section; nothing without lines.
pub(super) fn section(run: &Run) -> Result<String, Failure> {
    let mut all = Vec::new();
    for (name, found) in lines(&run.reader, &run.points.scene)? {
        let places = places(&found);
        all.push(Along {
            exact: run.exact.as_ref().and_then(|e| e.line(&name)),
            name,
            found,
            places,
        });
    }
    if all.is_empty() {
        return Ok(String::new());
    }
    let heads = all.iter().map(|a| format!("#Along {}", a.name));
    let heads: Vec<String> = std::iter::once("Greatest error".to_owned())
        .chain(heads)
        .collect();
    let mut errors = Rows::new(&heads.iter().map(String::as_str).collect::<Vec<_>>());
    let mut out = String::new();
    for quantity in &QUANTITIES {
        out += &plots(run, &all, quantity, &mut errors);
    }
    let known = match &run.exact {
        Some(exact) => paragraph(&format!("The exact solution: {}.", exact.source)),
        None => String::new(),
    };
    Ok(known + &out + &errors.render())
}

/// Places along a line: its coordinate where it runs along an axis, the distance from its start where not.
fn places(found: &Columns) -> Vec<f64> {
    let changes = |name: &&str| {
        let values = found.get(name).unwrap_or_default();
        values.first() != values.last()
    };
    let moving: Vec<&str> = ["x_m", "y_m", "z_m"].into_iter().filter(changes).collect();
    let name = match moving.as_slice() {
        [one] => one,
        _ => "distance_m",
    };
    found.get(name).unwrap_or_default().to_vec()
}

/// The greatest size of a quantity along all lines, as it is exactly where that is known.
fn greatest(all: &[Along<'_>], quantity: &Quantity) -> f64 {
    let values = all
        .iter()
        .filter_map(|a| a.exact.unwrap_or(&a.found).values(quantity));
    values
        .flatten()
        .map(f64::abs)
        .filter(|v| v.is_finite())
        .fold(0.0, f64::max)
}

/// Units, and what the figures of a quantity have to be multiplied by for them.
struct Scales {
    /// Letter of the quantity, between bars where it is a size.
    letter: String,
    unit: (String, f64),
    length: (String, f64),
    /// Its greatest size along all lines.
    most: f64,
}

impl Scales {
    fn of(run: &Run, all: &[Along<'_>], quantity: &Quantity) -> Option<Self> {
        let unit = all.iter().find_map(|a| a.found.unit(quantity))?;
        let most = greatest(all, quantity);
        let places = all.iter().flat_map(|a| a.places.iter());
        let reach = places.map(|p| p.abs()).fold(0.0, f64::max);
        Some(Self {
            letter: match run.points.columns.is_size(quantity) {
                true => format!("|{}|", symbol(quantity)),
                false => quantity.title.to_owned(),
            },
            unit: prefixed(unit, most),
            length: prefixed("m", reach),
            most,
        })
    }

    fn curve(&self, along: &Along<'_>, values: &[f64], factor: f64) -> Vec<[f64; 2]> {
        let each = along.places.iter().zip(values);
        each.map(|(p, v)| [self.length.1 * p, factor * v]).collect()
    }

    fn plot(&self, title: &str) -> Plot {
        Plot::new(&format!("place along the line [{}]", self.length.0), title)
    }
}

fn plots(run: &Run, all: &[Along<'_>], quantity: &Quantity, errors: &mut Rows) -> String {
    let Some(scales) = Scales::of(run, all, quantity) else {
        return String::new();
    };
    let title = capital(quantity.title);
    let plot = values(all, quantity, &scales);
    let mut figures = vec![figure(&plot.html(), &format!("{title} along the lines."))];
    let (off, worst) = differences(all, quantity, &scales);
    if !off.is_empty() {
        errors.row(std::iter::once(escape(quantity.title)).chain(worst));
        let words = format!(
            "{title}: what it differs by from the exact one, over the greatest along all lines."
        );
        figures.push(figure(&off.html(), &words));
    }
    side_by_side(&figures)
}

/// A quantity along all lines, with dots where it is known exactly.
fn values(all: &[Along<'_>], quantity: &Quantity, scales: &Scales) -> Plot {
    let mut plot = scales.plot(&format!("{} [{}]", scales.letter, scales.unit.0));
    for along in all {
        if let Some(found) = along.found.values(quantity) {
            let points = scales.curve(along, &found, scales.unit.1);
            plot.add(Line::new(&along.name, points));
        }
    }
    let mut name = "exact";
    for along in all {
        if let Some(values) = along.exact.and_then(|e| e.values(quantity)) {
            let points = scales.curve(along, &values, scales.unit.1);
            plot.add(Line::new(name, points).dotted());
            name = "";
        }
    }
    plot
}

/// What a quantity differs by from the exact one, and the most of it along each line.
fn differences(all: &[Along<'_>], quantity: &Quantity, scales: &Scales) -> (Plot, Vec<String>) {
    let title = format!("error of {} / greatest", scales.letter);
    let mut plot = scales.plot(&title).log_y();
    let mut worst = Vec::new();
    for along in all {
        let known = along
            .exact
            .and_then(|e| along.found.difference(e, quantity));
        let Some(difference) = known else {
            worst.push(String::new());
            continue;
        };
        let points = scales.curve(along, &difference, 1.0 / scales.most);
        plot.add(Line::new(&along.name, points));
        let far = difference.iter().copied().fold(0.0, f64::max);
        worst.push(format!("{} %", digits(100.0 * far / scales.most)));
    }
    (plot, worst)
}

/// With a large first letter.
fn capital(text: &str) -> String {
    let mut letters = text.chars();
    let first = letters.next().map(|c| c.to_uppercase().to_string());
    first.unwrap_or_default() + letters.as_str()
}
