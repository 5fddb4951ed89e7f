//! JSON Merge Patches (RFC 7386) that remember which file set each value.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use serde_json::{Map, Value};

use super::origin::{Document, Place, escaped};
use crate::failure::Failure;
use crate::fault::{Fault, Spot};

/// Where a file begins.
const ROOT: Place = Place { key: 0, value: 0 };

/// A scene with its patches applied; every value knows its file.
#[derive(Debug)]
pub struct Merged {
    documents: Vec<Document>,
    /// Of these the scene and its patches; behind them files that they name.
    written: usize,
    value: Value,
    origins: BTreeMap<String, (usize, Place)>,
    texts: Texts,
}

/// What patches have done to texts, which may be names of substances.
#[derive(Debug, Default)]
struct Texts {
    /// Texts in whose place patches have put members, by pointer.
    under: BTreeMap<String, String>,
    /// Pointers of members that patches have taken away.
    gone: Vec<String>,
}

impl Merged {
    pub(crate) fn new(document: Document) -> Self {
        let origins = document
            .places
            .iter()
            .map(|(pointer, &place)| (pointer.clone(), (0, place)))
            .collect();
        Self {
            value: document.value.clone(),
            origins,
            documents: vec![document],
            written: 1,
            texts: Texts::default(),
        }
    }

    /// Reads a JSON file for the places of its values, to locate faults in what is no scene.
    ///
    /// # Errors
    /// When the file cannot be read or is not JSON.
    pub fn read(path: &Path) -> Result<Self, Failure> {
        Document::read(path).map(Self::new)
    }

    /// The merged JSON.
    #[must_use]
    pub fn value(&self) -> &Value {
        &self.value
    }

    /// The patches in words: ", as A.json and B.json patch it"; nothing where there are none.
    pub(crate) fn patched(&self) -> String {
        let names = self.documents[1..self.written].iter();
        let names: Vec<String> = names.map(|d| d.path.display().to_string()).collect();
        if names.is_empty() {
            return String::new();
        }
        format!(", as {} patches it", names.join(" and "))
    }

    /// Changes the scene itself; what it adds has the origin of what is around it.
    pub(crate) fn change(
        &mut self,
        change: impl FnOnce(&mut Map<String, Value>) -> Result<(), Fault>,
    ) -> Result<(), Fault> {
        match &mut self.value {
            Value::Object(map) => change(map),
            _ => Ok(()),
        }
    }

    /// Sets a key of the scene.
    pub(crate) fn set(&mut self, key: &str, value: Value) {
        if let Value::Object(map) = &mut self.value {
            map.insert(key.to_owned(), value);
        }
    }

    /// Applies a patch.
    pub(crate) fn apply(&mut self, patch: Document) {
        let mut merge = Merge {
            origins: &mut self.origins,
            texts: &mut self.texts,
            patch: &patch,
            file: self.documents.len(),
        };
        merge.value(&mut self.value, &patch.value, "");
        self.documents.push(patch);
        self.written = self.documents.len();
    }

    /// Pointers of objects that patches have put where a text stood, with that text.
    pub(crate) fn over_texts(&self) -> Vec<(String, String)> {
        let under = self.texts.under.iter();
        under.map(|(at, text)| (at.clone(), text.clone())).collect()
    }

    /// Whether a patch has taken away what stood at a pointer.
    pub(crate) fn is_gone(&self, pointer: &str) -> bool {
        self.texts.gone.iter().any(|at| at == pointer)
    }

    /// The path of a file that the value at a pointer names: beside the file that the value is in, or else from where the
    /// program runs, as patches that are written into build folders have it.
    pub(crate) fn beside(&self, pointer: &str, file: &str) -> PathBuf {
        let (by, _) = self.origins.get(pointer).copied().unwrap_or((0, ROOT));
        let folder = self.documents[by].path.parent();
        let beside = folder.unwrap_or(Path::new("")).join(file);
        if !beside.exists() && Path::new(file).exists() {
            return file.into();
        }
        beside
    }

    /// Takes in a file whose values the scene shall have; gives its number.
    pub(crate) fn adopt(&mut self, file: Document) -> usize {
        self.documents.push(file);
        self.documents.len() - 1
    }

    /// Adds a key to the object at a pointer; its origin is that of the object.
    pub(crate) fn add(&mut self, pointer: &str, key: &str, value: Value) {
        if let Some(Value::Object(map)) = self.value.pointer_mut(pointer) {
            map.insert(key.to_owned(), value);
        }
    }

