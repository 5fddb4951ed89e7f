//! The temperature in the body at the last frame.

use run::Failure;

use super::Run;
use crate::draw::axes::number;
use crate::heat::Range;
use crate::heat::field::{Cut, Field};
use crate::html::{Rows, escape, figure, picture};
use crate::page::{Named, encoding, grouped};
use crate::picture::heat::{Shown, picture as draw};

/// The section.
pub(super) fn section(runs: &[Run], records: &[Named]) -> Result<String, Failure> {
    let mut out = table(runs, records);
    for run in runs {
        let Some(points) = &run.points else { continue };
        let Some(field) = Field::of(points) else {
            continue;
        };
        if let Some(shown) = draw(points, &field) {
            let when = if run.steady() {
                "in the steady state".to_owned()
            } else {
                format!("at {} s", number(points.time))
            };
            let caption = caption(&when, &field, &shown);
            let image = picture(&shown.canvas, &caption).map_err(|e| encoding(&e))?;
            out += &run.heading(runs);
            out += &figure(&image, &caption);
        }
    }
    Ok(out)
}

/// Temperatures with as many digits as tell them apart.
pub(super) fn kelvin(value: f64, range: Range) -> String {
    let spread = (range.greatest - range.least)
        .max(1e-3 * range.greatest.abs())
        .max(1e-9);
    let digits = (2.0 - spread.log10().floor()).clamp(0.0, 5.0) as usize;
    format!("{value:.digits$}").replace('-', "\u{2212}")
}

fn table(runs: &[Run], records: &[Named]) -> String {
    let mut table = Rows::new(&[
        "Run",
        "#Points",
        "#Steps",
        "#Time [s]",
        "#Coldest [K]",
        "#Mean [K]",
        "#Hottest [K]",
        "#Difference [K]",
    ]);
    for run in runs {
        let Some(points) = &run.points else { continue };
        let range = points.range();
        let record = records.iter().find(|r| r.0 == run.name);
        table.row([
            escape(&run.name),
            grouped(points.position.len()),
            record.map_or_else(|| "\u{2013}".to_owned(), |r| grouped(r.1.steps as usize)),
            if run.steady() {
                "steady".to_owned()
            } else {
                number(points.time)
            },
            kelvin(range.least, range),
            kelvin(range.mean, range),
            kelvin(range.greatest, range),
            kelvin(range.greatest - range.least, range),
        ]);
    }
    table.render()
}

fn caption(when: &str, field: &Field, shown: &Shown) -> String {
    let name = |axis: usize| ["x", "y", "z"][axis];
    let place = match field.cut {
        Cut::Plane => "in the plane of the body".to_owned(),
        Cut::Half(axis) => format!(
            "in half a section through the axis of the body, which lies along {}",
            name(axis)
        ),
        Cut::Middle(axis) => format!(
            "in a section through the middle of the body, at {} = {} mm",
            name(axis),
            number((1e6 * field.depth).round() * 1e-3)
        ),
    };
    let mut text = format!(
        "The temperature {when} {place}. The colours run from the coldest to the hottest point of the body."
    );
    if let Some(step) = shown.step {
        text += &format!(" Isotherms every {} K.", number(step));
    }
    if shown.layers {
        text += " Dashed: where one material meets another.";
    }
    if shown.stretch > 1.0 {
        text += &format!(" Heights are stretched by {}.", number(shown.stretch));
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn temperatures_have_the_digits_that_tell_them_apart() {
        let range = |least, greatest| Range {
            least,
            mean: least,
            greatest,
        };
        assert_eq!(kelvin(1023.456, range(1000.0, 1023.456)), "1023.5");
        assert_eq!(kelvin(1023.456, range(300.0, 1023.456)), "1023");
        assert_eq!(kelvin(0.51234, range(0.0, 1.0)), "0.51");
        assert_eq!(kelvin(-2.0, range(-2.0, -2.0)), "\u{2212}2.00000");
    }
}
