//! Powder, slag and metal: pictures of the section along the weld over time, and what has melted.

use artefact::Reader;
use run::Failure;
use serde_json::Value;

use super::encoding;
use crate::flux::{Flux, GRAINS, POWDER, SLAG};
use crate::html::{figure, picture};
use crate::measure::slag::{BEHIND, Slag};
use crate::picture::flux::{self as sections, Cut, Tells, scale};
use crate::plot::{Line, Plot};
use crate::weld::PARTICLES;

/// Most moments that are shown.
const MOMENTS: usize = 6;

/// The section; nothing where there are no grains beside metal.
pub(super) fn section(reader: &Reader, scene: &Value) -> Result<Option<String>, Failure> {
    let count = reader.count(PARTICLES).min(reader.count(GRAINS));
    if count == 0 {
        return Ok(None);
    }
    let shown = shown(count);
    let (mut moments, mut melted) = (Vec::new(), Melted::default());
    for index in 0..count {
        let Some(moment) = Flux::read(reader, scene, index)? else {
            continue;
        };
        melted.add(&moment);
        if shown.contains(&index) {
            moments.push(moment);
        }
    }
    let mut body = String::new();
    for (tells, words) in [
        (Some(Tells::States), "What each particle is"),
        (scale(&moments).map(Tells::Temperature), "Temperature"),
    ] {
        let Some(tells) = tells else { continue };
        for moment in &moments {
            let caption = format!(
                "{words} at {:.2} s, in the section along the weld. The arc moves to the right.",
                moment.weld.time
            );
            if let Some(canvas) = sections::section(moment, Cut::Along, &tells) {
                let image = picture(&canvas, &caption).map_err(|e| encoding(&e))?;
                body += &figure(&image, &caption);
            }
        }
    }
    if let Some(last) = moments.last() {
        body += &behind(last)?;
    }
    Ok(Some(body + &melted.section()))
}

/// The last frame and as many before it at equal times, each once; the start shows nothing yet.
fn shown(count: usize) -> Vec<usize> {
    let many = MOMENTS.min(count);
    let index = |k: usize| (k + 1) as f64 * count.saturating_sub(1) as f64 / many as f64;
    let mut all: Vec<usize> = (0..many).map(|k| index(k).round() as usize).collect();
    all.dedup();
    all
}

/// The section across the weld some way behind the arc, and how thick the slag lies there; nothing where there is none.
fn behind(last: &Flux) -> Result<String, Failure> {
    let (Some(source), Some(slag)) = (last.weld.source_along(), Slag::behind(last)) else {
        return Ok(String::new());
    };
    let place = source - BEHIND;
    let words = format!("{:.0} mm behind the arc", 1e3 * BEHIND);
    let mut body = String::new();
    let caption = format!("What each particle is in the section across the weld, {words}.");
    if let Some(canvas) = sections::section(last, Cut::Across(place), &Tells::States) {
        let image = picture(&canvas, &caption).map_err(|e| encoding(&e))?;
        body += &figure(&image, &caption);
    }
    let mut plot = Plot::new(
        &last.weld.titled("distance from the centre", "x"),
        "thickness of the slag [mm]",
    )
    .through(0.0);
    let points = slag.columns.iter().map(|column| column.map(|v| 1e3 * v));
    plot.add(Line::new("slag, molten or set", points.collect()).marked());
    let [middle, beside] = slag.middle_and_beside().map(|h| 1e3 * h);
    let shape = if slag.is_hollow() {
        "It is hollow in the middle."
    } else {
        "It is not hollow in the middle."
    };
    let caption = format!(
        "How thick the slag lies {words}, by the grains in each column as they lie, six tenths of the room filled: at most {:.1} mm, \
         {middle:.1} mm in the middle, {beside:.1} mm from 2 to 8 mm beside it. {shape}",
        1e3 * slag.greatest()
    );
    Ok(body + &figure(&plot.html(), &caption))
}

/// Numbers of particles over time: slag, frozen slag, liquid metal.
#[derive(Default)]
struct Melted {
    lines: [Vec<[f64; 2]>; 3],
}

impl Melted {
    /// Counts a moment.
    fn add(&mut self, flux: &Flux) {
        let (slag, all) = (flux.number(SLAG), flux.state.len());
        let frozen = all - slag - flux.number(POWDER);
        let liquid = flux.weld.liquid.iter().filter(|l| **l).count();
        for (line, value) in self.lines.iter_mut().zip([slag, frozen, liquid]) {
            line.push([flux.weld.time, value as f64]);
        }
    }

    /// The plot; nothing where nothing was counted.
    fn section(self) -> String {
        let mut plot = Plot::new("time [s]", "particles").through(0.0);
        for (name, points) in ["slag", "frozen slag", "liquid metal"]
            .into_iter()
            .zip(self.lines)
        {
            plot.add(Line::new(name, points).marked());
        }
        if plot.is_empty() {
            return String::new();
        }
        figure(
            &plot.html(),
            "How much is slag, has set again, and is liquid metal. Slag comes first: light strikes the wall of the cavity.",
        )
    }
}

#[cfg(test)]
mod tests {
    use super::shown;

    #[test]
    fn no_moment_is_shown_twice() {
        assert_eq!(shown(1), [0]);
        assert_eq!(shown(2), [1]);
        assert_eq!(shown(3), [1, 2]);
        assert_eq!(shown(13), [2, 4, 6, 8, 10, 12]);
    }
}
