//! Eddy currents: diffusion of a potential or field.
//!
//! The unknown is the reaction of the bodies alone; what coils and distant magnets give is known
//! exactly (`A_s`). In air `lap A = 0`, in a conductor `lap A - mu sigma (j w (A + A_s)) = 0`
//! (Matsuzawa 2017, eqs 2.64, 2.65 and 2.69: with `div A = 0` and one permeability, the components do not
//! mix and share one operator). On an interface `dA/dn` is continuous, from one-sided gradients: the
//! second derivative jumps there. Of `H_z` it is the electric field along the interface, `dH/dn / sigma`; between media of
//! different permeability see [`crate::magnetic::medium::interface`].

use krylov::Rows;

use super::source::C;
use crate::electric::equations::around;
use crate::magnetic::holes::{Hole, Holes, Media};
use crate::magnetic::medium::interface::Permeable;
use crate::magnetic::unknown::Unknown;
use crate::stencils::region::{Kind, Region};
use crate::stencils::sides::{Sides, along_normal, share_along};

/// Conductors by medium.
#[derive(Debug, Clone, Default)]
pub struct Conductors {
    /// `mu sigma` \[s/m2\]; 0 where nothing conducts.
    pub mu_sigma: Vec<f64>,
    /// What `H_z` needs beside; none for potentials.
    pub axial: Option<Axial>,
    /// What potentials need beside; none where permeability is uniform.
    pub permeable: Option<Permeable>,
}

/// The points, their stencils, and what is sought at them.
#[derive(Debug, Clone, Copy)]
pub struct Ground<'a, const D: usize> {
    /// Points.
    pub region: &'a Region<D>,
    /// Stencils.
    pub sides: &'a Sides<D>,
    /// What is sought.
    pub unknown: Unknown,
}

/// Media and holes as `H_z` needs them.
#[derive(Debug, Clone)]
pub struct Axial {
    /// Resistivity over the greatest of all conductors, by medium; 0 where nothing conducts.
    pub resistivity: Vec<f64>,
    /// `mu` over the greatest resistivity \[s/m2\], by medium.
    pub mu: Vec<f64>,
    /// Holes that conductors enclose.
    pub holes: Holes,
}

impl Conductors {
    /// What the slope on the side of a medium is multiplied by at its interfaces.
    pub(crate) fn weight(&self, medium: u16) -> f64 {
        match (&self.axial, &self.permeable) {
            (Some(axial), _) => axial.resistivity[medium as usize],
            (None, Some(permeable)) => permeable.weight(medium),
            (None, None) => 1.0,
        }
    }

    /// The same where slopes are continuous, whatever the permeability.
    #[must_use]
    pub fn smooth(&self) -> Self {
        Self {
            permeable: None,
            ..self.clone()
        }
    }

    /// `mu sigma` of a medium with the permeability of the surroundings: what a rate makes of current, in potentials far
    /// away \[s/m2\].
    #[must_use]
    pub fn current(&self, medium: u16) -> f64 {
        let own = self.mu_sigma[medium as usize];
        let permeable = self.permeable.as_ref();
        permeable.map_or(own, |permeable| permeable.weight(medium) * own)
    }

    /// The hole that point `i` belongs to, and what its law of induction needs.
    pub(crate) fn hole(&self, i: usize) -> Option<(&Hole, Media<'_>)> {
        let axial = self.axial.as_ref()?;
        let media = Media {
            mu_sigma: &self.mu_sigma,
            resistivity: &axial.resistivity,
            mu: &axial.mu,
        };
        axial.holes.at(i).map(|hole| (hole, media))
    }

    /// What stands before the rate in the row of point `i`, `row(A) = at d(A + A_s)/dt`: inside a
    /// medium `mu sigma`; on an interface the shares of the Laplacians on both sides in the slopes;
    /// nothing where the unknown is held.
    #[must_use]
    pub fn at<const D: usize>(
        &self,
        region: &Region<D>,
        sides: &Sides<D>,
        unknown: Unknown,
        i: usize,
    ) -> f64 {
        if self.held(region, unknown, i) {
            return 0.0;
        }
        if let Some((hole, media)) = self.hole(i) {
            let first = hole.first as usize == i;
            return if first {
                hole.rate(region, sides, media)
            } else {
                0.0
            };
        }
        match region.kinds[i] {
            Kind::Inside(m) => self.mu_sigma[m as usize],
            Kind::Wall { .. } => 0.0,
            Kind::Interface(face) => {
                let face = &region.faces[face as usize];
                let side = |medium: u16, stencils| {
                    self.weight(medium)
                        * self.mu_sigma[medium as usize]
                        * share_along(stencils, i, face.normal)
                };
                side(face.outer, &sides.outer) - side(face.inner, &sides.inner)
            }
        }
    }

