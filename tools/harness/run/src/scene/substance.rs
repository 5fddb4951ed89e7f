//! Substances: properties that a scene takes by name, from a sheet or from what it says itself.
//!
//! `"substances": {"steel": {"file": "../materials/mild-steel.json"}}` names a sheet. Wherever the scene then has `"steel"`
//! in place of a number, a table or an object, the value of the sheet is taken that belongs to the key: of
//! `"density_kg_m3": "steel"` the density, of `"melting": "steel"` all that the scene knows of melting. Where a scene wants a
//! text, a text stays one.

use std::sync::LazyLock;

use serde_json::{Map, Value, json};

use super::origin::escaped;
use super::patch::Merged;
use super::schema::SUBSTANCES;
use super::sheet::{self, sheet_schema};
use super::suggest::nearest;
use super::wanted;
use crate::failure::Failure;
use crate::fault::Fault;

/// Keys of scenes whose values a sheet has under another: the key around them, if it matters, the key, the place in the sheet.
const OTHER_NAMES: [(&str, &str, &str); 9] = [
    ("", "conductivity_w_m_k", "/thermal_conductivity_w_m_k"),
    ("", "gas_conductivity_w_m_k", "/thermal_conductivity_w_m_k"),
    ("", "conductivity_s_m", "/electric_conductivity_s_m"),
    ("", "gas_viscosity_pa_s", "/viscosity_pa_s"),
    ("marangoni", "slope_n_m_k", "/surface_tension_slope_n_m_k"),
    ("evaporation", "boiling_point_k", "/evaporation/boiling_k"),
    ("melting", "boiling_k", "/evaporation/boiling_k"),
    ("granular", "boiling_k", "/evaporation/boiling_k"),
    (
        "melting",
        "slag_conductivity_ratio",
        "/granular/slag_conductivity_ratio",
    ),
];

/// Parts of a sheet that have keys of their own.
const PARTS: [&str; 5] = ["melting", "evaporation", "granular", "elastic", "fracture"];

/// Keys of a sheet that are no properties.
const NO_PROPERTIES: [&str; 6] = ["title", "source", "comment", "kind", "version", "$schema"];

static SHEET: LazyLock<Value> = LazyLock::new(sheet_schema);

/// A key that takes all that the scene knows of a substance.
const WHOLE: &str = "material";

/// Where a sheet has what belongs at a key of a scene; none where it is no matter of substances.
fn place(around: &str, key: &str) -> Option<String> {
    let other = OTHER_NAMES
        .iter()
        .find(|(parent, name, _)| *name == key && (parent.is_empty() || *parent == around));
    if let Some((.., place)) = other {
        return Some((*place).to_owned());
    }
    if key == WHOLE {
        return Some(String::new());
    }
    if NO_PROPERTIES.contains(&key) {
        return None;
    }
    let own = |place: String| (!wanted::forms(&SHEET, &place).is_empty()).then_some(place);
    let within = PARTS.contains(&around).then(|| format!("/{around}/{key}"));
    within.and_then(own).or_else(|| own(format!("/{key}")))
}

/// The last two keys of a pointer, without numbers of entries.
fn ends(pointer: &str) -> (&str, &str) {
    let mut keys = pointer.rsplit('/').filter(|k| k.parse::<usize>().is_err());
    let key = keys.next().unwrap_or("");
    (keys.next().unwrap_or(""), key)
}

/// A substance: what the scene says, then its sheet; each with the file and the place in it that its values come from.
struct Known {
    name: String,
    said: Vec<(Value, Origin)>,
    /// Name and hash of the sheet's file.
    sheet: Option<(String, String)>,
}

/// A file among those of the scene, and a JSON pointer in it.
#[derive(Clone)]
struct Origin {
    /// None: where the scene has it.
    file: Option<usize>,
    at: String,
}

impl Known {
    /// What is said at a place.
    fn at(&self, place: &str) -> Option<(&Value, Origin)> {
        self.said.iter().find_map(|(all, origin)| {
            let at = format!("{}{place}", origin.at);
            let file = origin.file;
            Some((all.pointer(place)?, Origin { file, at }))
        })
    }

