//! The fields of a solution of eddy currents.
//!
//! Phasors are rms values of `exp(j w t)`; in a march in time fields are real. In a conductor `J = -j w sigma (A + A_s)` (Matsuzawa 2017,
//! eq. 2.65, here without charge on surfaces; [`crate::magnetic::charge::potential`] has that), `B = B_s + curl A` (2.67), the mean force density is
//! `Re(J x B*)` (2.68), the heat `|J|^2 / sigma`.

use num_complex::Complex;
use rayon::prelude::*;

use super::source::C;
use crate::magnetic::driven::winding::Windings;
use crate::magnetic::medium::law::{Law, beyond};
use crate::magnetic::unknown::{Unknown, along, component, local};
use crate::magnetic::waves::weights::Waves;
use crate::stencils::region::{Face, Region};
use crate::stencils::sides::Sides;

const NONE: [C; 3] = [Complex::new(0.0, 0.0); 3];

/// Fields of a solution, by point, in space: of an axisymmetric scene away from the axis, around it
/// and along it.
#[derive(Debug, Clone, Default)]
pub struct Fields {
    /// Vector potential, sources and reaction \[V s/m\]; nothing where the unknown is `H_z`.
    pub potential: Vec<[C; 3]>,
    /// Flux density, sources and reaction \[T\].
    pub flux: Vec<[C; 3]>,
    /// That of the reaction alone \[T\].
    pub reaction: Vec<[C; 3]>,
    /// Electric field, `-d(A + A_s)/dt` \[V/m\]; nothing where the unknown is `H_z`.
    pub electric: Vec<[C; 3]>,
    /// Current density \[A/m2\].
    pub current: Vec<[C; 3]>,
    /// Mean force density \[N/m3\].
    pub force: Vec<[f64; 3]>,
    /// Heat \[W/m3\].
    pub heat: Vec<f64>,
    /// On the outer side of interfaces, by face.
    pub beyond: Vec<Beyond>,
}

/// Fields on the outer side of an interface, where they jump.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Beyond {
    /// Electric field \[V/m\].
    pub electric: [C; 3],
    /// Flux density \[T\].
    pub flux: [C; 3],
    /// Current density \[A/m2\].
    pub current: [C; 3],
    /// Mean force density \[N/m3\].
    pub force: [f64; 3],
    /// Heat \[W/m3\].
    pub heat: f64,
}

impl Beyond {
    /// From the electric field there, the flux density and the conductivity.
    fn new(electric: [C; 3], flux: [C; 3], sigma: f64) -> Self {
        let current = electric.map(|e| e * sigma);
        let square: f64 = electric.iter().map(C::norm_sqr).sum();
        Self {
            electric,
            flux,
            current,
            force: cross_mean(current, flux),
            heat: sigma * square,
        }
    }
}

/// What fields are made from beside the solution.
#[derive(Debug, Clone, Copy)]
pub struct Media<'a> {
    /// Conductivity by medium \[S/m\].
    pub conductivity: &'a [f64],
    /// Permeability by medium.
    pub laws: &'a [Law],
    /// Flux density of the sources by point, in space \[T\].
    pub flux: &'a [[C; 3]],
}

impl Media<'_> {
    /// The permeability of a medium \[H/m\]; zero where it depends on the field.
    fn permeability(&self, medium: u16) -> f64 {
        self.laws[medium as usize].constant().unwrap_or(0.0)
    }
}

/// A solution, by point.
#[derive(Debug, Clone, Copy)]
pub struct Solution<'a, const K: usize> {
    /// The unknown: the reaction.
    pub found: &'a [[C; K]],
    /// What sources give of it; nothing of `H_z`.
    pub source: &'a [[C; K]],
    /// Rate of both together, over a second.
    pub change: &'a [[C; K]],
    /// What conductors carry in a steady state in a plane, and what of sources is a part of it; none elsewhere.
    pub waves: Option<(&'a Waves, &'a [[C; K]])>,
}

impl<const K: usize> Solution<'_, K> {
    /// Slopes of the reaction at a point, on interfaces from the inner side.
    fn slopes<const D: usize>(
        &self,
        region: &Region<D>,
        sides: &Sides<D>,
        unknown: Unknown,
        i: usize,
        media: &Media<'_>,
    ) -> [[C; D]; K] {
        let medium = region.medium(i);
        // Slopes beside a medium whose permeability depends on the field do not know the Laplacian.
        let mu_sigma = media.permeability(medium) * media.conductivity[medium as usize];
        let on = region.on_interface(i);
        let stencils = if on { &sides.inner } else { &sides.own };
        let plain = |k: usize| -> [C; D] {
            std::array::from_fn(|axis| {
                let row = stencils.derivative(i, axis);
                // The Laplacian on the interface is known from the equation.
                let share: f64 = row.conditions().sum();
                row.apply_with(|j| self.found[j][k]) + self.change[i][k] * (mu_sigma * share)
            })
        };
        let carried = |k: usize| -> Option<[C; D]> {
            let (waves, source) = self.waves?;
            let total = |j: usize| self.found[j][k] + source[j][k];
            let mut both = waves.slope(region, i, medium, stencils, total)?;
            // That of the sources is known.
            if unknown == Unknown::Potential {
                let [x, y, _] = media.flux[i];
                both[0] += y;
                both[1] -= x;
            }
            Some(both)
        };
        std::array::from_fn(|k| carried(k).unwrap_or_else(|| plain(k)))
    }
}

/// The rate of sources and reaction together in a sinusoidal steady state, `j w (A + A_s)`.
#[must_use]
pub fn steady_change<const K: usize>(
    omega: f64,
    found: &[[C; K]],
    source: &[[C; K]],
) -> Vec<[C; K]> {
    let rate = C::new(0.0, omega);
    let both = found.iter().zip(source);
    both.map(|(a, s)| std::array::from_fn(|k| rate * (a[k] + s[k])))
        .collect()
}

