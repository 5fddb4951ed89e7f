//! The command line of `report`.

use std::path::PathBuf;
use std::process::ExitCode;

use clap::{CommandFactory, Parser, Subcommand};
use run::{Failure, Form, Owned};

use crate::files::{
    CalculixFiles, DropFiles, FieldFiles, Folders, GasFiles, HeatFiles, JetFiles, LiveFiles,
    PageFiles, PairFiles, PassesFiles, PreviewFiles, SweepFiles, perhaps_named,
};
use crate::measure::heat_affected::AC1;
use crate::{figures, handover, index, page, probes, validate};

/// Pictures, plots and tables from artefacts and records, as self-contained HTML pages.
#[derive(Debug, Parser)]
#[command(
    name = "report",
    version,
    after_help = "Example, from the repository root:\n  \
    target/release/report page --study gmaw-quick --out build/gmaw-quick/report.html \
    --pool build/gmaw-quick/pool.mcap"
)]
struct Line {
    #[command(subcommand)]
    action: Action,
}

#[derive(Debug, Subcommand)]
enum Action {
    /// One page about a study; it shows all inputs that are given.
    Page(PageFiles),
    /// One page about an arc and a pool that were computed in turns, each from the result of the other.
    #[command(after_help = PASSES)]
    Passes(PassesFiles),
    /// One page about a study of heat conduction, of one run or of several.
    #[command(after_help = HEAT)]
    Heat(HeatFiles),
    /// One page about water jets that hit solids, with films, of one run or of several.
    #[command(after_help = JET)]
    Jet(JetFiles),
    /// One page about electric and magnetic fields, of one run or of several.
    #[command(after_help = FIELD)]
    Field(FieldFiles),
    /// One page about drops that move or are at rest, of one run or of several.
    #[command(after_help = DROP)]
    Drop(DropFiles),
    /// One page about tables of gases: curves, composition, published values, uncertain inputs.
    #[command(after_help = GAS)]
    Gas(GasFiles),
    /// One page about the points of a sweep; `sweep` calls it.
    Sweep(SweepFiles),
    /// One page that compares two runs: what was changed, numbers, pictures, curves.
    #[command(after_help = COMPARE)]
    Compare(PairFiles),
    /// One page about the initial state of a run, from the points that `TOOL check --points` writes.
    #[command(after_help = PREVIEW)]
    Preview(PreviewFiles),
    /// One page about a study that is running, which renews itself.
    #[command(after_help = LIVE)]
    Live(LiveFiles),
    /// One page about all evidence: exact cases, extreme cases, speed, studies.
    Index(Folders),
    /// Prints the measures of a weld's bead as JSON, with their units and ranges along the weld.
    Figures {
        /// Particle frames of the weld.
        #[arg(long)]
        pool: PathBuf,
    },
    /// Prints the double ellipsoid (Goldak) that warms the metal around a pool as the weld does, a heat source for other programs.
    #[command(after_help = GOLDAK)]
    Goldak {
        /// Particle frames of the weld.
        pool: PathBuf,
        /// Take the half axes of the pool itself, without a fit.
        #[arg(long)]
        melt: bool,
    },
    /// Writes the temperatures of a run at the nodes of a mesh, as steps of CalculiX.
    #[command(after_help = CALCULIX)]
    Calculix(CalculixFiles),
    /// Prints results of thermocouples as CSV: peaks, cooling times, the heat-affected zone; or their curves.
    Probes {
        /// Particle frames with probes, or points with monitors.
        file: PathBuf,
        /// The curves instead of the results.
        #[arg(long)]
        curves: bool,
        /// Isotherm of the heat-affected zone, in K.
        #[arg(long, default_value_t = AC1)]
        isotherm_k: f64,
    },
    /// Compares a weld or arcs with published values; exit code 1 where a tolerance is missed.
    Validate {
        /// Particle frames of the weld.
        #[arg(long)]
        pool: Option<PathBuf>,
        /// Arc source; if there are several, each with its name in the targets.
        #[arg(long, value_name = "[NAME=]FILE", value_parser = perhaps_named("arc"))]
        arc: Vec<(String, PathBuf)>,
        /// Published values.
        #[arg(long)]
        targets: PathBuf,
        /// Numerical bands of the study's figures, as `make certify` writes them.
        #[arg(long)]
        certificate: Option<PathBuf>,
    },
    /// Writes shell completions and manual pages.
    #[command(hide = true)]
    Manual(manual::Wanted),
}

const PASSES: &str = "Example, from the repository root:\n  \
    target/release/report passes --study gmaw-two-pass --out build/gmaw-two-pass/report.html \\\n    \
    --arc first=build/gmaw-300a/arc.mcap --arc second=build/gmaw-two-pass/arc.mcap";

const HEAT: &str = "Example, from the repository root:\n  \
    target/release/report heat --study fgm-shock --out build/fgm-shock/report.html \\\n    \
    --frames 1023=build/fgm-shock/disc-1023.mcap --frames 1073=build/fgm-shock/disc-1073.mcap";

