//! Figures over what is swept.

use super::points::{Parameter, Points};
use crate::csv::head;
use crate::html::{figure, side_by_side};
use crate::plot::{Line, Plot};

/// A curve needs as many points.
const LEAST: usize = 3;

/// A plot for each figure over each parameter that is a number; a line for each combination of the others.
pub(super) fn section(points: &Points, figures: &[Vec<Option<f64>>]) -> String {
    let mut plots = Vec::new();
    for (p, parameter) in points.parameters.iter().enumerate() {
        for (f, wanted) in points.figures.iter().enumerate() {
            let axes = [
                head(&parameter.words(), &parameter.unit),
                head(&wanted.name, &wanted.unit),
            ];
            let mut plot = Plot::new(&axes[0], &axes[1]);
            for (name, line) in lines(points, figures, p, f) {
                if line.len() >= LEAST {
                    plot.add(Line::new(&name, line).marked());
                }
            }
            if !plot.is_empty() {
                let caption = format!("{} over {}.", wanted.name, parameter.words());
                plots.push(figure(&plot.html(), &caption));
            }
        }
    }
    side_by_side(&plots)
}

/// Points of a figure over a parameter, in its order, by the values of the others. What goes with the parameter is no other.
fn lines(
    points: &Points,
    figures: &[Vec<Option<f64>>],
    parameter: usize,
    figure: usize,
) -> Vec<(String, Vec<[f64; 2]>)> {
    let others = others(points, parameter);
    let mut all: Vec<(String, Vec<[f64; 2]>)> = Vec::new();
    for (point, found) in points.points.iter().zip(figures) {
        let number = point.values.get(parameter).and_then(|v| v.number);
        let (Some(x), Some(Some(y))) = (number, found.get(figure)) else {
            continue;
        };
        let words = |o: &usize| {
            let other: &Parameter = &points.parameters[*o];
            head(&format!("{} {}", other.words(), point.values[*o].name), "1")
        };
        let name = others.iter().map(words).collect::<Vec<_>>().join(", ");
        match all.iter_mut().find(|(known, _)| *known == name) {
            Some((_, line)) => line.push([x, *y]),
            None => all.push((name, vec![[x, *y]])),
        }
    }
    for (_, line) in &mut all {
        line.sort_by(|a, b| a[0].total_cmp(&b[0]));
    }
    all
}

/// Parameters that differ while this one does not.
fn others(points: &Points, parameter: usize) -> Vec<usize> {
    let differs = |o: &usize| {
        points.points.iter().any(|a| {
            let same = |b: &&super::Point| a.values[parameter].name == b.values[parameter].name;
            let mut alike = points.points.iter().filter(same);
            alike.any(|b| a.values[*o].name != b.values[*o].name)
        })
    };
    let all = (0..points.parameters.len()).filter(|o| *o != parameter);
    all.filter(differs).collect()
}
