//! What sources give at the points: of the unknowns, and in the rows.

use shapes::frame::Vector;

use crate::magnetic::driven::right::Drive;
use crate::magnetic::medium::interface::Bound;
use crate::magnetic::open::multipoles::Multipoles;
use crate::magnetic::problem::Problem;
use crate::magnetic::source::{C, MU0, Source};
use crate::magnetic::unknown::Unknown;

impl<const D: usize> Problem<'_, D> {
    /// What sources give of the unknowns, by point.
    pub(crate) fn drive<const K: usize>(&self) -> Drive<K> {
        let mut held = [C::default(); K];
        if self.parameters.unknown == Unknown::Axial {
            let applied = self.source.uniform.iter().map(|u| u.flux[2]).sum::<C>();
            held[0] = applied / MU0;
        }
        Drive {
            omega: self.parameters.omega.unwrap_or(0.0),
            source: self.given(&self.source, &self.cloud.position),
            held,
        }
    }

    /// What sources give of the unknown at places in space.
    pub(crate) fn given<const K: usize>(&self, source: &Source, places: &[Vector]) -> Vec<[C; K]> {
        let zero = C::default();
        match self.parameters.unknown {
            Unknown::Axial => vec![[zero; K]; places.len()],
            Unknown::Around => {
                let a = source.potential(places);
                let at = |(x, a): (&Vector, [C; 3])| {
                    let mut value = [zero; K];
                    value[0] = if x[0] > 0.0 {
                        a[1] / x[0]
                    } else {
                        // A = r B_z / 2 beside the axis.
                        source.flux_at(*x)[2] * 0.5
                    };
                    value
                };
                places.iter().zip(a).map(at).collect()
            }
            Unknown::Potential if K == 1 => {
                let mut source = source.clone();
                // Of a uniform field in the plane the z component carries all, not half.
                for uniform in &mut source.uniform {
                    uniform.flux = uniform.flux.map(|b| b * 2.0);
                }
                let a = source.potential(places);
                a.into_iter().map(|a| [a[2]; K]).collect()
            }
            Unknown::Potential => {
                let a = source.potential(places);
                a.into_iter()
                    .map(|a| std::array::from_fn(|k| a[k]))
                    .collect()
            }
        }
    }

    /// Right sides without rates: of currents in coils of points, and of the magnetisation that exact sources make; none
    /// where there are neither.
    pub(crate) fn given_rows<const K: usize>(&self) -> Vec<[C; K]> {
        let mut right = self.wound();
        let Some(permeable) = &self.conductors.permeable else {
            return right;
        };
        let region = &self.region;
        right.resize(region.len(), [C::default(); K]);
        let magnetised = permeable.right::<D, K>(region, self.parameters.unknown, &self.source);
        for (right, more) in right.iter_mut().zip(magnetised) {
            *right = std::array::from_fn(|k| right[k] + more[k]);
        }
        right
    }

    /// Right sides that currents in coils of points make; none where there are no such coils.
    fn wound<const K: usize>(&self) -> Vec<[C; K]> {
        let Some(windings) = &self.windings else {
            return Vec::new();
        };
        let mu = self.parameters.around;
        let (region, unknown) = (&self.region, self.parameters.unknown);
        let mut right = windings.right::<D, K>(region, &self.sides, unknown);
        if self.parameters.open {
            windings.open(region, unknown, &mut right);
        }
        right.as_flattened_mut().iter_mut().for_each(|r| *r *= mu);
        right
    }

    /// Multipoles of bound currents in the rows of walls, in a plane or about an axis, and what sources add to the right
    /// side there; none where permeability is uniform.
    pub(crate) fn bound<const K: usize>(
        &self,
        multipoles: &Multipoles,
        right: &mut [[C; K]],
    ) -> Vec<Bound> {
        let Some(permeable) = &self.conductors.permeable else {
            return Vec::new();
        };
        let (region, mu_sigma) = (&self.region, &self.conductors.mu_sigma);
        let unknown = self.parameters.unknown;
        let bound = permeable.bound(region, &self.sides, unknown, mu_sigma, multipoles);
        let given = permeable.given(region, multipoles, &self.source);
        for (bound, given) in bound.iter().zip(given) {
            for (right, wall) in right.iter_mut().zip(&bound.walls) {
                right[0] += given * *wall;
            }
        }
        bound
    }
}
