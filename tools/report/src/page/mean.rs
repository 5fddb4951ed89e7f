//! The averaged flow.

use artefact::{Reader, Table};
use run::Failure;
use serde_json::Value;

use super::encoding;
use crate::draw::axes::number;
use crate::flux::GRAINS;
use crate::html::{escape, figure, picture};
use crate::picture::heading::Heading;
use crate::picture::mean::{Field, Style, phases, single};
use crate::plot::{Line, Plot};

/// Channel and name of a section, in the order shown.
const SECTIONS: [(&str, &str); 3] = [
    ("/section_x0", "Along the weld, in its centre plane"),
    ("/section_y0", "Across the weld, under the arc"),
    ("/surface", "The surface, from above"),
];
/// Names of the axes, by which a table tells where its plane stands.
const AXES: [&str; 3] = ["x", "y", "z"];
/// Melting point assumed where the frames tell none \[K\].
const MELTING: f64 = 1750.0;

/// Behind the channel of a section, its mean over time.
const MEAN: &str = "/time_mean";

/// Whether the means are of grains and not of metal.
pub(super) fn of_grains(reader: &Reader) -> bool {
    reader.header().scene.get("channel").and_then(Value::as_str) == Some(GRAINS)
}

/// Channels and titles of the sections: those that all studies have, then the others.
fn sections(reader: &Reader) -> artefact::Result<Vec<(String, String)>> {
    let mut all = Vec::new();
    for (channel, title) in SECTIONS {
        let means = format!("{channel}{MEAN}");
        let mut title = title.to_owned();
        if reader.has(&means) && !Heading::of(&reader.table(&means)?).is_along_y() {
            title = stands(&reader.table(&means)?).unwrap_or(title);
        }
        all.push((channel.to_owned(), title));
    }
    for found in reader.channels() {
        let channel = found.name.strip_suffix(MEAN);
        let new = channel.filter(|name| all.iter().all(|(known, _)| known != name));
        let Some(channel) = new else { continue };
        let table = reader.table(&found.name)?;
        if table.has("frames_metal") {
            let title = stands(&table).unwrap_or_else(|| channel.to_owned());
            all.push((channel.to_owned(), title));
        }
    }
    Ok(all)
}

/// Where the plane of a section stands.
fn stands(table: &Table) -> Option<String> {
    AXES.iter().find_map(|axis| {
        let at = table.scalar(&format!("{axis}_m")).ok()?;
        Some(format!("The plane {axis} = {} mm", number(1e3 * at)))
    })
}

/// The section; nothing where no liquid was averaged.
pub(super) fn section(reader: &Reader, melting: Option<f64>) -> Result<String, Failure> {
    let mut out = String::new();
    let mut speeds = Plot::new("phase of the droplet period", "mean speed [m/s]").through(0.0);
    let grains = of_grains(reader);
    for (channel, title) in sections(reader)? {
        let time = Field::all(reader, &format!("{channel}{MEAN}"))?;
        let cycle = Field::all(reader, &channel)?;
        let mut every = time.clone();
        every.extend(cycle.iter().cloned());
        let style = match grains {
            true => Style::of_all(&every),
            false => Style::of(&every, melting.unwrap_or(MELTING)),
        };
        let Some(style) = style else {
            continue;
        };
        out += &one(&title, time.first(), &cycle, &style)?;
        let points = cycle
            .iter()
            .filter_map(|f| Some([f.phase?, f.mean_speed()?]));
        speeds.add(Line::new(&title, points.collect()).marked());
    }
    if !speeds.is_empty() {
        out += &figure(
            &speeds.html(),
            "Mean speed in each section over the droplet period. A drop that strikes the pool lifts the curve; \
             how fast it falls again tells how fast the pool calms down.",
        );
    }
    Ok(out)
}

fn one(
    title: &str,
    time: Option<&Field>,
    cycle: &[Field],
    style: &Style,
) -> Result<String, Failure> {
    let mut out = String::new();
    let colour = if style.heat() { "temperature" } else { "speed" };
    let reference = number(style.reference());
    if let Some(field) = time
        && let Some(canvas) = single(field, style)
    {
        let chance = field.interval().map_or(String::new(), |half| {
            format!(
                " At a typical place in the liquid the true mean lies within {} m/s of this one in 95 of 100 cases.",
                number(half)
            )
        });
        let solid = if style.whole() { "" } else { ", grey is solid" };
        let caption = format!(
            "{title}, mean over {} frames{}. Arrows are the velocity relative to the arc (the arrow below the \
             picture is {reference} m/s), colour is {colour}{solid}.{chance}",
            field.frames,
            if field.drops > 0.0 {
                format!(" of {} droplets", field.drops)
            } else {
                String::new()
            }
        );
        let image = picture(&canvas, &caption).map_err(|e| encoding(&e))?;
        out += &figure(&image, &caption);
    }
    let filled: Vec<Field> = cycle.iter().filter(|f| f.frames > 0.0).cloned().collect();
    if let Some(canvas) = phases(&filled, style) {
        let caption = format!(
            "The same, phase by phase of the droplet period, first down the left column, then down the right. \
             All pictures share the colours and the arrow of {reference} m/s."
        );
        let image = picture(&canvas, &caption).map_err(|e| encoding(&e))?;
        out += &figure(&image, &caption);
    }
    Ok(if out.is_empty() {
        out
    } else {
        format!("<h3>{}</h3>\n{out}", escape(title))
    })
}
