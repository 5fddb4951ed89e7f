//! Media of different permeability.
//!
//! With the reluctivity `nu = mu_0 / mu` over that of the surroundings, `curl (nu curl A) = mu_0 J`. Within a medium that is
//! the equation of [`crate::magnetic::diffusion`]; where media meet, A and `nu n x curl A`, the field along the interface, are
//! continuous (Jackson 1999, section 5.8). Since `n x curl A = grad(n.A) - dA/dn` with n held,
//!
//! - in a plane `nu dA/dn` is;
//! - about an axis, with `u = A / r`, `nu (du/dn + 2 (n_r / r) u)` is;
//! - in space the components mix: [`crate::magnetic::medium::mixing`].
//!
//! Sources have no sheets of current there: of `A = A_s + a` they put `(nu_a - nu_b) n x B_s` into the row of a.
//!
//! Seen from afar a body has, beside its currents, the bound ones of its magnetisation, `mu_0 J_b = curl((1 - nu) B)`:
//! their multipole with the harmonic h is `int (1 - nu) B . curl(h e) dV`, e along the component.

use rayon::prelude::*;
use shapes::frame::{cross, dot};

use crate::magnetic::medium::law::Law;
use crate::magnetic::open::multipoles::Multipoles;
use crate::magnetic::source::{C, Source};
use crate::magnetic::unknown::{Unknown, component, local};
use crate::stencils::region::{Face, Kind, Region};
use crate::stencils::sides::Sides;

/// Permeabilities closer than this are one.
const ALIKE: f64 = 1e-12;
/// Step beside an axis, in spacings, at which what is proportional to the distance from it is taken.
const BESIDE: f64 = 1e-2;
/// Step of the gradient of sources, in spacings.
const STEP: f64 = 0.1;

/// Media of different permeability.
#[derive(Debug, Clone)]
pub struct Permeable {
    /// Permeability of the surroundings \[H/m\].
    around: f64,
    /// Reluctivity over that of the surroundings, by medium.
    reluctivity: Vec<f64>,
    /// `n_r / r` by face, about an axis; empty without.
    turn: Vec<f64>,
}

impl Permeable {
    /// Of permeabilities by medium, that of the surroundings first; none where all are the same.
    #[must_use]
    pub fn of<const D: usize>(region: &Region<D>, permeability: &[f64]) -> Option<Self> {
        let other = |mu: &f64| (permeability[0] / mu - 1.0).abs() > ALIKE;
        let jumps = permeability.iter().any(other);
        jumps.then(|| Self::new(region, permeability))
    }

    /// Of permeabilities by medium that depend on the field, and what stands for each in the rows.
    #[must_use]
    pub fn new<const D: usize>(region: &Region<D>, permeability: &[f64]) -> Self {
        let around = permeability[0];
        let turn = || match region.axial {
            true => region.faces.iter().map(|face| turn(region, face)).collect(),
            false => Vec::new(),
        };
        Self {
            around,
            reluctivity: permeability.iter().map(|mu| around / mu).collect(),
            turn: turn(),
        }
    }

    /// Permeability of the surroundings \[H/m\].
    #[must_use]
    pub fn around(&self) -> f64 {
        self.around
    }

    /// What the slope on the side of a medium is multiplied by at its interfaces.
    #[must_use]
    pub fn weight(&self, medium: u16) -> f64 {
        self.reluctivity[medium as usize]
    }

    /// Whether a medium differs from the surroundings.
    #[must_use]
    pub fn differs(&self, medium: u16) -> bool {
        (self.weight(medium) - 1.0).abs() > ALIKE
    }

    /// `nu_a - nu_b` of a face.
    pub(crate) fn jump<const D: usize>(&self, face: &Face<D>) -> f64 {
        self.weight(face.inner) - self.weight(face.outer)
    }

    /// What stands before `A / r` at the point of a face about an axis.
    #[must_use]
    pub fn turning<const D: usize>(&self, region: &Region<D>, number: u32) -> f64 {
        2.0 * self.jump(&region.faces[number as usize]) * self.turn[number as usize]
    }