const JET: &str = "Example, from the repository root:\n  \
    target/release/report jet --study jet-tofu-5 --out build/jet-tofu-5/report.html \\\n    \
    --frames 5=build/jet-tofu-5/jet.mcap";

const FIELD: &str = "Example, from the repository root:\n  \
    target/release/report field --study levitation-field --out build/levitation-field/report.html \\\n    \
    --fields drop=build/levitation-field/drop.mcap --exact drop=build/levitation-field/exact.json";

const DROP: &str = "Example, from the repository root:\n  \
    target/release/report drop --study drop-oscillation --out build/drop-oscillation/report.html \\\n    \
    --drop water=build/drop-oscillation/drop.mcap";

const COMPARE: &str = "Example, from the repository root:\n  \
    target/release/report compare --a build/gmaw-quick --b build/my-weld --out build/compare/my-weld.html";

const GAS: &str = "Example, from the repository root:\n  \
    target/release/report gas --study gases --out build/gases/report.html \\\n    \
    --table argon=build/gases/argon.mcap --reference argon=pipelines/gases/reference-argon.json";

const GOLDAK: &str = "What is printed is an entry of the key 'torches'. The conductivity and the heat capacity are means of the metal's own up to \
    its melting point, and closed faces of the plate let no heat through. Exit code 3 where the fit is off by more than 5 % of the rise to \
    the melting point. \
    Example, from the repository root:\n  \
    target/release/report goldak build/gmaw-quick/pool.mcap";

const CALCULIX: &str = "Steps are static, of the length of time between frames; what else a step needs (supports, materials) stands before them \
    in the input of the mesh. Exit code 3 where nodes lie in no metal. Example, from the repository root:\n  \
    target/release/report calculix build/gmaw-quick/pool.mcap --mesh plate.inp --unit-m 0.001 --out build/plate";

const LIVE: &str = "It ends when nothing has been written in the folder for a minute. Example, from the repository root:\n  \
    target/release/report live build/gmaw-quick --out build/gmaw-quick/live.html";

const PREVIEW: &str = "Example, from the repository root:\n  \
    target/release/poolsph check pipelines/gmaw-300a/pool.json --points build/look.mcap\n  \
    target/release/report preview pool=build/look.mcap --out build/look.html";

/// The whole program.
#[must_use]
pub fn main() -> ExitCode {
    let line = match Line::try_parse() {
        Ok(line) => line,
        Err(e) => {
            // Help and version go to stdout with code 0, errors to stderr with code 2.
            run::say_usage(&e);
            return ExitCode::from(u8::try_from(e.exit_code()).unwrap_or(2));
        }
    };
    report(line.action).unwrap_or_else(|failure| run::report_failure("report", &failure))
}

/// Owns the page while it is made, and writes it.
fn report(mut action: Action) -> Result<ExitCode, Failure> {
    complete(&action)?;
    let reads = action.reads();
    let reads = reads
        .iter()
        .map(|(what, path)| (what.clone(), path.as_path()));
    let Some(out) = action.out() else {
        return write(&action);
    };
    let owned = Owned::of(out, Form::Page, reads)?;
    owned.out().clone_into(out);
    write(&action)
}

impl Action {
    /// The page to write.
    fn out(&mut self) -> Option<&mut PathBuf> {
        match self {
            Self::Page(f) => Some(&mut f.out),
            Self::Passes(f) => Some(&mut f.out),
            Self::Heat(f) => Some(&mut f.out),
            Self::Jet(f) => Some(&mut f.out),
            Self::Field(f) => Some(&mut f.out),
            Self::Drop(f) => Some(&mut f.out),
            Self::Gas(f) => Some(&mut f.out),
            Self::Sweep(f) => Some(&mut f.out),
            Self::Compare(f) => Some(&mut f.out),
            Self::Preview(f) => Some(&mut f.out),
            Self::Live(f) => Some(&mut f.out),
            Self::Index(f) => Some(&mut f.out),
            Self::Validate { .. }
            | Self::Figures { .. }
            | Self::Goldak { .. }
            | Self::Calculix(_)
            | Self::Probes { .. }
            | Self::Manual(_) => None,
        }
    }

