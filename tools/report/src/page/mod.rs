//! The page of a study.

use std::path::{Path, PathBuf};

mod arc;
mod arcs;
mod balance;
mod bead;
mod beside;
mod compare;
pub(crate) mod drop;
mod exchange;
pub(crate) mod field;
mod flux;
pub(crate) mod gas;
pub(crate) mod heat;
mod heat_map;
pub(crate) mod jet;
pub(crate) mod live;
mod mean;
pub(crate) mod pair;
pub(crate) mod passes;
pub(crate) mod preview;
mod probes;
mod runs;
pub(crate) mod sweep;

use artefact::{Reader, Record};
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use run::Failure;

use crate::certified::{Certificate, Ran};
use crate::draw::canvas::Canvas;
use crate::draw::film::film;
use crate::files::{PageFiles, save};
use crate::html::{Page, enlarging, escape, paragraph};
use crate::records::RunRecord;
use crate::targets::{self, Targets};
use crate::weld::Weld;

/// A program's record under the name of its artefact.
type Named = (String, RunRecord);

/// An artefact with what the page calls it.
type Read = (String, Reader);

/// Each picture of a film is shown so long \[ms\].
const SHOWN: u16 = 100;

/// Pictures as one that moves, and what they show in words.
fn moving(pictures: &[Canvas], words: &str) -> Result<String, Failure> {
    let Some(first) = pictures.first() else {
        return Ok(String::new());
    };
    let data = film(pictures, SHOWN).map_err(|e| encoding(&e))?;
    Ok(enlarging(&format!(
        "<img class=\"picture\" width=\"{}\" height=\"{}\" alt=\"{}\" src=\"data:image/png;base64,{}\">",
        first.width,
        first.height,
        escape(words),
        STANDARD.encode(data)
    )))
}

/// Writes the page of a study.
pub(crate) fn write(files: &PageFiles) -> Result<(), Failure> {
    let open = |path: &Option<PathBuf>, kind| match path {
        Some(path) => Reader::open_sound(path, kind, 1).map(Some),
        None => Ok(None),
    };
    let all = |files: &[(String, PathBuf)], kind| -> Result<Vec<Read>, Failure> {
        let each = files.iter();
        each.map(|(name, path)| Ok((name.clone(), Reader::open_sound(path, kind, 1)?)))
            .collect()
    };
    let arcs = all(&files.arc, "arc-source")?;
    let balances = arcs::balances(&arcs)?;
    let pool = open(&files.pool, "particle-frames")?;
    let means = all(&files.mean, "mean-fields")?;
    let targets = match &files.targets {
        Some(path) => Some(Targets::read(path, &balances)?),
        None => None,
    };
    let records = beside(files);
    let weld = match &pool {
        Some(reader) => Weld::last(reader)?,
        None => None,
    };
    let stretch = weld.as_ref().and_then(Weld::bead);
    let published = targets.as_ref().map(Targets::published).unwrap_or_default();
    let certificate = certificate(files.certificate.as_deref())?;
    let mut page = Page::new(&files.study, &lead(&records));
    if let (Some(reader), Some(weld)) = (&pool, &weld) {
        page.section(
            "The bead",
            bead::section(reader, weld, stretch.as_ref(), published)?,
        );
        page.section("Thermocouples", probes::section(reader)?);
    }
    if let Some(body) = under_flux(pool.as_ref(), &records)? {
        page.section("Powder, slag and metal", body);
    }
    if let Some(targets) = &targets {
        let mut rows = targets::compare(targets, stretch.as_ref(), &balances);
        if let Some(certificate) = &certificate {
            targets::with_bands(&mut rows, &certificate.bands(&ran(&records)));
        }
        page.section("Against experiment and simulation", compare::section(&rows));
    }
    page.section("Numerical error", errors(certificate.as_ref(), &records));
    let melting = weld.as_ref().and_then(|w| w.plate.melting_point_k);
    averaged(&mut page, &means, melting)?;
    burning(&mut page, &arcs, &balances)?;
    let only = match arcs.as_slice() {
        [(_, reader)] => Some(reader),
        _ => None,
    };
    let mut body = match (only, &pool) {
        (Some(arc), Some(pool)) => exchange::section(arc, pool)?,
        _ => String::new(),
    };
    body += &balance::section(pool.as_ref(), only, &records)?;
    page.section("Mass and energy", body);
    page.section("How it was computed", runs::section(&records));
    save(&files.out, &page.render())
}

