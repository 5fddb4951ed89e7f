//! Bodies whose permeability depends on the field.

use artefact::Checkpoint;
use run::{Failure, Session};

use crate::magnetic::open::multipoles::Multipoles;
use crate::magnetic::problem::Problem;
use crate::magnetic::saturation::equations::Saturation;
use crate::magnetic::saturation::stage::Saturated;
use crate::march::scheme::{Settled, Stage};

impl<const D: usize> Problem<'_, D> {
    /// A stage with what such bodies make of its field; as it is where there are none.
    pub(crate) fn saturated<'a, const K: usize>(
        &'a self,
        stage: Box<dyn Stage + 'a>,
        session: &mut Session,
    ) -> Box<dyn Stage + 'a> {
        let curved = self
            .parameters
            .laws
            .iter()
            .any(|law| law.constant().is_none());
        let Some(permeable) = self.conductors.permeable.as_ref().filter(|_| curved) else {
            return stage;
        };
        let moves = !self.parameters.still;
        let conducts = self.conductors.mu_sigma.iter();
        let conducts: Vec<bool> = conducts.map(|m| moves && *m > 0.0).collect();
        let open = self.parameters.open;
        let media = session.timed("source", || {
            let multipoles = open.then(|| Multipoles::new(&self.region, &self.weights));
            Saturation::new(
                self.ground(),
                permeable,
                &self.parameters.laws,
                &conducts,
                &self.source,
                multipoles.as_ref(),
            )
        });
        Box::new(Saturated::<D, K>::new(stage, media))
    }

    /// Tells what they took, and where they did not come to an end.
    pub(crate) fn told(&self, settled: Option<Settled>, session: &mut Session) {
        let Some(settled) = settled else {
            return;
        };
        session.closing("steps_saturation", "1", settled.steps as f64);
        session.closing("residual_saturation", "T", settled.residual);
        if let Some((change, i)) = settled.lost {
            let [x, y, z] = self.cloud.position[i];
            let name = &self.cloud.media[self.curved(i)];
            session.warn(format!(
                "not converged: saturation of {name}: the flux density at ({x:.3e}, {y:.3e}, {z:.3e}) m still changes by {change:.2e} T from step to step; its curve of magnetisation may be too steep for the points there: take smaller spacings, or shorter steps in time"
            ));
        }
    }

    /// The medium at a point that has a curve of magnetisation.
    fn curved(&self, i: usize) -> usize {
        let own = self.region.medium(i) as usize;
        let touched = (0..self.parameters.laws.len()).filter(|m| self.region.touches(i, *m as u16));
        let curved = touched
            .into_iter()
            .find(|m| self.parameters.laws[*m].constant().is_none());
        curved.unwrap_or(own)
    }
}

/// Puts what they took into a checkpoint.
pub(crate) fn save(settled: Settled, checkpoint: &mut Checkpoint) {
    let (change, place) = settled.lost.unwrap_or((-1.0, 0));
    checkpoint.put_u64("saturation_steps", &[settled.steps, place as u64]);
    checkpoint.put_f64("saturation", &[settled.residual, change]);
}

/// Takes back what [`save`] put.
///
/// # Errors
/// Where it is not there.
pub(crate) fn restored(checkpoint: &mut Checkpoint) -> Result<Settled, Failure> {
    let (steps, left) = (
        checkpoint.u64("saturation_steps")?,
        checkpoint.f64("saturation")?,
    );
    let (&[steps, place], &[residual, change]) = (&steps[..], &left[..]) else {
        let what = "the checkpoint lacks a part of \"saturation\"";
        return Err(Failure::Other(what.to_owned()));
    };
    Ok(Settled {
        steps,
        residual,
        lost: (change >= 0.0).then_some((change, place as usize)),
    })
}
