//! What an exact case is: a name, a reference, targets, and a measurement at one resolution.

use std::collections::BTreeMap;

use crate::lab::{Finished, Lab, LabError};

/// Errors by quantity, for example `temperature_linf`.
pub type Errors = BTreeMap<String, f64>;

/// What a measurement took, by name, for example `iterations`: bound as errors are, and no error.
pub type Costs = BTreeMap<String, f64>;

/// What a target asks for.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Bound {
    /// The error is at most `max`, in the unit of the quantity.
    Error {
        /// Largest admissible error.
        max: f64,
    },
    /// The error is at most a multiple of that of the case's first method at the same level.
    Multiple {
        /// The multiple.
        times: f64,
        /// An error of at most this will do too: there are no multiples of round-off.
        or_error_below: f64,
    },
    /// The observed order is at least `min`.
    Order {
        /// Smallest admissible order.
        min: f64,
        /// The levels that it is observed over.
        over: Span,
        /// An error at the finest level of at most this will do too: what is exact to round-off has
        /// no order.
        or_error_below: Option<f64>,
    },
}

/// Levels over which an order is observed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Span {
    /// All that are run.
    All,
    /// The two finest: where the coarsest is not yet in the range of the order.
    FinestTwo,
}

/// A bound that the study must keep: of one quantity, one method and, for an error, one level.
///
/// ```
/// use verification::case::Target;
/// let targets = [
///     Target::error("temperature_linf", 2e-3).at_level(1),
///     Target::error("temperature_linf", 5e-4).at_level(2).of("pair-explicit"),
///     Target::order("temperature_linf", 1.8).or_error_below(1e-12),
///     Target::order("temperature_linf", 1.9).at_the_end(),
/// ];
/// assert_eq!(targets[1].name(), "temperature_linf_at_level_2_of_pair-explicit");
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Target {
    /// Key of [`Errors`].
    pub quantity: String,
    /// What is asked for.
    pub bound: Bound,
    /// The level at which an error is judged; the finest where none is named.
    pub level: Option<u32>,
    /// The method that is judged; the first of the case where none is named.
    pub method: Option<String>,
}

impl Target {
    /// The error of `quantity` is at most `max`.
    #[must_use]
    pub fn error(quantity: impl Into<String>, max: f64) -> Self {
        Self::new(quantity.into(), Bound::Error { max })
    }

    /// The error of `quantity` is at most `times` that of the case's first method, or at most
    /// `or_error_below`.
    #[must_use]
    pub fn multiple(quantity: impl Into<String>, times: f64, or_error_below: f64) -> Self {
        let bound = Bound::Multiple {
            times,
            or_error_below,
        };
        Self::new(quantity.into(), bound)
    }

    /// The order of `quantity` is at least `min`.
    #[must_use]
    pub fn order(quantity: impl Into<String>, min: f64) -> Self {
        let bound = Bound::Order {
            min,
            over: Span::All,
            or_error_below: None,
        };
        Self::new(quantity.into(), bound)
    }

    fn new(quantity: String, bound: Bound) -> Self {
        Self {
            quantity,
            bound,
            level: None,
            method: None,
        }
    }

    /// Judged at this level (1 is the coarsest) instead of the finest; not judged where the level is
    /// not run. An order has no level.
    #[must_use]
    pub fn at_level(mut self, level: u32) -> Self {
        self.level = Some(level);
        self
    }

    /// Judged on this method instead of the first.
    #[must_use]
    pub fn of(mut self, method: impl Into<String>) -> Self {
        self.method = Some(method.into());
        self
    }

    /// Met too where the error at the finest level is at most `error`. For an order only.
    #[must_use]
    pub fn or_error_below(mut self, error: f64) -> Self {
        if let Bound::Order { or_error_below, .. } = &mut self.bound {
            *or_error_below = Some(error);
        }
        self
    }

    /// Judged between the two finest levels instead of over all. For an order only.
    #[must_use]
    pub fn at_the_end(mut self) -> Self {
        if let Bound::Order { over, .. } = &mut self.bound {
            *over = Span::FinestTwo;
        }
        self
    }

    /// The key of the target in the record.
    #[must_use]
    pub fn name(&self) -> String {
        let mut name = match self.bound {
            Bound::Error { .. } | Bound::Multiple { .. } => self.quantity.clone(),
            Bound::Order {
                over: Span::All, ..
            } => format!("order_{}", self.quantity),
            Bound::Order {
                over: Span::FinestTwo,
                ..
            } => format!("order_{}_at_the_end", self.quantity),
        };
        if let Some(level) = self.level {
            name += &format!("_at_level_{level}");
        }
        if let Some(method) = &self.method {
            name += &format!("_of_{method}");
        }
        name
    }
}

/// One method of a case at one resolution: what was run, and the errors of what it wrote.
#[derive(Debug, Clone)]
pub struct Measurement {
    /// Number of cells, points or particles.
    pub points: u64,
    /// Spacing \[m\].
    pub spacing_m: f64,
    /// The runs whose time counts; short ones are repeated by the study.
    pub runs: Vec<Finished>,
    /// Errors measured on the artefacts of these runs.
    pub errors: Errors,
    /// What they took.
    pub costs: Costs,
}

impl Measurement {
    /// A measurement of one run.
    #[must_use]
    pub fn of(run: Finished, points: u64, spacing_m: f64, errors: Errors) -> Self {
        Self::over(vec![run], points, spacing_m, errors)
    }

    /// A measurement of several runs.
    #[must_use]
    pub fn over(runs: Vec<Finished>, points: u64, spacing_m: f64, errors: Errors) -> Self {
        Self {
            points,
            spacing_m,
            runs,
            errors,
            costs: Costs::new(),
        }
    }

    /// With what it took.
    #[must_use]
    pub fn at_costs<const N: usize>(self, costs: [(&str, f64); N]) -> Self {
        Self {
            costs: costs.map(|(name, cost)| (name.to_owned(), cost)).into(),
            ..self
        }
    }
}

/// An exact case. Level 1 is the coarsest.
pub trait Case: Sync {
    /// Name of the case and of its folder in `pipelines/verify`.
    fn name(&self) -> &'static str;
    /// The tool that is put to the test.
    fn tool(&self) -> &'static str;
    /// The reference: exact solution, author, year, equation.
    fn reference(&self) -> &'static str;
    /// Competing methods, each a series of its own; targets bind the first unless they name another.
    fn methods(&self) -> &'static [&'static str] {
        &["default"]
    }
    /// The levels of `asked` at which `method` is run: all, unless some are beyond it.
    fn levels(&self, method: &str, asked: &[u32]) -> Vec<u32> {
        let _ = method;
        asked.to_vec()
    }
    /// Bounds to keep.
    fn targets(&self) -> Vec<Target>;
    /// Runs the tool at `level` with `method` and measures the errors on the written artefact. Runs
    /// of one case need labels that differ by level and method: they are repeated later.
    ///
    /// # Errors
    /// When the tool fails or its artefact cannot be read.
    fn measure(&self, lab: &Lab, level: u32, method: &str) -> Result<Measurement, LabError>;
}