/// The certificate of a study, where it is given.
fn certificate(path: Option<&Path>) -> Result<Option<Certificate>, Failure> {
    path.map(Certificate::read).transpose()
}

/// Scenes that ran.
fn ran(records: &[Named]) -> Vec<Ran> {
    let each = records.iter();
    each.map(|(name, record)| (name.clone(), record.scene_hash.clone()))
        .collect()
}

/// Bands of the study's figures; nothing where it is not certified.
fn errors(certificate: Option<&Certificate>, records: &[Named]) -> String {
    certificate.map_or_else(String::new, |c| c.of_study(&ran(records)))
}

/// Sections of means: flows, and the heat that metal gets.
fn averaged(page: &mut Page, means: &[Read], melting: Option<f64>) -> Result<(), Failure> {
    for (name, reader) in means {
        let flow = match mean::of_grains(reader) {
            true => "The flow of grains",
            false => "The flow in the pool",
        };
        page.section(&called(flow, name, means), mean::section(reader, melting)?);
        page.section("The heat that metal gets", heat_map::section(reader)?);
    }
    Ok(())
}

/// Sections of arcs: each, and several beside each other.
fn burning(page: &mut Page, arcs: &[Read], balances: &[(String, Record)]) -> Result<(), Failure> {
    if arcs.len() > 1 {
        page.section("The arcs beside each other", arcs::section(balances));
    }
    for (name, reader) in arcs {
        page.section(&called("The arc", name, arcs), arc::section(reader)?);
    }
    Ok(())
}

/// A title; with the name of its artefact where there are several.
fn called(title: &str, name: &str, among: &[Read]) -> String {
    match among.len() > 1 {
        true => format!("{title}: {name}"),
        false => title.to_owned(),
    }
}

/// What is told of grains beside the metal of a pool; nothing where there are none.
fn under_flux(pool: Option<&Reader>, records: &[Named]) -> Result<Option<String>, Failure> {
    let record = records.iter().find(|(name, _)| name == "pool");
    match (pool, record) {
        (Some(reader), Some((_, record))) => flux::section(reader, &record.scene),
        _ => Ok(None),
    }
}

/// The record beside each artefact that has one.
fn beside(files: &PageFiles) -> Vec<Named> {
    let mut paths: Vec<(&str, Option<&Path>)> = Vec::new();
    for (name, path) in &files.arc {
        paths.push((name, Some(path)));
    }
    paths.push(("pool", files.pool.as_deref()));
    for (name, path) in &files.mean {
        paths.push((name, Some(path)));
    }
    paths
        .into_iter()
        .filter_map(|(name, path)| Some((name.to_owned(), RunRecord::beside(path?)?)))
        .collect()
}

/// Titles of the scenes, each once.
fn lead(records: &[Named]) -> String {
    let mut said: Vec<&str> = Vec::new();
    for (_, record) in records {
        if let Some(title) = record.title()
            && !said.contains(&title)
        {
            said.push(title);
        }
    }
    match said.as_slice() {
        [] => String::new(),
        all => paragraph(&all.join(" \u{b7} ")),
    }
}

/// The program of a record; with the name of its artefact where it ran more than once.
fn program(records: &[Named], name: &str, record: &RunRecord) -> String {
    let same = records.iter().filter(|(_, r)| r.tool == record.tool);
    if same.count() > 1 {
        format!("{}: {name}", record.tool)
    } else {
        record.tool.clone()
    }
}

/// A picture that could not be encoded.
fn encoding(error: &png::EncodingError) -> Failure {
    Failure::Other(format!("a picture could not be encoded: {error}"))
}

/// Facts as tiles: value and what it is.
fn tiles(facts: &[(String, String)]) -> String {
    if facts.is_empty() {
        return String::new();
    }
    let tile = |(value, name): &(String, String)| {
        format!(
            "<li><b>{}</b><span>{}</span></li>\n",
            escape(value),
            escape(name)
        )
    };
    format!(
        "<ul class=\"tiles\">\n{}</ul>\n",
        facts.iter().map(tile).collect::<String>()
    )
}

/// A count with its thousands set apart.
fn grouped(count: usize) -> String {
    let digits = count.to_string();
    let parts: Vec<&str> = digits
        .as_bytes()
        .rchunks(3)
        .rev()
        .filter_map(|p| std::str::from_utf8(p).ok())
        .collect();
    parts.join("\u{2009}")
}
