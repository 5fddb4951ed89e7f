//! Scenes of older versions: read by a chain of steps on JSON, each from one version to the next.

use serde_json::{Map, Value};

use super::Expected;
use super::origin::Document;
use super::patch::{Merged, located};
use crate::failure::Failure;
use crate::fault::Fault;

/// The step from a version of a scene to the next.
///
/// Patches have no version. They are merged before, so that they are of the version of their scene. A patch of a scene that is
/// not older may still have older words: steps that only rename are applied to it too.
#[derive(Debug, Clone, Copy)]
pub struct Migration {
    /// The version that it reads; it leaves the next.
    pub from: u32,
    /// Changes the scene; a fault where an old scene says what the new one cannot.
    pub change: fn(&mut Map<String, Value>) -> Result<(), Fault>,
    /// Whether it only renames keys: what lacks them, as a patch may, is left as it is.
    pub renames: bool,
}

/// Reads older words of a patch to a scene that is not older itself.
///
/// # Errors
/// What a step that only renames says.
pub(super) fn reword(
    patch: &mut Document,
    scene: &Merged,
    expected: Expected,
) -> Result<(), Failure> {
    let stated = scene.value().get("version").and_then(Value::as_u64);
    if stated != Some(expected.version.into()) {
        return Ok(());
    }
    let Value::Object(map) = &mut patch.value else {
        return Ok(());
    };
    for step in expected.migrations.iter().filter(|step| step.renames) {
        (step.change)(map)?;
    }
    Ok(())
}

/// Brings a scene to the version that the tool reads; gives the version that it had if it was older.
///
/// # Errors
/// A version that is missing, newer, or older than any migration reads.
pub(super) fn migrate(merged: &mut Merged, expected: Expected) -> Result<Option<u32>, Failure> {
    let found = match version(merged, expected) {
        Ok(found) => found,
        Err(fault) => return Err(Failure::Scene(located(vec![fault], merged))),
    };
    if found == expected.version {
        return Ok(None);
    }
    for from in found..expected.version {
        let step = expected.migrations.iter().find(|step| step.from == from);
        let changed = match step {
            Some(step) => merged.change(step.change),
            None => Err(refused(found, expected, "and knows no way from there")),
        };
        if let Err(fault) = changed {
            return Err(Failure::Scene(located(vec![fault], merged)));
        }
        // What a step forgets to say is said here.
        merged.set("version", (from + 1).into());
    }
    Ok(Some(found))
}

/// The version of a scene, at most that of the tool.
fn version(merged: &Merged, expected: Expected) -> Result<u32, Fault> {
    let Some(stated) = merged.value().get("version") else {
        let reads = expected.version;
        let what = format!("has no \"version\"; this tool reads version {reads}");
        return Err(Fault::at("", what));
    };
    match stated.as_u64().and_then(|v| u32::try_from(v).ok()) {
        Some(found) if found <= expected.version => Ok(found),
        Some(_) => Err(refused(stated, expected, "and nothing newer")),
        None => Err(refused(stated, expected, "and no other kind of number")),
    }
}

fn refused(found: impl std::fmt::Display, expected: Expected, more: &str) -> Fault {
    let Expected { kind, version, .. } = expected;
    let what = format!("'{kind}' is of version {found}, this tool reads version {version} {more}");
    Fault::at("/version", what)
}
