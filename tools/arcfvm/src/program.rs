//! The program: what it is called, what it reads, and one run from scene to artefact.

use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use run::{Estimate, Failure, Fault, Input, Inputs, Plan, Preview, Session, Tool};

use crate::assemble::{GasFile, assemble, pool, preview, sampled};
use crate::case::Case;
use crate::scene::{Gas, Scene};
use crate::settings::Settings;
use crate::solver::{Arc, Stopwatch};
use crate::{frames, march, plan, start};

/// Iterations that an arc takes, about: those of our studies take 425 to 1010.
const USUAL: usize = 650;

/// Iterations that tell how long one lasts, and the longest time for them.
const TRIAL: u32 = 20;
const LONGEST_TRIAL: Duration = Duration::from_millis(500);

/// The stage `arcfvm`.
#[derive(Debug, Clone, Copy)]
pub struct ArcFvm;

/// An arc before its first iteration.
#[derive(Debug)]
pub struct Ready {
    scene: Scene,
    case: Case,
    /// What is to be told of the surface of the inputs.
    doubt: Option<String>,
    /// A solution to start from.
    start: Option<PathBuf>,
}

impl Stopwatch for Session {
    fn timed<R>(&mut self, name: &'static str, work: impl FnOnce() -> R) -> R {
        Session::timed(self, name, work)
    }
}

impl Tool for ArcFvm {
    const NAME: &'static str = "arcfvm";
    const VERSION: &'static str = env!("CARGO_PKG_VERSION");
    const ABOUT: &'static str =
        "A steady axisymmetric arc plasma between a wire and a base metal, by finite volumes.";
    const EXAMPLE: &'static str = "cargo run --release -p arcfvm -- run pipelines/gmaw-300a/arc.json \
         --input gas=pipelines/gases/argon-1atm.json --out build/arc.mcap";
    const SCENE_KIND: &'static str = "arcfvm.scene";
    const ARTEFACT_KIND: &'static str = "arc-source";
    const INPUTS: &'static [Input] = &[
        Input {
            name: "gas",
            what: "gas table (gas-table 1.x)",
            required: false,
        },
        Input {
            name: "surface",
            what: "surface of a body with a profile (mean-fields 1.2 of avg, or surface-profile 1.x)",
            required: false,
        },
        Input {
            name: "start",
            what: "a solution to start from (arc-source 1.x), on any grid",
            required: false,
        },
    ];
    type Scene = Scene;
    type Ready = Ready;

    fn prepare(scene: Scene, inputs: Inputs) -> Result<Ready, Failure> {
        let start = inputs.get("start").map(Path::to_owned);
        let (scene, doubt) = match inputs.get("surface") {
            Some(path) => pool::deform(&scene, path)?,
            None => (scene, None),
        };
        let case = problem(&scene, &inputs)?;
        Ok(Ready {
            scene,
            case,
            doubt,
            start,
        })
    }

    fn plan(ready: &Ready) -> Result<Plan, Failure> {
        let told = [
            pool::told(&ready.scene, &ready.case),
            plan::entering(&ready.case),
        ];
        let told = told.into_iter().flatten();
        Ok(told.fold(plan::plan(&ready.case), Plan::note))
    }

    fn estimate(ready: Ready) -> Result<Option<Estimate>, Failure> {
        let Ready { scene, case, .. } = ready;
        let mut arc = Arc::new(case, Settings::from(&scene.iterate));
        arc.iterate(&mut ())?;
        let began = Instant::now();
        let mut done = 0_u32;
        while done == 0 || (done < TRIAL && began.elapsed() < LONGEST_TRIAL) {
            arc.iterate(&mut ())?;
            done += 1;
        }
        let each = began.elapsed().as_secs_f64() / f64::from(done);
        let most = scene.iterate.most;
        let usual = most.min(USUAL);
        Ok(Some(Estimate {
            seconds: each * usual as f64,
            basis: format!(
                "{:.2} ms an iteration, of which arcs take some {usual}; at most {most}",
                1e3 * each
            ),
            memory: Vec::new(),
        }))
    }

    fn preview(scene: &Scene, inputs: &Inputs) -> Result<Preview, Failure> {
        match inputs.get("surface") {
            Some(path) => preview(&pool::deform(scene, path)?.0),
            None => preview(scene),
        }
    }

    fn run(ready: Ready, session: &mut Session) -> Result<(), Failure> {
        let Ready {
            scene,
            case,
            doubt,
            start,
        } = ready;
        let mut arc = Arc::new(case, Settings::from(&scene.iterate));
        if let Some(path) = start
            && let Some(told) = start::take(&mut arc, &path)?
        {
            session.note(told);
        }
        march::march(&mut arc, &scene.iterate, session)?;
        let balance = arc.settle();
        for told in arc.beyond()? {
            match told.matters {
                true => session.warn(told.text),
                false => session.note(told.text),
            }
        }
        let sampled = sampled::told(&scene, &arc.case.grid).into_iter();
        for told in sampled.chain(arc.unheld(&scene.sample)).chain(doubt) {
            session.warn(told);
        }
        march::close(&arc, balance.as_ref(), session);
        frames::write(&arc, balance.as_ref(), &scene.sample, session)
    }
}

/// Reads the gas that the scene asks for and assembles the problem.
fn problem(scene: &Scene, inputs: &Inputs) -> Result<Case, Failure> {
    let gas = match (&scene.gas, inputs.get("gas")) {
        (Gas::Table(_), Some(path)) => Some(GasFile::read(path)?),
        _ => None,
    };
    let case = assemble(scene, gas.as_ref())?;
    let driven = case.potential.as_ref().and_then(|p| p.driven);
    if scene.iterate.continuation.is_some() && driven.is_none() {
        let what = "wants a total_current_a at one of the edges: there is no current to follow";
        return Err(Failure::Scene(vec![Fault::at(
            "/iterate/continuation",
            what,
        )]));
    }
    Ok(case)
}
