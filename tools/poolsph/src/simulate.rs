//! A run from the first step to the last: what is written when, and what stops it.

use run::{Failure, Session};
use steps::Figure;
use steps::instants::due;

use crate::assemble::Assembled;
use crate::balance::{Balance, Start, thrown, unclosed};
use crate::frames::{self, SourceNote};
use crate::grains::totals::Totals;
use crate::probes;
use crate::resume;
use crate::scene::{PoolOutput, Scene};
use crate::state::State;
use crate::watch::{bounded, endless, failure, undivided, watch};

/// All numbers of the state are looked at once in so many steps, and before anything is kept.
const WATCH_STEPS: u64 = 20;

/// Runs the scene.
///
/// # Errors
/// Divergence, a table that ends, the disk, the user.
pub fn run(scene: &Scene, run: Assembled, session: &mut Session) -> Result<(), Failure> {
    let mut simulation = Simulation::begin(scene, run, session)?;
    while !simulation.ended() {
        simulation.step(session)?;
    }
    simulation.close(session);
    Ok(())
}

/// A run under way.
struct Simulation<'a> {
    scene: &'a Scene,
    run: Assembled,
    start: Start,
}

impl<'a> Simulation<'a> {
    /// Starts afresh, or where the checkpoint stands.
    fn begin(scene: &'a Scene, mut run: Assembled, session: &mut Session) -> Result<Self, Failure> {
        if let Some(mut checkpoint) = session.restored() {
            let (state, march) = (&mut run.state, &mut run.march);
            let start = resume::restore(&mut checkpoint, state, march, scene.step())?;
            return Ok(Self { scene, run, start });
        }
        let start = Balance::of(&run.state, &run.march.figures()).start();
        if scene.has_metal() {
            frames::plate(&run.plate, session)?;
        }
        let mut simulation = Self { scene, run, start };
        simulation.write(session)?;
        Ok(simulation)
    }

    /// Whether the end has come, or what the run is for.
    fn ended(&self) -> bool {
        let ends = || self.run.march.stages().any(|stage| stage.ends());
        self.run.state.step == self.scene.steps() || ends()
    }

    fn step(&mut self, session: &mut Session) -> Result<(), Failure> {
        let until = self.mark();
        let Assembled { march, state, .. } = &mut self.run;
        let stepped = march
            .step(state, until, |name, work| session.timed(name, work))
            .map_err(|e| failure(e, state.time))?;
        if stepped.divided {
            session.substepped();
        }
        if let Some(limit) = stepped.limit {
            session.limit(&format!("step_{}", limit.name), limit.seconds, "s");
            let step = stepped.dt;
            if let Some(what) = endless(step, limit).or_else(|| undivided(step, limit)) {
                return Err(Failure::Diverged {
                    step: state.step,
                    time_s: state.time,
                    place: format!("the limit of '{}'", limit.name),
                    quantity: "step [s]".to_owned(),
                    what,
                });
            }
        }
        bounded(state, stepped.dt)?;
        if state.step / WATCH_STEPS != (state.step - stepped.stride) / WATCH_STEPS {
            watch(state)?;
        }
        self.write(session)?;
        let (state, march, start) = (&self.run.state, &self.run.march, self.start);
        session.progress(state.step, self.scene.steps(), || {
            status(state, &march.figures())
        });
        session.keep(|checkpoint| resume::save(checkpoint, state, march, start))
    }

    /// The next step at which something is due.
    fn mark(&self) -> u64 {
        let (step, dt) = (self.run.state.step, self.scene.step());
        if !self.run.march.strides().grows() {
            return step + 1;
        }
        self.scene.output.next(step, dt).min(self.scene.steps())
    }

    /// Writes all that is due at the present step.
    fn write(&mut self, session: &mut Session) -> Result<(), Failure> {
        let Assembled { march, state, .. } = &self.run;
        let scene = self.scene;
        let output = &scene.output;
        let is_due = |interval: f64| due(state.step, scene.step(), interval);
        // The state for which the run was made, whatever the interval.
        let last = self.ended();
        let particles = last || is_due(output.particles_interval_s);
        let centre = source(state);
        let pool = output.pool.as_ref().filter(|pool| {
            centre.is_some() && state.time >= pool.from_s - 1e-9 && is_due(pool.interval_s)
        });
        let balance = last || is_due(output.balance_interval());
        if !output.probes.is_empty() && (last || is_due(output.probes_interval())) {
            let readings = probes::record(&output.probes, state);
            session.record(probes::CHANNEL, state.time, &readings)?;
        }
        let grains = state.grains.is_some() && (last || is_due(output.grains_interval()));
        self.write_grains(grains, balance, session)?;
        if last {
            for (channel, frame) in march.stages().filter_map(|stage| stage.leaves(state)) {
                session.frame(channel, state.time, &frame)?;
            }
        }
        if !self.scene.has_metal() || !(particles || grains || pool.is_some() || balance) {
            return Ok(());
        }
        watch(state)?;
        if let Some(note) = centre.filter(|_| particles || grains || pool.is_some()) {
            frames::source(&note, session)?;
        }
        self.write_metal(particles, pool.zip(centre), session)?;
        if balance {
            let Assembled { march, state, .. } = &self.run;
            let figures = march.figures();
            let totals = Balance::of(state, &figures);
            session.record("/balance", state.time, &totals.record(self.start))?;
            for (stage, figure) in figures
                .iter()
                .filter(|(_, f)| !matches!(f.unit, "J" | "kg"))
            {
                let name = format!("{stage}_{}", figure.name);
                session.history(&name, figure.unit, state.time, figure.value);
            }
        }
        Ok(())
    }