    /// Right sides that sources make at interfaces: `(nu_a - nu_b) n x B_s`, by point.
    #[must_use]
    pub fn right<const D: usize, const K: usize>(
        &self,
        region: &Region<D>,
        unknown: Unknown,
        source: &Source,
    ) -> Vec<[C; K]> {
        let mut right = vec![[C::default(); K]; region.len()];
        let row = |face: &Face<D>| -> [C; K] {
            let jump = self.jump(face);
            if jump == 0.0 {
                return [C::default(); K];
            }
            let i = face.point as usize;
            let (mut place, mut normal) = (region.places[i], face.normal);
            if region.axial && place[0] == 0.0 {
                place[0] = BESIDE * region.metrics[i].spacing();
                normal[0] = self.turn_at(region, i) * place[0];
            }
            let n = region.raise(normal);
            let flux = source.flux_at(region.raise(place));
            let [re, im] = [|b: C| b.re, |b: C| b.im].map(|part| cross(n, flux.map(part)));
            let sum: [C; 3] = std::array::from_fn(|k| C::new(re[k], im[k]) * jump);
            component(unknown, &place, &sum)
        };
        let rows: Vec<[C; K]> = region.faces.par_iter().map(row).collect();
        for (face, row) in region.faces.iter().zip(rows) {
            right[face.point as usize] = row;
        }
        right
    }

    pub(crate) fn turn_at<const D: usize>(&self, region: &Region<D>, i: usize) -> f64 {
        match region.kinds[i] {
            Kind::Interface(face) => self.turn[face as usize],
            Kind::Inside(_) | Kind::Wall { .. } => 0.0,
        }
    }

    /// What the bound currents put into the rows of walls, in a plane or about an axis, by multipole.
    #[must_use]
    pub fn bound<const D: usize>(
        &self,
        region: &Region<D>,
        sides: &Sides<D>,
        unknown: Unknown,
        mu_sigma: &[f64],
        multipoles: &Multipoles,
    ) -> Vec<Bound> {
        let none = || vec![0.0; region.len()];
        let each = multipoles.fields.iter().map(|walls| Bound {
            walls: walls.clone(),
            value: none(),
            rate: none(),
        });
        let mut found: Vec<Bound> = each.collect();
        for (i, weight) in self.magnets(region, &multipoles.weights) {
            let own = match region.on_interface(i) {
                true => &sides.inner,
                false => &sides.own,
            };
            let rate = mu_sigma[region.medium(i) as usize];
            // The flux density of a unit value and of unit slopes.
            let unit = |value: f64, along: Option<usize>| -> [f64; 3] {
                let slope = |axis: usize| C::from(if along == Some(axis) { 1.0 } else { 0.0 });
                let value = [C::from(value)];
                let slopes = [std::array::from_fn(slope)];
                let (_, flux) = local::<D, 1>(unknown, &region.places[i], &value, &value, &slopes);
                flux.map(|b| weight * b.re)
            };
            for (bound, (value, gradient)) in found.iter_mut().zip(multipoles.regular(region, i)) {
                let curl = curl(region, i, value, gradient);
                bound.value[i] += dot(unit(1.0, None), curl);
                for axis in 0..D {
                    let size = dot(unit(0.0, Some(axis)), curl);
                    let row = own.derivative(i, axis);
                    for (j, w) in row.iter() {
                        bound.value[j] += size * w;
                    }
                    bound.rate[i] += size * rate * row.conditions().sum::<f64>();
                }
            }
        }
        found
    }

    /// What sources add to the moments of the bound currents, in a plane or about an axis, by multipole.
    #[must_use]
    pub fn given<const D: usize>(
        &self,
        region: &Region<D>,
        multipoles: &Multipoles,
        source: &Source,
    ) -> Vec<C> {
        let mut sums = vec![C::default(); multipoles.fields.len()];
        for (i, weight) in self.magnets(region, &multipoles.weights) {
            let flux = source.flux_at(region.raise(region.places[i]));
            for (sum, (value, gradient)) in sums.iter_mut().zip(multipoles.regular(region, i)) {
                let curl = curl(region, i, value, gradient);
                *sum += flux
                    .iter()
                    .zip(curl)
                    .map(|(b, c)| b * (weight * c))
                    .sum::<C>();
            }
        }
        sums
    }

