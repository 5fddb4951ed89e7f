//! A and the potential of charges together: equations, their solution, and fields with it.

use run::{Failure, Session};

use crate::magnetic::charge::equations::Coupled;
use crate::magnetic::charge::parts::Parts;
use crate::magnetic::charge::potential::{Charge, Side};
use crate::magnetic::charge::solution::AtRate;
use crate::magnetic::driven::right::Drive;
use crate::magnetic::open::multipoles::Multipoles;
use crate::magnetic::problem::Problem;
use crate::magnetic::source::C;
use crate::solve::report;
use crate::stencils::region::Kind;
use crate::stencils::unfit::no_stencil;

/// The part of the electric field that may point out of a conductor, over the largest field on its
/// surface, before it is said that charges are missing.
const LACK: f64 = 0.02;

/// What charges make.
pub(crate) struct Voltage {
    /// Potential V by point \[V\]; zero where nothing conducts.
    pub(crate) voltage: Vec<C>,
    /// `d(A + A_s)/dt + grad V` on the outer side of interfaces, by face \[V/m\].
    pub(crate) beyond: Vec<[C; 3]>,
}

/// What equations in which components mix are made of: those of charges, and of bodies of another permeability in space.
pub(crate) struct Coupling {
    /// Stencils of phi; of no point where charges are not computed.
    pub(crate) stencils: Charge,
    pub(crate) equations: Coupled,
    /// Right sides without rates, by point; none where there are none.
    pub(crate) given: Vec<[C; 3]>,
}

impl Coupling {
    /// Whether any charges are sought.
    pub(crate) fn charged(&self) -> bool {
        !self.stencils.is_empty()
    }
}

/// How far the electric field on the surfaces of conductors points out of them.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Lack {
    /// The largest field \[V/m\].
    pub(crate) largest: f64,
    /// The largest part that points out \[V/m\], and its point.
    pub(crate) worst: (f64, usize),
}

impl Lack {
    /// The worse of both.
    pub(crate) fn join(&mut self, other: Self) {
        self.largest = self.largest.max(other.largest);
        if other.worst.0 > self.worst.0 {
            self.worst = other.worst;
        }
    }
}

