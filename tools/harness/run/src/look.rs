//! `TOOL check --points`: writes what would be there before a run.

use std::path::Path;

use artefact::{Header, Writer};

use crate::command::Study;
use crate::failure::Failure;
use crate::inputs::Inputs;
use crate::owned::{Form, Owned};
use crate::preview::{KIND, LOOK, POINTS, SCHEMA, VERSION};
use crate::ready::{Read, guarded, placed, read};
use crate::tool::Tool;

/// Writes what a study would begin with; gives the number of points.
///
/// # Errors
/// Faults of the scene; a tool that has no points to show; the disk.
pub(crate) fn write<T: Tool>(study: &Study, out: &Path) -> Result<usize, Failure> {
    let named = |failure| match failure {
        Failure::Usage(what) => Failure::Usage(what.replacen("--out", "--points", 1)),
        other => other,
    };
    let owned = Owned::of(out, Form::Artefact, study.reads()).map_err(named)?;
    let Read { scene, merged, .. } = read::<T>(study)?;
    let inputs = Inputs::from_words(&study.inputs, T::INPUTS)?;
    let shown = guarded(|| T::preview(&scene, &inputs));
    let shown = shown.map_err(|failure| placed(failure, &merged))?;
    let header = Header {
        kind: KIND.to_owned(),
        version: VERSION,
        tool: T::NAME.to_owned(),
        tool_version: T::VERSION.to_owned(),
        scene: merged.value().clone(),
        inputs: inputs.hashes().clone(),
    };
    let mut writer = Writer::create(owned.out(), &header)?;
    writer.json(LOOK, 0.0, SCHEMA, &shown.look)?;
    writer.frame(POINTS, 0.0, &shown.frame())?;
    writer.finish()?;
    Ok(shown.spots().len())
}
