//! What an exact case is: a name, a reference, targets, and a measurement at one resolution.

use std::collections::BTreeMap;

use crate::lab::{Lab, LabError};

/// Errors by quantity, for example `temperature_linf`.
pub type Errors = BTreeMap<String, f64>;

/// A bound that the study must keep.
#[derive(Debug, Clone)]
pub enum Target {
    /// The error of `quantity` at the finest level is at most `max`.
    Error {
        /// Key of [`Errors`].
        quantity: &'static str,
        /// Largest admissible error, in the unit of the quantity.
        max: f64,
    },
    /// The observed order of `quantity` over all levels is at least `min`.
    Order {
        /// Key of [`Errors`].
        quantity: &'static str,
        /// Smallest admissible order.
        min: f64,
    },
}

/// One run of a case at one resolution.
#[derive(Debug, Clone)]
pub struct Measurement {
    /// Number of cells, points or particles.
    pub points: u64,
    /// Spacing \[m\].
    pub spacing_m: f64,
    /// Steps or iterations taken.
    pub steps: u64,
    /// Wall time of the solver, as its run record tells \[s\].
    pub run_time_s: f64,
    /// Errors measured on the artefact of the same run.
    pub errors: Errors,
}

/// An exact case. Level 1 is the coarsest.
pub trait Case: Sync {
    /// Name of the case and of its folder in `pipelines/verify`.
    fn name(&self) -> &'static str;
    /// The tool that is put to the test.
    fn tool(&self) -> &'static str;
    /// The reference: exact solution, author, year, equation.
    fn reference(&self) -> &'static str;
    /// Competing methods, each a series of its own; the first is the one that the targets bind.
    fn methods(&self) -> &'static [&'static str] {
        &["default"]
    }
    /// Bounds to keep.
    fn targets(&self) -> Vec<Target>;
    /// Runs the tool at `level` with `method` and measures the errors on the written artefact.
    ///
    /// # Errors
    /// When the tool fails or its artefact cannot be read.
    fn measure(&self, lab: &Lab, level: u32, method: &str) -> Result<Measurement, LabError>;
}
