//! What a stage holds while it runs: the artefact, the clock, progress, checkpoints, the ledger.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use std::time::{Duration, Instant};

use artefact::{Checkpoint, Frame, Header, Position, Record, Table, Writer, beside};
use serde::Serialize;

use crate::clock::Clock;
use crate::console::Level;
use crate::failure::Failure;
use crate::interrupt::{Expendable, Interrupt};
use crate::ledger::{Ledger, set};
use crate::plan::Plan;
use crate::progress::{Progress, Style};
use crate::watched::Watched;

/// Entry of a checkpoint that belongs to the session.
pub(crate) const LEDGER: &str = "run.ledger";
const POSITION: &str = "run.position";
/// A checkpoint may cost at most this part of the time between two of them.
const CHECKPOINT_SHARE: u32 = 20;

/// How a session is opened.
#[derive(Debug)]
pub(crate) struct Opening<'a> {
    /// When scene and plan were begun.
    pub(crate) began: Instant,
    /// How much of the time since was spent on reading the scene.
    pub(crate) read: Duration,
    pub(crate) out: &'a Path,
    pub(crate) header: Header,
    pub(crate) resume: bool,
    pub(crate) checkpoint_every: Duration,
    pub(crate) style: Style,
    pub(crate) level: Level,
    pub(crate) interrupt: Interrupt,
}

/// What a stage holds while it runs.
#[derive(Debug)]
pub struct Session {
    writer: Writer,
    pub(crate) header: Header,
    clock: Clock,
    pub(crate) ledger: Ledger,
    pub(crate) progress: Progress,
    level: Level,
    pub(crate) interrupt: Interrupt,
    checkpoint: PathBuf,
    pub(crate) every: Duration,
    last: Instant,
    restored: Option<Checkpoint>,
    /// What stages of a trial keep of memory.
    pub(crate) watched: Option<Watched>,
}

impl Session {
    /// A silent session without a command line: for tests of a stage as a library.
    ///
    /// # Errors
    /// When the artefact cannot be created.
    pub fn quiet(out: &Path, header: Header) -> Result<Self, Failure> {
        Self::open(Opening {
            began: Instant::now(),
            read: Duration::ZERO,
            out,
            header,
            resume: false,
            checkpoint_every: Duration::from_secs(60),
            style: Style::None,
            level: Level::Quiet,
            interrupt: Interrupt::default(),
        })
    }

    pub(crate) fn open(opening: Opening<'_>) -> Result<Self, Failure> {
        let checkpoint = beside(opening.out, ".checkpoint");
        let mut ledger = Ledger::default();
        let mut clock = Clock::since(opening.began);
        clock.add("scene", opening.read);
        clock.add("plan", opening.began.elapsed().saturating_sub(opening.read));
        let (writer, restored) = if opening.resume {
            let restored = Checkpoint::read(&checkpoint, &opening.header)?;
            let position: Position = restored.json(POSITION)?;
            let writer = Writer::resume(opening.out, &opening.header, &position)?;
            ledger = restored.json(LEDGER)?;
            clock.take_up(&ledger.stages);
            ledger.resumed += 1;
            (writer, Some(restored))
        } else {
            let writer = Writer::create(opening.out, &opening.header)?;
            remove(&checkpoint)?;
            (writer, None)
        };
        Ok(Self {
            writer,
            header: opening.header,
            clock,
            ledger,
            progress: Progress::new(opening.style),
            level: opening.level,
            interrupt: opening.interrupt,
            checkpoint,
            every: opening.checkpoint_every,
            last: Instant::now(),
            restored,
            watched: None,
        })
    }

    /// Enters the plan in the ledger; a run that is taken up has it there already.
    pub(crate) fn planned(&mut self, plan: &Plan) {
        if self.ledger.resumed > 0 {
            return;
        }
        plan.memory
            .iter()
            .for_each(|m| self.ledger.memory(&m.name, m.bytes));
        plan.limits
            .iter()
            .for_each(|l| set(&mut self.ledger.limits, &l.name, l.value, &l.unit));
        plan.left_out
            .iter()
            .for_each(|l| self.ledger.left_out(&l.name, &l.why));
        self.ledger.notes.extend(plan.notes.iter().cloned());
    }

    /// Writes a frame of particles or points at simulated time `time_s`.
    ///
    /// # Errors
    /// As [`Writer::frame`]: a value that is not finite, other columns than before, the disk.
    pub fn frame(&mut self, channel: &str, time_s: f64, frame: &Frame) -> Result<(), Failure> {
        let start = Instant::now();
        let done = self.writer.frame(channel, time_s, frame);
        self.clock.add("write", start.elapsed());
        Ok(done?)
    }

