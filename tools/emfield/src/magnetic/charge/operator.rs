//! All rows of A and phi at a rate, as one operator.

use krylov::Operator;
use rayon::prelude::*;

use crate::magnetic::charge::balance::Balance;
use crate::magnetic::charge::equations::Coupled;
use crate::magnetic::charge::parts::{ROWS, add};
use crate::magnetic::charge::rate::Rate;

/// All rows.
#[derive(Clone, Copy)]
pub(crate) struct Whole<'a, S> {
    pub(crate) coupled: &'a Coupled,
    pub(crate) rate: S,
    pub(crate) balance: &'a Balance<S>,
}

impl<S: Rate, const K: usize> Operator<S, K> for Whole<'_, S> {
    fn len(&self) -> usize {
        self.coupled.len()
    }

    fn apply(&self, x: &[[S; K]], out: &mut [[S; K]]) {
        let Self { coupled, rate, .. } = *self;
        let (a, phi) = x.split_at(3 * coupled.points());
        let (out_a, out_phi) = out.split_at_mut(3 * coupled.points());
        let a = a.as_chunks::<3>().0;
        let out_a = out_a.as_chunks_mut::<3>().0;
        coupled.rows_of_a(rate, a, phi, out_a);
        for pair in &coupled.pairs {
            let mut moment = pair.moment(a, phi).map(|m| m.map(|m| rate * m));
            if let Some(still) = pair.still(a) {
                let sum = moment.as_flattened_mut().iter_mut();
                sum.zip(still.as_flattened())
                    .for_each(|(sum, still)| *sum += *still);
            }
            for (i, u) in &pair.walls {
                for (out, moment) in out_a[*i as usize].iter_mut().zip(moment) {
                    add(out, &moment, *u);
                }
            }
        }
        self.charges(a, phi, out_phi);
        self.balance.forth(coupled, out_a, out_phi);
    }
}

impl<S: Rate> Whole<'_, S> {
    /// The rows of phi.
    fn charges<const K: usize>(&self, a: &[[[S; K]; 3]], phi: &[[S; K]], out: &mut [[S; K]]) {
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
