//! The page of a look before a run.

use run::Failure;
use run::preview::Marked;

use super::{encoding, grouped};
use crate::draw::axes::number;
use crate::files::{PreviewFiles, save};
use crate::html::{Page, Rows, escape, figure, note, paragraph, picture};
use crate::picture::preview::{By, View, picture as draw};
use crate::preview::Preview;

/// Writes the page.
pub(crate) fn write(files: &PreviewFiles) -> Result<(), Failure> {
    let title = files.study.as_deref().unwrap_or("A look before running");
    let lead = paragraph(
        "What would be there before anything runs: points by material, what holds at faces and surfaces, and the ways of \
         what moves. Lengths are in mm.",
    );
    let mut page = Page::new(title, &lead);
    for (name, path) in &files.looks {
        let preview = Preview::read(path)?;
        page.section(name, section(&preview)?);
    }
    save(&files.out, &page.render())
}

/// Tables and pictures of one look.
fn section(preview: &Preview) -> Result<String, Failure> {
    let mut out = String::new();
    if let Some(title) = &preview.title {
        out += &paragraph(title);
    }
    if preview.place.is_empty() {
        return Ok(out + &note("Nothing is there at the start."));
    }
    out += &paragraph(&format!("As {} would begin.", preview.tool));
    out += &materials(preview);
    out += &marks(preview);
    let conditions = preview.condition.iter().any(|c| *c > 0);
    for view in View::of(preview) {
        let ways = [
            (By::Material, true, ""),
            (
                By::Condition,
                conditions,
                " Colours of the points by what holds there.",
            ),
        ];
        for (by, _, words) in ways.into_iter().filter(|way| way.1) {
            if let Some(canvas) = draw(preview, view, by) {
                let caption = view.words(preview.look.coordinates) + words;
                let image = picture(&canvas, &caption).map_err(|e| encoding(&e))?;
                out += &figure(&image, &caption);
            }
        }
    }
    Ok(out)
}

/// From where to where places reach, in mm.
fn reach(places: impl Iterator<Item = [f64; 3]>) -> String {
    let mut corners: Option<[[f64; 3]; 2]> = None;
    for place in places {
        let [low, high] = corners.get_or_insert([place, place]);
        for k in 0..3 {
            low[k] = low[k].min(place[k]);
            high[k] = high[k].max(place[k]);
        }
    }
    let Some([low, high]) = corners else {
        return String::new();
    };
    let millimetres = |place: [f64; 3]| {
        let numbers = place.map(|x| number((1e6 * x).round() * 1e-3));
        format!("({})", numbers.join(", "))
    };
    format!("{} to {}", millimetres(low), millimetres(high))
}

/// Points of each material and condition.
fn materials(preview: &Preview) -> String {
    let mut table = Rows::new(&[
        "Points",
        "#Number",
        "Middles from and to [mm]",
        "#Least size [mm]",
    ]);
    let mut add = |name: &str, own: &[usize]| {
        if own.is_empty() {
            return;
        }
        let sizes = own
            .iter()
            .flat_map(|i| preview.size[*i])
            .filter(|s| *s > 0.0);
        let least = sizes.fold(f64::INFINITY, f64::min);
        table.row([
            escape(name),
            grouped(own.len()),
            reach(own.iter().map(|i| preview.place[*i])),
            number((1e6 * least).round() * 1e-3),
        ]);
    };
    let of = |column: &[u32], number: u32| -> Vec<usize> {
        (0..column.len()).filter(|i| column[*i] == number).collect()
    };
    for number in 0..preview.look.materials.len() as u32 {
        add(
            preview.material_name(number),
            &of(&preview.material, number),
        );
    }
    for number in 1..=preview.look.conditions.len() as u32 {
        add(
            preview.condition_name(number),
            &of(&preview.condition, number),
        );
    }
    table.render()
}

/// Axis, path, droplets, coils and probes.
fn marks(preview: &Preview) -> String {
    let mut table = Rows::new(&["Mark", "From and to [mm]"]);
    for mark in &preview.look.marks {
        let places = || mark.lines_m.iter().flatten().copied();
        let way = match mark.kind {
            Marked::Probe => places().map(|p| reach(std::iter::once(p))).collect(),
            _ => reach(places()),
        };
        table.row([escape(&mark.name), way]);
    }
    table.render()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn extents_are_told_in_millimetres() {
        let places = [[0.0, 1e-3, -2.5e-4], [2e-3, 0.0, 0.0]];
        assert_eq!(reach(places.into_iter()), "(0, 0, -0.25) to (2, 1, 0)");
        assert_eq!(reach(std::iter::empty()), "");
    }
}
