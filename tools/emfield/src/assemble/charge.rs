//! Charges on the conductors of a scene in space.

use num_complex::Complex;
use run::{Failure, Session};

use super::currents::{Setting, media};
use crate::scene::currents::OuterReaction;
use crate::solve::charge::{Charge, Side};
use crate::solve::coupled::{Coupled, Parts};
use crate::solve::eddy::Drive;
use crate::solve::factors;
use crate::solve::multipole::Multipoles;
use crate::solve::region::Kind;

type C = Complex<f64>;

/// The part of the electric field that may point out of a conductor, over the largest field on its
/// surface, before it is said that charges are missing.
const LACK: f64 = 0.02;

/// What charges make.
pub(super) struct Charged {
    /// Potential V by point \[V\]; zero where nothing conducts.
    pub(super) voltage: Vec<C>,
    /// `d(A + A_s)/dt + grad V` on the outer side of interfaces, by face \[V/m\].
    pub(super) beyond: Vec<[C; 3]>,
}

impl<const D: usize> Setting<'_, D> {
    /// The stencils of the potential of charges, where the scene computes it and something conducts.
    ///
    /// # Errors
    /// Where a stencil cannot be made.
    pub(super) fn charge(&self, session: &mut Session) -> Result<Option<Charge>, Failure> {
        match self.in_space() {
            Some(region) if self.currents.charged(self.scene.geometry) => {
                let sigma = media(self.scene, |m| m.conductivity_s_m);
                let form = super::form(self.scene);
                let made = session.timed("weights", || Charge::new(region, &sigma, &form));
                made.map_err(|error| Failure::Other(format!("electric potential: {error}")))
            }
            _ => Ok(None),
        }
    }

    /// The reaction of all points, and `V / (j w)` of those of conductors.
    ///
    /// # Errors
    /// Where a stencil cannot be made or the solve breaks down.
    pub(super) fn coupled<const K: usize>(
        &self,
        charge: &Charge,
        drive: &Drive<K>,
        session: &mut Session,
    ) -> Result<(Vec<[C; K]>, Vec<C>), Failure> {
        let (Some(region), Some(sides)) = (self.in_space(), self.sides_in_space()) else {
            return Ok((
                self.solve(drive, session)?,
                vec![C::default(); charge.len()],
            ));
        };
        let conductivity = media(self.scene, |m| m.conductivity_s_m);
        let parts = Parts {
            region,
            sides,
            conductors: &self.conductors,
            conductivity: &conductivity,
            charge,
            omega: drive.omega,
        };
        let source: Vec<[C; 3]> = spread(&drive.source);
        let coupled = session.timed("assemble", || {
            let open = self.currents.outer == OuterReaction::Multipole;
            let multipoles = open.then(|| Multipoles::new(&self.region, &self.weights));
            Coupled::new(&parts, (&source, &self.wound()), multipoles.as_ref())
        });
        let options = super::options(self.scene);
        let stop = session.interrupt();
        let rule = super::rule(self.scene, &*stop);
        let with = (&options, rule);
        let made = session.timed("solve", || factors::solve(&parts, &coupled, with));
        let ((a, phi), solved) =
            made.map_err(|error| Failure::Other(format!("eddy currents: {error}")))?;
        let size = |i: usize| a[i].iter().map(C::norm_sqr).sum();
        let at = (self.cloud, size);
        super::report(("vector_potential", "V s/m"), &solved, at, session)?;
        Ok((spread(&a), phi))
    }

    /// Adds `grad V` to the rate of A.
    pub(super) fn charged<const K: usize>(
        &self,
        (charge, phi): (&Charge, &[C]),
        omega: f64,
        change: &mut [[C; K]],
    ) -> Charged {
        let rate = C::new(0.0, omega);
        let mut voltage = vec![C::default(); change.len()];
        let mut beyond: Vec<[C; 3]> = Vec::with_capacity(self.region.faces.len());
        let pull = |i: usize, side: Side| {
            let mut sum = [C::default(); 3];
            for (q, w) in charge.gradient(i, side) {
                for k in 0..3 {
                    sum[k] += phi[q] * rate * w[k];
                }
            }
            sum
        };
        for face in &self.region.faces {
            let i = face.point as usize;
            let push = pull(i, Side::Outer);
            beyond.push(std::array::from_fn(|k| change[i][k.min(K - 1)] + push[k]));
        }
        for (p, i) in charge.points.iter().enumerate() {
            let i = *i as usize;
            voltage[i] = rate * phi[p];
            let push = pull(i, Side::Inner);
            for (change, push) in change[i].iter_mut().zip(push) {
                *change += push;
            }
        }
        Charged { voltage, beyond }
    }

    /// Says where a current would leave a conductor: charges are missing there.
    pub(super) fn lack<const K: usize>(&self, change: &[[C; K]], session: &mut Session) {
        if self.in_space().is_none() {
            return;
        }
        let conducts = |m: u8| self.conductors.mu_sigma[m as usize] > 0.0;
        let (mut largest, mut worst, mut place) = (0.0_f64, 0.0_f64, 0);
        for face in &self.region.faces {
            let i = face.point as usize;
            if !conducts(face.inner) || conducts(face.outer) {
                continue;
            }
            let size = change[i].iter().map(C::norm_sqr).sum::<f64>().sqrt();
            let along = change[i].iter().zip(face.normal).map(|(e, n)| e * n);
            let out = along.sum::<C>().norm();
            largest = largest.max(size);
            if out > worst {
                (worst, place) = (out, i);
            }
        }
        if largest == 0.0 {
            return;
        }
        let share = worst / largest;
        session.closing("field_out_of_conductors", "1", share);
        if share > LACK {
            let Kind::Interface(face) = self.region.kinds[place] else {
                return;
            };
            let inner = self.region.faces[face as usize].inner;
            let name = self.scene.medium_name(inner as usize);
            let x = self.cloud.position[place];
            let what = if self.currents.charged(self.scene.geometry) {
                "the solution is not converged"
            } else {
                "charges are missing, which the potential of conductors would compute"
            };
            session.warn(format!(
                "at ({:.3e}, {:.3e}, {:.3e}) m {share:.1e} of the largest electric field on the surface points out of {name}: {what}",
                x[0], x[1], x[2]
            ));
        }
    }
}

/// The same components, of which there are three in space.
fn spread<const A: usize, const B: usize>(values: &[[C; A]]) -> Vec<[C; B]> {
    let each = |v: &[C; A]| std::array::from_fn(|k| v.get(k).copied().unwrap_or_default());
    values.iter().map(each).collect()
}
