//! The cut, forces and energies over time.

use ::run::Failure;

use super::run::Run;
use crate::html::{figure, side_by_side};
use crate::plot::{Line, Plot};

/// Depth and width of the cuts, and what is left in one piece.
pub(super) fn cut(runs: &[Run]) -> Result<String, Failure> {
    let mut depth = Plot::new("time [ms]", "depth [mm]");
    let mut width = Plot::new("time [ms]", "width [mm]");
    let mut pieces = Plot::new("time [ms]", "largest piece [1]");
    for run in runs {
        let course = run.cut()?;
        let of = |k: usize| {
            course
                .iter()
                .map(|(t, cut)| [1e3 * t, cut[k]])
                .collect::<Vec<_>>()
        };
        depth.add(Line::new(&run.name, of(0)));
        width.add(Line::new(&run.name, of(1)));
        for (name, points) in named(run, |name| name.ends_with("_largest_piece"))? {
            pieces.add(Line::new(
                &format!("{}: {}", run.name, name.replace("_largest_piece", "")),
                points,
            ));
        }
    }
    let figures = [
        (
            depth,
            "From the upper face of the solid to the lowest broken particle, by places at the start.",
        ),
        (width, "From the leftmost to the rightmost broken particle."),
        (
            pieces,
            "Part of the solid that the largest piece holds: parted where it falls to a half.",
        ),
    ];
    Ok(shown(figures))
}

/// Forces on walls and solids.
pub(super) fn forces(runs: &[Run]) -> Result<String, Failure> {
    let mut plot = Plot::new("time [ms]", "force [N]");
    for run in runs {
        for (name, points) in named(run, |name| name.contains("force_on_"))? {
            if points.iter().any(|p| p[1].abs() > 0.0) {
                plot.add(Line::new(
                    &format!("{}: {}", run.name, name.replace('_', " ")),
                    points,
                ));
            }
        }
    }
    Ok(shown([(
        plot,
        "Forces on solids and walls; in a plane scene per metre of depth.",
    )]))
}

/// Energies.
pub(super) fn energies(runs: &[Run]) -> Result<String, Failure> {
    let mut body = String::new();
    for run in runs {
        let mut plot = Plot::new("time [ms]", "energy [J]");
        let wanted = [
            "kinetic_energy_j",
            "stored_energy_j",
            "work_j",
            "spent_energy_j",
        ];
        let is_wanted = |name: &str| wanted.contains(&name) || name.ends_with("_fracture_energy");
        for (name, points) in named(run, is_wanted)? {
            plot.add(Line::new(
                &name.trim_end_matches("_j").replace('_', " "),
                points,
            ));
        }
        let caption = format!(
            "{}: motion, what water and solid store, what came in, what friction and fracture have taken.",
            run.name
        );
        body += &shown([(plot, caption.as_str())]);
    }
    Ok(body)
}

/// Names and points of curves.
type Courses = Vec<(String, Vec<[f64; 2]>)>;

/// Courses of the balances whose name is wanted.
fn named(run: &Run, wanted: impl Fn(&str) -> bool) -> Result<Courses, Failure> {
    let balances = run.balances()?;
    let names = balances
        .first()
        .into_iter()
        .flat_map(|(_, record)| &record.values);
    let names: Vec<String> = names
        .map(|entry| entry.name.clone())
        .filter(|name| wanted(name))
        .collect();
    let course = |name: String| {
        let at = |(t, record): &(f64, artefact::Record)| Some([1e3 * t, record.get(&name).ok()?]);
        let points = balances.iter().filter_map(at).collect();
        (name, points)
    };
    Ok(names.into_iter().map(course).collect())
}

fn shown<const N: usize>(plots: [(Plot, &str); N]) -> String {
    let filled = plots.iter().filter(|(plot, _)| !plot.is_empty());
    let figures: Vec<String> = filled
        .map(|(plot, caption)| figure(&plot.html(), caption))
        .collect();
    side_by_side(&figures)
}
