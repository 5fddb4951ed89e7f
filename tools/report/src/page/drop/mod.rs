//! The page of a study of drops: their motion, radii, modes and energies over time, and shapes at rest.

mod groups;

use std::f64::consts::PI;

use artefact::{Reader, Record};
use run::Failure;

use super::{Named, certificate, errors, lead, runs};
use crate::field::columns::prefixed;
use crate::files::{DropFiles, save};
use crate::html::{Page, Rows, figure, paragraph, side_by_side};
use crate::plot::{Line, Plot};
use crate::records::RunRecord;

/// Channel of the rows of a drop.
const ROWS: &str = "/liquid";
/// Vertices of the outline in a picture.
const VERTICES: usize = 72;
/// Points this far from a ray, as a cosine, tell its radius.
const NEAR: f64 = 0.96;
/// Edge of a moving picture, and what of it the drop takes.
const EDGE: f64 = 320.0;
const SHARE: f64 = 0.36;
/// How long a moving picture runs \[s\].
const RUNS: f64 = 4.0;
/// A drop whose radii differ by less than this is drawn with its differences enlarged to it.
const VISIBLE: f64 = 0.15;

/// A run of the study.
struct Run {
    name: String,
    reader: Reader,
    rows: Vec<(f64, Record)>,
}

/// Writes the page.
pub(crate) fn write(files: &DropFiles) -> Result<(), Failure> {
    let mut all = Vec::new();
    let mut records: Vec<Named> = Vec::new();
    for (name, path) in &files.drops {
        let reader = Reader::open_kind(path, "point-fields", 1)?;
        all.push(Run {
            name: name.clone(),
            rows: reader.records(ROWS)?,
            reader,
        });
        if let Some(record) = RunRecord::beside(path) {
            records.push((name.clone(), record));
        }
    }
    let mut page = Page::new(&files.study, &lead(&records));
    page.section("The drop in motion", motion(&all)?);
    page.section("At the end", ends(&all));
    page.section("Radii, modes and energies", curves(&all));
    page.section("Shapes at rest", outlines(&all)?);
    let certificate = certificate(files.certificate.as_deref())?;
    page.section("Numerical error", errors(certificate.as_ref(), &records));
    page.section("How it was computed", runs::section(&records));
    save(&files.out, &page.render())
}

impl Run {
    /// A column over time; nothing where it is missing or there is no time.
    fn column(&self, name: &str) -> Vec<[f64; 2]> {
        let moves = self.rows.len() > 1;
        let each = self.rows.iter().filter(|_| moves);
        each.filter_map(|(t, r)| Some([*t, r.get(name).ok()?]))
            .collect()
    }
}

/// Numbers of the last row of each run.
fn ends(runs: &[Run]) -> String {
    let mut table = Rows::new(&["drop", "quantity", "#value", "unit"]);
    for run in runs {
        for value in run.rows.last().iter().flat_map(|(_, r)| &r.values) {
            let number = format!("{:.6e}", value.value);
            table.row([
                run.name.clone(),
                value.name.clone(),
                number,
                value.unit.clone(),
            ]);
        }
    }
    table.render()
}

fn curves(runs: &[Run]) -> String {
    let mut figures = Vec::new();
    for (title, names, unit) in [
        ("radii", &["radius_x", "radius_y", "radius_z"][..], "m"),
        ("lengths", &["extent_x", "extent_y", "extent_z"][..], "m"),
        ("drops", &["drops", "parcels"][..], "1"),
        ("modes", &["mode_2", "mode_3", "mode_4"][..], "m"),
        ("energies", &["kinetic_energy", "surface_energy"][..], "J"),
        ("height of the centre", &["centre_z"][..], "m"),
        (
            "force of the field",
            &["force_x", "force_y", "force_z"][..],
            "N",
        ),
        ("heat of the currents", &["power"][..], "W"),
    ] {
        for run in runs {
            let last = run.rows.last().map_or(0.0, |r| r.0);
            let (time, scale) = prefixed("s", last);
            let columns = names.iter().map(|n| (*n, run.column(n)));
            let columns: Vec<(&str, Vec<[f64; 2]>)> = columns.collect();
            let all = columns.iter().flat_map(|c| &c.1);
            let most = all.map(|p| p[1].abs()).fold(0.0, f64::max);
            let (own, factor) = prefixed(unit, most);
            let mut plot = Plot::new(&format!("time [{time}]"), &format!("{title} [{own}]"));
            for (name, points) in columns {
                let scaled = points.iter().map(|[t, v]| [scale * t, factor * v]);
                plot.add(Line::new(name, scaled.collect()));
            }
            if !plot.is_empty() {
                figures.push(figure(
                    &plot.html(),
                    &format!("{}: {title} over time.", run.name),
                ));
            }
        }
    }
    side_by_side(&figures)
}

/// Outlines of drops at rest.
fn outlines(runs: &[Run]) -> Result<String, Failure> {
    let mut plot = Plot::new("r [m]", "z [m]");
    for run in runs.iter().filter(|r| r.reader.has("/outline")) {
        let table = run.reader.table("/outline")?;
        let (r, z) = (table.values("r_m")?, table.values("z_m")?);
        let outline: Vec<[f64; 2]> = r.iter().zip(z).map(|(r, z)| [*r, *z]).collect();
        let on_wall = run
            .reader
            .header()
            .scene
            .pointer("/liquid/equilibrium/contact_angle_deg");
        plot.add(Line::new(&run.name, completed(&outline, on_wall.is_some())));
    }
    if plot.is_empty() {
        return Ok(String::new());
    }
    Ok(figure(
        &plot.html(),
        "Outlines of drops at rest, from the axis.",
    ))
}

