//! What a method that chooses for itself turns to where multigrid stands still.
//!
//! Coarse equations are sums of rows. Where rows lean on many neighbours with weights of both signs, as those of quartics
//! over layers much thinner than wide, sums stand for other equations. Incomplete factors by size (Saad 1994) know each row
//! as it is, and are tried next unless they amplify; then multigrid with minimal residuals, and sparse factors where the
//! system is small enough.

use crate::factors::{Factors, joined, weak};
use crate::lowrank::Ties;
use crate::operator::Equations;
use crate::{
    Coefficient, Direct, Ending, Error, Incomplete, Keep, Rule, Scalar, Solved, Stagnation, System,
};

/// Most products that incomplete factors take.
const TRIED: usize = 400;

/// What they keep.
const KEEP: Keep = Keep::Threshold {
    drop: 1e-2,
    fill: 1.0,
};

/// What took the place of multigrid where that stood still.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Rescue {
    /// Incomplete factors by size.
    Incomplete,
    /// Sparse factors.
    Direct,
}

/// Are sparse factors to be tried?
fn failed(solved: &Solved) -> bool {
    match solved.ending {
        Ending::Stagnated(why) => !matches!(why, Stagnation::Rounding { .. }),
        Ending::BrokenDown(_) => true,
        Ending::Converged | Ending::Stopped | Ending::Spent => false,
    }
}

impl<S: Scalar, T> System<T, S>
where
    T: Coefficient<S> + Scalar,
    f32: Coefficient<S> + Coefficient<T>,
{
    /// Goes over to what multigrid was replaced by in another system of the same equations: what is solved from here on
    /// has the bits that it had there.
    ///
    /// # Errors
    /// Where sparse factors are asked for and the equations are singular.
    pub fn rescue(&mut self, way: Rescue) -> Result<(), Error> {
        self.factors = match way {
            Rescue::Incomplete => Factors::Real(self.incomplete_factors()),
            Rescue::Direct => Factors::Direct(Box::new(Direct::new(&self.rows, &self.shift)?)),
        };
        self.rescued = Some(way);
        Ok(())
    }

    fn incomplete_factors(&self) -> Incomplete<f32> {
        Incomplete::new(&self.rows, &self.shift, &self.order, KEEP)
    }

    /// Solves by what serves.
    pub(crate) fn choose<const C: usize>(
        &mut self,
        ties: &Ties<S>,
        b: &[[S; C]],
        y: &mut [[S; C]],
        rule: Rule,
    ) -> Solved {
        let mut solved = self.run(ties, |factors, a, scratch| {
            factors.stabilised(&Equations { a, b }, y, rule, scratch)
        });
        if weak(&solved) && !matches!(self.factors, Factors::Direct(_)) {
            solved = match self.incomplete(ties, b, y, solved, rule) {
                Ok(solved) => return solved,
                Err(solved) => self.run(ties, |factors, a, scratch| {
                    factors.minimal(&Equations { a, b }, y, solved, rule, scratch)
                }),
            };
        }
        let small = self.rows.len() <= self.options.rescue;
        if failed(&solved)
            && small
            && !matches!(self.factors, Factors::Direct(_))
            && let Ok(factors) = Direct::new(&self.rows, &self.shift)
        {
            self.factors = Factors::Direct(Box::new(factors));
            self.rescued = Some(Rescue::Direct);
            y.fill([S::ZERO; C]);
            let last = self.run(ties, |factors, a, scratch| {
                factors.solve(&Equations { a, b }, y, rule, scratch)
            });
            solved = joined(solved, last);
        }
        solved
    }

    /// Goes on with incomplete factors, which stay if they serve; otherwise all is as before but for the products spent.
    fn incomplete<const C: usize>(
        &mut self,
        ties: &Ties<S>,
        b: &[[S; C]],
        y: &mut [[S; C]],
        solved: Solved,
        rule: Rule,
    ) -> Result<Solved, Solved> {
        let left = rule.products.saturating_sub(solved.products);
        if left == 0 || matches!(self.factors, Factors::Real(_)) {
            return Err(solved);
        }
        let factors = self.incomplete_factors();
        if factors.growth::<S>() > self.usual_growth() {
            return Err(solved);
        }
        let grids = std::mem::replace(&mut self.factors, Factors::Real(factors));
        let before = (y.to_vec(), solved.ending);
        if solved.worst() > 1.0 {
            y.fill([S::ZERO; C]);
        }
        let rule = Rule {
            products: TRIED.min(left),
            ..rule
        };
        let next = self.run(ties, |factors, a, scratch| {
            factors.solve(&Equations { a, b }, y, rule, scratch)
        });
        let mut both = joined(solved, next);
        if both.converged() || both.ending == Ending::Stopped {
            self.rescued = Some(Rescue::Incomplete);
            return Ok(both);
        }
        self.factors = grids;
        y.copy_from_slice(&before.0);
        both.ending = before.1;
        Err(both)
    }
}
