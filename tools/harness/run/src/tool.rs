//! What a stage tells of itself.

use artefact::Version;
use schemars::JsonSchema;
use serde::de::DeserializeOwned;

use crate::failure::Failure;
use crate::inputs::{Input, Inputs};
use crate::plan::{Estimate, Plan};
use crate::preview::Preview;
use crate::scene::{Expected, Migration};
use crate::session::Session;

/// A stage: reads a scene and inputs, writes one artefact.
pub trait Tool: 'static {
    /// Name of the program: `poolsph`.
    const NAME: &'static str;
    /// Version of the program: `env!("CARGO_PKG_VERSION")`.
    const VERSION: &'static str;
    /// One sentence for `--help`.
    const ABOUT: &'static str;
    /// Sample commands for `--help`, one per line, that work from the repository root: `poolsph
    /// run ...` is shown as `cargo run --release -p poolsph -- run ...`.
    const EXAMPLE: &'static str;
    /// Kind of its scene: `poolsph.scene`.
    const SCENE_KIND: &'static str;
    /// Version of its scene.
    const SCENE_VERSION: u32 = 1;
    /// Ways from older versions of its scene; a version without one is refused by name.
    const MIGRATIONS: &'static [Migration] = &[];
    /// Kind of its artefact: `particle-frames`.
    const ARTEFACT_KIND: &'static str;
    /// Version of its artefact.
    const ARTEFACT_VERSION: Version = Version::new(1, 0);
    /// Its inputs.
    const INPUTS: &'static [Input] = &[];
    /// Wall time between checkpoints \[s\].
    const CHECKPOINT_S: f64 = 60.0;

    /// Work that `check` may take for plan and estimate, beyond reading the scene \[s\]; what is known by then is told.
    const CHECK_S: f64 = 2.0;

    /// Its scene; doc comments become descriptions, `#[schemars(range(..))]` becomes a check.
    type Scene: DeserializeOwned + JsonSchema;

    /// A scene and its inputs put together, as the first step of a run finds them.
    type Ready;

    /// Puts a scene and its inputs together, once for all that follows, and finds every fault that the types cannot express.
    ///
    /// # Errors
    /// [`Failure::Scene`] with all faults found, or what is wrong with an input.
    fn prepare(scene: Self::Scene, inputs: Inputs) -> Result<Self::Ready, Failure>;

    /// Says what a run would do.
    ///
    /// # Errors
    /// As [`Tool::prepare`], for faults that show only when the parts stand together.
    fn plan(ready: &Self::Ready) -> Result<Plan, Failure>;

    /// What of the plan is known at once, for `check` where the plan itself takes longer than that may.
    #[must_use]
    fn outline(_scene: &Self::Scene) -> Plan {
        Plan::new()
    }

    /// Says how long the run will take, for `check`: a few steps may be taken to find out. `None`
    /// where nothing can be said.
    ///
    /// # Errors
    /// As [`Tool::run`]; `check` then says why in place of the time.
    fn estimate(_ready: Self::Ready) -> Result<Option<Estimate>, Failure> {
        Ok(None)
    }

    /// Why the steps of a run will last longer than those that [`Tool::estimate`] took, where they will:
    /// `check` then gives the time as the least.
    #[must_use]
    fn grows(_scene: &Self::Scene) -> Option<&'static str> {
        None
    }

    /// What would be there when a run begins, for `check --points`: points by material and condition, and the ways of what
    /// moves. Inputs that only the run wants may be absent.
    ///
    /// # Errors
    /// Faults of the scene; a program without points.
    fn preview(_scene: &Self::Scene, _inputs: &Inputs) -> Result<Preview, Failure> {
        let what = format!("--points: {} has no points to show", Self::NAME);
        Err(Failure::Usage(what))
    }

    /// Runs. The plan has been made and found good before.
    ///
    /// # Errors
    /// Any [`Failure`]; the record and the exit code follow from it.
    fn run(ready: Self::Ready, session: &mut Session) -> Result<(), Failure>;
}

/// Kind and version of the scene of a tool.
pub(crate) fn expected<T: Tool>() -> Expected {
    Expected {
        kind: T::SCENE_KIND,
        version: T::SCENE_VERSION,
        migrations: T::MIGRATIONS,
    }
}
