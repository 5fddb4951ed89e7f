//! The command line that all stages share.

use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::time::Duration;

use clap::{ArgAction, Args, CommandFactory, FromArgMatches, Parser, Subcommand};

use crate::console::Level;
use crate::progress::Style;
use crate::tool::Tool;

#[derive(Debug, Parser)]
pub(crate) struct Line {
    #[command(subcommand)]
    pub(crate) action: Action,
}

#[derive(Debug, Subcommand)]
pub(crate) enum Action {
    /// Runs a scene and writes an artefact and its run record.
    Run(Run),
    /// Validates a scene and its inputs, prints the plan, runs nothing.
    Check(Check),
    /// Prints the JSON Schema of the scene.
    Schema,
    /// Writes shell completions and manual pages.
    #[command(hide = true)]
    Manual(manual::Wanted),
}

/// A scene with what belongs to it.
#[derive(Debug, Clone, Args)]
pub(crate) struct Study {
    /// The scene.
    #[arg(value_name = "SCENE.json")]
    pub(crate) scene: PathBuf,
    /// An input file by name.
    #[arg(long = "input", value_name = "NAME=FILE")]
    pub(crate) inputs: Vec<String>,
    /// A JSON Merge Patch (RFC 7386) applied to the scene; several are applied in order.
    #[arg(long = "patch", value_name = "FILE.json")]
    pub(crate) patches: Vec<PathBuf>,
}

impl Study {
    /// Every file that is read, with what it is.
    pub(crate) fn reads(&self) -> impl Iterator<Item = (String, &Path)> + Clone {
        let scene = [("the scene".to_owned(), self.scene.as_path())];
        let patches = self.patches.iter();
        let patches = patches.map(|path| ("a patch".to_owned(), path.as_path()));
        let inputs = self.inputs.iter().filter_map(|word| word.split_once('='));
        let inputs = inputs.map(|(name, path)| (format!("the input '{name}'"), Path::new(path)));
        scene.into_iter().chain(patches).chain(inputs)
    }
}

#[derive(Debug, Args)]
pub(crate) struct Check {
    #[command(flatten)]
    pub(crate) study: Study,
    /// Writes the initial state without running: points by material and condition, axis, path and walls, for
    /// `report preview`.
    #[arg(long, value_name = "FILE.mcap")]
    pub(crate) points: Option<PathBuf>,
    /// Prints the plan as JSON, for programs.
    #[arg(long)]
    pub(crate) json: bool,
}

#[derive(Debug, Args)]
pub(crate) struct Run {
    #[command(flatten)]
    pub(crate) study: Study,
    /// The artefact to write; its record is written beside it as NAME.run.json.
    #[arg(long, value_name = "FILE.mcap")]
    pub(crate) out: PathBuf,
    /// Threads; the result is the same for any number [default: all cores].
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
    pub(crate) threads: Option<u16>,
    /// Continues from FILE.mcap.checkpoint, to the same bytes as an uninterrupted run.
    #[arg(long)]
    pub(crate) resume: bool,
    /// Wall time between two checkpoints [default: depends on the tool, mostly 60].
    #[arg(long, value_name = "SECONDS", value_parser = seconds)]
    pub(crate) checkpoint_s: Option<Duration>,
    /// How progress is shown.
    #[arg(long, value_enum, default_value_t = Style::Auto)]
    pub(crate) progress: Style,
    /// Prints only warnings and errors.
    #[arg(short, long, conflicts_with = "verbose")]
    pub(crate) quiet: bool,
    /// Prints hashes and checkpoints as well.
    #[arg(short, long, action = ArgAction::SetTrue)]
    pub(crate) verbose: bool,
}

fn seconds(text: &str) -> Result<Duration, String> {
    let wrong = || format!("'{text}' is no time in seconds, for example 60");
    let seconds: f64 = text.parse().map_err(|_| wrong())?;
    Duration::try_from_secs_f64(seconds).map_err(|_| wrong())
}

impl Run {
    pub(crate) fn level(&self) -> Level {
        match (self.quiet, self.verbose) {
            (true, _) => Level::Quiet,
            (_, true) => Level::Verbose,
            _ => Level::Normal,
        }
    }
}

/// Reads the command line of a tool.
pub(crate) fn parse<T: Tool>(
    words: impl IntoIterator<Item = OsString>,
) -> Result<Line, clap::Error> {
    Line::from_arg_matches(&line::<T>().try_get_matches_from(words)?)
}

/// What the command line of a tool holds.
pub(crate) fn line<T: Tool>() -> clap::Command {
    let example: Vec<String> = T::EXAMPLE
        .lines()
        .map(|line| format!("  {}", runnable(T::NAME, line.trim())))
        .collect();
    let after = format!(
        "Example, from the repository root:\n{}\n\nExit codes: 0 done, 1 failed, 2 usage or invalid scene, \
         3 done with warnings that matter, 130 interrupted.",
        example.join("\n")
    );
    Line::command()
        .name(T::NAME)
        .version(T::VERSION)
        // A wrapped command could not be copied.
        .term_width(0)
        .about(T::ABOUT)
        .after_help(after.clone())
        .mut_subcommand("run", |run| {
            run.after_help(after).mut_arg("inputs", inputs_help::<T>)
        })
        .mut_subcommand("check", |check| check.mut_arg("inputs", inputs_help::<T>))
}

/// A sample command that works from the repository root: `poolsph run ...` through cargo.
fn runnable(name: &str, sample: &str) -> String {
    match sample
        .strip_prefix(name)
        .filter(|rest| rest.starts_with(' '))
    {
        Some(rest) => format!("cargo run --release -p {name} --{rest}"),
        None => sample.to_owned(),
    }
}

fn inputs_help<T: Tool>(arg: clap::Arg) -> clap::Arg {
    if T::INPUTS.is_empty() {
        return arg.hide(true);
    }
    let names = T::INPUTS.iter().map(|input| {
        let need = if input.required {
            ""
        } else {
            ", where the scene needs it"
        };
        format!("{}: {}{need}", input.name, input.what)
    });
    arg.help(format!(
        "An input file by name; {}",
        names.collect::<Vec<_>>().join("; ")
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn samples_are_shown_as_commands_of_the_repository_root() {
        let sample = "poolsph run a.json --out build/a.mcap";
        assert_eq!(
            runnable("poolsph", sample),
            "cargo run --release -p poolsph -- run a.json --out build/a.mcap"
        );
        for already in [
            "cargo run --release -p poolsph -- run a.json",
            "poolsphere run a.json",
        ] {
            assert_eq!(runnable("poolsph", already), already);
        }
    }
}
