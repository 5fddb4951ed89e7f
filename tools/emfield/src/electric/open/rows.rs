//! Walls of electrostatics as if there were none: what bodies add to an applied potential decays beyond them, as the
//! sum of its multipoles.
//!
//! Over any closed surface about all bodies, in the medium around them, Green's second identity gives the moments of
//! what lies within, `M = int (V dR/dn - R dV/dn) dS` with a regular harmonic R, whatever bodies are: dielectrics,
//! electrodes or both. An applied potential `V_a`, harmonic within, has none of its own. So rows of walls are
//!
//! `V - sum F M(V - V_a) = V_a`, with the harmonics F that decay.
//!
//! In a plane the logarithm of a whole charge does not decay. Bodies have none together, and the potential far away is
//! the number C that lets their charge be zero: `V = V_0 + C V_1`, `V_1` with 1 in place of `V_a`. Without electrodes
//! their charge is zero by itself, and C with it.

use krylov::Pair;

use crate::electric::open::harmonics::Harmonics;
use crate::stencils::region::{Kind, Region};
use crate::surface::fits::Enclosed;

/// Open walls: moments over a surface and what each gives at the walls.
#[derive(Debug, Clone)]
pub struct Open {
    harmonics: Harmonics,
    /// By harmonic and point: what a potential adds to the moment.
    moments: Vec<Vec<f64>>,
    /// By harmonic and point: what a unit moment gives there; zero off the walls.
    fields: Vec<Vec<f64>>,
    /// By point: what a potential adds to the flux of its field through the surface.
    flux: Vec<f64>,
}

impl Open {
    /// Multipoles about a centre, up to the sixth degree in space, the eighth in a plane and about an axis, with moments
    /// over a surface about all bodies.
    #[must_use]
    pub fn new<const D: usize>(
        region: &Region<D>,
        enclosed: &Enclosed<D>,
        centre: [f64; D],
    ) -> Self {
        let wall = |i: usize| matches!(region.kinds[i], Kind::Wall { .. });
        Self::of(region, enclosed, centre, wall)
    }

    /// The same where only some walls are open.
    #[must_use]
    pub fn of<const D: usize>(
        region: &Region<D>,
        enclosed: &Enclosed<D>,
        centre: [f64; D],
        opened: impl Fn(usize) -> bool,
    ) -> Self {
        let harmonics = Harmonics::of(D, region.axial);
        let off = |x: [f64; D]| -> [f64; D] { std::array::from_fn(|k| x[k] - centre[k]) };
        let surface = &enclosed.surface;
        let places = surface.places.iter().zip(&surface.normals);
        let regular: Vec<_> = places
            .map(|(x, n)| {
                let found = harmonics.regular(off(region.lower(*x)));
                let n = region.lower(*n);
                let through = |slope: [f64; D]| (0..D).map(|k| slope[k] * n[k]).sum::<f64>();
                let each = found.into_iter().map(|(r, slope)| (through(slope), -r));
                each.collect::<Vec<(f64, f64)>>()
            })
            .collect();
        let count = regular.first().map_or(0, Vec::len);
        let sum = |l: usize| enclosed.integral(region, |place| regular[place][l]);
        let mut fields = vec![vec![0.0; region.len()]; count];
        for i in 0..region.len() {
            if opened(i) {
                let decaying = harmonics.decaying(off(region.places[i]));
                for (field, value) in fields.iter_mut().zip(decaying) {
                    field[i] = value;
                }
            }
        }
        Self {
            harmonics,
            moments: (0..count).map(sum).collect(),
            fields,
            flux: enclosed.integral(region, |_| (0.0, -1.0)),
        }
    }

    /// What the multipoles put into the rows of walls.
    #[must_use]
    pub fn pairs(&self) -> Vec<Pair<f64>> {
        let both = self.fields.iter().zip(&self.moments);
        let pair = |(field, moment): (&Vec<f64>, &Vec<f64>)| {
            Pair::new(field.iter().map(|f| -f), moment.iter().copied())
        };
        both.map(pair).collect()
    }

    /// Whether the potential of a point counts in the moments.
    #[must_use]
    pub fn asks(&self, i: usize) -> bool {
        self.flux[i] != 0.0 || self.moments.iter().any(|m| m[i] != 0.0)
    }

    /// Takes the moments of an applied potential, by point, out of the right side.
    pub fn applied(&self, potential: &[f64], right: &mut [[f64; 1]]) {
        for (field, moment) in self.fields.iter().zip(&self.moments) {
            let given = dot(moment, potential);
            for (right, field) in right.iter_mut().zip(field) {
                right[0] -= field * given;
            }
        }
    }

    /// Flux of the field of a potential by point out of the surface: the charge of all within over its permittivity.
    #[must_use]
    pub fn flux(&self, potential: &[f64]) -> f64 {
        dot(&self.flux, potential)
    }

    /// The dipole moment of all within over the permittivity, by coordinate; about an axis that along it alone.
    #[must_use]
    pub fn dipole(&self, potential: &[f64]) -> Vec<f64> {
        let moment = |(l, factor): &(usize, f64)| factor * dot(&self.moments[*l], potential);
        self.harmonics.dipole().iter().map(moment).collect()
    }

    /// Whether a whole charge has a potential that does not decay.
    #[must_use]
    pub fn logarithmic(&self) -> bool {
        self.harmonics == Harmonics::Plane
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
