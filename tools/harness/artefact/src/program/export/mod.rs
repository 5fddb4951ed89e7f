//! `artefact export`: the same numbers for ParaView, NumPy or a spreadsheet.

mod csv;
mod fields;
mod npz;
mod series;
mod vtk;

use std::path::{Path, PathBuf};

use artefact::{Channel, Lock, Reader, must_not_be_read};
use clap::ValueEnum;

use super::open::{channels, open_whole};
use super::sheet::{Form, Sheet};
use super::trouble::{Trouble, Verdict, file_error};
use super::{Source, Streams};
use series::Series;

/// For whom to write.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Target {
    /// ParaView: frames as .vtu, grids as .vti or .vtr, each channel with a .pvd over time; what
    /// has no place in space (tables, grids over other quantities than lengths, scalars) as .csv.
    #[value(alias = "vtk")]
    Vtu,
    /// NumPy: a .npz with one array per column.
    Npz,
    /// Any program: text with names and units in the first line.
    Csv,
}

/// Arguments of `export`.
#[derive(Debug, clap::Args)]
#[command(after_help = "Examples:
  target/release/artefact export build/gmaw-quick/pool.mcap --to vtu --out build/paraview --channel /particles
    then open build/paraview/particles.pvd in ParaView
  target/release/artefact export build/gmaw-300a/arc.mcap --to csv --out build/csv
Frames, tables and grids become one file per message, CHANNEL/CHANNEL_00012.vtu; records and other
scalars become one file per channel with a row per message. Coordinates and units are those of the
artefact (SI), but a depth is a z below 0 in ParaView; it shows units where they are stored as UNITS_LABEL. Of a damaged file all that
is whole is written, what is lost is named, and the exit code is 1.")]
pub(crate) struct Arguments {
    #[command(flatten)]
    source: Source,
    /// For whom to write.
    #[arg(long, visible_alias = "format", value_enum)]
    to: Target,
    /// Folder to write into; made when it is not there.
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
    /// Only these channels.
    #[arg(long, value_name = "CHANNEL")]
    channel: Vec<String>,
    /// Only every N-th message of each channel, from the first on.
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..))]
    every: u32,
}

pub(crate) fn run(arguments: &Arguments, streams: &mut Streams<'_>) -> Result<Verdict, Trouble> {
    // Many files are written: who writes into the folder owns it.
    let _owned = Lock::of(&arguments.out.join("export"))?;
    let (reader, whole) = open_whole(&arguments.source.file, streams)?;
    let channels = channels(&reader, &arguments.channel)?;
    let mut names: Vec<String> = Vec::new();
    for channel in &channels {
        let mut name = file_name(&channel.name);
        while names.contains(&name) {
            name.push('_');
        }
        let export = Export {
            reader: &reader,
            channel,
            target: arguments.to,
            folder: &arguments.out,
            name: &name,
        };
        let (files, first) = export.channel(arguments.every as usize)?;
        let plural = if files == 1 { "" } else { "s" };
        let first = arguments.out.join(first);
        writeln!(
            streams.out,
            "{}: {files} file{plural}, {}",
            channel.name,
            first.display()
        )?;
        names.push(name);
    }
    Ok(Verdict::from_good(whole))
}

/// The name of a channel as a file can bear it: `/section_x0/time_mean` is
/// `section_x0_time_mean`.
fn file_name(channel: &str) -> String {
    let plain = |c: char| c.is_ascii_alphanumeric() || c == '_' || c == '-';
    let name: String = channel
        .trim_start_matches('/')
        .chars()
        .map(|c| if plain(c) { c } else { '_' })
        .collect();
    if name.is_empty() {
        "channel".to_owned()
    } else {
        name
    }
}

/// One channel on its way out.
struct Export<'a> {
    reader: &'a Reader,
    channel: &'a Channel,
    target: Target,
    folder: &'a Path,
    name: &'a str,
}

impl Export<'_> {
    /// Writes every n-th message; gives the number of files, and the one to open.
    fn channel(&self, every: usize) -> Result<(usize, String), Trouble> {
        let mut series = Series::default();
        let mut steps = Vec::new();
        for index in (0..self.channel.messages).step_by(every) {
            let sheet = Sheet::read(self.reader, self.channel, index)?;
            if sheet.form == Form::Scalars {
                series.push(sheet);
                continue;
            }
            let file = self.sheet(&sheet, index)?;
            steps.push((sheet.time_s, file));
        }
        let mut files = steps.len();
        let mut first = steps
            .first()
            .map_or(String::new(), |(_, file)| file.clone());
        if self.target == Target::Vtu && steps.iter().any(|(_, file)| !file.ends_with(".csv")) {
            first = format!("{}.pvd", self.name);
            let text = vtk::collection(&steps);
            self.write(&first, text.as_bytes())?;
            files += 1;
        }
        if !series.is_empty() {
            first = self.series(&series)?;
            files += 1;
        }
        Ok((files, first))
    }

    /// Writes one message; gives its file relative to the folder.
    fn sheet(&self, sheet: &Sheet, index: usize) -> Result<String, Trouble> {
        let (bytes, suffix) = match (self.target, sheet.form) {
            (Target::Npz, _) => (npz::sheet(sheet)?, "npz"),
            (Target::Vtu, Form::Frame) => (vtk::cloud(sheet), "vtu"),
            (Target::Vtu, Form::Grid) if sheet.rows() > 0 && vtk::is_place(sheet) => {
                vtk::grid(sheet)
            }
            _ => (csv::sheet(sheet), "csv"),
        };
        let file = format!("{0}/{0}_{index:05}.{suffix}", self.name);
        self.write(&file, &bytes)?;
        Ok(file)
    }

    /// Writes scalars over time; gives their file relative to the folder.
    fn series(&self, series: &Series) -> Result<String, Trouble> {
        let (bytes, suffix) = match self.target {
            Target::Npz => (npz::series(series)?, "npz"),
            Target::Vtu | Target::Csv => (csv::series(series), "csv"),
        };
        let file = format!("{}.{suffix}", self.name);
        self.write(&file, &bytes)?;
        Ok(file)
    }

    /// Writes a file, named from the folder on, into a folder that is made when it is not there.
    fn write(&self, file: &str, bytes: &[u8]) -> Result<(), Trouble> {
        let path = self.folder.join(file);
        must_not_be_read(&path, [("the artefact".to_owned(), self.reader.path())])?;
        if let Some(folder) = path.parent() {
            std::fs::create_dir_all(folder).map_err(file_error(folder, "create"))?;
        }
        std::fs::write(&path, bytes).map_err(file_error(&path, "write"))
    }
}

#[cfg(test)]
mod tests {
    use super::file_name;

    #[test]
    fn channels_become_file_names() {
        assert_eq!(file_name("/particles"), "particles");
        assert_eq!(file_name("/section_x0/time_mean"), "section_x0_time_mean");
        assert_eq!(file_name("/"), "channel");
    }
}
