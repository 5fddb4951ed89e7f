//! The page of a sweep: all its points, and what changes with what is swept.

mod over;
mod points;

use run::{Failure, duration};
use serde_json::json;

use self::points::{Point, Points};
use super::beside::{self, Member, curves, numbers, pictures};
use super::{arc, runs};
use crate::csv::{self, Csv};
use crate::files::{SweepFiles, save};
use crate::html::{Page, Rows, escape, note, paragraph, verdict};
use crate::records::{RunRecord, figure as digits};

/// So many points stand side by side in tables of everything.
const SIDE_BY_SIDE: usize = 12;

/// Writes the page; beside it its table as CSV, and what it tells of points that are not comparable, for `sweep`.
pub(crate) fn write(files: &SweepFiles) -> Result<(), Failure> {
    let points = Points::read(&files.points)?;
    let mut members = Vec::new();
    let mut all = Vec::new();
    for point in &points.points {
        let member = Member::open(&points.label(point), &point.files())?;
        all.push(numbers::of(&member)?);
        members.push(member);
    }
    let figures = points.figures(&all)?;
    let lead = points.title.as_deref().map_or_else(String::new, paragraph);
    let mut page = Page::new(&format!("{}: sweep", points.study), &lead);
    let mut unlike = beside::unlike(&members);
    unlike.extend(points.lacking(&figures));
    let body = beside::notes(&unlike) + &table(&points, &members, &figures);
    page.section("The points", body);
    page.section("Over what is swept", over::section(&points, &figures));
    for stage in beside::stages(&members) {
        let body = pictures::section(&members, stage)?;
        page.section(&format!("Pictures: {stage}"), body);
        let body = curves::section(&members, stage)?;
        page.section(&format!("Curves: {stage}"), body);
    }
    let names: Vec<&str> = members.iter().map(|m| m.name.as_str()).collect();
    if members.len() <= SIDE_BY_SIDE {
        let body = numbers::table(&names, &all);
        page.section("All numbers beside each other", body);
    }
    for stage in &points.whole {
        for member in &members {
            let Some(own) = member.stage(stage) else {
                continue;
            };
            if own.reader.header().kind == "arc-source" {
                let title = format!("{stage}: {}", member.name);
                page.section(&title, arc::section(&own.reader)?);
            }
        }
    }
    if members.len() <= SIDE_BY_SIDE {
        let records = beside::records(&members);
        page.section("How it was computed", runs::section(&records));
    }
    let told = sheet(&points, &figures, &all);
    let beside = |ending: &str| files.out.with_extension(ending);
    artefact::write_atomically(&beside("csv"), told.text().as_bytes())?;
    let unlike = json!({"kind": "sweep-told", "version": "1.0", "told": unlike});
    artefact::write_atomically(&beside("told.json"), format!("{unlike:#}\n").as_bytes())?;
    save(&files.out, &page.render())
}

/// A row for each point: values, figures, how long it took, how it ended.
fn table(points: &Points, members: &[Member], figures: &[Vec<Option<f64>>]) -> String {
    let mut head: Vec<String> = Vec::new();
    for parameter in &points.parameters {
        head.push(csv::head(
            &format!("#{}", parameter.words()),
            &parameter.unit,
        ));
    }
    for figure in &points.figures {
        head.push(csv::head(&format!("#{}", figure.name), &figure.unit));
    }
    head.extend(["#Time".to_owned(), "Ended".to_owned()]);
    let head: Vec<&str> = head.iter().map(String::as_str).collect();
    let mut table = Rows::new(&head);
    for ((point, member), found) in points.points.iter().zip(members).zip(figures) {
        let mut row: Vec<String> = point.values.iter().map(|v| escape(&v.name)).collect();
        row.extend(
            found
                .iter()
                .map(|v| v.map_or_else(|| "\u{2013}".to_owned(), digits)),
        );
        let times = member.stages.iter().filter_map(|s| s.record.as_ref());
        row.push(duration(times.map(|r| r.wall_s).sum()));
        row.push(ended(point, member));
        table.row(row);
    }
    let failed = points.points.iter().filter(|p| p.failed.is_some()).count();
    let mut out = match failed {
        0 => String::new(),
        n => note(&format!("{n} of {} points failed.", points.points.len())),
    };
    out += &table.render();
    for (member, record) in members.iter().flat_map(|m| warned(m).map(move |r| (m, r))) {
        for warning in &record.warnings {
            out += &note(&format!("{}: {warning}", member.name));
        }
    }
    out
}

/// Records with warnings.
fn warned(member: &Member) -> impl Iterator<Item = &RunRecord> {
    let records = member.stages.iter().filter_map(|s| s.record.as_ref());
    records.filter(|record| !record.warnings.is_empty())
}

fn ended(point: &Point, member: &Member) -> String {
    if let Some(failed) = &point.failed {
        let words = format!("{}: {}", failed.stage, failed.what);
        return format!(
            "{}<br><small>{}</small>",
            verdict("failed", Some(false)),
            escape(&words)
        );
    }
    match warned(member).map(|record| record.warnings.len()).sum() {
        0 => "made".to_owned(),
        1 => "made, with a warning".to_owned(),
        n => format!("made, with {n} warnings"),
    }
}

/// The table for other programs: values, figures, then every number.
fn sheet(points: &Points, figures: &[Vec<Option<f64>>], all: &[Vec<numbers::Number>]) -> Csv {
    let quantities = numbers::beside(all);
    let mut csv = Csv::default();
    let mut head = vec!["point".to_owned()];
    head.extend(
        points
            .parameters
            .iter()
            .map(|p| csv::head(&p.name, &p.unit)),
    );
    head.extend(points.figures.iter().map(|f| csv::head(&f.name, &f.unit)));
    head.push("ended".to_owned());
    let place = |q: &numbers::Number| format!("{}: {}", q.origin(), q.name);
    head.extend(
        quantities
            .iter()
            .map(|(q, _)| csv::head(&place(q), &q.unit)),
    );
    csv.line(head);
    for (i, (point, found)) in points.points.iter().zip(figures).enumerate() {
        let cell = |v: &Option<f64>| v.map_or_else(String::new, csv::number);
        let mut row = vec![point.name.clone()];
        row.extend(point.values.iter().map(|v| v.name.clone()));
        row.extend(found.iter().map(cell));
        row.push(
            if point.failed.is_some() {
                "failed"
            } else {
                "made"
            }
            .to_owned(),
        );
        row.extend(quantities.iter().map(|(_, values)| cell(&values[i])));
        csv.line(row);
    }
    csv
}
