//! What the command line needs to know of this tool.

use run::{Estimate, Failure, Inputs, Plan, Preview, Session, Tool};

use crate::assemble::{Assembled, assemble, preview};
use crate::scene::{KIND, Scene};
use crate::{plan, simulate, trial};

/// The program `jetsph`.
#[derive(Debug)]
pub struct JetSph;

impl Tool for JetSph {
    const NAME: &'static str = "jetsph";
    const VERSION: &'static str = env!("CARGO_PKG_VERSION");
    const ABOUT: &'static str = "A water jet cuts a solid: elastic solids by smoothed particles, in the plane and in space.";
    const EXAMPLE: &'static str =
        "jetsph run pipelines/verify/solid-bar/scene.json --out build/bar.mcap";
    const SCENE_KIND: &'static str = KIND.0;
    const SCENE_VERSION: u32 = KIND.1;
    const ARTEFACT_KIND: &'static str = "jet-frames";
    type Scene = Scene;
    type Ready = Ready;

    fn prepare(scene: Scene, _: Inputs) -> Result<Ready, Failure> {
        let run = assemble(&scene)?;
        Ok(Ready { scene, run })
    }

    fn plan(ready: &Ready) -> Result<Plan, Failure> {
        plan::plan(&ready.scene, &ready.run)
    }

    fn estimate(ready: Ready) -> Result<Option<Estimate>, Failure> {
        trial::estimate(&ready.scene, ready.run).map(Some)
    }

    fn preview(scene: &Scene, _: &Inputs) -> Result<Preview, Failure> {
        Ok(preview(scene)?)
    }

    fn run(ready: Ready, session: &mut Session) -> Result<(), Failure> {
        simulate::run(&ready.scene, ready.run, session)
    }
}

/// A scene with its particles and stages at the start of a run.
pub struct Ready {
    scene: Scene,
    run: Assembled,
}
