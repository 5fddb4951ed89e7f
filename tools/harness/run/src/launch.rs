//! From the command line to the exit code.

use std::path::Path;
use std::process::ExitCode;
use std::time::{Duration, Instant};

use artefact::{Header, beside};

use crate::awake::Awake;
use crate::checked::check;
use crate::command::{self, Action, Check, Run, parse};
use crate::console::{Level, data, line};
use crate::failure::Failure;
use crate::interrupt::Interrupt;
use crate::leftover::{advised, make_way};
use crate::look;
use crate::machine;
use crate::owned::{Form, Owned};
use crate::plan::{Plan, bytes, duration};
use crate::progress::Style;
use crate::ready::{Planned, guarded, placed, planned, read};
use crate::record::RunRecord;
use crate::scene::{named, schema_of, schema_text};
use crate::session::{Opening, Session};
use crate::tool::{Tool, expected};

/// Exit code where not all could be judged.
const WARNED: u8 = 3;

/// The whole program of a stage.
#[must_use]
pub fn main<T: Tool>() -> ExitCode {
    let line = match parse::<T>(std::env::args_os()) {
        Ok(line) => line,
        Err(e) => {
            // Help and version go to stdout with code 0, errors to stderr with code 2.
            say_usage(&e);
            return ExitCode::from(u8::try_from(e.exit_code()).unwrap_or(2));
        }
    };
    let done = match line.action {
        Action::Schema => print(&schema_text(&named(schema_of::<T::Scene>(expected::<T>())))),
        Action::Check(check) => check_scene::<T>(&check),
        Action::Run(run) => run_scene::<T>(run),
        Action::Manual(wanted) => explain(&command::line::<T>(), &wanted),
    };
    done.unwrap_or_else(|failure| report_failure(T::NAME, &failure))
}

/// Says what is wrong with a command line, or prints the help that was asked for.
pub fn say_usage(e: &clap::Error) {
    if e.use_stderr() {
        line(e.render().to_string().trim_end());
    } else {
        // A closed stdout wants no help.
        let _ = e.print();
    }
}

/// Says on stderr why there is no result, and gives the exit code that goes with it.
#[must_use]
pub fn report_failure(program: &str, failure: &Failure) -> ExitCode {
    line(&format!("{program}: {failure}"));
    ExitCode::from(failure.exit_code())
}

fn print(text: &str) -> Result<ExitCode, Failure> {
    data(text)
        .map(|()| ExitCode::SUCCESS)
        .map_err(|source| Failure::Io {
            path: "stdout".into(),
            action: "write",
            source,
        })
}

fn check_scene<T: Tool>(wanted: &Check) -> Result<ExitCode, Failure> {
    let study = &wanted.study;
    if let Some(out) = &wanted.points {
        // Ahead of the plan, which may want inputs that are not made yet.
        let points = look::write::<T>(study, out)?;
        line(&format!(
            "{points} points as a run would begin: {}",
            out.display()
        ));
    }
    let (plan, judged) = check::<T>(study)?;
    let told = if wanted.json {
        format!("{:#}\n", plan.json())
    } else {
        format!("{}\n{plan}", title::<T>(&study.scene))
    };
    print(&told)?;
    Ok(ExitCode::from(if judged { 0 } else { WARNED }))
}

/// Writes completions and pages about a program.
///
/// # Errors
/// When a file cannot be written.
pub fn explain(program: &clap::Command, wanted: &manual::Wanted) -> Result<ExitCode, Failure> {
    let written = manual::write(program, &wanted.into);
    written
        .map(|()| ExitCode::SUCCESS)
        .map_err(|source| Failure::Io {
            path: wanted.into.clone(),
            action: "write into",
            source,
        })
}

fn title<T: Tool>(scene: &Path) -> String {
    format!("{} {}  {}", T::NAME, T::VERSION, scene.display())
}

fn run_scene<T: Tool>(mut run: Run) -> Result<ExitCode, Failure> {
    let (start, began) = (machine::now(), Instant::now());
    let owned = Owned::of(&run.out, Form::Artefact, run.study.reads())?;
    run.out = owned.out().to_owned();
    set_threads(run.threads)?;
    let planned = planned::<T>(&run.study, read::<T>(&run.study)?)?;
    let opened = open::<T>(&run, &planned.header, began, planned.read);
    let (mut session, told) = opened.map_err(|failure| advised(failure, &run.out))?;
    if run.level() > Level::Quiet {
        head::<T>(&run, &planned.plan, &planned.header);
    }
    let Planned {
        ready,
        plan,
        header,
        merged,
        ..
    } = planned;
    session.planned(&plan);
    if let Some(told) = told {
        session.note(told);
    }
    if let Some(tight) = tight(&plan, &run.out) {
        session.note(tight);
    }
    let awake = Awake::keep();
    let ended = guarded(|| T::run(ready, &mut session));
    drop(awake);
    let ended = ended.map_err(|failure| placed(failure, &merged));
    let (ledger, ended) = session.end(ended);
    let ended = ended.map_err(|failure| advised(failure, &run.out));
    let record = RunRecord::new(&run.out, &header, start, ledger, ended.as_ref().copied());
    let written = record.write();
    ended?;
    written?;
    if run.level() > Level::Quiet {
        closing(&record, &run.out);
    }
    Ok(ExitCode::from(record.exit_code()))
}

