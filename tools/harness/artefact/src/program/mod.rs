//! The command line of `artefact`: one file per command; results to stdout, the rest to stderr.

mod diff;
mod export;
mod hash;
mod info;
mod json;
mod ls;
mod open;
mod recover;
mod sheet;
mod trouble;
mod validate;

use std::io::{self, BufWriter, Write};
use std::path::PathBuf;
use std::process::ExitCode;

use artefact::Shown;
use clap::{CommandFactory, Parser, Subcommand};

use trouble::{Trouble, Verdict};

/// Shows, checks, compares, exports and recovers artefacts.
///
/// An artefact is what one stage hands to the next: NAME.mcap with frames, tables and records over
/// simulated time, and NAME.run.json beside it with all that varies between two runs (time,
/// memory, warnings). A file holds only what its scene asked for.
#[derive(Debug, Parser)]
#[command(
    name = "artefact",
    version,
    after_help = "\
Examples, from the repository root:
  target/release/artefact info build/gmaw-quick/pool.mcap
  target/release/artefact validate build/gmaw-quick/*.mcap
  target/release/artefact diff build/gmaw-quick/pool.mcap build/other/pool.mcap
  target/release/artefact export build/gmaw-quick/pool.mcap --to vtu --out build/paraview --every 10
  target/release/artefact recover build/gmaw-300a/pool.mcap.part

Exit code: 0 done; 1 the file is damaged, differs or cannot be read; 2 wrong usage."
)]
struct Arguments {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Describes a file: its tool and inputs, its channels, columns, units and ranges.
    Info(info::Arguments),
    /// Lists the messages of a file in order of time.
    Ls(ls::Arguments),
    /// Checks checksums, schemas and that every number is finite; exit code 1 when not.
    Validate(validate::Arguments),
    /// Compares two files column by column; exit code 0 when equal, 1 when different.
    Diff(diff::Arguments),
    /// Writes for ParaView (vtu), NumPy (npz) or other programs (csv).
    Export(export::Arguments),
    /// Saves the undamaged part of a file whose run was killed.
    Recover(recover::Arguments),
    /// Compares the hashes in a file with the scene and the inputs that it should come from.
    VerifyHash(hash::Arguments),
    /// Writes shell completions and manual pages.
    #[command(hide = true)]
    Manual(manual::Wanted),
}

/// Where a command writes.
pub(crate) struct Streams<'a> {
    /// Results.
    pub(crate) out: &'a mut dyn Write,
    /// Remarks to people.
    pub(crate) err: &'a mut dyn Write,
}

/// The file that most commands take.
#[derive(Debug, clap::Args)]
pub(crate) struct Source {
    /// An artefact (.mcap), the partial file of a run (.mcap.part), or a JSON record.
    #[arg(value_name = "FILE")]
    pub(crate) file: PathBuf,
}

pub(crate) fn main() -> ExitCode {
    let arguments = match Arguments::try_parse() {
        Ok(arguments) => arguments,
        Err(e) => return refused(&e),
    };
    let mut out = Shown(BufWriter::new(io::stdout().lock()));
    let mut err = Shown(io::stderr().lock());
    let mut streams = Streams {
        out: &mut out,
        err: &mut err,
    };
    let result = arguments.command.run(&mut streams);
    let result = result.and_then(|verdict| {
        streams.out.flush()?;
        Ok(verdict)
    });
    match result {
        Ok(Verdict::Good) => ExitCode::SUCCESS,
        Ok(Verdict::Bad) => ExitCode::from(1),
        // The reader of our output has seen enough: `artefact ls FILE | head`.
        Err(Trouble::Output(e)) if e.kind() == io::ErrorKind::BrokenPipe => ExitCode::SUCCESS,
        Err(trouble) => {
            // Nothing is left to be told when even this fails.
            let _ = writeln!(err, "error: {trouble}");
            ExitCode::from(trouble.code())
        }
    }
}

fn explain(wanted: &manual::Wanted) -> Result<Verdict, Trouble> {
    let written = manual::write(&Arguments::command(), &wanted.into);
    written
        .map(|()| Verdict::Good)
        .map_err(|source| Trouble::File {
            path: wanted.into.clone(),
            action: "write into",
            source,
        })
}

/// Help and version go to stdout with code 0, what is wrong with a command line to stderr with code 2.
fn refused(e: &clap::Error) -> ExitCode {
    if e.use_stderr() {
        let text = e.render().to_string();
        let _ = write!(Shown(io::stderr().lock()), "{text}");
    } else {
        let _ = e.print();
    }
    ExitCode::from(u8::try_from(e.exit_code()).unwrap_or(2))
}

impl Command {
    fn run(&self, streams: &mut Streams<'_>) -> Result<Verdict, Trouble> {
        match self {
            Self::Info(arguments) => info::run(arguments, streams),
            Self::Ls(arguments) => ls::run(arguments, streams),
            Self::Validate(arguments) => validate::run(arguments, streams),
            Self::Diff(arguments) => diff::run(arguments, streams),
            Self::Export(arguments) => export::run(arguments, streams),
            Self::Recover(arguments) => recover::run(arguments, streams),
            Self::VerifyHash(arguments) => hash::run(arguments, streams),
            Self::Manual(wanted) => explain(wanted),
        }
    }
}

#[cfg(test)]
mod tests {
    use clap::CommandFactory;

    #[test]
    fn the_command_line_is_consistent() {
        super::Arguments::command().debug_assert();
    }
}