    /// Frames of the metal: of all particles, and of those around the source.
    fn write_metal(
        &mut self,
        particles: bool,
        pool: Option<(&PoolOutput, SourceNote)>,
        session: &mut Session,
    ) -> Result<(), Failure> {
        let Assembled { march, state, .. } = &mut self.run;
        let width = self.scene.output.precision;
        if particles || pool.is_some() {
            state.show();
            march.show(state);
        }
        if particles {
            frames::particles(state, width, session)?;
        }
        if let Some((pool, note)) = pool {
            frames::pool(state, pool, width, [note.x_m, note.y_m, note.z_m], session)?;
        }
        Ok(())
    }

    /// Grains and their totals, if there are any.
    fn write_grains(
        &self,
        frame: bool,
        balance: bool,
        session: &mut Session,
    ) -> Result<(), Failure> {
        let state = &self.run.state;
        let (Some(set), Some(scene)) = (&state.grains, &self.scene.grains) else {
            return Ok(());
        };
        if frame {
            let grains = frames::grains(set, self.scene.output.precision);
            session.frame(&columns::channel(set), state.time, &grains)?;
        }
        if balance {
            let totals = Totals::of(set, scene.inertia_factor);
            let figures = self.run.march.figures().into_iter();
            let heats = figures.filter(|(stage, figure)| *stage == "grains" && figure.unit == "J");
            let record = heats.fold(totals.record(state.time), |record, (_, figure)| {
                record.with(figure.name, figure.unit, figure.value)
            });
            session.record("/grains_balance", state.time, &record)?;
        }
        Ok(())
    }

    /// Totals and memory for the record.
    fn close(&self, session: &mut Session) {
        let Assembled { march, state, .. } = &self.run;
        if let (Some(set), Some(grains)) = (&state.grains, &self.scene.grains) {
            let totals = Totals::of(set, grains.inertia_factor);
            for (name, unit, value) in totals.closing() {
                session.closing(name, unit, value);
            }
            let figures = march.figures().into_iter();
            for (_, figure) in figures.filter(|(stage, _)| *stage == "grains") {
                session.closing(figure.name, figure.unit, figure.value);
            }
        }
        if march.strides().grows() {
            let taken = march.strides().taken as f64;
            session.closing("steps_taken", "1", taken);
            session.closing("step_mean", "s", state.time / taken);
        }
        let totals = Balance::of(state, &march.figures());
        if self.scene.has_metal() {
            for (name, unit, value) in totals.closing(self.start) {
                session.closing(name, unit, value);
            }
        }
        if let Some((_, _, closure)) = totals.closure(self.start)
            && let Some(warning) = unclosed(closure)
        {
            session.warn(warning);
        }
        if let Some(warning) = totals.lost().and_then(thrown) {
            session.warn(warning);
        }
        for note in march.stages().flat_map(|stage| stage.notes()) {
            session.note(note);
        }
        let told = march.stages().flat_map(|stage| stage.warnings());
        let doubts = crate::scene::doubts(self.scene).into_iter();
        for warning in told.chain(doubts).chain(self.run.grain_doubts.clone()) {
            session.warn(warning);
        }
        if state.step == self.scene.steps()
            && self.scene.waits()
            && !march.stages().any(|s| s.ends())
        {
            session.warn("not settled: grains still move at the end of the run".to_owned());
        }
        for (name, bytes) in state.memory() {
            session.memory(name, bytes as u64);
        }
        for stage in march.stages().filter(|stage| stage.bytes() > 0) {
            session.memory(stage.name(), stage.bytes() as u64);
        }
    }
}

/// Where the source is, if the scene has one.
fn source(state: &State) -> Option<SourceNote> {
    let place = state.source?;
    let [x_m, y_m, z_m] = place.position;
    Some(SourceNote {
        time_s: state.time,
        x_m,
        y_m,
        z_m,
        phase: place.phase,
        droplet: place.droplets,
    })
}

/// Numbers for the status row.
fn status(
    state: &State,
    figures: &[(&'static str, Figure)],
) -> Vec<(&'static str, f64, &'static str)> {
    let mut row = vec![("time", state.time, "s")];
    if !state.is_empty() {
        row.push(("liquid", state.liquid() as f64, ""));
    }
    let shown = figures.iter().filter(|(_, figure)| {
        !matches!(figure.unit, "J" | "kg") && figure.name != "liquid_particles"
    });
    row.extend(shown.map(|(_, figure)| (figure.name, figure.value, figure.unit)));
    row
}
