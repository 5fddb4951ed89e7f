//! The stage of a march of A and V together.

use krylov::{Error, Options, Rescue, Rule, Solved};

use crate::magnetic::charge::equations::Coupled;
use crate::magnetic::charge::solution::AtRate;
use crate::march::scheme::Stage;

/// The equations at a slope, and what drives them.
pub struct Charged<'a> {
    slope: f64,
    coupled: &'a Coupled,
    factors: AtRate<f64>,
    /// What the sources add to the rows of phi where their wave is 1.
    pull: Vec<f64>,
    /// Right sides that currents in coils make where the wave is 1, by point; empty where there are none.
    given: Vec<[f64; 3]>,
}

impl<'a> Charged<'a> {
    /// Factorises the equations at a slope; `source` is what the sources give of A where their wave is 1, by point.
    ///
    /// # Errors
    /// Where a coefficient is no number, or a part is singular.
    pub fn new(
        coupled: &'a Coupled,
        source: &[[f64; 3]],
        given: Vec<[f64; 3]>,
        slope: f64,
        options: Options,
    ) -> Result<Self, Error> {
        let unknowns = 0..coupled.points.len();
        Ok(Self {
            slope,
            pull: unknowns.map(|p| coupled.pull(p, source)).collect(),
            factors: AtRate::new(coupled, slope, &options)?,
            coupled,
            given,
        })
    }
}

impl Stage for Charged<'_> {
    fn pace(&mut self, slope: f64) -> Result<(), Error> {
        self.slope = slope;
        self.factors.pace(self.coupled, slope)
    }

    fn rescued(&self) -> Option<Rescue> {
        self.factors.rescued().then_some(Rescue::Direct)
    }

    /// The rows of A are only ever factorised.
    fn rescue(&mut self, _: Rescue) -> Result<(), Error> {
        self.factors.rescue(self.coupled)
    }

    fn moved(&self, driven: &[f64], unknown: &[f64]) -> Vec<f64> {
        self.coupled.rated(self.slope, unknown, driven)
    }

    fn solve(
        &mut self,
        driven: &[f64],
        wave: f64,
        more: &[f64],
        unknown: &mut [f64],
        rule: Rule,
    ) -> Solved {
        let (pull, given) = (&self.pull, &self.given);
        let mut right = self.coupled.right(driven, wave, pull, given);
        self.coupled.beside(more, &mut right);
        self.factors.solve(self.coupled, right, unknown, rule)
    }
}
