//! What is wrong with a scene, and where.

use std::fmt;
use std::path::PathBuf;

/// File, line and column, from 1.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Spot {
    pub(crate) file: PathBuf,
    pub(crate) line: usize,
    pub(crate) column: usize,
}

/// One thing that is wrong with a scene.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Fault {
    path: String,
    /// Further places that have a part in it.
    others: Vec<String>,
    what: String,
    key: Option<String>,
    spot: Option<Box<Spot>>,
}

impl Fault {
    /// A fault at a JSON pointer (`/arc/current_a`); file and line are added when it is reported.
    ///
    /// Say what is wrong with value, unit and admissible range:
    /// `Fault::at("/time/step_s", format!("{dt} s is above the viscous limit of {limit} s"))`.
    #[must_use]
    pub fn at(path: &str, what: impl Into<String>) -> Self {
        Self {
            path: path.to_owned(),
            others: Vec::new(),
            what: what.into(),
            key: None,
            spot: None,
        }
    }

    /// A fault of a key in the object at `path`.
    pub(crate) fn of_key(path: &str, key: &str, what: impl Into<String>) -> Self {
        Self {
            key: Some(key.to_owned()),
            ..Self::at(path, what)
        }
    }

    /// A fault at a place in a file that could not be parsed.
    pub(crate) fn in_text(spot: Spot, what: impl Into<String>) -> Self {
        Self {
            spot: Some(Box::new(spot)),
            ..Self::at("", what)
        }
    }

    /// The same, where the value at `path` has as much of a part in it: it is told at the one that the last patch set.
    #[must_use]
    pub fn or_at(mut self, path: &str) -> Self {
        self.others.push(path.to_owned());
        self
    }

    /// The fault at the place of all that have a part in it that was set last, as `set` counts.
    pub(crate) fn latest(mut self, set: impl Fn(&str) -> usize) -> Self {
        for other in std::mem::take(&mut self.others) {
            if self.key.is_none() && set(&other) > set(&self.path) {
                self.path = other;
            }
        }
        self
    }

    /// JSON pointer.
    #[must_use]
    pub fn path(&self) -> &str {
        &self.path
    }

    /// The fault seen from a parent: `prefix` is put before its path.
    #[must_use]
    pub fn within(mut self, prefix: &str) -> Self {
        self.path = format!("{prefix}{}", self.path);
        for other in &mut self.others {
            *other = format!("{prefix}{other}");
        }
        self
    }

    /// The fault at the place that `place` finds for its path and key, unless it has one.
    pub(crate) fn placed(mut self, place: impl FnOnce(&str, Option<&str>) -> Spot) -> Self {
        if self.spot.is_none() {
            let spot = place(&self.path, self.key.as_deref());
            self.spot = Some(Box::new(spot));
        }
        self
    }

    /// Where it is, once it has been placed.
    pub(crate) fn spot(&self) -> Option<&Spot> {
        self.spot.as_deref()
    }
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(spot) = &self.spot {
            write!(f, "{}:{}:{}: ", spot.file.display(), spot.line, spot.column)?;
        }
        match (&self.key, self.path.as_str()) {
            (Some(key), path) => write!(f, "{path}/{key}: {}", self.what),
            (None, "") => f.write_str(&self.what),
            (None, path) => write!(f, "{path}: {}", self.what),
        }
    }
}
