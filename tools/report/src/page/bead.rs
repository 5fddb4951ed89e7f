//! The bead: pictures, measures, and how they change along the weld.

use artefact::Reader;
use run::Failure;

use super::{encoding, grouped, tiles};
use crate::html::{FRAME_WIDTH, chosen, figure, frames, note, picture, side_by_side};
use crate::picture::bead::{self, Paint, View};
use crate::picture::cross::{self, Published};
use crate::plot::{Line, Plot};
use crate::weld::{PARTICLES, Stretch, Weld};

/// A weld of fewer frames has no course to show.
const LEAST: usize = 5;

/// The section; nothing without particles.
pub(super) fn section(
    reader: &Reader,
    weld: &Weld,
    stretch: Option<&Stretch>,
    published: Published,
) -> Result<String, Failure> {
    let mut body = String::new();
    if let Some(stretch) = stretch {
        body += &tiles(&facts(weld, stretch));
        if !stretch.frozen {
            body += &note(&format!(
                "Nothing of this weld has frozen beyond its run-in yet: the measures are the greatest \
                 ones {:.2} s into the weld, not those of a finished bead.",
                weld.time
            ));
        }
    }
    if weld.mirror.is_some() {
        body += &note(
            "Half of this weld was computed, beside its mirror plane. It is shown and measured whole.",
        );
    }
    body += &weld.strayed().map(|told| note(&told)).unwrap_or_default();
    if weld.lost > 0 {
        body += &note(&format!(
            "{} particles have left the plate over its edges; they are neither shown nor measured.",
            grouped(weld.lost)
        ));
    }
    let course = course(reader)?;
    let mut all: Vec<&Weld> = course.iter().collect();
    all.push(weld);
    let paint = Paint::of(&all);
    body += &views(weld, &paint)?;
    if let Some(stretch) = stretch {
        body += &sections(weld, &paint, stretch, published)?;
        body += &along(weld, stretch);
    }
    body += &growth(&course, weld, &paint)?;
    Ok(body)
}

/// The weld at moments from its first frame to its last.
fn course(reader: &Reader) -> Result<Vec<Weld>, Failure> {
    let count = reader.count(PARTICLES);
    if count < LEAST {
        return Ok(Vec::new());
    }
    let moments = chosen(count).into_iter();
    Ok(moments
        .map(|m| Weld::read(reader, m))
        .collect::<Result<_, _>>()?)
}

fn facts(weld: &Weld, stretch: &Stretch) -> Vec<(String, String)> {
    let depth = match stretch.through() {
        true => "penetration below the original surface: the plate is fused through",
        false => "penetration below the original surface",
    };
    let mut facts = Vec::new();
    for (name, words) in [
        ("penetration", depth),
        ("fused_width", "greatest width fused below the surface"),
        ("reinforcement", "height above the surface"),
        ("bead_width", "width of the bead above the surface"),
    ] {
        if let Some(measure) = stretch.get(name) {
            let [low, high] = measure.range.map(|v| 1e3 * v);
            let range = if stretch.frozen {
                format!("{words}; {low:.1} to {high:.1} mm along the weld")
            } else {
                format!("{words}, so far")
            };
            facts.push((format!("{:.1} mm", 1e3 * measure.value), range));
        }
    }
    if let Some(measure) = stretch.get("dilution").filter(|_| stretch.frozen) {
        let words = "dilution: fused plate in the whole bead".to_owned();
        facts.push((format!("{:.0} %", 100.0 * measure.value), words));
    }
    let liquid = weld.liquid.iter().filter(|l| **l).count();
    facts.push((format!("{:.2} s", weld.time), "of welding shown".to_owned()));
    facts.push((
        grouped(weld.position.len()),
        format!(
            "particles of {:.2} mm, {} of them liquid now",
            1e3 * weld.plate.spacing_m,
            grouped(liquid)
        ),
    ));
    facts
}

