//! Rows of A and V of which none is large with its rate.
//!
//! Where the rate is large against diffusion from point to point, rows of A in conductors are nearly `A + grad phi` alone,
//! which does not know fields with `A = -grad phi`: what tells them, the jump of `dA/dn` along the normal, would be lost
//! in what a solve leaves. On the surface of a conductor the normal part of `A + A_s + grad phi` is zero by the row of
//! phi, so that so many times this row is taken from that of A; what is left along the normal has no rate. Other rows
//! are divided by it.

use crate::magnetic::charge::equations::Coupled;
use crate::magnetic::charge::rate::Rate;
use crate::magnetic::charge::surface::Surface;

/// What the rows are multiplied by from the left.
#[derive(Debug, Clone)]
pub struct Balance<S> {
    /// By point, but along the normal of surfaces.
    even: Vec<f64>,
    /// By surface: what is taken from the row of A, along the normal, of the row of phi.
    along: Vec<S>,
}

impl<S: Rate> Balance<S> {
    /// Of equations at a rate.
    #[must_use]
    pub fn new(coupled: &Coupled, rate: S) -> Self {
        let size = rate.modulus();
        let even = |r: &f64| 1.0 / (size * r.abs()).max(1.0);
        let along = |s: &Surface| rate.times_real(coupled.rates[s.point as usize] * s.share);
        Self {
            even: coupled.rates.iter().map(even).collect(),
            along: coupled.surfaces.iter().map(along).collect(),
        }
    }

    /// Balances the rows of A.
    pub fn forth<const K: usize>(&self, coupled: &Coupled, a: &mut [[[S; K]; 3]], phi: &[[S; K]]) {
        for (surface, along) in coupled.surfaces.iter().zip(&self.along) {
            let i = surface.point as usize;
            let (row, charge) = (&mut a[i], &phi[surface.unknown as usize]);
            // Of the normal part nothing is divided by `even` below.
            let rest = 1.0 / self.even[i];
            for (c, charge) in charge.iter().enumerate() {
                let normal = surface.normal_part(row, c);
                let wanted = (normal - *along * *charge).times_real(rest);
                surface.add(row, c, wanted - normal);
            }
        }
        for (a, even) in a.iter_mut().zip(&self.even) {
            for a in a.as_flattened_mut() {
                *a = a.times_real(*even);
            }
        }
    }

    /// Undoes [`Self::forth`].
    pub fn back(&self, coupled: &Coupled, a: &mut [[S; 3]], phi: impl Fn(usize) -> S) {
        for (a, even) in a.iter_mut().zip(&self.even) {
            *a = a.map(|a| a.times_real(1.0 / even));
        }
        for (surface, along) in coupled.surfaces.iter().zip(&self.along) {
            let i = surface.point as usize;
            let row = &mut a[i].map(|a| [a]);
            let normal = surface.normal_part(row, 0);
            let charge = phi(surface.unknown as usize);
            let wanted = normal.times_real(self.even[i]) + *along * charge;
            surface.add(row, 0, wanted - normal);
            a[i] = row.map(|[a]| a);
        }
    }
}
