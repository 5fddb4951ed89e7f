//! The command line of `sweep`.

use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use clap::{CommandFactory, Parser, Subcommand, ValueEnum};
use run::Failure;
use run::scene::{schema_of, schema_text};

use crate::plan::{KIND, Sweep};
use crate::points::Points;
use crate::{check, here, judge, queue, rules, slurm};

/// Runs a study over swept values, and compares all its points on one page.
#[derive(Debug, Parser)]
#[command(
    name = "sweep",
    version,
    after_help = "Example, from the repository root:\n  \
    target/release/sweep check pipelines/arc-currents/sweep.json\n\n\
    Exit code: 0 all points are made; 3 all are made, and runs warned or points are not comparable; 1 points failed, and the \
    page tells which, or there is no page; 2 the sweep is not sound."
)]
struct Line {
    #[command(subcommand)]
    action: Action,
}

#[derive(Debug, Subcommand)]
enum Action {
    /// Makes all points, and the page that compares them: `make sweep STUDY=name`.
    Run {
        /// The sweep.
        sweep: PathBuf,
        /// What makes the points.
        #[arg(long, value_enum, default_value_t = Engine::Here)]
        engine: Engine,
        /// Threads of each run.
        #[arg(long, default_value_t = 1)]
        threads: usize,
        /// Waits until all submitted jobs have ended.
        #[arg(long)]
        wait: bool,
    },
    /// Reads the sweep and prints what it would run; runs nothing.
    Check {
        /// The sweep.
        sweep: PathBuf,
    },
    /// Makes the page from the results of the last run.
    Page {
        /// The sweep.
        sweep: PathBuf,
    },
    /// Prints the JSON Schema of sweeps.
    Schema,
    /// Writes shell completions and manual pages.
    #[command(hide = true)]
    Manual(manual::Wanted),
}

/// What makes the points.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Engine {
    /// make, on this machine.
    Here,
    /// Slurm: arrays of jobs, by sbatch.
    Slurm,
    /// HyperQueue: one job, by hq.
    Hq,
}

/// The whole program.
#[must_use]
pub fn main() -> ExitCode {
    let line = match Line::try_parse() {
        Ok(line) => line,
        Err(e) => {
            run::say_usage(&e);
            return ExitCode::from(u8::try_from(e.exit_code()).unwrap_or(2));
        }
    };
    act(&line.action).unwrap_or_else(|failure| run::report_failure("sweep", &failure))
}

fn act(action: &Action) -> Result<ExitCode, Failure> {
    match action {
        Action::Run {
            sweep,
            engine,
            threads,
            wait,
        } => make(&points(sweep)?, *engine, (*threads).max(1), *wait),
        Action::Check { sweep } => {
            say(&plan(&points(sweep)?));
            Ok(ExitCode::SUCCESS)
        }
        Action::Page { sweep } => concluded(&points(sweep)?),
        Action::Schema => {
            say(&schema_text(&schema_of::<Sweep>(KIND)));
            Ok(ExitCode::SUCCESS)
        }
        Action::Manual(wanted) => run::explain(&Line::command(), wanted),
    }
}

fn points(file: &Path) -> Result<Points, Failure> {
    Ok(Points::of(check::read(file, Path::new(""))?, file))
}

fn make(points: &Points, engine: Engine, threads: usize, wait: bool) -> Result<ExitCode, Failure> {
    // An interrupt is for the runs, which write their checkpoints; it is waited for them.
    let interrupted = Arc::new(AtomicBool::new(false));
    for signal in [signal_hook::consts::SIGINT, signal_hook::consts::SIGTERM] {
        let told = signal_hook::flag::register(signal, Arc::clone(&interrupted));
        told.map_err(|e| Failure::Other(format!("no signal can be caught: {e}")))?;
    }
    rules::write(points)?;
    match engine {
        Engine::Here => {
            if here::only_tells() {
                here::run(points, threads)?;
                return Ok(ExitCode::SUCCESS);
            }
            rules::forget(points);
            here::run(points, threads)?;
        }
        Engine::Slurm => {
            rules::forget(points);
            slurm::submit(points, threads, wait)?;
            if !wait {
                return Ok(ExitCode::SUCCESS);
            }
        }
        Engine::Hq => {
            rules::forget(points);
            queue::run(points, threads)?;
        }
    }
    if interrupted.load(Ordering::Relaxed) {
        return Err(Failure::Interrupted { resumable: true });
    }
    concluded(points)
}

fn concluded(points: &Points) -> Result<ExitCode, Failure> {
    Ok(judge::conclude(points)?.code())
}

/// What would be run.
fn plan(points: &Points) -> String {
    let mut text = format!("{} points of {}\n", points.points.len(), points.sweep.study);
    for (number, stage) in points.sweep.stages.iter().enumerate() {
        let runs = points.runs.iter().filter(|run| run.stage == number);
        text += &format!(
            "{:<12} {} runs of {}\n",
            stage.name,
            runs.count(),
            stage.tool.program()
        );
    }
    for run in &points.runs {
        text += &format!("  {}\n", run.out.display());
    }
    text += &format!(
        "page         {}\n",
        points.out.with_added_extension("html").display()
    );
    text
}

#[allow(clippy::print_stdout, reason = "a program talks to its user")]
fn say(words: &str) {
    print!("{}", artefact::shown(words));
}
