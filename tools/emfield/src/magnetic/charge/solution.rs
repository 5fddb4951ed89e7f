//! A and V together at a rate of change: [`crate::magnetic::charge::equations`] has the equations.
//!
//! The system is solved whole, by a Krylov method. Its preconditioner solves for A, then for `phi`
//! with the charges that A asks for. In a thin skin the field of these charges is nearly cancelled by
//! currents: of a wave `exp(j q x)` along a plane surface, A and phi together leave the share
//! `2 q / (q + sqrt(q^2 + k^2))` of the normal derivative of phi, with `k^2 = rate mu sigma`. Its
//! inverse is about `1 + k / (2 q)`, and `1 / q` is what the solution for a given normal derivative has
//! on the surface: the charges are corrected by `k / 2` times the potential found first.

use krylov::{Ending, Error, Method, Options, Rule, Scratch, Solved, Stagnation, minimal_residual};

use crate::magnetic::charge::balance::Balance;
use crate::magnetic::charge::equations::Coupled;
use crate::magnetic::charge::factors::{Approximate, Factors};
use crate::magnetic::charge::operator::Whole;
use crate::magnetic::charge::parts::ones;
use crate::magnetic::charge::rate::Rate;

/// Bytes of a basis of minimal residuals, about.
const MEMORY: usize = 600 << 20;

/// The equations at a rate, with factors of their parts.
pub struct AtRate<S: Rate> {
    rate: S,
    balance: Balance<S>,
    factors: Factors<S>,
    /// How the rows of A are solved.
    options: Options,
    rescued: bool,
    scratch: Scratch<S>,
}

impl<S: Rate> AtRate<S> {
    /// Factors of the equations at a rate.
    ///
    /// # Errors
    /// Where a coefficient is no number, or a part is singular.
    pub fn new(coupled: &Coupled, rate: S, options: &Options) -> Result<Self, Error> {
        Ok(Self {
            rate,
            balance: Balance::new(coupled, rate),
            factors: Factors::new(coupled, rate, options)?,
            options: *options,
            rescued: false,
            scratch: Scratch::default(),
        })
    }

    /// Goes over to another rate.
    ///
    /// # Errors
    /// As for [`Self::new`].
    pub fn pace(&mut self, coupled: &Coupled, rate: S) -> Result<(), Error> {
        self.factors.pace(coupled, rate, &self.options)?;
        self.balance = Balance::new(coupled, rate);
        self.rate = rate;
        Ok(())
    }

    /// Whether the rows of A are factorised because multigrid did not serve.
    pub fn rescued(&self) -> bool {
        self.rescued
    }

    /// Factorises the rows of A, for this rate and those to come.
    ///
    /// # Errors
    /// Where they are singular.
    pub fn rescue(&mut self, coupled: &Coupled) -> Result<(), Error> {
        let options = Options {
            method: Method::Direct,
            ..self.options
        };
        self.factors.pace(coupled, self.rate, &options)?;
        (self.options, self.rescued) = (options, true);
        Ok(())
    }

    /// Solves the equations for right sides, of which it leaves nothing, by minimal residuals: stabilised bi-conjugate
    /// gradients take twice as many products, and stagnate in thin skins. `x` is the first guess. Where that stagnates
    /// and the points are few enough, the rows of A are factorised and it begins anew.
    pub fn solve(
        &mut self,
        coupled: &Coupled,
        mut right: Vec<S>,
        x: &mut [S],
        rule: Rule,
    ) -> Solved {
        let (a, phi) = right.split_at_mut(3 * coupled.points());
        let a = a.as_chunks_mut::<1>().0.as_chunks_mut::<3>().0;
        self.balance.forth(coupled, a, ones(phi));
        let first = self.run(coupled, &right, x, rule);
        let failed = match first.ending {
            Ending::Stagnated(why) => !matches!(why, Stagnation::Rounding { .. }),
            Ending::BrokenDown(_) => true,
            _ => false,
        };
        let few = coupled.points() <= self.options.rescue;
        if failed && few && self.options.method == Method::Chosen && self.rescue(coupled).is_ok() {
            x.fill(S::ZERO);
            let again = self.run(coupled, &right, x, rule);
            return Solved {
                products: first.products + again.products,
                ..again
            };
        }
        first
    }

    fn run(&mut self, coupled: &Coupled, right: &[S], x: &mut [S], rule: Rule) -> Solved {
        let whole = Whole {
            coupled,
            rate: self.rate,
            balance: &self.balance,
        };
        let vectors = (MEMORY / (size_of::<S>() * right.len().max(1))).clamp(20, 120);
        let mut inverse = Approximate {
            whole,
            factors: &mut self.factors,
        };
        let x = x.as_chunks_mut::<1>().0;
        let (right, rule) = (ones(right), rule.restarted(vectors));
        minimal_residual(&whole, right, x, &mut inverse, rule, &mut self.scratch)
    }
}