    /// [`Conductors::at`] of all points.
    #[must_use]
    pub fn rates<const D: usize>(
        &self,
        region: &Region<D>,
        sides: &Sides<D>,
        unknown: Unknown,
    ) -> Vec<f64> {
        (0..region.len())
            .map(|i| self.at(region, sides, unknown, i))
            .collect()
    }

    /// Is there none at all?
    #[must_use]
    pub fn none(&self) -> bool {
        self.mu_sigma.iter().all(|m| *m == 0.0)
    }

    /// Real rows: the Laplacian of the unknown, jumps of its slope, values held on walls.
    #[must_use]
    pub fn rows<const D: usize>(
        &self,
        region: &Region<D>,
        sides: &Sides<D>,
        unknown: Unknown,
    ) -> Rows<f64> {
        self.rows_of(region, |_| sides, unknown)
    }

    /// The same of stencils that are asked for by point.
    #[must_use]
    pub fn rows_of<'a, const D: usize>(
        &self,
        region: &Region<D>,
        of: impl Fn(usize) -> &'a Sides<D> + Sync,
        unknown: Unknown,
    ) -> Rows<f64> {
        let inside = |i: usize, row: &mut Vec<(u32, f64)>| {
            let plain = of(i).own.laplacian(i).iter();
            row.extend(plain.map(|(j, w)| (j as u32, w)));
        };
        self.rows_with(region, &of, inside, unknown)
    }

    /// The same of stencils whose Laplacians inside media are given by a function of their own.
    #[must_use]
    pub fn rows_with<'a, const D: usize>(
        &self,
        region: &Region<D>,
        of: impl Fn(usize) -> &'a Sides<D> + Sync,
        inside: impl Fn(usize, &mut Vec<(u32, f64)>) + Sync,
        unknown: Unknown,
    ) -> Rows<f64> {
        Rows::gathered(region.len(), 0.0, |i, row| {
            let sides = of(i);
            let mut push = |j: usize, w: f64| row.push((j as u32, w));
            if self.held(region, unknown, i) {
                push(i, 1.0);
                return;
            }
            if let Some((hole, media)) = self.hole(i) {
                if hole.first as usize == i {
                    hole.row(region, sides, media, push);
                } else {
                    push(i, 1.0);
                    push(hole.first as usize, -1.0);
                }
                return;
            }
            match region.kinds[i] {
                Kind::Interface(number) => {
                    let face = &region.faces[number as usize];
                    let [inner, outer] = [face.inner, face.outer].map(|m| self.weight(m));
                    if let (Some(permeable), Unknown::Around) = (&self.permeable, unknown) {
                        push(i, permeable.turning(region, number));
                    }
                    along_normal(&sides.inner, i, face.normal, inner, &mut push);
                    along_normal(&sides.outer, i, face.normal, -outer, &mut push);
                }
                _ => {
                    inside(i, row);
                    if unknown == Unknown::Around {
                        let push = |j: usize, w: f64| row.push((j as u32, w));
                        around(region, &sides.own, i, unknown.around(), push);
                    }
                }
            }
        })
    }

    /// Is the unknown given at point `i`?
    #[must_use]
    pub fn held<const D: usize>(&self, region: &Region<D>, unknown: Unknown, i: usize) -> bool {
        if self.hole(i).is_some() {
            return false;
        }
        let conducts = |m: u16| self.mu_sigma[m as usize] > 0.0;
        match region.kinds[i] {
            Kind::Wall { .. } => true,
            Kind::Inside(m) => unknown == Unknown::Axial && !conducts(m),
            Kind::Interface(face) => {
                let face = &region.faces[face as usize];
                unknown == Unknown::Axial && !(conducts(face.inner) && conducts(face.outer))
            }
        }
    }
}

/// What `j w` adds to the diagonal, from [`Conductors::rates`].
#[must_use]
pub fn shift(rates: &[f64], omega: f64) -> Vec<C> {
    rates.iter().map(|r| C::new(0.0, -omega * r)).collect()
}
