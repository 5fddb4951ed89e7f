//! The sinusoidal steady state: its equations, their solution and the fields of it.

use krylov::{Rows, Scalar, System};
use run::{Failure, Session};

use super::charge::fields::Coupling;
use super::columns::Driven;
use super::diffusion;
use super::driven::bar::Bar;
use super::driven::right::Drive;
use super::fields::{Solution, steady_change};
use super::open::multipoles::Multipoles;
use super::problem::Problem;
use super::source::C;
use super::waves::rows::WaveRows;
use crate::frames::Found;
use crate::solve::broken::unsolvable;
use crate::solve::report;

impl<const D: usize> Problem<'_, D> {
    /// Solves the eddy currents of a sinusoidal steady state, with `K` unknowns a point: 3 in space, else 1.
    ///
    /// # Errors
    /// Where a stencil cannot be made or the solve breaks down.
    pub(crate) fn harmonic<const K: usize>(&self, session: &mut Session) -> Result<Found, Failure> {
        self.warn(session);
        let drive = session.timed("source", || self.drive::<K>());
        let charges = self.charges(session)?;
        let (found, phi) = match &charges {
            None => (self.solve(&drive, session)?, Vec::new()),
            Some(charges) => self.coupled(charges, &drive, session)?,
        };
        let mut change = steady_change(drive.omega, &found, &drive.source);
        let mut carried = drive.source.clone();
        let along = self.applied(drive.omega, &found, &mut change, &mut carried);
        let charged = charges.filter(Coupling::charged).map(|charges| {
            let rate = C::new(0.0, drive.omega);
            let voltage: Vec<C> = phi.iter().map(|phi| rate * phi).collect();
            self.charged(&charges.stencils, &voltage, &voltage, &mut change)
        });
        self.tell(self.lack(&change, 0.0), session);
        let solution = Solution {
            found: &found,
            source: &drive.source,
            change: &change,
            waves: self.waves.as_ref().map(|waves| (waves, carried.as_slice())),
        };
        Ok(session.timed("fields", || {
            let flux = self.source.flux(&self.cloud.position);
            let driven = Driven {
                source: &self.source,
                flux: &flux,
                windings: self.windings.as_ref(),
            };
            let mut found = self.found(solution, charged.as_ref(), driven);
            found.join(along);
            found
        }))
    }

    /// The reaction of all points, without charges on conductors.
    fn solve<const K: usize>(
        &self,
        drive: &Drive<K>,
        session: &mut Session,
    ) -> Result<Vec<[C; K]>, Failure> {
        let (region, sides) = (&self.region, &self.sides);
        let (conductors, unknown) = (&self.conductors, self.parameters.unknown);
        let (rates, rows) = session.timed("assemble", || {
            let rates = conductors.rates(region, sides, unknown);
            (rates, conductors.rows(region, sides, unknown))
        });
        let Some(waves) = &self.waves else {
            let right = drive.right(conductors, region, unknown, &rates);
            return self.solved(drive, rows, &rates, right, session);
        };
        let ground = self.ground();
        let made = || ground.rows(conductors, waves, &rows, rates, &drive.source);
        let WaveRows {
            rows,
            rates,
            source,
        } = session.timed("assemble", made);
        let mut right = drive.right(conductors, region, unknown, &rates);
        for (right, source) in right.iter_mut().zip(source) {
            *right = std::array::from_fn(|k| right[k] - source[k]);
        }
        self.solved(drive, rows, &rates, right, session)
    }

    /// What is applied along each bar in the rows of all points.
    fn columns<T: Scalar, const K: usize>(&self, drive: &Drive<K>, rows: &Rows<T>) -> Vec<Vec<C>>
    where
        C: From<T>,
    {
        let (region, sides) = (&self.region, &self.sides);
        let column = |bar: &Bar| bar.column(&self.conductors, region, sides, rows, drive.omega);
        self.bars.iter().map(column).collect()
    }

    /// The solution of rows with rates, where rates and weights have given this right side.
    fn solved<T: Scalar, const K: usize>(
        &self,
        drive: &Drive<K>,
        rows: Rows<T>,
        rates: &[f64],
        mut right: Vec<[C; K]>,
        session: &mut Session,
    ) -> Result<Vec<[C; K]>, Failure>
    where
        C: krylov::Unknown<T> + From<T>,
    {
        let (region, unknown) = (&self.region, self.parameters.unknown);
        let mut bars = self.columns(drive, &rows);
        for (right, given) in right.iter_mut().zip(self.given_rows::<K>()) {
            for (right, given) in right.iter_mut().zip(given) {
                *right += given;
            }
        }
        let mut pairs = if self.parameters.open {
            let multipoles = Multipoles::new(region, &self.weights);
            let mut pairs = drive.pairs(&self.conductors, region, unknown, &multipoles, &mut right);
            let bound = self.bound(&multipoles, &mut right);
            pairs.extend(drive.bound(&bound, &mut right));
            for (bar, column) in self.bars.iter().zip(&mut bars) {
                bar.far(column, &self.conductors, region, &multipoles);
            }
            pairs
        } else {
            Vec::new()
        };
        for (bar, column) in self.bars.iter().zip(bars) {
            pairs.push(bar.pair(column, drive.omega, &drive.source, &mut right));
        }
        let shift = diffusion::shift(rates, drive.omega);
        let options = self.parameters.numerics.options;
        let made = session.timed("factorise", || System::new(rows, shift, options));
        let failed = |error: krylov::Error| unsolvable("eddy currents", &error, self.cloud);
        let mut system = made.map_err(failed)?;
        let mut x = vec![[C::default(); K]; right.len()];
        let stop = session.interrupt();
        let rule = self.parameters.numerics.rule(&*stop);
        let solved = session.timed("solve", || system.solve_with(&pairs, &right, &mut x, rule));
        let size = |i: usize| x[i].iter().map(C::norm_sqr).sum();
        let name = "vector_potential";
        report(name, "V s/m", &solved, self.cloud, size, session)?;
        Ok(x)
    }

    /// Takes what is applied along bars from the rates of their points, and what of sources waves know there; the totals.
    fn applied<const K: usize>(
        &self,
        omega: f64,
        found: &[[C; K]],
        change: &mut [[C; K]],
        source: &mut [[C; K]],
    ) -> Found {
        let mut totals = Found::default();
        let all: Vec<[C; K]> = found
            .iter()
            .zip(source.iter())
            .map(|(a, s)| std::array::from_fn(|k| a[k] + s[k]))
            .collect();
        for bar in &self.bars {
            let along = bar.voltage(omega, &all);
            for i in (0..self.region.len()).filter(|i| self.region.touches(*i, bar.medium)) {
                for k in 0..K {
                    change[i][k] -= along[k];
                    source[i][k] -= along[k] / C::new(0.0, omega);
                }
            }
            let name = &self.cloud.media[bar.medium as usize];
            for (part, value) in [("real", along[0].re), ("imag", along[0].im)] {
                totals
                    .totals
                    .push((format!("bar_voltage_{name}_{part}"), "V/m", value));
            }
        }
        totals
    }
}
