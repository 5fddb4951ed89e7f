//! From the command line to the exit code.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;
use std::process::ExitCode;
use std::time::{Duration, Instant};

use artefact::{Header, beside};

use crate::awake::Awake;
use crate::command::{Action, Run, Study, parse};
use crate::console::{Level, data, line};
use crate::failure::Failure;
use crate::inputs::Inputs;
use crate::interrupt::Interrupt;
use crate::leftover::{advised, make_way};
use crate::machine;
use crate::owned::{Form, Owned};
use crate::plan::{Plan, bytes, duration};
use crate::progress::Style;
use crate::record::RunRecord;
use crate::scene::{Loaded, Merged, load, located, schema_of, schema_text};
use crate::session::{Opening, Session};
use crate::tool::{Tool, expected};

/// The whole program of a stage.
#[must_use]
pub fn main<T: Tool>() -> ExitCode {
    let line = match parse::<T>(std::env::args_os()) {
        Ok(line) => line,
        Err(e) => {
            // Help and version go to stdout with code 0, errors to stderr with code 2.
            let _ = e.print();
            return ExitCode::from(u8::try_from(e.exit_code()).unwrap_or(2));
        }
    };
    let done = match line.action {
        Action::Schema => print(&schema_text(&schema_of::<T::Scene>(expected::<T>()))),
        Action::Check(study) => check::<T>(&study),
        Action::Run(run) => run_scene::<T>(run),
    };
    done.unwrap_or_else(|failure| report_failure(T::NAME, &failure))
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

/// A scene that was found good, with its plan.
struct Ready<S> {
    scene: S,
    inputs: Inputs,
    plan: Plan,
    header: Header,
    merged: Merged,
    /// What reading and checking the scene against its schema took.
    read: Duration,
}

fn prepare<T: Tool>(study: &Study) -> Result<Ready<T::Scene>, Failure> {
    let began = Instant::now();
    let schema = schema_of::<T::Scene>(expected::<T>());
    let Loaded {
        scene,
        merged,
        migrated,
    } = load::<T::Scene>(&study.scene, &study.patches, &schema, expected::<T>())?;
    let read = began.elapsed();
    let inputs = Inputs::from_words(&study.inputs, T::INPUTS)?;
    let plan = guarded(|| T::plan(&scene, &inputs)).map_err(|failure| placed(failure, &merged))?;
    let plan = match migrated {
        Some(from) => plan.note(format!(
            "scene of version {from}, read as version {}",
            T::SCENE_VERSION
        )),
        None => plan,
    };
    let header = Header {
        kind: T::ARTEFACT_KIND.to_owned(),
        version: T::ARTEFACT_VERSION,
        tool: T::NAME.to_owned(),
        tool_version: T::VERSION.to_owned(),
        scene: merged.value().clone(),
        inputs: inputs.hashes().clone(),
    };
    Ok(Ready {
        scene,
        inputs,
        plan,
        header,
        merged,
        read,
    })
}

/// Adds file and line to the faults of a scene.
fn placed(failure: Failure, merged: &Merged) -> Failure {
    match failure {
        Failure::Scene(faults) => Failure::Scene(located(faults, merged)),
        other => other,
    }
}

fn check<T: Tool>(study: &Study) -> Result<ExitCode, Failure> {
    let ready = prepare::<T>(study)?;
    // The scene is good whether or not its time can be told.
    let estimate = guarded(|| T::estimate(&ready.scene, &ready.inputs));
    let grows = T::grows(&ready.scene);
    let plan = ready.plan.estimate(estimate.ok().flatten(), grows);
    print(&format!("{}\n{plan}", title::<T>(&study.scene)))
}

fn title<T: Tool>(scene: &Path) -> String {
    format!("{} {}  {}", T::NAME, T::VERSION, scene.display())
}

fn run_scene<T: Tool>(mut run: Run) -> Result<ExitCode, Failure> {
    let (start, began) = (machine::now(), Instant::now());
    let owned = Owned::of(&run.out, Form::Artefact, run.study.reads())?;
    run.out = owned.out().to_owned();
    set_threads(run.threads)?;
    let ready = prepare::<T>(&run.study)?;
    let opened = open::<T>(&run, &ready.header, (began, ready.read));
    let (mut session, told) = opened.map_err(|failure| advised(failure, &run.out))?;
    if run.level() > Level::Quiet {
        head::<T>(&run, &ready);
    }
    session.planned(&ready.plan);
    if let Some(told) = told {
        session.note(told);
    }
    if let Some(tight) = tight(&ready.plan, &run.out) {
        session.note(tight);
    }
    let awake = Awake::keep();
    let ended = guarded(|| T::run(&ready.scene, &ready.inputs, &mut session));
    drop(awake);
    let ended = ended.map_err(|failure| placed(failure, &ready.merged));
    let (ledger, ended) = session.end(ended);
    let ended = ended.map_err(|failure| advised(failure, &run.out));
    let record = RunRecord::new(
        &run.out,
        &ready.header,
        start,
        ledger,
        ended.as_ref().copied(),
    );
    let written = record.write();
    ended?;
    written?;
    if run.level() > Level::Quiet {
        closing(&record, &run.out);
    }
    Ok(ExitCode::from(record.exit_code()))
}

/// A panic is a fault of ours; the run still ends with a record and exit code 1.
fn guarded<R>(work: impl FnOnce() -> Result<R, Failure>) -> Result<R, Failure> {
    catch_unwind(AssertUnwindSafe(work)).unwrap_or_else(|panic| {
        let text = panic
            .downcast_ref::<String>()
            .map(String::as_str)
            .or_else(|| panic.downcast_ref::<&str>().copied())
            .unwrap_or("no message");
        Err(Failure::Other(format!("internal error: {text}")))
    })
}

/// The session, and what is to be told of an earlier run to the same place. Told are when the program
/// began and how long it read the scene.
fn open<T: Tool>(
    run: &Run,
    header: &Header,
    (began, read): (Instant, Duration),
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

/// This thread works with the others: a step is hundreds of short parallel loops, and to hand each over
/// to sleeping threads and be woken at its end costs more than many of them.
fn set_threads(threads: Option<u16>) -> Result<(), Failure> {
    let builder = rayon::ThreadPoolBuilder::new().use_current_thread();
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

fn head<T: Tool>(run: &Run, ready: &Ready<T::Scene>) {
    line(&title::<T>(&run.study.scene));
    line(ready.plan.to_string().trim_end());
    line(&format!(
        "  {:<20} {}",
        "threads",
        rayon::current_num_threads()
    ));
    if run.level() == Level::Verbose {
        line(&format!(
            "  {:<20} {}",
            "scene",
            ready.header.scene_sha256()
        ));
        for (name, hash) in ready.inputs.hashes() {
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
