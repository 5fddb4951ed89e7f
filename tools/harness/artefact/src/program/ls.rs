//! `artefact ls`: the messages of a file in order of time.

use super::open::{channels, open};
use super::sheet::{Form, Sheet};
use super::trouble::{Trouble, Verdict};
use super::{Source, Streams};

/// Arguments of `ls`.
#[derive(Debug, clap::Args)]
#[command(after_help = "Example:
  target/release/artefact ls build/gmaw-quick/pool.mcap --channel /particles
Columns: simulated time in s, channel, index of the message in it, size.")]
pub(crate) struct Arguments {
    #[command(flatten)]
    source: Source,
    /// Only these channels.
    #[arg(long, value_name = "CHANNEL")]
    channel: Vec<String>,
}

/// Widest that a column of names may be.
const WIDEST: usize = 60;

pub(crate) fn run(arguments: &Arguments, streams: &mut Streams<'_>) -> Result<Verdict, Trouble> {
    let reader = open(&arguments.source.file, streams)?;
    let channels = channels(&reader, &arguments.channel)?;
    let mut messages = Vec::new();
    for channel in &channels {
        let times = reader.times(&channel.name)?;
        messages.extend(times.into_iter().enumerate().map(|(i, t)| (t, channel, i)));
    }
    messages.sort_by(|a, b| a.0.total_cmp(&b.0));
    let longest = channels.iter().map(|c| c.name.len()).max();
    let width = longest.unwrap_or(0).min(WIDEST);
    for (time, channel, index) in messages {
        let sheet = Sheet::read(&reader, channel, index)?;
        let rows = match sheet.form {
            Form::Scalars => sheet.columns.len() + sheet.texts.len(),
            _ => sheet.rows(),
        };
        writeln!(
            streams.out,
            "{time:<14} {:<width$} {index:>6}  {rows} {}",
            channel.name,
            sheet.form.word()
        )?;
    }
    Ok(Verdict::Good)
}
