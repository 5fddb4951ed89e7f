//! What the command line needs to know of this tool.

use run::{Estimate, Failure, Input, Inputs, Migration, Plan, Preview, Session, Tool};

use crate::assemble::preview::preview;
use crate::assemble::{Assembled, assemble};
use crate::scene::{KIND, MIGRATIONS, Scene};
use crate::{plan, simulate, trial};

/// The program `poolsph`.
#[derive(Debug)]
pub struct PoolSph;

impl Tool for PoolSph {
    const NAME: &'static str = "poolsph";
    const VERSION: &'static str = env!("CARGO_PKG_VERSION");
    const ABOUT: &'static str = "Weld pool and bead by incompressible SPH: flow, heat, melting and droplets under a moving arc.";
    const EXAMPLE: &'static str = "poolsph run pipelines/gmaw-300a/pool.json --input arc=build/gmaw-300a/arc.mcap --out build/pool.mcap\n\
         poolsph run pipelines/verify/pool-hydrostatic/scene.json --out build/tank.mcap";
    const SCENE_KIND: &'static str = KIND.0;
    const SCENE_VERSION: u32 = KIND.1;
    const MIGRATIONS: &'static [Migration] = MIGRATIONS;
    const ARTEFACT_KIND: &'static str = "particle-frames";
    const INPUTS: &'static [Input] = &[
        Input {
            name: "arc",
            what: "arc source (arc-source 1.x), needed by the keys that ask for it",
            required: false,
        },
        Input {
            name: "arc2",
            what: "a second arc source (arc-source 1.x), for entries of the key 'arcs' that say so",
            required: false,
        },
        Input {
            name: "start",
            what: "an earlier run (particle-frames 1.x), whose metal is the initial state where the scene says so",
            required: false,
        },
        Input {
            name: "bed",
            what: "grains at rest (particle-frames 1.x), for bodies of grains that say so",
            required: false,
        },
    ];
    type Scene = Scene;
    type Ready = Ready;

    fn prepare(scene: Scene, inputs: Inputs) -> Result<Ready, Failure> {
        let run = assemble(&scene, &inputs)?;
        Ok(Ready { scene, run })
    }

    fn plan(ready: &Ready) -> Result<Plan, Failure> {
        plan::plan(&ready.scene, &ready.run)
    }

    fn estimate(ready: Ready) -> Result<Option<Estimate>, Failure> {
        trial::estimate(&ready.scene, ready.run).map(Some)
    }

    fn grows(scene: &Scene) -> Option<&'static str> {
        trial::grows(scene)
    }

    fn preview(scene: &Scene, inputs: &Inputs) -> Result<Preview, Failure> {
        preview(scene, inputs)
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
