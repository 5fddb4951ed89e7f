//! Bars along z in a plane that carry a given net current.
//!
//! What is applied along a bar drops by the same everywhere in its section, `E = g - j w (A + A_s)` with one unknown
//! `g = -dV/dz`. In all rows the rate `j w (A + A_s)` of the bar gives way to `j w (A + A_s) - g`, and
//!
//! `int sigma (g - j w (A + A_s)) dS = I`, so that `g = (I / sigma + j w int (A + A_s) dS) / S`.
//!
//! With this g the rows have a low-rank part, one pair for each bar. Bars without a given current are joined far away,
//! `g = 0`.

use krylov::{Pair, Rows, Scalar};

use crate::magnetic::diffusion::Conductors;
use crate::magnetic::driven::right;
use crate::magnetic::open::multipoles::Multipoles;
use crate::magnetic::source::C;
use crate::magnetic::unknown::Unknown;
use crate::stencils::region::{Kind, Region};
use crate::stencils::sides::Sides;

/// A bar.
#[derive(Debug, Clone)]
pub struct Bar {
    /// Its medium.
    pub medium: u16,
    /// Its net current over its conductivity \[V m\].
    drop: C,
    /// By point: its part of the section, over the whole.
    shares: Vec<f64>,
    /// Section \[m2\].
    section: f64,
}

impl Bar {
    /// A bar of a medium with the conductivity `sigma` \[S/m\] that carries a current \[A\]; `weights` are those of
    /// [`crate::stencils::quadrature`].
    #[must_use]
    pub fn new<const D: usize>(
        region: &Region<D>,
        weights: &[f64],
        medium: u16,
        sigma: f64,
        current: C,
    ) -> Self {
        let own = |(i, w): (usize, &f64)| if region.medium(i) == medium { *w } else { 0.0 };
        let mut shares: Vec<f64> = weights.iter().enumerate().map(own).collect();
        let section: f64 = shares.iter().sum();
        shares.iter_mut().for_each(|w| *w /= section);
        Self {
            medium,
            drop: current / sigma,
            shares,
            section,
        }
    }

    /// What g is multiplied by in each row but those of walls: `rates` with this bar alone, and inside it, where rows are
    /// not made of differences, less what they make of the same everywhere.
    #[must_use]
    pub fn column<T: Scalar, const D: usize>(
        &self,
        conductors: &Conductors,
        region: &Region<D>,
        sides: &Sides<D>,
        rows: &Rows<T>,
        omega: f64,
    ) -> Vec<C>
    where
        C: From<T>,
    {
        let own = |(m, value): (usize, &f64)| {
            if m == self.medium as usize {
                *value
            } else {
                0.0
            }
        };
        let alone = Conductors {
            mu_sigma: conductors.mu_sigma.iter().enumerate().map(own).collect(),
            ..conductors.clone()
        };
        let rates = alone.rates(region, sides, Unknown::Potential);
        let rate = C::new(0.0, omega);
        let each = rates.iter().enumerate().map(|(i, at)| {
            let sum: C = match region.kinds[i] {
                Kind::Inside(m) if m == self.medium => rows.pairs(i).map(|(_, w)| C::from(w)).sum(),
                _ => C::default(),
            };
            *at - sum / rate
        });
        each.collect()
    }

    /// Adds to a column what g gives in the rows of walls through the multipoles of the current.
    pub fn far<const D: usize>(
        &self,
        column: &mut [C],
        conductors: &Conductors,
        region: &Region<D>,
        multipoles: &Multipoles,
    ) {
        for (field, moment) in right::pairs(conductors, region, Unknown::Potential, multipoles) {
            let own = |(i, v): (usize, &f64)| {
                if region.medium(i) == self.medium {
                    *v
                } else {
                    0.0
                }
            };
            let whole: f64 = moment.iter().enumerate().map(own).sum();
            for (column, field) in column.iter_mut().zip(&field) {
                *column -= field * whole;
            }
        }
    }

    /// The pair that stands for g in the rows, and what the current and sources give through it on the right side.
    #[must_use]
    pub fn pair<const K: usize>(
        &self,
        column: Vec<C>,
        omega: f64,
        source: &[[C; K]],
        right: &mut [[C; K]],
    ) -> Pair<C> {
        let given = self.voltage(omega, source);
        for (right, at) in right.iter_mut().zip(&column) {
            *right = std::array::from_fn(|k| right[k] - at * given[k]);
        }
        Pair::new(column, self.shares.iter().map(|w| C::new(0.0, omega * w)))
    }

    /// `g` of a potential by point \[V/m\].
    #[must_use]
    pub fn voltage<const K: usize>(&self, omega: f64, potential: &[[C; K]]) -> [C; K] {
        let mut mean = [C::default(); K];
        for (w, a) in self.shares.iter().zip(potential) {
            mean = std::array::from_fn(|k| mean[k] + a[k] * *w);
        }
        mean.map(|a| self.drop / self.section + C::new(0.0, omega) * a)
    }
}
