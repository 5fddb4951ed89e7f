//! From a scene to its plan.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::time::{Duration, Instant};

use artefact::Header;

use crate::command::Study;
use crate::failure::Failure;
use crate::inputs::Inputs;
use crate::plan::Plan;
use crate::room::crowded;
use crate::scene::quantity;
use crate::scene::{Loaded, Merged, load, located, schema_of};
use crate::tool::{Tool, expected};

/// A scene that was found good and put together, with its plan.
pub(crate) struct Planned<R> {
    pub(crate) ready: R,
    pub(crate) plan: Plan,
    pub(crate) header: Header,
    pub(crate) merged: Merged,
    /// What reading and checking the scene against its schema took.
    pub(crate) read: Duration,
}

/// A scene that was read, before its plan.
pub(crate) struct Read<S> {
    pub(crate) scene: S,
    pub(crate) merged: Merged,
    migrated: Option<u32>,
    /// What reading and checking the scene against its schema took.
    read: Duration,
}

/// Reads the scene of a study.
///
/// # Errors
/// What is wrong with its files.
pub(crate) fn read<T: Tool>(study: &Study) -> Result<Read<T::Scene>, Failure> {
    let began = Instant::now();
    let schema = schema_of::<T::Scene>(expected::<T>());
    let Loaded {
        scene,
        merged,
        migrated,
    } = load::<T::Scene>(&study.scene, &study.patches, &schema, expected::<T>())?;
    Ok(Read {
        scene,
        merged,
        migrated,
        read: began.elapsed(),
    })
}

/// Puts a scene together and plans it.
///
/// # Errors
/// All faults of the scene and its inputs; more memory than there is.
pub(crate) fn planned<T: Tool>(
    study: &Study,
    read: Read<T::Scene>,
) -> Result<Planned<T::Ready>, Failure> {
    let Read {
        scene,
        merged,
        migrated,
        read,
    } = read;
    let inputs = Inputs::from_words(&study.inputs, T::INPUTS)?;
    let hashes = inputs.hashes().clone();
    let made = guarded(|| {
        let ready = T::prepare(scene, inputs)?;
        let plan = T::plan(&ready)?;
        Ok((ready, plan))
    });
    let (ready, plan) = made.map_err(|failure| placed(failure, &merged))?;
    #[allow(clippy::cast_precision_loss, reason = "no limit is known to the byte")]
    let wanted = plan.memory_bytes() as f64;
    if let Some(fault) = crowded("", "all that is planned", wanted, "take fewer points") {
        return Err(placed(fault.into(), &merged));
    }
    let plan = match migrated {
        Some(from) => plan.note(format!(
            "scene of version {from}, read as version {}",
            T::SCENE_VERSION
        )),
        None => plan,
    };
    let doubts = quantity::doubts(merged.value());
    let plan = doubts.into_iter().fold(plan, Plan::note);
    let header = Header {
        kind: T::ARTEFACT_KIND.to_owned(),
        version: T::ARTEFACT_VERSION,
        tool: T::NAME.to_owned(),
        tool_version: T::VERSION.to_owned(),
        scene: merged.value().clone(),
        inputs: hashes,
    };
    Ok(Planned {
        ready,
        plan,
        header,
        merged,
        read,
    })
}

/// Adds file and line to the faults of a scene.
pub(crate) fn placed(failure: Failure, merged: &Merged) -> Failure {
    match failure {
        Failure::Scene(faults) => Failure::Scene(located(faults, merged)),
        other => other,
    }
}

/// A panic is a fault of ours; the run still ends with a record and exit code 1.
pub(crate) fn guarded<R>(work: impl FnOnce() -> Result<R, Failure>) -> Result<R, Failure> {
    caught(work).and_then(|done| done)
}

/// A panic as a failure.
pub(crate) fn caught<R>(work: impl FnOnce() -> R) -> Result<R, Failure> {
    catch_unwind(AssertUnwindSafe(work)).map_err(|panic| {
        let text = panic
            .downcast_ref::<String>()
            .map(String::as_str)
            .or_else(|| panic.downcast_ref::<&str>().copied())
            .unwrap_or("no message");
        Failure::Other(format!("internal error: {text}"))
    })
}
