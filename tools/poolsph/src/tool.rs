//! What the command line needs to know of this tool.

use run::{Estimate, Failure, Input, Inputs, Plan, Preview, Session, Tool};

use crate::assemble::preview::preview;
use crate::scene::{KIND, Scene};
use crate::{simulate, trial};

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

    fn plan(scene: &Scene, inputs: &Inputs) -> Result<Plan, Failure> {
        simulate::plan(scene, inputs)
    }

    fn estimate(scene: &Scene, inputs: &Inputs) -> Result<Option<Estimate>, Failure> {
        trial::estimate(scene, inputs).map(Some)
    }

    fn grows(scene: &Scene) -> Option<&'static str> {
        trial::grows(scene)
    }

    fn preview(scene: &Scene, inputs: &Inputs) -> Result<Preview, Failure> {
        preview(scene, inputs)
    }

    fn run(scene: &Scene, inputs: &Inputs, session: &mut Session) -> Result<(), Failure> {
        simulate::run(scene, inputs, session)
    }
}
