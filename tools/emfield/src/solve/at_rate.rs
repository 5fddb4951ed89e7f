//! A and V together at a rate of change: [`super::coupled`] has the equations.
//!
//! The system is solved whole, by a Krylov method. Its preconditioner solves for A, then for `phi`
//! with the charges that A asks for. In a thin skin the field of these charges is nearly cancelled by
//! currents: of a wave `exp(j q x)` along a plane surface, A and phi together leave the share
//! `2 q / (q + sqrt(q^2 + k^2))` of the normal derivative of phi, with `k^2 = rate mu sigma`. Its
//! inverse is about `1 + k / (2 q)`, and `1 / q` is what the solution for a given normal derivative has
//! on the surface: the charges are corrected by `k / 2` times the potential found first.

use krylov::{
    Ending, Error, Inverse, Method, Operator, Options, Rule, Scratch, Solved, Stagnation,
    minimal_residual,
};
use rayon::prelude::*;

use super::balance::Balance;
use super::block::Block;
use super::coupled::{Coupled, add, ones};
use super::rate::Rate;

/// Bytes of a basis of minimal residuals, about.
const MEMORY: usize = 600 << 20;

/// Rows that one task gathers.
const ROWS: usize = 512;

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
        let mut hold = vec![0.0; coupled.points.len()];
        for body in &coupled.bodies {
            for p in body.clone() {
                hold[p] = coupled.hold[p] * body.len() as f64;
            }
        }
        // Multigrid serves the rows of phi badly: one-sided slopes.
        let own = match options.method {
            Method::Chosen if coupled.points.len() <= options.rescue => Options {
                method: Method::Direct,
                ..*options
            },
            _ => *options,
        };
        Ok(Self {
            rate,
            balance: Balance::new(coupled, rate),
            factors: Factors {
                potential: potential(coupled, rate, options)?,
                charge: Block::new(&coupled.poisson, &hold, &own)?,
                a: [(); 2].map(|()| vec![[S::ZERO; 3]; coupled.points()]),
                phi: [(); 2].map(|()| vec![[S::ZERO; 1]; coupled.points.len()]),
            },
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
        self.factors.potential = potential(coupled, rate, &self.options)?;
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
        self.factors.potential = potential(coupled, self.rate, &options)?;
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
        self.balance.forth(coupled, (a, ones(phi)));
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
        let with = (rule, vectors);
        minimal_residual(
            &whole,
            ones(right),
            x,
            &mut inverse,
            with,
            &mut self.scratch,
        )
    }
}

fn potential<S: Rate>(coupled: &Coupled, rate: S, options: &Options) -> Result<S::Block, Error> {
    let shift: Vec<S> = coupled.rates.iter().map(|r| rate.times_real(*r)).collect();
    S::block(&coupled.rows, &shift, options)
}

/// All rows.
#[derive(Clone, Copy)]
struct Whole<'a, S> {
    coupled: &'a Coupled,
    rate: S,
    balance: &'a Balance<S>,
}

impl<S: Rate> Operator<S> for Whole<'_, S> {
    fn len(&self) -> usize {
        self.coupled.len()
    }

    fn apply<const K: usize>(&self, x: &[[S; K]], out: &mut [[S; K]]) {
        let Self { coupled, rate, .. } = *self;
        let (a, phi) = x.split_at(3 * coupled.points());
        let (out_a, out_phi) = out.split_at_mut(3 * coupled.points());
        let a = a.as_chunks::<3>().0;
        let out_a = out_a.as_chunks_mut::<3>().0;
        let row = |(i, out): (usize, &mut [[S; K]; 3])| {
            let mut own = [[S::ZERO; K]; 3];
            for (j, w) in coupled.rows.pairs(i) {
                for (own, a) in own.iter_mut().zip(&a[j]) {
                    add(own, a, w);
                }
            }
            let moved = coupled.moved(i, (a, phi));
            for k in 0..3 {
                for c in 0..K {
                    out[k][c] = own[k][c] + rate * moved[k][c];
                }
            }
        };
        let rows = out_a.par_iter_mut().with_min_len(ROWS);
        rows.enumerate().for_each(row);
        for pair in &coupled.pairs {
            let moment = pair.moment(&coupled.points, (a, phi));
            for (i, u) in &pair.walls {
                for (out, moment) in out_a[*i as usize].iter_mut().zip(moment) {
                    for (out, moment) in out.iter_mut().zip(moment) {
                        *out += (rate * moment).times_real(*u);
                    }
                }
            }
        }
        self.charges((a, phi), out_phi);
        self.balance.forth(coupled, (out_a, out_phi));
    }
}

impl<S: Rate> Whole<'_, S> {
    /// The rows of phi.
    fn charges<const K: usize>(&self, (a, phi): (&[[[S; K]; 3]], &[[S; K]]), out: &mut [[S; K]]) {
        let coupled = self.coupled;
        let row = |(p, out): (usize, &mut [S; K])| {
            let mut sum = [S::ZERO; K];
            for (q, w) in coupled.poisson.pairs(p) {
                add(&mut sum, &phi[q], w);
            }
            let here = &a[coupled.points[p] as usize];
            for (here, normal) in here.iter().zip(coupled.normal[p]) {
                add(&mut sum, here, normal);
            }
            *out = sum;
        };
        let rows = out.par_iter_mut().with_min_len(ROWS);
        rows.enumerate().for_each(row);
        for body in &coupled.bodies {
            let mut total = [S::ZERO; K];
            for phi in &phi[body.clone()] {
                add(&mut total, phi, 1.0);
            }
            for p in body.clone() {
                add(&mut out[p], &total, coupled.hold[p]);
            }
        }
    }
}

/// Factors of the rows of A and of those of phi, and scratch.
struct Factors<S: Rate> {
    potential: S::Block,
    charge: Block<f64>,
    a: [Vec<[S; 3]>; 2],
    phi: [Vec<[S; 1]>; 2],
}

/// Solves for A, then for the charges that it asks for.
struct Approximate<'a, S: Rate> {
    whole: Whole<'a, S>,
    factors: &'a mut Factors<S>,
}

impl<S: Rate> Inverse<S> for Approximate<'_, S> {
    fn invert<const K: usize>(&mut self, given: &[[S; K]], found: &mut [[S; K]]) {
        let Whole {
            coupled, balance, ..
        } = self.whole;
        let root = self.whole.rate.root();
        let start = 3 * coupled.points();
        let Factors {
            potential,
            charge,
            a: [a, b],
            phi: [phi, rest],
        } = &mut *self.factors;
        for c in 0..K {
            let rows = given[..start].as_chunks::<3>().0;
            for (a, given) in a.iter_mut().zip(rows) {
                *a = given.map(|g| g[c]);
            }
            balance.back(coupled, (a, |p| given[start + p][c]));
            potential.invert(a, b);
            for (p, rest) in rest.iter_mut().enumerate() {
                *rest = [given[start + p][c] - coupled.pull(p, b)];
            }
            S::invert(charge, rest, phi);
            for body in &coupled.bodies {
                let on = || body.clone().filter(|p| coupled.skin[*p] != 0.0);
                let count = on().count().max(1) as f64;
                let mean = on().map(|p| phi[p][0]).sum::<S>();
                let mean = mean.times_real(1.0 / count);
                for p in on() {
                    rest[p][0] += root * (phi[p][0] - mean).times_real(coupled.skin[p]);
                }
            }
            S::invert(charge, rest, phi);
            let all = b.as_flattened().iter().chain(phi.as_flattened());
            for (found, own) in found.iter_mut().zip(all) {
                found[c] = *own;
            }
        }
    }
}