    /// Its name as a message has it.
    fn called(&self) -> String {
        match &self.sheet {
            Some((file, _)) => format!("{} ({file})", self.name),
            None => self.name.clone(),
        }
    }
}

/// Takes from the substances of a scene what it asks of them; without the key `substances` nothing is done.
///
/// # Errors
/// A sheet that is missing or wrong.
pub(super) fn fill(merged: &mut Merged, schema: &Value) -> Result<Vec<Fault>, Failure> {
    let Some(written) = merged.value().get(SUBSTANCES).cloned() else {
        return Ok(Vec::new());
    };
    let Value::Object(entries) = &written else {
        let what = "is no object with a name for each substance";
        return Ok(vec![Fault::at(&format!("/{SUBSTANCES}"), what)]);
    };
    let (known, mut faults) = read(merged, entries)?;
    if !faults.is_empty() {
        return Ok(faults);
    }
    let mut texts = Vec::new();
    collect(merged.value(), "", &mut texts);
    for (pointer, text) in texts {
        let forms = wanted::forms(schema, &pointer);
        let (around, key) = ends(&pointer);
        if forms.is_empty() || wanted::text(&forms) {
            continue;
        }
        let Some(place) = place(around, key) else {
            continue;
        };
        let found = known.iter().find(|one| one.name == text);
        match found {
            Some(one) => faults.extend(take(merged, schema, &pointer, &place, one)),
            None => faults.push(Fault::at(&pointer, unknown(&text, &known))),
        }
    }
    for (pointer, text) in merged.over_texts() {
        let (around, key) = ends(&pointer);
        let part = place(around, key).is_some_and(|place| is_part(&place));
        let one = known.iter().find(|one| part && one.name == text);
        let members = merged
            .value()
            .pointer(&pointer)
            .is_some_and(Value::is_object);
        if let Some(one) = one.filter(|_| members) {
            complete(merged, schema, &pointer, one);
        }
    }
    let record = known.iter().map(|one| (one.name.clone(), told(one)));
    merged.set(SUBSTANCES, Value::Object(record.collect()));
    Ok(faults)
}

/// Reads the sheets of all substances.
fn read(
    merged: &mut Merged,
    entries: &Map<String, Value>,
) -> Result<(Vec<Known>, Vec<Fault>), Failure> {
    let (mut known, mut faults) = (Vec::new(), Vec::new());
    for (name, own) in entries {
        let at = format!("/{SUBSTANCES}/{}", escaped(name));
        let wrong = sheet::faults(own);
        faults.extend(wrong.into_iter().map(|fault| fault.within(&at)));
        let origin = Origin {
            file: None,
            at: at.clone(),
        };
        let mut one = Known {
            name: name.clone(),
            said: vec![(own.clone(), origin)],
            sheet: None,
        };
        if let Some(file) = own.get("file").and_then(Value::as_str) {
            let sheet = sheet::read(merged, &format!("{at}/file"), file)?;
            let value = sheet.value.clone();
            let hash = artefact::sha256(sheet.text.as_bytes());
            let origin = Origin {
                file: Some(merged.adopt(sheet)),
                at: String::new(),
            };
            one.said.push((value, origin));
            one.sheet = Some((file.to_owned(), hash));
        }
        known.push(one);
    }
    Ok((known, faults))
}

/// All texts of a scene outside its substances, with their pointers.
fn collect(value: &Value, at: &str, found: &mut Vec<(String, String)>) {
    match value {
        Value::String(text) => found.push((at.to_owned(), text.clone())),
        Value::Array(list) => {
            for (i, value) in list.iter().enumerate() {
                collect(value, &format!("{at}/{i}"), found);
            }
        }
        Value::Object(map) => {
            for (key, value) in map {
                if !(at.is_empty() && key == SUBSTANCES) {
                    collect(value, &format!("{at}/{}", escaped(key)), found);
                }
            }
        }
        _ => {}
    }
}

/// Puts what a substance says of a place in its sheet to a pointer of the scene.
fn take(
    merged: &mut Merged,
    schema: &Value,
    pointer: &str,
    place: &str,
    one: &Known,
) -> Option<Fault> {
    if !is_part(place) {
        return match one.at(place) {
            Some((value, origin)) => {
                let value = value.clone();
                merged.put(pointer, value, origin.file, &origin.at);
                None
            }
            None => Some(Fault::at(pointer, lacking(place, one))),
        };
    }
    merged.put(pointer, json!({}), None, pointer);
    let any = complete(merged, schema, pointer, one);
    (!any).then(|| Fault::at(pointer, lacking(place, one)))
}

