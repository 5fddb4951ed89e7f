//! The measures of a weld, for programs and for pages that compare: of its bead, and of the slag behind the arc.

use std::path::Path;
use std::process::ExitCode;

use artefact::Reader;
use run::Failure;
use serde_json::{Map, Value, json};

use crate::files::{print, warn};
use crate::flux::Flux;
use crate::measure::bead::MEASURES;
use crate::measure::slag::Slag;
use crate::weld::{PARTICLES, Stretch, Weld};

/// Thicknesses of the slag behind the arc.
const SLAG: [&str; 3] = ["slag_greatest", "slag_middle", "slag_beside"];

/// A measure with its name.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Measured {
    pub(crate) name: &'static str,
    pub(crate) unit: &'static str,
    pub(crate) value: f64,
    /// Least and greatest value along the weld, and whether that has frozen; none of what is measured at one place.
    along: Option<([f64; 2], bool)>,
    /// A depth that is the thickness of a plate that is fused through.
    through: bool,
}

/// Whether a measure of that name exists.
pub(crate) fn known(name: &str) -> bool {
    SLAG.contains(&name) || MEASURES.iter().any(|measure| measure.name == name)
}

/// Every measure of a weld whose bead is `stretch`; none where nothing has ever melted and no slag lies.
///
/// # Errors
/// When a frame cannot be read.
pub(crate) fn of(reader: &Reader, stretch: Option<&Stretch>) -> artefact::Result<Vec<Measured>> {
    let bead = MEASURES.iter().filter_map(|named| {
        let (stretch, measure) = stretch.and_then(|s| Some((s, s.get(named.name)?)))?;
        Some(Measured {
            name: named.name,
            unit: named.unit,
            value: measure.value,
            along: Some((measure.range, stretch.frozen)),
            through: named.name == "penetration" && stretch.through(),
        })
    });
    let mut all: Vec<Measured> = bead.collect();
    if let Some(slag) = slag(reader)? {
        let [middle, beside] = slag.middle_and_beside();
        let values = [slag.greatest(), middle, beside];
        all.extend(SLAG.into_iter().zip(values).map(|(name, value)| Measured {
            name,
            unit: "m",
            value,
            along: None,
            through: false,
        }));
    }
    Ok(all)
}

/// The slag behind the arc in the last frame; none where there is none.
fn slag(reader: &Reader) -> artefact::Result<Option<Slag>> {
    let Some(last) = reader.count(PARTICLES).checked_sub(1) else {
        return Ok(None);
    };
    let flux = Flux::read(reader, &reader.header().scene, last)?;
    Ok(flux.as_ref().and_then(Slag::behind))
}

/// Prints every measure of a weld at its end as JSON.
///
/// `{"penetration": {"value": 0.0035, "unit": "m", "range": [0.003, 0.004], "frozen": true}, ...}`; an empty object where
/// nothing has ever melted. `"through": true` stands where the plate is fused through. Of welds under flux `slag_greatest`, `slag_middle` and `slag_beside` tell how thick the slag lies behind the
/// arc at the end.
pub(crate) fn run(pool: &Path) -> Result<ExitCode, Failure> {
    let reader = Reader::open_sound(pool, "particle-frames", 1)?;
    let weld = Weld::last(&reader)?;
    let stretch = weld.as_ref().and_then(Weld::bead);
    let mut told = Map::new();
    for measured in of(&reader, stretch.as_ref())? {
        let mut value = json!({"value": measured.value, "unit": measured.unit});
        if let Some((range, frozen)) = measured.along {
            value["range"] = json!(range);
            value["frozen"] = json!(frozen);
        }
        if measured.through {
            value["through"] = json!(true);
        }
        told.insert(measured.name.to_owned(), value);
    }
    let text = format!("{:#}\n", Value::Object(told));
    print(&text)?;
    match weld.as_ref().and_then(Weld::strayed) {
        Some(told) => warn(pool, &told),
        None => Ok(ExitCode::SUCCESS),
    }
}
