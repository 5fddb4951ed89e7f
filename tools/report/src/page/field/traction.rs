//! The pull of an electric field on surfaces.

use run::Failure;

use super::Run;
use crate::field::columns::prefixed;
use crate::html::{figure, side_by_side};
use crate::plot::{Line, Plot};

/// The section; nothing where no surface is pulled.
pub(super) fn section(run: &Run) -> Result<String, Failure> {
    let points = &run.points;
    let Some(tractions) = points.surface.joined("traction") else {
        return Ok(String::new());
    };
    // Along the normal; of the surface points of each body.
    let mut bodies: Vec<(u8, Vec<[f64; 2]>)> = Vec::new();
    for (meeting, t) in points.meetings.iter().zip(&tractions) {
        let pull: f64 = (0..3).map(|k| t[k] * meeting.normal[k]).sum();
        let place = points.position[meeting.point];
        let height = place[points.scene.upward()];
        match bodies.iter_mut().find(|(m, _)| *m == meeting.media[0]) {
            Some((_, all)) => all.push([height, pull]),
            None => bodies.push((meeting.media[0], vec![[height, pull]])),
        }
    }
    let exact = run.exact.as_ref().and_then(|e| e.line("surface"));
    let exact: Vec<[f64; 2]> = match exact.map(|e| (e.get("z_m"), e.get("traction"))) {
        Some((Some(z), Some(t))) => z.iter().zip(t).map(|(z, t)| [*z, *t]).collect(),
        _ => Vec::new(),
    };
    let all = || bodies.iter().flat_map(|b| &b.1);
    let most = |k: usize| all().map(|p| p[k].abs()).fold(0.0, f64::max);
    let ((length, scale), (unit, factor)) = (prefixed("m", most(0)), prefixed("Pa", most(1)));
    let axis = ["x", "y", "z"][points.scene.upward()];
    let mut plot = Plot::new(&format!("{axis} [{length}]"), &format!("traction [{unit}]"));
    let scaled = |p: &[f64; 2]| [scale * p[0], factor * p[1]];
    for (medium, mut own) in bodies.clone() {
        own.sort_by(|a, b| a[0].total_cmp(&b[0]));
        let name = points.scene.name(medium);
        plot.add(Line::new(name, own.iter().map(scaled).collect()));
    }
    plot.add(Line::new("exact", exact.iter().map(scaled).collect()).dotted());
    let words = format!(
        "Pull along the outward normal at every point of the surface, over its {axis}: all around at once."
    );
    Ok(side_by_side(&[figure(&plot.html(), &words)]))
}