/// The session, and what is to be told of an earlier run to the same place. Told are when the program
/// began and how long it read the scene.
fn open<T: Tool>(
    run: &Run,
    header: &Header,
    began: Instant,
    read: Duration,
) -> Result<(Session, Option<String>), Failure> {
    let checkpoint = beside(&run.out, ".checkpoint");
    if run.resume && !checkpoint.exists() {
        let what = format!(
            "--resume: there is no {}; run without --resume",
            checkpoint.display()
        );
        return Err(Failure::Usage(what));
    }
    let told = if run.resume {
        None
    } else {
        make_way(&run.out, header)?
    };
    let session = Session::open(Opening {
        began,
        read,
        out: &run.out,
        header: header.clone(),
        resume: run.resume,
        checkpoint_every: run.checkpoint_s.unwrap_or_else(|| {
            Duration::try_from_secs_f64(T::CHECKPOINT_S).unwrap_or(Duration::MAX)
        }),
        style: if run.quiet { Style::None } else { run.progress },
        level: run.level(),
        interrupt: Interrupt::listen()?,
    })?;
    Ok((session, told))
}

/// What to say where the disk has less room than the output may take.
fn tight(plan: &Plan, out: &Path) -> Option<String> {
    let (wanted, free) = (plan.output_bytes(), artefact::free_bytes(out)?);
    (wanted > free).then(|| {
        let (wanted, free) = (bytes(wanted), bytes(free));
        format!("the output may take {wanted} before it is compressed, the disk has {free} free")
    })
}

/// More threads than these for each that the machine runs at once only wait for each other.
const THREADS_PER_CORE: usize = 8;

/// This thread works with the others: a step is hundreds of short parallel loops, and to hand each over
/// to sleeping threads and be woken at its end costs more than many of them.
fn set_threads(threads: Option<u16>) -> Result<(), Failure> {
    let builder = rayon::ThreadPoolBuilder::new().use_current_thread();
    if let Some(threads) = threads {
        let cores = machine::cores();
        let most = THREADS_PER_CORE * cores;
        if usize::from(threads) > most {
            return Err(Failure::Usage(format!(
                "--threads {threads}: this machine runs {cores} at once: at most {most}, best {cores}"
            )));
        }
    }
    let Some(threads) = threads else {
        // Only where the process already has its threads does this fail, and then they serve.
        builder.build_global().ok();
        return Ok(());
    };
    builder
        .num_threads(usize::from(threads))
        .build_global()
        .map_err(|e| Failure::Other(format!("--threads {threads}: {e}")))
}

fn head<T: Tool>(run: &Run, plan: &Plan, header: &Header) {
    line(&title::<T>(&run.study.scene));
    line(plan.to_string().trim_end());
    line(&format!(
        "  {:<20} {}",
        "threads",
        rayon::current_num_threads()
    ));
    if run.level() == Level::Verbose {
        line(&format!("  {:<20} {}", "scene", header.scene_sha256()));
        for (name, hash) in &header.inputs {
            line(&format!("  {:<20} {name} {hash}", "input"));
        }
    }
    if run.resume {
        line(&format!(
            "  {:<20} {}",
            "resumes",
            beside(&run.out, ".checkpoint").display()
        ));
    }
}

fn closing(record: &RunRecord, out: &Path) {
    for total in &record.closing {
        line(&format!(
            "  {:<32} {:>14.6e} {}",
            total.name, total.value, total.unit
        ));
    }
    for stage in &record.stages {
        line(&format!(
            "  {:<32} {:>14} {:>5.1} %",
            stage.name,
            duration(stage.wall_s),
            100.0 * stage.share
        ));
    }
    let warnings = match record.warnings.len() {
        0 => String::new(),
        1 => " with 1 warning".to_owned(),
        n => format!(" with {n} warnings"),
    };
    line(&format!(
        "done{warnings} in {}: {}",
        duration(record.wall_s),
        out.display()
    ));
}
