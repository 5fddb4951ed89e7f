//! How every stage is run: command line, scene, clock, progress, record, checkpoint.
//!
//! A stage implements [`Tool`]; its program is one line (`examples/rod.rs` is a whole stage):
//!
//! ```no_run
//! use run::{Failure, Fault, Inputs, Plan, Session, Tool};
//! use schemars::JsonSchema;
//! use serde::Deserialize;
//!
//! /// Free fall.
//! #[derive(Deserialize, JsonSchema)]
//! #[serde(deny_unknown_fields)]
//! struct Scene {
//!     /// Height above the floor.
//!     #[schemars(range(min = 0.0))]
//!     height_m: f64,
//! }
//!
//! struct Fall;
//!
//! impl Tool for Fall {
//!     const NAME: &'static str = "fall";
//!     const VERSION: &'static str = env!("CARGO_PKG_VERSION");
//!     const ABOUT: &'static str = "Free fall to the floor.";
//!     const EXAMPLE: &'static str = "fall run pipelines/fall/scene.json --out build/fall.mcap";
//!     const SCENE_KIND: &'static str = "fall.scene";
//!     const ARTEFACT_KIND: &'static str = "fall-time";
//!     type Scene = Scene;
//!     type Ready = Scene;
//!
//!     fn prepare(scene: Scene, _: Inputs) -> Result<Scene, Failure> {
//!         if scene.height_m > 1e4 {
//!             let what = format!("{} m is out of range: at most 1e4 m without air", scene.height_m);
//!             return Err(Fault::at("/height_m", what).into());
//!         }
//!         Ok(scene)
//!     }
//!
//!     fn plan(_: &Scene) -> Result<Plan, Failure> {
//!         Ok(Plan::new().stage("fall").left_out("air", "never computed"))
//!     }
//!
//!     fn run(scene: Scene, session: &mut Session) -> Result<(), Failure> {
//!         let time_s = session.timed("fall", || (2.0 * scene.height_m / 9.80665).sqrt());
//!         session.closing("time", "s", time_s);
//!         session.record("/fall", 0.0, &artefact::Record::new().with("time", "s", time_s))
//!     }
//! }
//!
//! fn main() -> std::process::ExitCode {
//!     run::main::<Fall>()
//! }
//! ```
//!
//! What it gets for that: `TOOL run`, `TOOL check`, `TOOL schema`; scenes that are patched,
//! validated and located to the line ([`scene`]); properties as numbers, tables or expressions
//! ([`property`]); an artefact with its header set, a clock per stage, progress, checkpoints and a
//! run record ([`Session`]); one exit code per kind of failure ([`Failure`]).

mod awake;
mod ballast;
mod bounded;
mod checked;
mod clock;
mod command;
mod console;
mod failure;
mod fault;
mod inputs;
mod interrupt;
mod launch;
mod ledger;
mod leftover;
mod look;
mod machine;
mod owned;
mod plan;
pub mod preview;
mod progress;
pub mod property;
mod ready;
mod record;
mod room;
pub mod scene;
mod session;
mod tool;
mod trial;
mod watched;

pub use failure::Failure;
pub use fault::Fault;
pub use inputs::{Input, Inputs};
pub use launch::{explain, main, report_failure, say_usage};
pub use owned::{Form, Owned};
pub use plan::{Estimate, Plan, duration};
pub use preview::Preview;
pub use room::{Room, crowded, memory_room};
pub use scene::Migration;
pub use session::Session;
pub use tool::Tool;
pub use trial::{Part, Taken, trial};
