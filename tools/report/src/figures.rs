//! `report figures`: the measures of a bead, for programs.

use std::path::Path;
use std::process::ExitCode;

use artefact::Reader;
use run::Failure;
use serde_json::{Map, Value, json};

use crate::files::print;
use crate::flux::Flux;
use crate::measure::bead::MEASURES;
use crate::measure::slag::Slag;
use crate::weld::{PARTICLES, Weld};

/// Prints every measure of the bead at the end of a weld as JSON.
///
/// `{"penetration": {"value": 0.0035, "unit": "m", "range": [0.003, 0.004], "frozen": true}, ...}`; an empty object where
/// nothing has ever melted. Of welds under flux `slag_greatest`, `slag_middle` and `slag_beside` tell how thick the slag lies behind the
/// arc at the end.
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
    for (name, thickness) in slag(&reader)? {
        let value = json!({"value": thickness, "unit": "m"});
        told.insert(name.to_owned(), value);
    }
    let text = format!("{:#}\n", Value::Object(told));
    print(&text)?;
    Ok(ExitCode::SUCCESS)
}

/// Thicknesses of the slag behind the arc \[m\]; none where there is none.
fn slag(reader: &Reader) -> Result<Vec<(&'static str, f64)>, Failure> {
    let Some(last) = reader.count(PARTICLES).checked_sub(1) else {
        return Ok(Vec::new());
    };
    let flux = Flux::read(reader, &reader.header().scene, last)?;
    let slag = flux.as_ref().and_then(Slag::behind);
    let told = slag.map(|slag| {
        let [middle, beside] = slag.middle_and_beside();
        let greatest = ("slag_greatest", slag.greatest());
        vec![greatest, ("slag_middle", middle), ("slag_beside", beside)]
    });
    Ok(told.unwrap_or_default())
}
