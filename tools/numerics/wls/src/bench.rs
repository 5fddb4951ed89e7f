//! What rows are made with: the cloud, the plan and the rules of all, and the memory of one worker.

use crate::basis::Basis;
use crate::error::Error;
use crate::fit::Fit;
use crate::functional::{Columns, Condition};
use crate::moments::Coefficients;
use crate::plan::{Plan, Rules};
use crate::search::{Search, Support};

/// Everything that rows of one plan share.
pub(crate) struct Bench<'a, const D: usize> {
    pub(crate) search: &'a Search<'a, D>,
    pub(crate) plan: &'a Plan,
    pub(crate) rules: &'a dyn Rules<D>,
    pub(crate) columns: Columns,
    /// By order, from 1.
    pub(crate) bases: Vec<Basis<D>>,
}

impl<'a, const D: usize> Bench<'a, D> {
    /// The bench of a plan.
    ///
    /// # Errors
    /// Where the plan is none.
    pub(crate) fn new(
        search: &'a Search<'a, D>,
        plan: &'a Plan,
        rules: &'a dyn Rules<D>,
    ) -> Result<Self, Error> {
        plan.check::<D>()?;
        Ok(Self {
            search,
            plan,
            rules,
            columns: Columns::new::<D>(plan.wants),
            bases: (1..=plan.order.max(2)).map(Basis::new).collect(),
        })
    }
}

/// Memory of one worker.
pub(crate) struct Work<const D: usize> {
    pub(crate) support: Support<D>,
    pub(crate) fit: Fit<D>,
    pub(crate) conditions: Vec<Condition<D>>,
    /// For each row of a condition: the power of the spacing that its datum bears, if it has one.
    pub(crate) powers: Vec<Option<i32>>,
    pub(crate) condition_rows: Vec<Coefficients>,
    /// What a harmonic polynomial obeys, where it must be one.
    pub(crate) harmonic: Vec<Coefficients>,
    pub(crate) functionals: Vec<Coefficients>,
    /// What the weights of points are multiplied by beside that of their distance: room of each point over that of the
    /// own one, where points weigh by it, and more along columns of layers.
    pub(crate) rooms: Vec<f64>,
    /// Weights of the data of conditions, functional after functional.
    pub(crate) shares: Vec<f64>,
}

impl<const D: usize> Work<D> {
    pub(crate) fn new() -> Self {
        Self {
            support: Support::new(),
            fit: Fit::new(),
            conditions: Vec::new(),
            powers: Vec::new(),
            condition_rows: Vec::new(),
            harmonic: Vec::new(),
            functionals: Vec::new(),
            rooms: Vec::new(),
            shares: Vec::new(),
        }
    }
}
