//! Coils that are regions of points: a current density that is given, with the potential that it makes as an unknown.
//!
//! The unknown is then the whole potential of these coils, not a reaction to them (Matsuzawa 2017, eqs 2.64 and 2.69, with
//! the current of the coil on the right side): in a coil `lap A = -mu J`, about an axis `lap (A/r) + 3/r d(A/r)/dr =
//! -mu J / r`. The current is spread evenly over the section of the coil and flows around an axis, or along z in a plane,
//! so that `div J = 0`. On the surface of the coil `dA/dn` is continuous, from one-sided gradients that know the Laplacian
//! of their side: with the shares s of the Laplacians in them, `row(A) = mu (s_i J_i - s_o J_o)`.
//!
//! Where the walls truncate nothing, the potential there is the sum of those of the parts of the coil: by coaxial rings
//! about an axis, by lines in a plane, by `mu J dV / (4 pi d)` in space.

use std::f64::consts::{PI, TAU};

use num_complex::Complex;
use rayon::prelude::*;
use shapes::frame::{cross, difference, dot};

use crate::magnetic::source::{C, Loop, MU0, Wire};
use crate::magnetic::unknown::{Unknown, component};
use crate::stencils::region::{Kind, Region};
use crate::stencils::sides::{Sides, share_along};

const ZERO: C = Complex::new(0.0, 0.0);

/// A ring or line of current counts as this thin \[m\].
const THIN: f64 = 1e-9;

/// Where a current flows.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Flow {
    /// Around an axis in space: a place on it \[m\] and its direction.
    Ring([f64; 3], [f64; 3]),
    /// Around the axis of symmetry.
    Turn,
    /// Along z in a plane.
    Along,
}

/// A medium that carries a given current.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Winding {
    /// The medium.
    pub medium: u16,
    /// Current density \[A/m2\], rms.
    pub density: C,
    /// Where it flows.
    pub flow: Flow,
}

impl Winding {
    /// The current density at a place in space, about an axis away from it, around it and along it \[A/m2\].
    #[must_use]
    pub fn at(&self, place: [f64; 3]) -> [C; 3] {
        match self.flow {
            Flow::Turn => [ZERO, self.density, ZERO],
            Flow::Along => [ZERO, ZERO, self.density],
            Flow::Ring(centre, axis) => {
                let around = cross(axis, difference(place, centre));
                let size = dot(around, around).sqrt();
                around.map(|x| self.density * (x / size))
            }
        }
    }
}

/// The given currents of a region.
#[derive(Debug, Clone, Default)]
pub struct Windings {
    /// Current density by point, on interfaces on the inner side \[A/m2\].
    pub own: Vec<[C; 3]>,
    /// On the outer side of interfaces, by face.
    pub beyond: Vec<[C; 3]>,
    /// Weights of points in integrals over coils.
    pub weights: Vec<f64>,
}

impl Windings {
    /// The currents at the points; `weights` are those of [`crate::stencils::quadrature`], of which those of coils are taken away.
    #[must_use]
    pub fn new<const D: usize>(
        region: &Region<D>,
        windings: &[Winding],
        weights: &mut [f64],
    ) -> Self {
        let density = |medium: u16, i: usize| {
            let mut sum = [ZERO; 3];
            for winding in windings.iter().filter(|w| w.medium == medium) {
                let here = winding.at(region.raise(region.places[i]));
                sum = std::array::from_fn(|k| sum[k] + here[k]);
            }
            sum
        };
        let mut made = Self {
            weights: vec![0.0; region.len()],
            ..Self::default()
        };
        for (i, weight) in weights.iter_mut().enumerate() {
            let medium = region.medium(i);
            made.own.push(density(medium, i));
            if windings.iter().any(|w| w.medium == medium) {
                made.weights[i] = std::mem::take(weight);
            }
        }
        let faces = region.faces.iter();
        made.beyond = faces.map(|f| density(f.outer, f.point as usize)).collect();
        made
    }