impl<const D: usize> Problem<'_, D> {
    /// Stencils and equations of charges, where they are sought and something conducts, and of bodies of another
    /// permeability in space.
    ///
    /// # Errors
    /// Where a stencil cannot be made.
    pub(crate) fn charges(&self, session: &mut Session) -> Result<Option<Coupling>, Failure> {
        let (Some(region), Some(sides)) = (self.in_space(), self.sides_in_space()) else {
            return Ok(None);
        };
        let charged = self.parameters.charged;
        let permeable = self.conductors.permeable.as_ref();
        if !charged && permeable.is_none() {
            return Ok(None);
        }
        let conductivity = self.parameters.conductivity.iter();
        let conductivity = conductivity.map(|s| if charged { *s } else { 0.0 });
        let conductivity: Vec<f64> = conductivity.collect();
        let form = self.parameters.numerics.form;
        let made = session.timed("weights", || Charge::new(region, &conductivity, &form));
        let stencils =
            made.map_err(|error| no_stencil("electric potential", &error, self.cloud))?;
        if stencils.is_empty() && permeable.is_none() {
            return Ok(None);
        }
        let parts = Parts {
            region,
            sides,
            conductors: &self.conductors,
            conductivity: &conductivity,
            charge: &stencils,
        };
        let open = self.parameters.open;
        let multipoles = open.then(|| Multipoles::new(region, &self.weights));
        let equations = session.timed("assemble", || Coupled::new(&parts, multipoles.as_ref()));
        let mut given = self.given_rows();
        if let (Some(permeable), Some(multipoles)) = (permeable, &multipoles) {
            let far = permeable.far(region, multipoles, &self.source);
            for (given, far) in given.iter_mut().zip(far) {
                *given = std::array::from_fn(|k| given[k] + far[k]);
            }
        }
        Ok(Some(Coupling {
            stencils,
            equations,
            given,
        }))
    }

    /// The reaction of all points, and `V / (j w)` of those of conductors.
    ///
    /// # Errors
    /// Where the solve breaks down.
    pub(crate) fn coupled<const K: usize>(
        &self,
        charges: &Coupling,
        drive: &Drive<K>,
        session: &mut Session,
    ) -> Result<(Vec<[C; K]>, Vec<C>), Failure> {
        let coupled = &charges.equations;
        let rate = C::new(0.0, drive.omega);
        let options = self.parameters.numerics.options;
        let failed = |error| Failure::Other(format!("eddy currents: {error}"));
        let made = session.timed("factorise", || AtRate::new(coupled, rate, &options));
        let mut factors = made.map_err(failed)?;
        let source: Vec<[C; 3]> = spread(&drive.source);
        let mut driven: Vec<C> = source.as_flattened().iter().map(|a| rate * a).collect();
        driven.resize(coupled.len(), C::default());
        let unknowns = 0..coupled.points.len();
        let pull: Vec<C> = unknowns.map(|p| coupled.pull(p, &source)).collect();
        let right = coupled.right(&driven, 1.0, &pull, &charges.given);
        let mut x = vec![C::default(); coupled.len()];
        let stop = session.interrupt();
        let rule = self.parameters.numerics.rule(&*stop);
        let solved = session.timed("solve", || factors.solve(coupled, right, &mut x, rule));
        let (a, phi) = x.split_at(3 * coupled.points());
        let a = a.as_chunks::<3>().0;
        let size = |i: usize| a[i].iter().map(C::norm_sqr).sum();
        let name = "vector_potential";
        report(name, "V s/m", &solved, self.cloud, size, session)?;
        Ok((spread(a), coupled.whole(phi)))
    }

    /// Adds the gradient of the rate of phi to that of A; `voltage` is the potential that is written.
    pub(crate) fn charged<const K: usize>(
        &self,
        charge: &Charge,
        phi: &[C],
        voltage: &[C],
        change: &mut [[C; K]],
    ) -> Voltage {
        let mut written = vec![C::default(); change.len()];
        let mut beyond: Vec<[C; 3]> = Vec::with_capacity(self.region.faces.len());
        let pull = |i: usize, side: Side| {
            let mut sum = [C::default(); 3];
            for (q, w) in charge.gradient(i, side) {
                for k in 0..3 {
                    sum[k] += phi[q] * w[k];
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
            written[i] = voltage[p];
            let push = pull(i, Side::Inner);
            for (change, push) in change[i].iter_mut().zip(push) {
                *change += push;
            }
        }
        Voltage {
            voltage: written,
            beyond,
        }
    }

    /// How far `change`, the rate of A and of its gradient part, points out of conductors; a field is taken to be at
    /// least as large as \[V/m\].
    pub(crate) fn lack<const K: usize>(&self, change: &[[C; K]], least: f64) -> Lack {
        let mut lack = Lack::default();
        if self.in_space().is_none() {
            return lack;
        }
        let conducts = |m: u16| self.conductors.mu_sigma[m as usize] > 0.0;
        for face in &self.region.faces {
            let i = face.point as usize;
            if !conducts(face.inner) || conducts(face.outer) {
                continue;
            }
            let size = change[i].iter().map(C::norm_sqr).sum::<f64>().sqrt();
            let along = change[i].iter().zip(face.normal).map(|(e, n)| e * n);
            lack.join(Lack {
                largest: size.max(least),
                worst: (along.sum::<C>().norm(), i),
            });
        }
        lack
    }

    /// Says where a current would leave a conductor: charges are missing there.
    pub(crate) fn tell(&self, lack: Lack, session: &mut Session) {
        if lack.largest == 0.0 {
            return;
        }
        let (worst, place) = lack.worst;
        let share = worst / lack.largest;
        session.closing("field_out_of_conductors", "1", share);
        if share > LACK {
            let Kind::Interface(face) = self.region.kinds[place] else {
                return;
            };
            let inner = self.region.faces[face as usize].inner;
            let name = &self.cloud.media[inner as usize];
            let x = self.cloud.position[place];
            let what = if self.parameters.charged {
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
pub(crate) fn spread<T: Copy + Default, const A: usize, const B: usize>(
    values: &[[T; A]],
) -> Vec<[T; B]> {
    let each = |v: &[T; A]| std::array::from_fn(|k| v.get(k).copied().unwrap_or_default());
    values.iter().map(each).collect()
}