    /// Replaces the value at a pointer by one that stands in another file at `source`, or in the scene itself.
    pub(crate) fn put(&mut self, pointer: &str, value: Value, file: Option<usize>, source: &str) {
        let inside = format!("{source}/");
        let from: Vec<(String, (usize, Place))> = match file {
            Some(file) => self.documents[file]
                .places
                .iter()
                .map(|(at, &place)| (at.clone(), (file, place)))
                .collect(),
            None => self.origins.clone().into_iter().collect(),
        };
        for (at, origin) in from {
            if at == source || at.starts_with(&inside) {
                let target = format!("{pointer}{}", &at[source.len()..]);
                self.origins.insert(target, origin);
            }
        }
        let (around, key) = pointer.rsplit_once('/').unwrap_or(("", pointer));
        match self.value.pointer_mut(around) {
            Some(Value::Object(map)) => {
                map.insert(key.replace("~1", "/").replace("~0", "~"), value);
            }
            Some(Value::Array(list)) => {
                if let Some(entry) = key.parse::<usize>().ok().and_then(|i| list.get_mut(i)) {
                    *entry = value;
                }
            }
            _ => {}
        }
    }

    /// Where the value at a pointer was set, or its nearest ancestor.
    pub(crate) fn spot(&self, pointer: &str) -> Spot {
        let mut at = pointer;
        loop {
            if let Some(&(file, place)) = self.origins.get(at) {
                return self.documents[file].spot(place.value);
            }
            match at.rfind('/') {
                Some(end) => at = &at[..end],
                None => return self.documents[0].spot(0),
            }
        }
    }

    /// Number of the last file that set the value at a pointer, or something within it: 0 is the scene.
    fn set_by(&self, pointer: &str) -> usize {
        let within = format!("{pointer}/");
        let inner = self.origins.range(within.clone()..);
        let inner = inner.take_while(|(path, _)| path.starts_with(&within));
        let own = self.origins.get(pointer).map_or(0, |(file, _)| *file);
        inner.map(|(_, (file, _))| *file).fold(own, usize::max)
    }

    /// Where what a fault is about was set: within the value at a pointer if a patch changed a part of it.
    fn latest_spot(&self, pointer: &str) -> Spot {
        let last = self.set_by(pointer);
        let within = format!("{pointer}/");
        let inner = self.origins.range(within.clone()..);
        let mut inner = inner.take_while(|(path, _)| path.starts_with(&within));
        let own = self.origins.get(pointer).map_or(0, |(file, _)| *file);
        match inner.find(|(_, (file, _))| *file == last) {
            // What is said of the scene as a whole is about no key of a patch.
            Some((path, _)) if last > own && !pointer.is_empty() => self.spot(path),
            _ => self.spot(pointer),
        }
    }

    /// Where a key of the object at a pointer was set.
    pub(crate) fn key_spot(&self, pointer: &str, key: &str) -> Spot {
        match self.origins.get(&format!("{pointer}/{}", escaped(key))) {
            Some(&(file, place)) => self.documents[file].spot(place.key),
            None => self.spot(pointer),
        }
    }
}

/// Adds file, line and column to each fault, and sorts by them.
#[must_use]
pub fn located(faults: Vec<Fault>, merged: &Merged) -> Vec<Fault> {
    let place = |path: &str, key: Option<&str>| match key {
        Some(key) => merged.key_spot(path, key),
        None => merged.latest_spot(path),
    };
    let placed = |f: Fault| f.latest(|path| merged.set_by(path)).placed(place);
    let mut faults: Vec<Fault> = faults.into_iter().map(placed).collect();
    faults.sort_by(|a, b| a.spot().cmp(&b.spot()));
    faults.dedup();
    faults
}

struct Merge<'a> {
    origins: &'a mut BTreeMap<String, (usize, Place)>,
    texts: &'a mut Texts,
    patch: &'a Document,
    file: usize,
}

impl Merge<'_> {
    fn value(&mut self, target: &mut Value, patch: &Value, pointer: &str) {
        let Value::Object(changes) = patch else {
            self.forget(pointer);
            self.remember(pointer);
            *target = patch.clone();
            return;
        };
        if !target.is_object() {
            if let Value::String(text) = target {
                self.texts.under.insert(pointer.to_owned(), text.clone());
            }
            self.forget(pointer);
            self.set(pointer);
            *target = Value::Object(Map::new());
        }
        let Value::Object(map) = target else { return };
        for (key, change) in changes {
            let child = format!("{pointer}/{}", escaped(key));
            if change.is_null() {
                self.forget(&child);
                map.shift_remove(key);
                self.texts.gone.push(child);
            } else {
                if !map.contains_key(key) {
                    self.set(&child);
                }
                self.value(
                    map.entry(key.clone()).or_insert(Value::Null),
                    change,
                    &child,
                );
            }
        }
    }

    /// Removes the origin of a value and of all in it.
    fn forget(&mut self, pointer: &str) {
        let inside = format!("{pointer}/");
        self.origins
            .retain(|key, _| key != pointer && !key.starts_with(&inside));
    }

    /// Takes the origin of one value from the patch.
    fn set(&mut self, pointer: &str) {
        if let Some(&place) = self.patch.places.get(pointer) {
            self.origins.insert(pointer.to_owned(), (self.file, place));
        }
    }

    /// Takes the origin of a value and of all in it from the patch.
    fn remember(&mut self, pointer: &str) {
        let inside = format!("{pointer}/");
        for (key, &place) in &self.patch.places {
            if key == pointer || key.starts_with(&inside) {
                self.origins.insert(key.clone(), (self.file, place));
            }
        }
    }
}