impl Fields {
    /// Fields of a solution, on interfaces from the inner side.
    #[must_use]
    pub fn new<const D: usize, const K: usize>(
        region: &Region<D>,
        sides: &Sides<D>,
        unknown: Unknown,
        solution: Solution<'_, K>,
        media: &Media<'_>,
    ) -> Self {
        let Solution {
            found,
            source,
            change,
            ..
        } = solution;
        let point = |i: usize| {
            let place = region.places[i];
            let medium = region.medium(i);
            let sigma = media.conductivity[medium as usize];
            let total: [C; K] = std::array::from_fn(|k| found[i][k] + source[i][k]);
            let slopes = solution.slopes(region, sides, unknown, i, media);
            let (potential, reaction) = local(unknown, &place, &total, &found[i], &slopes);
            let electric = along(unknown, &place, &change[i]).map(|rate| -rate);
            let mut flux = reaction;
            for (b, s) in flux.iter_mut().zip(&media.flux[i]) {
                *b += s;
            }
            let mut current = electric.map(|e| e * sigma);
            if unknown == Unknown::Axial {
                let mu = media.permeability(medium);
                flux = reaction.map(|h| h * mu);
                current = NONE;
                if sigma > 0.0 {
                    // J = curl H.
                    [current[0], current[1]] = [slopes[0][1], -slopes[0][0]];
                }
            }
            ((potential, electric), (flux, reaction), current, sigma)
        };
        let points: Vec<_> = (0..region.len()).into_par_iter().map(point).collect();
        let mut fields = Self::default();
        for ((potential, electric), (flux, reaction), current, sigma) in points {
            fields.potential.push(potential);
            fields.electric.push(electric);
            fields.flux.push(flux);
            fields.reaction.push(reaction);
            fields.current.push(current);
            fields.force.push(cross_mean(current, flux));
            let square: f64 = current.iter().map(C::norm_sqr).sum();
            fields
                .heat
                .push(if sigma > 0.0 { square / sigma } else { 0.0 });
        }
        fields.beyond = fields.beyond(region, unknown, media);
        fields
    }

    /// The fields on the outer side of interfaces: E is continuous along an interface; where no charge is computed, all of
    /// it.
    fn beyond<const D: usize>(
        &self,
        region: &Region<D>,
        unknown: Unknown,
        media: &Media<'_>,
    ) -> Vec<Beyond> {
        let face = |face: &Face<D>| {
            let i = face.point as usize;
            let [a, b] = [face.inner, face.outer].map(|m| media.conductivity[m as usize]);
            let electric = match unknown {
                Unknown::Axial if a > 0.0 => self.current[i].map(|j| j / a),
                _ => self.electric[i],
            };
            let flux = beyond(media.laws, face, self.flux[i], region.raise(face.normal));
            Beyond::new(electric, flux, b)
        };
        region.faces.iter().map(face).collect()
    }

    /// Takes the rate on the outer side of interfaces, by face: charges make its normal part jump.
    pub fn charged<const D: usize>(
        &mut self,
        region: &Region<D>,
        media: &Media<'_>,
        change: &[[C; 3]],
    ) {
        for ((face, beyond), change) in region.faces.iter().zip(&mut self.beyond).zip(change) {
            let sigma = media.conductivity[face.outer as usize];
            *beyond = Beyond::new(change.map(|rate| -rate), beyond.flux, sigma);
        }
    }
}

impl Fields {
    /// Takes currents that are given in coils: `J` there, `J x B`, and `B` on their surfaces, where slopes from within know
    /// that the Laplacian is `-mu J`.
    pub fn wound<const D: usize, const K: usize>(
        &mut self,
        region: &Region<D>,
        sides: &Sides<D>,
        unknown: Unknown,
        media: &Media<'_>,
        windings: &Windings,
    ) {
        let none = [C::new(0.0, 0.0); K];
        let carries = |j: &[C; 3]| *j != NONE;
        for i in (0..region.len()).filter(|i| carries(&windings.own[*i])) {
            let current = windings.own[i];
            if region.on_interface(i) {
                let place = region.places[i];
                let mu = media.permeability(region.medium(i));
                let bend: [C; K] = component(unknown, &place, &current);
                let share = |axis: usize| -> f64 {
                    let row = sides.inner.derivative(i, axis);
                    row.conditions().sum::<f64>() * -mu
                };
                let slopes: [[C; D]; K] =
                    std::array::from_fn(|k| std::array::from_fn(|axis| bend[k] * share(axis)));
                let (_, curl) = local(unknown, &place, &none, &none, &slopes);
                for (k, b) in curl.iter().enumerate() {
                    self.flux[i][k] += b;
                    self.reaction[i][k] += b;
                }
            }
            self.current[i] = current;
            self.force[i] = cross_mean(current, self.flux[i]);
        }
        for ((other, face), current) in self
            .beyond
            .iter_mut()
            .zip(&region.faces)
            .zip(&windings.beyond)
        {
            let i = face.point as usize;
            if carries(&windings.own[i]) {
                other.flux = beyond(media.laws, face, self.flux[i], region.raise(face.normal));
            }
            if carries(current) {
                other.current = *current;
                other.force = cross_mean(*current, other.flux);
            }
        }
    }
}

/// `Re(a x b*)`.
#[must_use]
pub fn cross_mean(a: [C; 3], b: [C; 3]) -> [f64; 3] {
    let part = |i: usize, j: usize| (a[i] * b[j].conj() - a[j] * b[i].conj()).re;
    [part(1, 2), part(2, 0), part(0, 1)]
}