    /// Every file that a page is made from, with what it is.
    fn reads(&self) -> Vec<(String, PathBuf)> {
        let named = |lists: &[&[(String, PathBuf)]]| {
            let files = lists.iter().flat_map(|list| list.iter().cloned());
            files
                .flat_map(|(name, path)| with_record(&name, path))
                .collect()
        };
        match self {
            Self::Page(f) => {
                let more = [
                    ("pool", &f.pool),
                    ("targets", &f.targets),
                    ("certificate", &f.certificate),
                ];
                let more = more
                    .into_iter()
                    .filter_map(|(name, path)| Some((name.to_owned(), path.clone()?)));
                let more: Vec<_> = more.collect();
                named(&[&f.arc, &f.mean, &more])
            }
            Self::Passes(f) => named(&[&f.arc, &f.pool, &f.mean]),
            Self::Heat(f) => named(&[&f.frames, &certificate(f.certificate.as_ref())]),
            Self::Jet(f) => named(&[&f.frames, &certificate(f.certificate.as_ref())]),
            Self::Field(f) => named(&[&f.fields, &f.exact]),
            Self::Drop(f) => named(&[&f.drops, &certificate(f.certificate.as_ref())]),
            Self::Gas(f) => named(&[&f.table, &f.reference, &f.variant]),
            Self::Sweep(f) => vec![("the points".to_owned(), f.points.clone())],
            Self::Preview(f) => named(&[&f.looks]),
            Self::Index(f) => f.read(),
            Self::Compare(_)
            | Self::Live(_)
            | Self::Validate { .. }
            | Self::Figures { .. }
            | Self::Goldak { .. }
            | Self::Calculix(_)
            | Self::Probes { .. }
            | Self::Manual(_) => Vec::new(),
        }
    }
}

/// The certificate of a study, where one is given.
fn certificate(path: Option<&PathBuf>) -> Vec<(String, PathBuf)> {
    path.map(|path| ("certificate".to_owned(), path.clone()))
        .into_iter()
        .collect()
}

/// A file, and the record beside it.
fn with_record(name: &str, path: PathBuf) -> [(String, PathBuf); 2] {
    let record = path.with_extension("run.json");
    let what = |file: &str| format!("{file} of '{name}'");
    [(what("the file"), path), (what("the record"), record)]
}

/// Refuses command lines that name nothing to report on.
fn complete(action: &Action) -> Result<(), Failure> {
    let (wanted, given) = match action {
        Action::Page(f) => {
            let given = !f.arc.is_empty() || f.pool.is_some() || !f.mean.is_empty();
            ("--arc, --pool or --mean", given)
        }
        Action::Passes(f) => {
            let given = !f.arc.is_empty() || !f.pool.is_empty() || !f.mean.is_empty();
            ("--arc, --pool or --mean", given)
        }
        Action::Index(f) => {
            let folders = [
                &f.verify,
                &f.stability,
                &f.bench,
                &f.certify,
                &f.faults,
                &f.studies,
            ];
            let given = folders.iter().any(|folder| folder.is_some());
            (
                "--verify, --stability, --bench, --certify, --faults or --studies",
                given,
            )
        }
        Action::Validate { pool, arc, .. } => {
            let given = pool.is_some() || !arc.is_empty();
            ("--pool or --arc", given)
        }
        Action::Figures { .. } => ("--pool", true),
        Action::Goldak { .. } | Action::Calculix(_) => ("FILE", true),
        Action::Probes { .. } => ("FILE", true),
        Action::Heat(_) | Action::Jet(_) => ("--frames", true),
        Action::Field(_) => ("--fields", true),
        Action::Drop(_) => ("--drop", true),
        Action::Gas(_) => ("--table", true),
        Action::Sweep(_) => ("--points", true),
        Action::Compare(_) => ("--a and --b", true),
        Action::Preview(_) => ("FILE.mcap", true),
        Action::Live(_) => ("FOLDER", true),
        Action::Manual(_) => ("--into", true),
    };
    if !given {
        let what = format!("there is nothing to report on: name at least one of {wanted}");
        return Err(Failure::Usage(what));
    }
    Ok(())
}

fn write(action: &Action) -> Result<ExitCode, Failure> {
    match action {
        Action::Page(files) => page::write(files).map(|()| ExitCode::SUCCESS),
        Action::Passes(files) => page::passes::write(files).map(|()| ExitCode::SUCCESS),
        Action::Heat(files) => page::heat::write(files).map(|()| ExitCode::SUCCESS),
        Action::Jet(files) => page::jet::write(files).map(|()| ExitCode::SUCCESS),
        Action::Field(files) => page::field::write(files).map(|()| ExitCode::SUCCESS),
        Action::Drop(files) => page::drop::write(files).map(|()| ExitCode::SUCCESS),
        Action::Gas(files) => page::gas::write(files).map(|()| ExitCode::SUCCESS),
        Action::Sweep(files) => page::sweep::write(files).map(|()| ExitCode::SUCCESS),
        Action::Compare(files) => page::pair::write(files),
        Action::Preview(files) => page::preview::write(files).map(|()| ExitCode::SUCCESS),
        Action::Live(files) => page::live::write(files).map(|()| ExitCode::SUCCESS),
        Action::Index(folders) => index::write(folders).map(|()| ExitCode::SUCCESS),
        Action::Figures { pool } => figures::run(pool),
        Action::Goldak { pool, melt } => handover::goldak::run(pool, *melt),
        Action::Calculix(files) => handover::calculix::run(files),
        Action::Probes {
            file,
            curves,
            isotherm_k,
        } => probes::run(file, *curves, *isotherm_k),
        Action::Validate {
            pool,
            arc,
            targets,
            certificate,
        } => validate::run(pool.as_deref(), arc, targets, certificate.as_deref()),
        Action::Manual(wanted) => run::explain(&Line::command(), wanted),
    }
}