    /// Writes a table or grid.
    ///
    /// # Errors
    /// As [`Writer::table`].
    pub fn table(&mut self, channel: &str, time_s: f64, table: &Table) -> Result<(), Failure> {
        let start = Instant::now();
        let done = self.writer.table(channel, time_s, table);
        self.clock.add("write", start.elapsed());
        Ok(done?)
    }

    /// Writes named scalars.
    ///
    /// # Errors
    /// As [`Writer::record`].
    pub fn record(&mut self, channel: &str, time_s: f64, record: &Record) -> Result<(), Failure> {
        let start = Instant::now();
        let done = self.writer.record(channel, time_s, record);
        self.clock.add("write", start.elapsed());
        Ok(done?)
    }

    /// Writes any value under a JSON Schema of its own: `("poolsph.source.v1", SCHEMA_TEXT)`.
    ///
    /// # Errors
    /// As [`Writer::json`].
    pub fn json<T: Serialize>(
        &mut self,
        channel: &str,
        time_s: f64,
        schema: (&str, &str),
        value: &T,
    ) -> Result<(), Failure> {
        let start = Instant::now();
        let done = self.writer.json(channel, time_s, schema, value);
        self.clock.add("write", start.elapsed());
        Ok(done?)
    }

    /// Does `work` and adds its wall time to the stage `name`.
    pub fn timed<R>(&mut self, name: &'static str, work: impl FnOnce() -> R) -> R {
        let before = Watched::before(self.watched.as_ref());
        let start = Instant::now();
        let done = work();
        self.clock.add(name, start.elapsed());
        if let (Some(watched), Some(before)) = (&mut self.watched, before) {
            watched.add(name, before);
        }
        done
    }

    /// Shows that `done` of `total` units (steps, sweeps) are done, and notes `done` as the steps
    /// of the run. `status` gives name, value, unit of each number in the status row; it is only
    /// called when a row is due.
    pub fn progress(
        &mut self,
        done: u64,
        total: u64,
        status: impl FnOnce() -> Vec<(&'static str, f64, &'static str)>,
    ) {
        self.ledger.steps = done;
        self.progress.show(done, total, status);
    }

    /// Call after each step (or sweep). Writes a checkpoint when one is due or the user has
    /// interrupted the run: `save` puts everything that the rest of the run depends on.
    ///
    /// # Errors
    /// [`Failure::Interrupted`] after the checkpoint of an interrupted run: hand it on with `?`.
    pub fn keep(
        &mut self,
        save: impl FnOnce(&mut Checkpoint) -> artefact::Result<()>,
    ) -> Result<(), Failure> {
        let interrupted = self.interrupted();
        if !interrupted && self.last.elapsed() < self.every {
            return Ok(());
        }
        let start = Instant::now();
        self.write_checkpoint(save)?;
        let cost = start.elapsed();
        self.clock.add("checkpoint", cost);
        self.every = self.every.max(cost * CHECKPOINT_SHARE);
        self.last = Instant::now();
        if interrupted {
            Err(Failure::Interrupted { resumable: true })
        } else {
            Ok(())
        }
    }

    fn write_checkpoint(
        &mut self,
        save: impl FnOnce(&mut Checkpoint) -> artefact::Result<()>,
    ) -> Result<(), Failure> {
        let mut checkpoint = Checkpoint::new(&self.header);
        save(&mut checkpoint)?;
        checkpoint.put_json(POSITION, &self.writer.position()?)?;
        checkpoint.put_json(LEDGER, &self.ledger())?;
        checkpoint.write(&self.checkpoint)?;
        if self.level == Level::Verbose {
            self.progress.say(&format!(
                "checkpoint {} at {} steps",
                self.checkpoint.display(),
                self.ledger.steps
            ));
        }
        Ok(())
    }

    /// The checkpoint that `--resume` takes up, once; `None` in a run from the start.
    pub fn restored(&mut self) -> Option<Checkpoint> {
        self.restored.take()
    }

    /// Whether the user wants the run to stop. A stage without checkpoints returns
    /// [`Session::stopped`] then; one with them calls [`Session::keep`], which does it all.
    #[must_use]
    pub fn interrupted(&self) -> bool {
        self.interrupt.wanted()
    }

    /// Set as soon as the user wants the run to stop: for loops that last long, which end then. The
    /// stage calls [`Session::stopped`] after them.
    #[must_use]
    pub fn interrupt(&self) -> Arc<AtomicBool> {
        self.interrupt.flag()
    }

