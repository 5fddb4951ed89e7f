//! Heat through the surface, entry by entry, and the balance of heat.

use run::Failure;

use super::Run;
use super::curves::{Series, curve, series};
use crate::html::{Rows, escape, figure, side_by_side};
use crate::plot::{Line, Plot};
use crate::records::figure as digits;

/// Ending of the names of heat rates.
const RATE: &str = ".heat_rate";
/// Most curves that runs share a plot for.
const MOST: usize = 7;
const RAISED: [char; 10] = [
    '\u{2070}', '\u{b9}', '\u{b2}', '\u{b3}', '\u{2074}', '\u{2075}', '\u{2076}', '\u{2077}',
    '\u{2078}', '\u{2079}',
];

/// Names of the entries of a surface.
fn entries(series: &Series) -> Vec<String> {
    let Some((_, first)) = series.first() else {
        return Vec::new();
    };
    let names = first.values.iter().map(|e| e.name.as_str());
    names
        .filter_map(|n| n.strip_suffix(RATE).map(str::to_owned))
        .collect()
}

/// Unit of a value.
fn unit(series: &Series, name: &str) -> String {
    let found = series
        .first()
        .and_then(|(_, r)| r.values.iter().find(|e| e.name == name));
    found.map_or_else(String::new, |e| e.unit.clone())
}

/// Curves of one plot: the name of each, and its entry in the records of its run.
type Curves<'a> = Vec<(String, &'a Series, String)>;

/// The heat through every entry of the surface; nothing for insulated bodies.
pub(super) fn section(runs: &[Run]) -> Result<String, Failure> {
    let mut table = Rows::new(&[
        "Run",
        "Part of the surface",
        "#Area",
        "Unit",
        "#Heat rate at the end",
        "Unit",
        "#Heat since the start",
        "Unit",
        "#Mean temperature [K]",
    ]);
    let all: Vec<Series> = runs
        .iter()
        .map(|run| series(run, "/boundaries"))
        .collect::<Result<_, _>>()?;
    let mut together: Curves<'_> = Vec::new();
    let mut apart = String::new();
    for (run, series) in runs.iter().zip(&all) {
        let names = entries(series);
        for name in &names {
            rows(&mut table, run, series, name);
        }
        if series.len() > 1 && !names.is_empty() {
            let own = names.iter().map(|n| (n.clone(), series, n.clone()));
            apart += &(run.heading(runs) + &plots(&own.collect()));
            together.extend(names.iter().map(|n| (run.own(runs, n), series, n.clone())));
        }
    }
    let kinds = |c: &(String, &Series, String)| unit(c.1, &format!("{}{RATE}", c.2));
    let alike = together
        .windows(2)
        .all(|pair| kinds(&pair[0]) == kinds(&pair[1]));
    if !together.is_empty() && together.len() <= MOST && alike {
        apart = plots(&together);
    }
    Ok(table.render() + &apart)
}

fn plots(curves: &Curves<'_>) -> String {
    side_by_side(&[
        plot(curves, "heat_rate", "heat rate", "Heat into the body"),
        plot(
            curves,
            "heat",
            "heat",
            "Heat that came into the body since the start",
        ),
        plot(
            curves,
            "temperature",
            "temperature",
            "Mean temperature of the surface",
        ),
    ])
}

fn rows(table: &mut Rows, run: &Run, series: &Series, entry: &str) {
    let Some((_, last)) = series.last() else {
        return;
    };
    let of = |what: &str| {
        let name = format!("{entry}.{what}");
        let unit = unit(series, &name);
        match last.get(&name) {
            Ok(v) if unit == "m2" && v < 0.01 => (digits(1e4 * v), "cm2".to_owned()),
            Ok(v) => (digits(v), escape(&unit)),
            Err(_) => ("\u{2013}".to_owned(), String::new()),
        }
    };
    let (area, rate, heat) = (of("area"), of("heat_rate"), of("heat"));
    table.row([
        escape(&run.name),
        escape(entry),
        area.0,
        area.1,
        rate.0,
        rate.1,
        heat.0,
        heat.1,
        of("temperature").0,
    ]);
}

/// A quantity over time.
fn plot(curves: &Curves<'_>, what: &str, title: &str, words: &str) -> String {
    let Some((_, first, entry)) = curves.first() else {
        return String::new();
    };
    let all: Vec<(&String, Vec<[f64; 2]>)> = curves
        .iter()
        .map(|(name, series, entry)| (name, curve(series, &format!("{entry}.{what}"))))
        .collect();
    let unit = unit(first, &format!("{entry}.{what}"));
    let (unit, factor) = match what {
        "temperature" => (unit, 1.0),
        _ => short(&unit, all.iter().flat_map(|c| &c.1)),
    };
    let mut plot = Plot::new("time [s]", &format!("{title} [{unit}]"));
    if what != "temperature" {
        plot = plot.through(0.0);
    }
    for (name, points) in &all {
        plot.add(Line::new(name, scaled(points, factor)));
    }
    figure(&plot.html(), &format!("{words}, by part of the surface."))
}

/// The unit with a prefix that keeps numbers short, and the factor to it.
fn short<'a>(unit: &str, points: impl Iterator<Item = &'a [f64; 2]>) -> (String, f64) {
    let most = points.fold(0.0_f64, |m, p| m.max(p[1].abs()));
    match most {
        m if m >= 1e7 => (format!("M{unit}"), 1e-6),
        m if m >= 1e4 => (format!("k{unit}"), 1e-3),
        _ => (unit.to_owned(), 1.0),
    }
}