    /// Force of sources on magnetised media \[N\], \[N/m\] in a plane; about an axis only that along it: the sum of
    /// `M_k* grad B_k`, `M = (1/mu_0 - 1/mu) B`, over volumes for which points stand.
    #[must_use]
    pub fn pull<const D: usize>(
        &self,
        region: &Region<D>,
        weights: &[f64],
        flux: &[[C; 3]],
        laws: &[Law],
        source: &(dyn Fn([f64; 3]) -> [C; 3] + Sync),
    ) -> [f64; 3] {
        let had = if region.axial { 2..3 } else { 0..D };
        let on = |(i, size): &(usize, f64)| -> [f64; 3] {
            let place = region.raise(region.places[*i]);
            let step = STEP * region.metrics[*i].spacing();
            let mut force = [0.0; 3];
            for k in had.clone() {
                let at = |n: f64| {
                    let mut beside = place;
                    beside[k] += n * step;
                    source(beside)
                };
                // Of the fourth order.
                let [a, b, c, d] = [1.0, -1.0, 2.0, -2.0].map(at);
                for m in 0..3 {
                    let slope = ((a[m] - b[m]) * 8.0 - (c[m] - d[m])) / (12.0 * step);
                    force[k] += size / self.around * (flux[*i][m].conj() * slope).re;
                }
            }
            force
        };
        let magnets = self.magnetised(region, weights, flux, laws);
        let forces: Vec<[f64; 3]> = magnets.par_iter().map(on).collect();
        let add = |sum: [f64; 3], f: &[f64; 3]| std::array::from_fn(|k| sum[k] + f[k]);
        forces.iter().fold([0.0; 3], add)
    }

    /// [`Self::magnets`] with the reluctivity that media have at a flux density.
    fn magnetised<const D: usize>(
        &self,
        region: &Region<D>,
        weights: &[f64],
        flux: &[[C; 3]],
        laws: &[Law],
    ) -> Vec<(usize, f64)> {
        let own = |(i, size): (usize, f64)| match &laws[region.medium(i) as usize] {
            Law::Constant(_) => (i, size),
            Law::Curve(curve) => {
                let square: f64 = flux[i].iter().map(C::norm_sqr).sum();
                let reluctivity = self.around * curve.at(square.sqrt()).reluctivity;
                (i, weights[i] * (1.0 - reluctivity))
            }
        };
        self.magnets(region, weights).map(own).collect()
    }

    /// Points of magnetised media with `(1 - nu)` times the volume for which each stands.
    pub(crate) fn magnets<'a, const D: usize>(
        &'a self,
        region: &'a Region<D>,
        weights: &'a [f64],
    ) -> impl Iterator<Item = (usize, f64)> + 'a {
        let own = move |(i, w): (usize, &f64)| {
            let size = w * (1.0 - self.weight(region.medium(i)));
            (size != 0.0).then_some((i, size))
        };
        weights.iter().enumerate().filter_map(own)
    }
}

/// Media on which magnetic fields act.
#[derive(Debug, Clone, Copy)]
pub struct Acting<'a> {
    /// Whether a medium conducts, or has another permeability than the surroundings.
    pub acts: &'a [bool],
    /// Permeability by medium.
    pub laws: &'a [Law],
    /// Where permeability is not uniform.
    pub permeable: Option<&'a Permeable>,
}

/// A multipole of bound currents in the rows of walls.
#[derive(Debug, Clone, PartialEq)]
pub struct Bound {
    /// What a unit moment gives at each point of a wall.
    pub walls: Vec<f64>,
    /// The moment of unit values, by point.
    pub value: Vec<f64>,
    /// The moment of unit rates, by point.
    pub rate: Vec<f64>,
}

/// `curl(h e)` of a harmonic with its gradient, e along the component that a plane or an axis has.
pub(crate) fn curl<const D: usize>(
    region: &Region<D>,
    i: usize,
    value: f64,
    gradient: [f64; D],
) -> [f64; 3] {
    if region.axial {
        let r = region.places[i][0];
        let over = if r > 0.0 { value / r } else { gradient[0] };
        [-gradient[1], 0.0, gradient[0] + over]
    } else {
        [gradient[1], -gradient[0], 0.0]
    }
}

/// `n_r / r` of a face about an axis; on the axis that of the nearest beside it on the same surface.
fn turn<const D: usize>(region: &Region<D>, face: &Face<D>) -> f64 {
    let at = region.places[face.point as usize];
    let own = |face: &Face<D>| face.normal[0] / region.places[face.point as usize][0];
    if at[0] > 0.0 {
        return own(face);
    }
    let beside = region.faces.iter().filter(|other| {
        let same = other.inner == face.inner && other.outer == face.outer;
        same && region.places[other.point as usize][0] > 0.0
    });
    let far = |other: &&Face<D>| -> f64 {
        let place = region.places[other.point as usize];
        (0..D).map(|k| (place[k] - at[k]).powi(2)).sum()
    };
    let nearest = beside.min_by(|a, b| far(a).total_cmp(&far(b)));
    nearest.map_or(0.0, own)
}
