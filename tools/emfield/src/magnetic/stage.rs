//! The stage of a march of A alone, or of `H_z`: without charges on conductors.
//!
//! `row(A) = k d(A + A_s)/dt` with `k` from [`crate::magnetic::diffusion::Conductors::rates`].

use krylov::{Error, Options, Pair, Rescue, Rows, Rule, Solved, System};

use crate::magnetic::medium::interface::Bound;
use crate::march::scheme::Stage;

/// The rows of a stage whatever its slope, and what drives it.
#[derive(Debug, Clone)]
pub struct Equations<const K: usize> {
    /// What stands before the rates, from [`crate::magnetic::diffusion::Conductors::rates`].
    pub rates: Vec<f64>,
    /// Rows without rates.
    pub rows: Rows<f64>,
    /// Rows of low order, which precondition those of high order.
    pub low: Option<Rows<f64>>,
    /// What the unknown is held at where the wave of the sources is 1, at points where it is held.
    pub held: Vec<Option<[f64; K]>>,
    /// Right sides that currents in coils make where the wave is 1, by point; empty where there are none.
    pub given: Vec<[f64; K]>,
    /// Pairs `(u, v)` of columns: `u` times the sum of `v d(A + A_s)/dt` is added to the rows.
    pub pairs: Vec<(Vec<f64>, Vec<f64>)>,
    /// Multipoles of bound currents; none where permeability is uniform.
    pub bound: Vec<Bound>,
    /// How they are solved.
    pub options: Options,
}

/// The equations at a slope.
pub struct Alone<const K: usize> {
    slope: f64,
    equations: Equations<K>,
    system: System<f64, f64>,
    pairs: Vec<Pair<f64>>,
}

impl<const K: usize> Equations<K> {
    fn system(&self, slope: f64) -> Result<System<f64, f64>, Error> {
        let shift = self.rates.iter().map(|k| -k * slope).collect();
        let rows = self.rows.clone();
        match &self.low {
            Some(low) => System::with_low_order(rows, shift, low.clone(), self.options),
            None => System::new(rows, shift, self.options),
        }
    }

    fn implicit(&self, slope: f64) -> Vec<Pair<f64>> {
        let pair = |(u, v): &(Vec<f64>, Vec<f64>)| {
            Pair::new(u.iter().copied(), v.iter().map(|v| slope * v))
        };
        let bound = |bound: &Bound| {
            let both = bound.value.iter().zip(&bound.rate);
            let moments = both.map(|(value, rate)| -(value + slope * rate));
            Pair::new(bound.walls.iter().copied(), moments)
        };
        let pairs = self.pairs.iter().map(pair);
        pairs.chain(self.bound.iter().map(bound)).collect()
    }
}

impl<const K: usize> Alone<K> {
    /// Factorises the equations at a slope.
    ///
    /// # Errors
    /// Where a coefficient is no number, or they are singular.
    pub fn new(equations: Equations<K>, slope: f64) -> Result<Self, Error> {
        Ok(Self {
            slope,
            system: equations.system(slope)?,
            pairs: equations.implicit(slope),
            equations,
        })
    }
}

impl<const K: usize> Stage for Alone<K> {
    fn pace(&mut self, slope: f64) -> Result<(), Error> {
        self.system = self.equations.system(slope)?;
        self.pairs = self.equations.implicit(slope);
        self.slope = slope;
        Ok(())
    }

    fn rescued(&self) -> Option<Rescue> {
        self.system.rescued()
    }

    fn rescue(&mut self, way: Rescue) -> Result<(), Error> {
        self.system.rescue(way)
    }

    fn moved(&self, driven: &[f64], unknown: &[f64]) -> Vec<f64> {
        let both = unknown
            .as_chunks::<K>()
            .0
            .iter()
            .zip(driven.as_chunks::<K>().0);
        let rows = self.equations.rates.iter().zip(both);
        let row = |(rate, (a, driven)): (&f64, (&[f64; K], &[f64; K]))| -> [f64; K] {
            std::array::from_fn(|k| -rate * (self.slope * a[k] + driven[k]))
        };
        rows.flat_map(row).collect()
    }

    fn solve(
        &mut self,
        driven: &[f64],
        wave: f64,
        more: &[f64],
        unknown: &mut [f64],
        rule: Rule,
    ) -> Solved {
        let equations = &self.equations;
        let driven = driven.as_chunks::<K>().0;
        let row = |(i, held): (usize, &Option<[f64; K]>)| match held {
            Some(held) => held.map(|h| h * wave),
            None => driven[i].map(|d| equations.rates[i] * d),
        };
        let mut right: Vec<[f64; K]> = equations.held.iter().enumerate().map(row).collect();
        for (right, given) in right.iter_mut().zip(&equations.given) {
            for (right, given) in right.iter_mut().zip(given) {
                *right += given * wave;
            }
        }
        for (right, more) in right.iter_mut().zip(more.as_chunks::<K>().0) {
            *right = std::array::from_fn(|k| right[k] + more[k]);
        }
        let bound = equations.bound.iter().map(|b| (&b.walls, &b.rate, 1.0));
        let pairs = equations.pairs.iter().map(|(u, v)| (u, v, -1.0));
        for (u, v, sign) in pairs.chain(bound) {
            let moment: [f64; K] = std::array::from_fn(|k| {
                let parts = v.iter().zip(driven);
                parts.map(|(v, driven)| v * driven[k]).sum()
            });
            for (right, u) in right.iter_mut().zip(u) {
                for (right, moment) in right.iter_mut().zip(moment) {
                    *right += sign * u * moment;
                }
            }
        }
        let unknown = unknown.as_chunks_mut::<K>().0;
        self.system.solve_with(&self.pairs, &right, unknown, rule)
    }
}