/// Takes all that the object at a pointer of the scene can have, and has not, from a substance; gives whether it had any of it.
/// What a patch has taken away stays away.
fn complete(merged: &mut Merged, schema: &Value, pointer: &str, one: &Known) -> bool {
    let forms = wanted::forms(schema, pointer);
    let mut asked = wanted::keys(&forms);
    let around = ends(pointer).1.to_owned();
    asked.dedup_by_key(|(key, _)| *key);
    let mut any = false;
    for (key, _) in asked {
        let inner = format!("{pointer}/{}", escaped(key));
        let Some(place) = self::place(&around, key) else {
            continue;
        };
        let has = merged.value().pointer(&inner).is_some() || merged.is_gone(&inner);
        if one.at(&place).is_some() && !has {
            any = true;
            merged.put(&inner, Value::Null, None, pointer);
            take(merged, schema, &inner, &place, one);
        }
    }
    any
}

/// Whether a place is an object of keys of its own: the whole sheet, or a part of it.
fn is_part(place: &str) -> bool {
    place.is_empty()
        || PARTS
            .iter()
            .any(|part| place.strip_prefix('/') == Some(part))
}

fn lacking(place: &str, one: &Known) -> String {
    let has: Vec<&str> = one
        .said
        .iter()
        .filter_map(|(all, _)| all.as_object())
        .flat_map(|map| map.keys().map(String::as_str))
        .filter(|key| self::place("", key).is_some_and(|p| !p.is_empty()))
        .collect();
    let what = match place.trim_start_matches('/') {
        "" => "nothing that is asked for here".to_owned(),
        place => format!("no '{place}'"),
    };
    format!("{} has {what}; it has {}", one.called(), has.join(", "))
}

fn unknown(text: &str, known: &[Known]) -> String {
    let names: Vec<&str> = known.iter().map(|one| one.name.as_str()).collect();
    let hint = match nearest(text, &names) {
        Some(meant) => format!("did you mean \"{meant}\"?"),
        None => format!("there are {}", names.join(", ")),
    };
    format!("\"{text}\" is no substance of this scene; {hint}")
}

/// What an artefact tells of a substance: the values stand where they were asked for.
fn told(one: &Known) -> Value {
    let mut told = Map::new();
    for key in ["title", "source", "from", "sha256"] {
        if let Some((value, _)) = one.at(&format!("/{key}")) {
            told.insert(key.to_owned(), value.clone());
        }
    }
    if let Some((file, hash)) = &one.sheet {
        told.insert("from".to_owned(), json!(file));
        told.insert("sha256".to_owned(), json!(hash));
    }
    Value::Object(told)
}

/// The schema of a scene as editors use it, before names of substances have become values.
#[must_use]
pub fn named(mut schema: Value) -> Value {
    offer(&mut schema);
    schema
}

/// What a key may be, or the name of a substance.
fn or_named(value: &mut Value) {
    let mut choice = Map::new();
    if let Some(text) = value.get("description") {
        choice.insert("description".to_owned(), text.clone());
    }
    let text = json!({"type": "string", "description": "A substance of this scene."});
    choice.insert("anyOf".to_owned(), json!([value.take(), text]));
    *value = Value::Object(choice);
}

fn offer(node: &mut Value) {
    match node {
        Value::Object(map) => {
            for (word, child) in map.iter_mut() {
                match (word.as_str(), child) {
                    ("properties", Value::Object(properties)) => {
                        for (key, value) in properties.iter_mut() {
                            offer(value);
                            // What surrounds a key is not known here: the parts' own keys are known by any part.
                            let around = PARTS.iter().chain(&[""]);
                            if around.map(|around| place(around, key)).any(|p| p.is_some()) {
                                or_named(value);
                            }
                        }
                    }
                    (_, child) => offer(child),
                }
            }
        }
        Value::Array(list) => list.iter_mut().for_each(offer),
        _ => {}
    }
}