fn views(weld: &Weld, paint: &Paint) -> Result<String, Failure> {
    let mut out = String::new();
    let captions = [
        (
            View::Above,
            "The weld from above. Yellow is the hottest liquid, dark red the coolest; blue-grey metal \
             was liquid and has frozen, grey metal never melted.",
        ),
        (
            View::Side,
            "The weld from the side: how high the bead stands above the plate. Drops on their way and spatter are shown but not measured.",
        ),
    ];
    for (view, caption) in captions {
        if let Some(canvas) = bead::picture(weld, paint, view) {
            let image = picture(&canvas, caption).map_err(|e| encoding(&e))?;
            out += &figure(&image, &format!("{caption} Time {:.2} s.", weld.time));
        }
    }
    Ok(out)
}

fn sections(
    weld: &Weld,
    paint: &Paint,
    stretch: &Stretch,
    published: Published,
) -> Result<String, Failure> {
    let mut out = String::new();
    if let Some(place) = stretch.place() {
        let (section, measures) = weld.section(place);
        if let Some(canvas) = cross::across(weld, &section, &measures, published) {
            let state = if stretch.frozen {
                "in the middle of the frozen stretch"
            } else {
                "where the weld is deepest so far; not all of it has frozen"
            };
            let caption = format!(
                "Section across the weld at {} mm, {state}. The green line encloses all metal that \
                 has ever been liquid; arrows measure it from the dashed original surface.{}",
                weld.placed(&format!("{:.1}", 1e3 * place)),
                if published == Published::default() {
                    ""
                } else {
                    " Red lines are what was measured."
                }
            )
            .replace("= -", "= \u{2212}");
            let image = picture(&canvas, &caption).map_err(|e| encoding(&e))?;
            out += &figure(&image, &caption);
        }
    }
    if let Some(canvas) = cross::along(weld, paint) {
        let caption = "Section along the centre of the weld: the pool under the arc, its tail, the bead \
                       behind it, and the green fusion line below.";
        let image = picture(&canvas, caption).map_err(|e| encoding(&e))?;
        out += &figure(&image, caption);
    }
    Ok(out)
}

/// The measures over the place along the weld.
fn along(weld: &Weld, stretch: &Stretch) -> String {
    if stretch.beads.len() < 3 {
        return String::new();
    }
    let place = weld.titled("place along the weld", "y");
    let line = |name: &str, value: fn(&crate::measure::bead::Bead) -> f64| {
        let points = stretch
            .beads
            .iter()
            .map(|(y, bead)| [1e3 * y, 1e3 * value(bead)]);
        Line::new(name, points.collect())
    };
    let mut depth = Plot::new(&place, "depth and height [mm]").through(0.0);
    depth.add(line("penetration", |b| b.penetration));
    depth.add(line("height of the bead", |b| b.reinforcement));
    let mut width = Plot::new(&place, "width [mm]").through(0.0);
    width.add(line("fused below the surface", |b| b.fused_width));
    width.add(line("bead above the surface", |b| b.bead_width));
    let what = if stretch.frozen {
        format!(
            "over the {:.0} mm of frozen weld that the measures above are medians of",
            1e3 * stretch.length()
        )
    } else {
        "over all that has melted so far".to_owned()
    };
    side_by_side(&[
        figure(
            &depth.html(),
            &format!("Penetration and height {what}. Level lines mean a steady weld."),
        ),
        figure(&width.html(), &format!("Widths {what}.")),
    ])
}

/// How the bead came to be: from above, with what the last frame shows.
fn growth(course: &[Weld], last: &Weld, paint: &Paint) -> Result<String, Failure> {
    let Some(seen) = bead::seen(last, paint, View::Above) else {
        return Ok(String::new());
    };
    let moment = |weld: &Weld| {
        let canvas = bead::within(weld, paint, View::Above, seen)?;
        Some((format!("{:.3} s", weld.time), canvas.smaller(FRAME_WIDTH)))
    };
    let moments: Vec<_> = course.iter().filter_map(moment).collect();
    if moments.is_empty() {
        return Ok(String::new());
    }
    let all = frames(&moments, "The weld from above at").map_err(|e| encoding(&e))?;
    Ok(format!("<h3>How the bead came to be</h3>\n{all}"))
}
