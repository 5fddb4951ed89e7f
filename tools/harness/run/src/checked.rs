//! `TOOL check`: the plan of a scene and what a run will take, within a bound of time.

use std::time::Duration;

use crate::bounded::{Step, bounded};
use crate::command::Study;
use crate::failure::Failure;
use crate::plan::{Estimate, Plan, bytes, duration};
use crate::ready::{caught, planned, read};
use crate::room::memory_room;
use crate::tool::Tool;

/// The plan of a study, and whether all of it could be judged within the bound.
///
/// # Errors
/// All faults of the scene; a panic, wherever it happens.
pub(crate) fn check<T: Tool>(study: &Study) -> Result<(Plan, bool), Failure> {
    let bound = Duration::try_from_secs_f64(T::CHECK_S).unwrap_or(Duration::MAX);
    let known = {
        let study = study.clone();
        bounded(bound, move |tell| steps::<T>(&study, tell))?
    };
    Ok(match (known.plan, known.estimate) {
        (Some((plan, grows)), Some(estimate)) => (told(plan, estimate, grows), true),
        (Some((plan, _)), None) => {
            let late = format!(
                "time: not told, as a trial takes longer than {}",
                duration(T::CHECK_S)
            );
            (plan.note(late), true)
        }
        (None, _) => {
            let outline = known.outline.map(|(plan, _)| plan);
            let late = format!(
                "not judged: the plan takes longer than {}; a run makes it first, and tells what does not fit",
                duration(T::CHECK_S)
            );
            (outline.unwrap_or_default().note(late), false)
        }
    })
}

/// A plan, and why its steps grow.
type Planned = (Plan, Option<&'static str>);
/// An estimate, or why there is none.
type Estimated = Result<Option<Estimate>, Failure>;

/// The steps of `check`.
fn steps<T: Tool>(study: &Study, tell: &dyn Fn(Step<Planned, Estimated>)) -> Result<(), Failure> {
    let read = read::<T>(study)?;
    tell(Step::Read);
    tell(Step::Outline((caught(|| T::outline(&read.scene))?, None)));
    let grows = caught(|| T::grows(&read.scene))?;
    let planned = planned::<T>(study, read)?;
    tell(Step::Plan((planned.plan, grows)));
    // The scene is good whether or not its time can be told, but a panic is a fault of ours.
    let estimate = caught(|| T::estimate(planned.ready))?;
    tell(Step::Estimate(estimate));
    Ok(())
}

/// A plan with its estimate, or why there is none.
fn told(plan: Plan, estimate: Estimated, grows: Option<&'static str>) -> Plan {
    match estimate {
        Ok(estimate) => roomy(plan.estimate(estimate, grows)),
        Err(failure) => plan.note(format!("time: not told: in a trial, {failure}")),
    }
}

/// A plan that tells where it comes to more memory than there is.
fn roomy(plan: Plan) -> Plan {
    let wanted = plan.memory_bytes();
    match memory_room() {
        Some(room) if wanted > room.bytes => {
            let (wanted, there) = (bytes(wanted), bytes(room.bytes));
            plan.note(format!("memory: about {wanted}, {} {there}", room.whose))
        }
        _ => plan,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::inputs::Inputs;
    use crate::session::Session;
    use schemars::JsonSchema;
    use serde::Deserialize;

    #[derive(Deserialize, JsonSchema)]
    struct Scene {
        #[serde(default)]
        refused: bool,
    }

    /// A tool whose trial goes wrong.
    struct Wrong;

    impl Tool for Wrong {
        const NAME: &'static str = "wrong";
        const VERSION: &'static str = "1";
        const ABOUT: &'static str = "";
        const EXAMPLE: &'static str = "";
        const SCENE_KIND: &'static str = "wrong.scene";
        const ARTEFACT_KIND: &'static str = "wrong";
        type Scene = Scene;
        type Ready = Scene;

        fn prepare(scene: Scene, _: Inputs) -> Result<Scene, Failure> {
            Ok(scene)
        }

        fn plan(_: &Scene) -> Result<Plan, Failure> {
            Ok(Plan::new().stage("trial"))
        }

        fn estimate(scene: Scene) -> Result<Option<Estimate>, Failure> {
            assert!(scene.refused, "no such point");
            Err(Failure::Other("the disk is full".to_owned()))
        }

        fn run(_: Scene, _: &mut Session) -> Result<(), Failure> {
            Ok(())
        }
    }

    fn checked(text: &str) -> Result<(Plan, bool), Failure> {
        let folder = tempfile::tempdir().unwrap();
        let scene = folder.path().join("scene.json");
        std::fs::write(&scene, text).unwrap();
        check::<Wrong>(&Study {
            scene,
            inputs: Vec::new(),
            patches: Vec::new(),
        })
    }

    #[test]
    fn a_panic_in_a_trial_is_told_and_a_failure_is_named() {
        let failure = checked(r#"{"kind": "wrong.scene", "version": 1}"#).unwrap_err();
        assert_eq!(failure.exit_code(), 1);
        assert!(
            failure
                .to_string()
                .contains("internal error: no such point"),
            "{failure}"
        );
        let (plan, judged) =
            checked(r#"{"kind": "wrong.scene", "version": 1, "refused": true}"#).unwrap();
        assert!(
            judged
                && plan
                    .to_string()
                    .contains("time: not told: in a trial, the disk is full"),
            "{plan}"
        );
    }
}
