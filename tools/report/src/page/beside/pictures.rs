//! Pictures of several runs, small, each kind with the same colours.

use run::Failure;

use super::{Member, Stage};
use crate::draw::canvas::Canvas;
use crate::heat::Points;
use crate::heat::field::Field as Heat;
use crate::html::{figure, picture};
use crate::page::{encoding, jet};
use crate::picture::arc::Plasma;
use crate::picture::bead::{self, Paint, View};
use crate::picture::cross::{self, Published};
use crate::picture::heat;
use crate::picture::mean::{Field, Style, single};
use crate::weld::Weld;

/// Width of a picture where there are few \[px\], and where there are more.
const WIDE: usize = 880;
const NARROW: usize = 590;
/// So many runs are few.
const FEW: usize = 4;
/// Melting point assumed where the frames tell none \[K\].
const MELTING: f64 = 1750.0;

/// Pictures of one kind: what they show, and the picture of each run.
type Shown = (&'static str, Vec<(String, Canvas)>);

/// The pictures of a stage; nothing where there is nothing to see.
///
/// # Errors
/// When a message cannot be read.
pub(in crate::page) fn section(members: &[Member], stage: &str) -> Result<String, Failure> {
    let own = members
        .iter()
        .filter_map(|m| Some((m.name.as_str(), m.stage(stage)?)));
    let own: Vec<(&str, &Stage)> = own.collect();
    let width = if own.len() > FEW { NARROW } else { WIDE };
    let mut out = String::new();
    let mut kinds = welds(&own);
    kinds.push(("The arc in a plane through its axis.", arcs(&own)?));
    kinds.push(means(&own)?);
    kinds.push(("The temperature at the end.", heats(&own)?));
    kinds.push(("The last frame.", jets(&own)?));
    for (what, all) in kinds {
        let mut figures = String::new();
        for (run, canvas) in all {
            let words = format!("{run}: {what}");
            let image = picture(&canvas.smaller(width), &words).map_err(|e| encoding(&e))?;
            figures += &figure(&image, &run);
        }
        if !figures.is_empty() {
            out += &format!("<p>{what}</p>\n<div class=\"small\">\n{figures}</div>\n");
        }
    }
    Ok(out)
}

fn welds(own: &[(&str, &Stage)]) -> Vec<Shown> {
    let all = own
        .iter()
        .filter_map(|(run, s)| Some((*run, *s, s.weld.as_ref()?)));
    let all: Vec<(&str, &Stage, &Weld)> = all.collect();
    let paint = Paint::of(&all.iter().map(|(_, _, weld)| *weld).collect::<Vec<_>>());
    let mut kinds: Vec<Shown> = vec![
        ("The weld from above.", Vec::new()),
        ("Section across the weld.", Vec::new()),
        ("Section along its centre.", Vec::new()),
    ];
    for (run, stage, weld) in all {
        let place = stage.stretch.as_ref().and_then(|s| s.place());
        let section = place.map(|y| weld.section(y));
        let pictures = [
            bead::picture(weld, &paint, View::Above),
            section.and_then(|(section, measures)| {
                cross::across(weld, &section, &measures, Published::default())
            }),
            cross::along(weld, &paint),
        ];
        for (kind, canvas) in kinds.iter_mut().zip(pictures) {
            kind.1.extend(canvas.map(|canvas| (run.to_owned(), canvas)));
        }
    }
    kinds
}

fn arcs(own: &[(&str, &Stage)]) -> Result<Vec<(String, Canvas)>, Failure> {
    let mut all = Vec::new();
    for (run, stage) in own
        .iter()
        .filter(|(_, s)| s.reader.has("/plasma") && s.is("arc-source"))
    {
        let plasma = Plasma::read(&stage.reader.table("/plasma")?)?;
        let canvas = plasma.as_ref().and_then(Plasma::picture);
        all.extend(canvas.map(|canvas| ((*run).to_owned(), canvas)));
    }
    Ok(all)
}

fn means(own: &[(&str, &Stage)]) -> Result<Shown, Failure> {
    let mut fields = Vec::new();
    for (run, stage) in own.iter().filter(|(_, s)| s.is("mean-fields")) {
        let first = Field::all(&stage.reader, "/section_x0/time_mean")?;
        fields.extend(
            first
                .into_iter()
                .next()
                .map(|field| ((*run).to_owned(), field)),
        );
    }
    let all: Vec<Field> = fields.iter().map(|(_, field)| field.clone()).collect();
    let Some(style) = Style::of(&all, MELTING) else {
        return Ok(("", Vec::new()));
    };
    let what = match all.iter().all(Field::is_usual) {
        true => "The mean flow along the weld.",
        false => "The mean flow in the section x0.",
    };
    let drawn = fields.into_iter();
    let drawn = drawn.filter_map(|(run, field)| Some((run, single(&field, &style)?)));
    Ok((what, drawn.collect()))
}

fn heats(own: &[(&str, &Stage)]) -> Result<Vec<(String, Canvas)>, Failure> {
    let mut all = Vec::new();
    let heated = |s: &Stage| s.reader.header().tool == "heatsph";
    for (run, stage) in own.iter().filter(|(_, s)| heated(s)) {
        let Some(points) = Points::last(&stage.reader)? else {
            continue;
        };
        let field = Heat::of(&points);
        let shown = field.and_then(|field| heat::picture(&points, &field));
        all.extend(shown.map(|shown| ((*run).to_owned(), shown.canvas)));
    }
    Ok(all)
}

fn jets(own: &[(&str, &Stage)]) -> Result<Vec<(String, Canvas)>, Failure> {
    let mut all = Vec::new();
    for (run, stage) in own.iter().filter(|(_, s)| s.is("jet-frames")) {
        let canvas = jet::last(run, stage.reader.path())?;
        all.extend(canvas.map(|canvas| ((*run).to_owned(), canvas)));
    }
    Ok(all)
}
