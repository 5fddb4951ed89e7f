//! `report figures`: the measures of a bead, for programs.

use std::path::Path;
use std::process::ExitCode;

use artefact::Reader;
use run::Failure;
use serde_json::{Map, Value, json};

use crate::files::print;
use crate::measure::bead::MEASURES;
use crate::weld::Weld;

/// Prints every measure of the bead at the end of a weld as JSON.
///
/// `{"penetration": {"value": 0.0035, "unit": "m", "range": [0.003, 0.004], "frozen": true}, ...}`; an empty object where
/// nothing has ever melted.
pub(crate) fn run(pool: &Path) -> Result<ExitCode, Failure> {
    let reader = Reader::open_sound(pool, "particle-frames", 1)?;
    let stretch = Weld::last(&reader)?.and_then(|weld| weld.bead());
    let mut told = Map::new();
    for named in &MEASURES {
        if let Some((stretch, measure)) =
            stretch.as_ref().and_then(|s| Some((s, s.get(named.name)?)))
        {
            let value = json!({"value": measure.value, "unit": named.unit, "range": measure.range, "frozen": stretch.frozen});
            told.insert(named.name.to_owned(), value);
        }
    }
    let text = format!("{:#}\n", Value::Object(told));
    print(&text)?;
    Ok(ExitCode::SUCCESS)
}
