//! Approximate solution of A and V together, part after part.

use krylov::{Error, Inverse, Method, Options, Rows};

use crate::magnetic::charge::block::Block;
use crate::magnetic::charge::equations::Coupled;
use crate::magnetic::charge::operator::Whole;
use crate::magnetic::charge::parts::ones;
use crate::magnetic::charge::rate::Rate;
use crate::magnetic::medium::mixing::Magnetised;

/// Factors of the rows of A.
struct Potential<S: Rate> {
    /// With continuous slopes.
    smooth: S::Block,
    /// With slopes as reluctivity weights them, where it jumps.
    along: Option<Along<S>>,
}

/// What the rows of slopes along interfaces are solved with.
struct Along<S: Rate> {
    block: S::Block,
    /// No charges.
    uncharged: Vec<[S; 1]>,
    rest: Vec<[S; 3]>,
    found: Vec<[S; 3]>,
}

/// `rate` times what stands before it.
fn shift<S: Rate>(rates: &[f64], rate: S) -> Vec<S> {
    rates.iter().map(|r| rate.times_real(*r)).collect()
}

/// What makes diagonals positive. Laplacians have negative ones and slopes positive ones: summed up as they are, rows would
/// cancel in the coarse equations.
fn signs(rows: &Rows<f64>) -> Vec<f64> {
    let sign = |i: usize| if rows.diagonal(i) < 0.0 { -1.0 } else { 1.0 };
    (0..rows.len()).map(sign).collect()
}

impl<S: Rate> Potential<S> {
    fn new(coupled: &Coupled, rate: S, options: &Options) -> Result<Self, Error> {
        let along = |magnetised: &Magnetised| {
            let apart = &magnetised.along;
            let zeros = || vec![[S::ZERO; 3]; coupled.points()];
            Ok(Along {
                block: S::block(
                    &apart.rows,
                    &apart.sizes,
                    &shift(&apart.rates, rate),
                    options,
                )?,
                uncharged: vec![[S::ZERO; 1]; coupled.points.len()],
                rest: zeros(),
                found: zeros(),
            })
        };
        let (rows, shifts) = (&coupled.rows, shift(&coupled.rates, rate));
        Ok(Self {
            smooth: S::block(rows, &signs(rows), &shifts, options)?,
            along: coupled.magnetised.as_ref().map(along).transpose()?,
        })
    }

    /// Solves with continuous slopes, and for what that leaves along interfaces with those of reluctivities.
    fn invert(&mut self, coupled: &Coupled, rate: S, given: &[[S; 3]], found: &mut [[S; 3]]) {
        self.smooth.invert(given, found);
        let (Some(along), Some(magnetised)) = (&mut self.along, &coupled.magnetised) else {
            return;
        };
        let values = ones(found.as_flattened()).as_chunks::<3>().0;
        let rest = along.rest.as_flattened_mut();
        let rest = rest.as_chunks_mut::<1>().0.as_chunks_mut::<3>().0;
        coupled.rows_of_a(rate, values, &along.uncharged, rest);
        for (rest, given) in along.rest.iter_mut().zip(given) {
            *rest = std::array::from_fn(|k| given[k] - rest[k]);
        }
        magnetised.keep(&mut along.rest);
        along.block.invert(&along.rest, &mut along.found);
        let all = found.as_flattened_mut().iter_mut();
        all.zip(along.found.as_flattened())
            .for_each(|(found, more)| *found += *more);
    }
}

/// Factors of the rows of A and of those of phi, and scratch.
pub(crate) struct Factors<S: Rate> {
    potential: Potential<S>,
    charge: Block<f64>,
    a: [Vec<[S; 3]>; 2],
    phi: [Vec<[S; 1]>; 2],
}

impl<S: Rate> Factors<S> {
    /// Factors of the equations at a rate.
    ///
    /// # Errors
    /// Where a coefficient is no number, or a part is singular.
    pub(crate) fn new(coupled: &Coupled, rate: S, options: &Options) -> Result<Self, Error> {
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
            potential: Potential::new(coupled, rate, options)?,
            charge: Block::new(&coupled.poisson, &signs(&coupled.poisson), &hold, &own)?,
            a: [(); 2].map(|()| vec![[S::ZERO; 3]; coupled.points()]),
            phi: [(); 2].map(|()| vec![[S::ZERO; 1]; coupled.points.len()]),
        })
    }

    /// Factors of the rows of A at another rate.
    ///
    /// # Errors
    /// As for [`Self::new`].
    pub(crate) fn pace(
        &mut self,
        coupled: &Coupled,
        rate: S,
        options: &Options,
    ) -> Result<(), Error> {
        self.potential = Potential::new(coupled, rate, options)?;
        Ok(())
    }
}

/// Solves for A, then for the charges that it asks for.
pub(crate) struct Approximate<'a, S: Rate> {
    pub(crate) whole: Whole<'a, S>,
    pub(crate) factors: &'a mut Factors<S>,
}

impl<S: Rate, const K: usize> Inverse<S, K> for Approximate<'_, S> {
    fn invert(&mut self, given: &[[S; K]], found: &mut [[S; K]]) {
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
            balance.back(coupled, a, |p| given[start + p][c]);
            potential.invert(coupled, self.whole.rate, a, b);
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