fn scaled(points: &[[f64; 2]], factor: f64) -> Vec<[f64; 2]> {
    points.iter().map(|[t, v]| [*t, factor * v]).collect()
}

/// Balances over time: what is stored, what came through the surface and from sources.
pub(super) fn balance(runs: &[Run]) -> Result<String, Failure> {
    let mut figures = Vec::new();
    let mut errors: Vec<(String, Vec<[f64; 2]>)> = Vec::new();
    for run in runs {
        let series = series(run, "/balance")?;
        let moved = moved(&series);
        if series.len() < 2 || moved <= 0.0 {
            continue;
        }
        let stored = curve(&series, "stored");
        let (unit, factor) = short(&unit(&series, "stored"), stored.iter());
        let mut plot = Plot::new("time [s]", &format!("heat [{unit}]")).through(0.0);
        plot.add(Line::new("stored", scaled(&stored, factor)));
        for (name, label) in [("boundaries", "through the surface"), ("source", "source")] {
            plot.add(Line::new(label, scaled(&curve(&series, name), factor)).guide());
        }
        let words = if curve(&series, "source").is_empty() {
            "heat stored since the start, and what came in. They must be one."
        } else {
            "heat stored since the start, and what came in; stored must be the sum of the others."
        };
        let caption = run.own(runs, words);
        figures.push(figure(&plot.html(), &sentence(&caption)));
        let parts = curve(&series, "imbalance");
        errors.push((run.own(runs, ""), scaled(&parts, 1.0 / moved)));
    }
    if let Some(plot) = imbalance(&errors) {
        figures.push(plot);
    }
    Ok(side_by_side(&figures))
}

/// The first letter large.
fn sentence(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map_or_else(String::new, |first| {
        first.to_uppercase().chain(letters).collect()
    })
}

/// The most heat that was stored, passed the surface or came from a source by any time.
fn moved(series: &Series) -> f64 {
    let each = ["stored", "boundaries", "source"]
        .iter()
        .flat_map(|n| curve(series, n));
    each.map(|[_, v]| v.abs()).fold(0.0, f64::max)
}

/// The imbalance as part of the heat moved, in a power of ten that leaves plain numbers.
fn imbalance(errors: &[(String, Vec<[f64; 2]>)]) -> Option<String> {
    let values = errors.iter().flat_map(|e| e.1.iter().map(|p| p[1].abs()));
    let most = values.fold(0.0, f64::max);
    if errors.is_empty() {
        return None;
    }
    let power = if most > 0.0 {
        (most.log10().floor() as i32).min(0)
    } else {
        0
    };
    let title = match power {
        0 => "relative imbalance".to_owned(),
        _ => format!("relative imbalance [{}]", ten_to(power)),
    };
    let mut plot = Plot::new("time [s]", &title).through(0.0);
    for (name, points) in errors {
        let factor = 10.0_f64.powi(-power);
        plot.add(Line::new(name, scaled(points, factor)));
    }
    Some(figure(
        &plot.html(),
        "What is stored less what came in, as part of the most heat that the run has moved. Zero is perfect.",
    ))
}

/// A power of ten in raised digits.
fn ten_to(power: i32) -> String {
    let raised = |letter: char| match letter.to_digit(10) {
        Some(digit) => RAISED[digit as usize],
        None => '\u{207b}',
    };
    let power: String = power.to_string().chars().map(raised).collect();
    format!("10{power}")
}

#[cfg(test)]
mod tests {
    use super::*;
    use artefact::Record;

    #[test]
    fn powers_of_ten_are_raised() {
        assert_eq!(ten_to(-12), "10\u{207b}\u{b9}\u{b2}");
    }

    #[test]
    fn long_numbers_get_a_prefix() {
        let of = |v: f64| short("J/m", [[0.0, 0.0], [1.0, v]].iter());
        assert_eq!(of(-1500.0), ("J/m".to_owned(), 1.0));
        assert_eq!(of(-127_000.0), ("kJ/m".to_owned(), 1e-3));
        assert_eq!(of(2e8), ("MJ/m".to_owned(), 1e-6));
    }

    #[test]
    fn an_imbalance_is_a_part_of_the_most_heat_moved() {
        let record = |stored: f64, surface: f64| {
            Record::new()
                .with("stored", "J", stored)
                .with("boundaries", "J", surface)
        };
        let series = vec![
            (0.0, record(0.0, 0.0)),
            (1.0, record(-4.0, -5.0)),
            (2.0, record(1.0, 2.0)),
        ];
        assert!((moved(&series) - 5.0).abs() < 1e-12);
        let plot = imbalance(&[("a".to_owned(), vec![[0.0, 0.0], [1.0, -3e-8]])]).unwrap();
        assert!(
            plot.contains("relative imbalance [10\u{207b}\u{2078}]"),
            "{plot}"
        );
        assert!(imbalance(&[]).is_none());
    }

    #[test]
    fn entries_are_what_has_a_heat_rate() {
        let record = Record::new()
            .with("top side.area", "m2", 1.0)
            .with("top side.heat_rate", "W", 2.0)
            .with("rim.heat_rate", "W", 2.0);
        let series = vec![(0.0, record)];
        assert_eq!(entries(&series), ["top side", "rim"]);
        assert_eq!(unit(&series, "top side.area"), "m2");
    }
}