    /// While the value is kept there is nothing that a checkpoint could hold: a run that is
    /// interrupted and does not stop by itself within a second, in factors of a large matrix say,
    /// is ended where it stands, with the artefact as after a crash and without a record.
    #[must_use]
    pub fn expendable(&self) -> Expendable {
        self.interrupt.expendable(&self.header.tool)
    }

    /// Ends an interrupted run that keeps no checkpoint.
    ///
    /// # Errors
    /// [`Failure::Interrupted`] if the user wants the run to stop.
    pub fn stopped(&self) -> Result<(), Failure> {
        if self.interrupted() {
            Err(Failure::Interrupted { resumable: false })
        } else {
            Ok(())
        }
    }

    /// Says and records what a reader of the result should know; the exit code stays 0.
    pub fn note(&mut self, text: impl Into<String>) {
        let text = text.into();
        if self.level >= Level::Normal {
            self.progress.say(&format!("note: {text}"));
        }
        self.ledger.notes.push(text);
    }

    /// Says and records a warning that matters (not converged, a limit clipped): the outcome
    /// becomes `warned` and the exit code 3. A warning said before is not said again.
    pub fn warn(&mut self, text: impl Into<String>) {
        let text = text.into();
        if !self.ledger.warnings.contains(&text) {
            if self.watched.is_none() {
                self.progress.say(&format!("warning: {text}"));
            }
            self.ledger.warnings.push(text);
        }
    }

    /// Records a stability limit: the smallest met, say. The same name replaces the value.
    pub fn limit(&mut self, name: &str, value: f64, unit: &str) {
        set(&mut self.ledger.limits, name, value, unit);
    }

    /// Records a conserved total for the closing block: `("energy_balance", "1", 1e-4)`.
    pub fn closing(&mut self, name: &str, unit: &str, value: f64) {
        set(&mut self.ledger.closing, name, value, unit);
    }

    /// Adds a point to a history, for example `("residual_energy", "1", sweep, value)`: `at` is
    /// the step, sweep or time.
    pub fn history(&mut self, name: &str, unit: &str, at: f64, value: f64) {
        self.ledger.history(name, unit, at, value);
    }

    /// Records the memory of a column, table or stage \[byte\].
    pub fn memory(&mut self, name: &str, bytes: u64) {
        self.ledger.memory(name, bytes);
    }

    /// Records physics that is not computed, and why.
    pub fn left_out(&mut self, name: &str, why: &str) {
        self.ledger.left_out(name, why);
    }

    /// Records that a step was divided to stay below a limit: once for every step that was.
    pub fn substepped(&mut self) {
        self.ledger.divided += 1;
    }

    /// Records the number of steps, if it is not the `done` of [`Session::progress`].
    pub fn steps(&mut self, steps: u64) {
        self.ledger.steps = steps;
    }

    /// Header of the artefact: scene, inputs, hashes.
    #[must_use]
    pub fn header(&self) -> &Header {
        &self.header
    }

    /// The ledger as of now.
    pub(crate) fn ledger(&self) -> Ledger {
        Ledger {
            stages: self.clock.stages(),
            earlier_s: self.ledger.earlier_s + self.clock.elapsed_s(),
            ..self.ledger.clone()
        }
    }

    /// Gives the artefact its name and removes the checkpoint.
    ///
    /// # Errors
    /// When the disk refuses.
    pub fn finish(self) -> Result<(), Failure> {
        self.end(Ok(())).1
    }

    /// Ends the session as the stage ended; gives the ledger with all times.
    pub(crate) fn end(self, ended: Result<(), Failure>) -> (Ledger, Result<(), Failure>) {
        self.progress.end();
        let start = Instant::now();
        let mut ledger = self.ledger();
        let Self {
            writer,
            checkpoint,
            mut clock,
            ..
        } = self;
        let ended = ended
            .and_then(|()| Ok(writer.finish()?))
            .and_then(|()| remove(&checkpoint));
        clock.add("write", start.elapsed());
        ledger.earlier_s += start.elapsed().as_secs_f64();
        ledger.stages = clock.stages();
        (ledger, ended)
    }
}

fn remove(path: &Path) -> Result<(), Failure> {
    match std::fs::remove_file(path) {
        Err(e) if e.kind() != std::io::ErrorKind::NotFound => Err(Failure::Io {
            path: path.to_owned(),
            action: "remove",
            source: e,
        }),
        _ => Ok(()),
    }
}
