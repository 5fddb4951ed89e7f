//! What `make verify` writes, as far as a page needs it.

use std::collections::{BTreeMap, BTreeSet};

use serde::Deserialize;

use crate::records::{LeftOut, Memory, Spent, figure as digits};

/// More lines than this make a plot hard to read.
const MOST_LINES: usize = 8;

/// One resolution.
#[derive(Debug, Clone, Deserialize)]
pub(super) struct Level {
    pub(super) points: f64,
    #[serde(default)]
    pub(super) spacing_m: f64,
    #[serde(default)]
    pub(super) steps: f64,
    pub(super) run_time_s: f64,
    #[serde(default)]
    pub(super) run_time_least_s: Option<f64>,
    #[serde(default)]
    pub(super) run_time_greatest_s: Option<f64>,
    #[serde(default)]
    pub(super) repeats: Option<u64>,
    #[serde(default)]
    pub(super) peak_memory_bytes: Option<u64>,
    #[serde(default)]
    pub(super) threads: u64,
    pub(super) errors: BTreeMap<String, Option<f64>>,
    /// What they took, by name.
    #[serde(default)]
    pub(super) costs: BTreeMap<String, f64>,
}

/// A target and what was found.
#[derive(Debug, Clone, Deserialize)]
pub(super) struct Target {
    #[serde(default)]
    pub(super) quantity: Option<String>,
    #[serde(default)]
    pub(super) method: Option<String>,
    #[serde(default)]
    pub(super) at_points: Option<f64>,
    #[serde(default)]
    pub(super) at_level: Option<u32>,
    #[serde(default)]
    pub(super) max: Option<f64>,
    #[serde(default)]
    pub(super) min: Option<f64>,
    #[serde(default)]
    pub(super) or_error_below: Option<f64>,
    #[serde(default)]
    pub(super) finest_error: Option<f64>,
    #[serde(default)]
    pub(super) found: Option<f64>,
    #[serde(default)]
    pub(super) holds: Option<bool>,
}

/// A method over its levels.
#[derive(Debug, Clone, Deserialize)]
pub(super) struct Series {
    #[serde(default = "unnamed")]
    pub(super) method: String,
    pub(super) levels: Vec<Level>,
    #[serde(default)]
    pub(super) order: BTreeMap<String, Option<f64>>,
    #[serde(default)]
    pub(super) stages: Option<Vec<Spent>>,
    #[serde(default)]
    pub(super) memory: Option<Vec<Memory>>,
    #[serde(default)]
    pub(super) left_out: Option<Vec<LeftOut>>,
}

fn unnamed() -> String {
    "default".to_owned()
}

/// A record of `make verify`.
#[derive(Debug, Clone, Deserialize)]
pub(in crate::index) struct Study {
    pub(super) case: String,
    pub(super) tool: String,
    pub(super) reference: String,
    #[serde(flatten)]
    pub(super) first: Series,
    #[serde(default)]
    pub(super) targets: BTreeMap<String, Target>,
    pub(super) holds: bool,
    #[serde(default)]
    pub(super) series: Vec<Series>,
}

impl Study {
    /// Whether all targets are met, in words as well; `None` where none is missed but some could not be judged, since
    /// their level was not run or their method refused the patch.
    pub(super) fn standing(&self) -> (String, Option<bool>) {
        let holds = |word| self.targets.values().any(|t| t.holds == word);
        if holds(Some(false)) || (self.targets.is_empty() && !self.holds) {
            return ("targets missed".to_owned(), Some(false));
        }
        if self.targets.is_empty() {
            return ("has no targets".to_owned(), None);
        }
        if !holds(None) {
            return ("targets met".to_owned(), Some(true));
        }
        let open = self.targets.values().filter(|t| t.holds.is_none());
        let levels: BTreeSet<u32> = open.filter_map(|t| t.at_level).collect();
        let levels: Vec<String> = levels.iter().map(u32::to_string).collect();
        let why = match levels.as_slice() {
            [] => "a method refused the patch".to_owned(),
            [one] => format!("level {one} was not run"),
            several => format!("levels {} were not run", several.join(" and ")),
        };
        (format!("not judged: {why}"), None)
    }

    /// All methods, the first first.
    pub(super) fn all(&self) -> impl Iterator<Item = &Series> {
        std::iter::once(&self.first).chain(&self.series)
    }

    /// Quantities to plot: all, or where that would be too many lines those that targets name.
    pub(super) fn plotted(&self) -> Vec<&str> {
        let all = self.quantities();
        if all.len() * (1 + self.series.len()) <= MOST_LINES {
            return all;
        }
        let named = |q: &&str| {
            self.targets
                .iter()
                .any(|(key, target)| target.quantity(key) == *q)
        };
        let chosen: Vec<&str> = all.iter().copied().filter(named).collect();
        if chosen.is_empty() { all } else { chosen }
    }

    /// Quantities with an error, in the order of their names.
    pub(super) fn quantities(&self) -> Vec<&str> {
        let first = self.first.levels.first();
        first
            .map(|l| l.errors.keys().map(String::as_str).collect())
            .unwrap_or_default()
    }

    /// What runs took, by name, as far as the record tells.
    pub(super) fn costs(&self) -> Vec<&str> {
        let levels = self.all().flat_map(|series| &series.levels);
        let names = levels.flat_map(|level| level.costs.keys().map(String::as_str));
        names.collect::<BTreeSet<_>>().into_iter().collect()
    }
}

impl Target {
    pub(super) fn quantity<'a>(&'a self, key: &'a str) -> &'a str {
        let of_key = key.strip_prefix("order_").unwrap_or(key);
        self.quantity.as_deref().unwrap_or(of_key)
    }

    pub(super) fn bound(&self) -> String {
        let below = self
            .or_error_below
            .map(|below| format!(", or an error of at most {}", digits(below)));
        match (self.max, self.min) {
            (Some(max), _) => format!("at most {}", digits(max)),
            (None, Some(min)) => format!("order at least {min}{}", below.unwrap_or_default()),
            (None, None) => String::new(),
        }
    }

    pub(super) fn found(&self) -> String {
        let found = match (self.found, self.min) {
            (Some(order), Some(_)) => format!("{order:.2}").replace('-', "\u{2212}"),
            (Some(error), None) => digits(error),
            (None, _) => "nothing".to_owned(),
        };
        match self.finest_error {
            Some(error) => format!("{found}, error {}", digits(error)),
            None => found,
        }
    }

    pub(super) fn place(&self) -> String {
        match (self.max, self.at_points, self.at_level) {
            (Some(_), Some(points), _) => format!("{} points", whole(points)),
            (Some(_), None, Some(level)) => format!("level {level}"),
            (Some(_), None, None) => "finest".to_owned(),
            (None, ..) => "all levels".to_owned(),
        }
    }
}

/// A count.
pub(super) fn whole(count: f64) -> String {
    format!("{count:.0}")
}
