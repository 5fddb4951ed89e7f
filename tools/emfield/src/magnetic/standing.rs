//! Fields that stand still: a stage of a march without a rate.

use run::{Failure, Session};

use super::problem::Problem;
use super::transient::{View, stage};
use crate::frames::Found;
use crate::march::scheme::State;
use crate::solve::report;

impl<const D: usize> Problem<'_, D> {
    /// Solves the fields of steady currents, with `K` unknowns a point: 3 in space, else 1.
    ///
    /// # Errors
    /// Where a stencil cannot be made or the solve breaks down.
    pub(crate) fn standing<const K: usize>(&self, session: &mut Session) -> Result<Found, Failure> {
        self.warn(session);
        let drive = session.timed("source", || self.drive::<K>());
        let flux = self.source.flux(&self.cloud.position);
        let charges = self.charges(session)?;
        let mut stage = stage(self, &drive, charges.as_ref(), 0.0, session)?;
        let source: Vec<f64> = drive.source.as_flattened().iter().map(|a| a.re).collect();
        let unknowns = source.len() + charges.as_ref().map_or(0, |c| c.stencils.len());
        let none = vec![0.0; unknowns];
        let mut unknown = none.clone();
        let stop = session.interrupt();
        let rule = self.parameters.numerics.rule(&*stop);
        let solved = session.timed("solve", || stage.solve(&none, 1.0, &[], &mut unknown, rule));
        let size = |i: usize| unknown[K * i..K * (i + 1)].iter().map(|a| a * a).sum();
        report(
            "vector_potential",
            "V s/m",
            &solved,
            self.cloud,
            size,
            session,
        )?;
        self.told(stage.settled(), session);
        let view = View {
            problem: self,
            drive: &drive,
            flux: &flux,
            charges: charges.as_ref(),
        };
        let mut total = unknown.clone();
        for (total, source) in total.iter_mut().zip(&source) {
            *total += source;
        }
        let state = State {
            following: vec![0.0; unknowns - source.len()],
            unknown,
            total,
            change: none,
        };
        let (found, _) = session.timed("fields", || view.fields(&state, 1.0, f64::INFINITY));
        Ok(found)
    }
}
