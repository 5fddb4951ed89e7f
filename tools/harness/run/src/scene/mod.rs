//! From scene files to a typed scene: reading, patching, validating, locating every fault.

mod choice;
mod instants;
mod migrate;
mod names;
mod origin;
mod patch;
pub(crate) mod quantity;
mod schema;
mod sheet;
mod substance;
mod suggest;
mod surface;
mod twins;
mod validate;
mod walk;
mod wanted;
mod whole;
mod width;
mod words;

use std::path::{Path, PathBuf};

use schemars::JsonSchema;
use serde::de::DeserializeOwned;
use serde_json::Value;

use crate::failure::Failure;
use crate::fault::Fault;
pub use migrate::Migration;
pub use schema::{schema_of, schema_text};
pub use sheet::{SHEET, Substance, sheet_schema};
pub use substance::named;
pub use suggest::nearest;
pub use width::FloatWidth;

use origin::Document;
pub use patch::{Merged, located};

/// Kind and version that a tool reads.
#[derive(Debug, Clone, Copy)]
pub struct Expected {
    /// `poolsph.scene`.
    pub kind: &'static str,
    /// Version of the kind.
    pub version: u32,
    /// Ways from older versions.
    pub migrations: &'static [Migration],
}

/// A scene as it was put together, with the origin of every value.
#[derive(Debug)]
pub struct Loaded<S> {
    /// The typed scene.
    pub scene: S,
    /// The merged JSON, in the version that the tool reads.
    pub merged: Merged,
    /// Version of the file, if it is an older one.
    pub migrated: Option<u32>,
}

/// Reads a scene and its patches, and validates the whole.
///
/// # Errors
/// [`Failure::Scene`] with every fault, each with file, line and column.
pub fn load<S: DeserializeOwned>(
    scene: &Path,
    patches: &[PathBuf],
    schema: &Value,
    expected: Expected,
) -> Result<Loaded<S>, Failure> {
    let mut merged = Merged::new(Document::read(scene)?);
    for patch in patches {
        let mut patch = Document::read(patch)?;
        migrate::reword(&mut patch, &merged, expected)?;
        merged.apply(patch);
    }
    typed(merged, schema, expected)
}

/// Reads a scene from its text, as [`load`] reads it from a file: for tests of a stage.
///
/// # Errors
/// As [`load`].
pub fn parse<S: DeserializeOwned + JsonSchema>(
    text: &str,
    expected: Expected,
) -> Result<Loaded<S>, Failure> {
    let document = Document::parse(Path::new("scene.json"), text.to_owned())?;
    typed(Merged::new(document), &schema_of::<S>(expected), expected)
}

fn typed<S: DeserializeOwned>(
    mut merged: Merged,
    schema: &Value,
    expected: Expected,
) -> Result<Loaded<S>, Failure> {
    check_kind(&merged, expected)?;
    let migrated = migrate::migrate(&mut merged, expected)?;
    let written = merged.value().clone();
    let mut unfilled = substance::fill(&mut merged, schema)?;
    unfilled.extend(surface::fill(&mut merged, schema));
    if *merged.value() != written {
        let hash = artefact::sha256(artefact::canonical(&written).as_bytes());
        merged.set(artefact::WRITTEN, hash.into());
    }
    if !unfilled.is_empty() {
        return Err(Failure::Scene(located(unfilled, &merged)));
    }
    let mut faults = validate::faults(&whole::bounded(schema.clone()), merged.value());
    let more = quantity::faults(merged.value());
    let more = more.into_iter().chain(instants::faults(merged.value()));
    let more = more.chain(twins::faults(merged.value()));
    faults.extend(
        more.filter(|new| faults.iter().all(|known| known.path() != new.path()))
            .collect::<Vec<_>>(),
    );
    if !faults.is_empty() {
        return Err(Failure::Scene(located(faults, &merged)));
    }
    let mut plain = merged.value().clone();
    if let Value::Object(map) = &mut plain {
        for key in schema::ENVELOPE {
            map.shift_remove(key);
        }
    }
    let scene = whole::read(plain).map_err(|e| {
        let what = format!(
            "passes the schema but cannot be read{}: {e}",
            merged.patched()
        );
        Failure::Scene(located(vec![Fault::at("", what)], &merged))
    })?;
    Ok(Loaded {
        scene,
        merged,
        migrated,
    })
}

/// Refuses another kind before anything else is said about the scene.
fn check_kind(merged: &Merged, expected: Expected) -> Result<(), Failure> {
    let refuse =
        |at: &str, what: String| Err(Failure::Scene(located(vec![Fault::at(at, what)], merged)));
    let Some(map) = merged.value().as_object() else {
        return refuse(
            "",
            format!("a scene is an object with \"kind\": \"{}\"", expected.kind),
        );
    };
    match map.get("kind") {
        Some(Value::String(kind)) if kind == expected.kind => {}
        Some(other) => {
            return refuse(
                "/kind",
                format!("is {other}, this tool reads \"{}\"", expected.kind),
            );
        }
        None => {
            return refuse(
                "",
                format!("has no \"kind\"; this tool reads \"{}\"", expected.kind),
            );
        }
    }
    Ok(())
}
