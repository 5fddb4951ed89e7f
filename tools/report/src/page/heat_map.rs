//! Heat that the metal gets through its surface: maps of the flux by each way, and its course at places (Komen 2019, figs 5.28
//! and 5.29).

use artefact::{Reader, Table};
use run::Failure;

use super::encoding;
use crate::draw::axes::Scale;
use crate::html::{FRAME_WIDTH, chosen, escape, figure, frames, picture};
use crate::picture::heading::Heading;
use crate::picture::heat_map::{WAYS, Way, beside, scale};
use crate::plot::{Line, Plot};

/// Channel of the maps; what stands behind it is the mean, or a place.
const MAPS: &str = "/heat_map";
const MEAN: &str = "/heat_map/time_mean";
const PLACES: &str = "/heat_map/";
/// Moments that are shown large.
const MOMENTS: usize = 4;

/// A way of heat with its colours.
type Shown = (Way, Scale);

/// The section; nothing where there are no maps.
pub(super) fn section(reader: &Reader) -> Result<String, Failure> {
    let maps: Vec<Table> = (0..reader.count(MAPS))
        .map(|i| reader.table_at(MAPS, i))
        .collect::<Result<_, _>>()?;
    let ways: Vec<Shown> = WAYS
        .into_iter()
        .filter_map(|way| Some((way, scale(&maps, way)?)))
        .collect();
    if ways.is_empty() {
        return Ok(String::new());
    }
    let shown = MOMENTS.min(maps.len());
    let places = (1..=shown).map(|k| k * maps.len() / shown - 1);
    let mut out = String::new();
    for map in places.map(|place| &maps[place]) {
        let [from, to] = span(map)?;
        let caption = format!(
            "Heat flux into the metal from above, mean of {from:.2} to {to:.2} s: red where metal is heated, blue where it is \
             cooled, white where nothing passes. {}",
            Heading::of(map).seen_from_above()
        );
        out += &drawn(map, &ways, &caption)?;
    }
    out += &course(&maps, &ways)?;
    if reader.has(MEAN) {
        let caption = "The same, mean over the whole time.";
        out += &drawn(&reader.table(MEAN)?, &ways, caption)?;
    }
    for channel in reader.channels() {
        let name = channel.name.strip_prefix(PLACES);
        if let Some(name) = name.filter(|_| channel.name != MEAN) {
            out += &place(reader, name, &ways)?;
        }
    }
    Ok(out)
}

/// Where the interval of a map begins and ends \[s\].
fn span(map: &Table) -> Result<[f64; 2], Failure> {
    Ok([map.scalar("from_s")?, map.scalar("to_s")?])
}

fn drawn(map: &Table, ways: &[Shown], caption: &str) -> Result<String, Failure> {
    let Some(canvas) = beside(map, ways) else {
        return Ok(String::new());
    };
    let image = picture(&canvas, caption).map_err(|e| encoding(&e))?;
    Ok(figure(&image, caption))
}

/// The maps as a moving picture, where they are more than those shown large.
fn course(maps: &[Table], ways: &[Shown]) -> Result<String, Failure> {
    if maps.len() <= MOMENTS {
        return Ok(String::new());
    }
    let mut moments = Vec::new();
    for map in chosen(maps.len()).into_iter().map(|place| &maps[place]) {
        let [_, to] = span(map)?;
        let canvas = beside(map, ways);
        moments.extend(canvas.map(|canvas| (format!("{to:.2} s"), canvas.smaller(FRAME_WIDTH))));
    }
    frames(&moments, "Heat flux into the metal up to").map_err(|e| encoding(&e))
}

/// The fluxes at a place over time.
fn place(reader: &Reader, name: &str, ways: &[Shown]) -> Result<String, Failure> {
    let records = reader.records(&format!("{PLACES}{name}"))?;
    let mut plot = Plot::new("time [s]", "heat flux into the metal [MW/m2]").through(0.0);
    for (way, _) in ways {
        let point = |record: &artefact::Record| {
            let middle = 0.5 * (record.get("from_s").ok()? + record.get("to_s").ok()?);
            Some([middle, 1e-6 * way.sign * record.get(way.column).ok()?])
        };
        let points: Vec<_> = records
            .iter()
            .filter_map(|(_, record)| point(record))
            .collect();
        if points.iter().any(|point| point[1] != 0.0) {
            plot.add(Line::new(way.words, points).marked());
        }
    }
    if plot.is_empty() {
        return Ok(String::new());
    }
    let caption = format!(
        "Heat flux into the metal at the place '{}', interval by interval.",
        escape(name)
    );
    Ok(figure(&plot.html(), &caption))
}
