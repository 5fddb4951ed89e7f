//! What the command line needs to know of this tool.

use run::{Estimate, Failure, Inputs, Plan, Preview, Session, Tool};

use crate::scene::{KIND, Scene};
use crate::{assemble, simulate, trial};

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

    fn plan(scene: &Scene, _: &Inputs) -> Result<Plan, Failure> {
        simulate::plan(scene)
    }

    fn estimate(scene: &Scene, _: &Inputs) -> Result<Option<Estimate>, Failure> {
        trial::estimate(scene).map(Some)
    }

    fn preview(scene: &Scene, _: &Inputs) -> Result<Preview, Failure> {
        Ok(assemble::preview(scene)?)
    }

    fn run(scene: &Scene, _: &Inputs, session: &mut Session) -> Result<(), Failure> {
        simulate::run(scene, session)
    }
}