    /// The same so many times as strong.
    #[must_use]
    pub fn times(&self, factor: f64) -> Self {
        let times = |all: &[[C; 3]]| all.iter().map(|j| j.map(|j| j * factor)).collect();
        Self {
            own: times(&self.own),
            beyond: times(&self.beyond),
            weights: self.weights.clone(),
        }
    }

    /// Right sides that these currents make, over the permeability, by point: nothing on walls.
    #[must_use]
    pub fn right<const D: usize, const K: usize>(
        &self,
        region: &Region<D>,
        sides: &Sides<D>,
        unknown: Unknown,
    ) -> Vec<[C; K]> {
        let row = |i: usize| {
            let at = |current: &[C; 3]| component::<D, K>(unknown, &region.places[i], current);
            match region.kinds[i] {
                Kind::Inside(_) => at(&self.own[i]).map(|j| -j),
                Kind::Wall { .. } => [ZERO; K],
                Kind::Interface(face) => {
                    let (own, beyond) = (at(&self.own[i]), at(&self.beyond[face as usize]));
                    let normal = region.faces[face as usize].normal;
                    let inner = share_along(&sides.inner, i, normal);
                    let outer = share_along(&sides.outer, i, normal);
                    std::array::from_fn(|k| own[k] * inner - beyond[k] * outer)
                }
            }
        };
        (0..region.len()).map(row).collect()
    }

    /// Puts the potential of these currents without walls, over the permeability, into the right sides of walls.
    pub fn open<const D: usize, const K: usize>(
        &self,
        region: &Region<D>,
        unknown: Unknown,
        right: &mut [[C; K]],
    ) {
        let parts: Vec<Part> = self.parts(region).collect();
        let wall = |(i, right): (usize, &mut [C; K])| {
            if let Kind::Wall { .. } = region.kinds[i] {
                let place = region.raise(region.places[i]);
                let mut sum = [ZERO; 3];
                for part in &parts {
                    for (sum, a) in sum.iter_mut().zip(part.potential(region, place)) {
                        *sum += a;
                    }
                }
                *right = component(unknown, &region.places[i], &sum);
            }
        };
        right.par_iter_mut().enumerate().for_each(wall);
    }

    /// The parts of coils for which points stand.
    pub(crate) fn parts<const D: usize>(&self, region: &Region<D>) -> impl Iterator<Item = Part> {
        let stands = self.weights.iter().enumerate().filter(|(_, w)| **w != 0.0);
        stands.map(|(i, w)| Part {
            place: region.raise(region.places[i]),
            moment: self.own[i].map(|j| j * w),
        })
    }
}

/// The part of a coil for which a point stands.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Part {
    /// Place in space \[m\].
    pub(crate) place: [f64; 3],
    /// Current times volume \[A m\], \[A\] in a plane, of a full turn about an axis.
    pub(crate) moment: [C; 3],
}

impl Part {
    /// Its potential over the permeability at a place in space.
    fn potential<const D: usize>(&self, region: &Region<D>, place: [f64; 3]) -> [C; 3] {
        if region.axial {
            let ring = Loop {
                centre: [0.0, 0.0, self.place[2]],
                axis: [0.0, 0.0, 1.0],
                radius: self.place[0],
                wire_radius: THIN,
                current: self.moment[1] / (TAU * self.place[0]),
            };
            ring.potential(place).map(|a| ring.current * (a / MU0))
        } else if D == 2 {
            let line = Wire {
                place: [self.place[0], self.place[1]],
                wire_radius: THIN,
                current: self.moment[2],
            };
            line.potential(place).map(|a| line.current * (a / MU0))
        } else {
            let d = difference(place, self.place);
            let share = (4.0 * PI * dot(d, d).sqrt()).recip();
            self.moment.map(|m| m * share)
        }
    }
}
