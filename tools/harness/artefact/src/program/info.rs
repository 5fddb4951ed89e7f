//! `artefact info`: who wrote a file from what, and what is in it.

use artefact::{Channel, RECOVERED, Reader};

use super::open::{channels, is_json, open};
use super::sheet::{Form, Sheet, short};
use super::trouble::{Trouble, Verdict};
use super::{Source, Streams, json};

/// Arguments of `info`.
#[derive(Debug, clap::Args)]
#[command(after_help = "Example:
  target/release/artefact info build/gmaw-300a/arc.mcap
For each channel it lists the columns of the last message with unit, type and range.
For a run record (.run.json) it lists how the run went: outcome, time and memory per stage.")]
pub(crate) struct Arguments {
    #[command(flatten)]
    source: Source,
    /// Only these channels.
    #[arg(long, value_name = "CHANNEL")]
    channel: Vec<String>,
    /// Prints the scene as the tool ran it, patches applied, and nothing else.
    #[arg(long)]
    scene: bool,
}

pub(crate) fn run(arguments: &Arguments, streams: &mut Streams<'_>) -> Result<Verdict, Trouble> {
    let path = &arguments.source.file;
    if is_json(path) {
        json::info(path, streams)?;
        return Ok(Verdict::Good);
    }
    let reader = open(path, streams)?;
    if arguments.scene {
        let scene = &reader.header().scene;
        writeln!(streams.out, "{scene:#}")?;
        return Ok(Verdict::Good);
    }
    let channels = channels(&reader, &arguments.channel)?;
    header(&reader, streams)?;
    for channel in channels {
        describe(&reader, &channel, streams)?;
    }
    Ok(Verdict::Good)
}

fn header(reader: &Reader, streams: &mut Streams<'_>) -> Result<(), Trouble> {
    let header = reader.header();
    let out = &mut streams.out;
    writeln!(out, "file        {}", reader.path().display())?;
    writeln!(out, "size        {} bytes", reader.bytes())?;
    writeln!(out, "kind        {} {}", header.kind, header.version)?;
    writeln!(out, "tool        {} {}", header.tool, header.tool_version)?;
    writeln!(out, "scene       sha256 {}", header.scene_sha256())?;
    if let Some(title) = header.scene["title"].as_str() {
        writeln!(out, "title       {title}")?;
    }
    for (name, hash) in &header.inputs {
        writeln!(out, "input       {name} sha256 {hash}")?;
    }
    if let Some(note) = reader.metadata(RECOVERED) {
        let of = |key: &str| note.get(key).map_or("?", String::as_str);
        writeln!(
            out,
            "recovered   from a run that did not finish: {} messages saved, {} bytes lost",
            of("messages"),
            of("lost_bytes")
        )?;
        if let Some(chunks) = note.get("lost_chunks") {
            writeln!(out, "            {chunks} damaged chunks are left out")?;
        }
    }
    Ok(())
}

fn describe(reader: &Reader, channel: &Channel, streams: &mut Streams<'_>) -> Result<(), Trouble> {
    let out = &mut streams.out;
    let span = match channel.span_s {
        Some((first, last)) if channel.messages > 1 => format!("{first} s to {last} s"),
        Some((first, _)) => format!("at {first} s"),
        None => "empty".to_owned(),
    };
    let plural = if channel.messages == 1 { "" } else { "s" };
    writeln!(
        out,
        "\n{}  {}  {} message{plural}, {span}",
        channel.name, channel.schema, channel.messages
    )?;
    let Some(last) = channel.messages.checked_sub(1) else {
        return Ok(());
    };
    let sheet = Sheet::read(reader, channel, last)?;
    if sheet.form != Form::Scalars {
        let shape: Vec<String> = sheet.shape.iter().map(usize::to_string).collect();
        writeln!(out, "  last: {} {}", shape.join(" x "), sheet.form.word())?;
    }
    for column in sheet.all() {
        let values = column.values.to_f64();
        let low = values.iter().copied().fold(f64::INFINITY, f64::min);
        let high = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let range = match values.len() {
            0 => "no entry".to_owned(),
            1 => short(low),
            _ => format!("{} .. {}", short(low), short(high)),
        };
        let kind = column.values.type_name();
        writeln!(
            out,
            "  {:<32} {:<8} {kind:<4} {range}",
            column.name, column.unit
        )?;
    }
    for (name, text) in &sheet.texts {
        writeln!(out, "  {name:<32} {text}")?;
    }
    Ok(())
}