/// The outline of a drop from its upper half; one on a wall, or one that goes below its middle, is whole as it is.
fn completed(outline: &[[f64; 2]], on_wall: bool) -> Vec<[f64; 2]> {
    let size = outline.iter().map(|p| p[1].abs()).fold(0.0, f64::max);
    let upper = outline.iter().rev().copied();
    if on_wall || outline.iter().any(|p| p[1] < -1e-9 * size) {
        return upper.collect();
    }
    upper.chain(outline.iter().map(|[r, z]| [*r, -z])).collect()
}

/// Moving pictures of the section along x and z.
fn motion(runs: &[Run]) -> Result<String, Failure> {
    let mut figures = Vec::new();
    for run in runs {
        if let Some(film) = groups::film(&run.name, &run.reader)? {
            figures.push(film);
            continue;
        }
        let count = run.reader.count("/surface");
        if count < 3 {
            continue;
        }
        let mut all = Vec::new();
        for index in 0..count {
            all.push(radii(
                &run.reader.frame("/surface", index)?.position_vectors()?,
            ));
        }
        let mean = all.iter().flatten().sum::<f64>() / (count * VERTICES) as f64;
        let spread = all
            .iter()
            .flatten()
            .map(|r| (r - mean).abs())
            .fold(0.0, f64::max)
            / mean;
        let enlarged = if spread > 0.0 && spread < VISIBLE {
            VISIBLE / spread
        } else {
            1.0
        };
        let words = format!(
            "{}: the section along x (across) and z (up), about its centre, {count} frames{}.",
            run.name,
            if enlarged > 1.0 {
                format!("; differences from the sphere are drawn {enlarged:.0} times as large")
            } else {
                String::new()
            }
        );
        figures.push(figure(&moving(&all, mean, enlarged), &words));
    }
    if figures.is_empty() {
        return Ok(paragraph("No run has frames of a motion."));
    }
    Ok(side_by_side(&figures))
}

/// Radii of the surface in the plane of x and z, from the middle of its points.
fn radii(points: &[[f64; 3]]) -> Vec<f64> {
    let middle = [0, 1, 2].map(|k| points.iter().map(|x| x[k]).sum::<f64>() / points.len() as f64);
    let rays: Vec<[f64; 3]> = points
        .iter()
        .map(|x| [0, 1, 2].map(|k| x[k] - middle[k]))
        .collect();
    let length = |x: &[f64; 3]| x.iter().map(|c| c * c).sum::<f64>().sqrt();
    (0..VERTICES)
        .map(|k| {
            let (sine, cosine) = (2.0 * PI * k as f64 / VERTICES as f64).sin_cos();
            let (mut sum, mut weight) = (0.0, 0.0);
            for ray in &rays {
                let r = length(ray);
                let along = (ray[0] * cosine + ray[2] * sine) / r;
                let w = (along - NEAR).max(1e-9);
                sum += w * r;
                weight += w;
            }
            sum / weight
        })
        .collect()
}

/// A polygon that changes from frame to frame.
fn moving(frames: &[Vec<f64>], mean: f64, enlarged: f64) -> String {
    let polygon = |radii: &Vec<f64>| {
        let vertices = radii.iter().enumerate().map(|(k, r)| {
            let (sine, cosine) = (2.0 * PI * k as f64 / VERTICES as f64).sin_cos();
            let r = EDGE * SHARE * (1.0 + enlarged * (r / mean - 1.0));
            format!(
                "{:.1},{:.1}",
                0.5 * EDGE + r * cosine,
                0.5 * EDGE - r * sine
            )
        });
        vertices.collect::<Vec<_>>().join(" ")
    };
    let all: Vec<String> = frames.iter().map(polygon).collect();
    format!(
        "<svg class=\"plot moving\" data-seconds=\"{RUNS}\" viewBox=\"0 0 {EDGE} {EDGE}\" role=\"img\" aria-label=\"a drop in motion\">\n\
         <circle cx=\"{0}\" cy=\"{0}\" r=\"{1}\" fill=\"none\" stroke=\"currentColor\" stroke-dasharray=\"4 4\"/>\n\
         <polygon points=\"{2}\" fill=\"#56b4e9\" fill-opacity=\"0.6\" stroke=\"#0072b2\" stroke-width=\"2\">\
         <animate attributeName=\"points\" dur=\"{RUNS}s\" repeatCount=\"indefinite\" values=\"{3}\"/></polygon>\n</svg>\n",
        0.5 * EDGE,
        EDGE * SHARE,
        all[0],
        all.join(";")
    )
}

#[cfg(test)]
mod tests {
    use super::completed;

    #[test]
    fn a_drop_on_a_wall_is_no_lens() {
        let half = [[1.0, 0.0], [0.7, 0.7], [0.0, 1.0]];
        assert_eq!(completed(&half, true), [[0.0, 1.0], [0.7, 0.7], [1.0, 0.0]]);
        let free = completed(&half, false);
        assert_eq!((free.len(), free[5]), (6, [0.0, -1.0]));
        let whole = [[0.0, -1.0], [1.0, 0.0], [0.0, 1.0]];
        assert_eq!(completed(&whole, false).len(), 3);
    }
}
