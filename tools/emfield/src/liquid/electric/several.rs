//! Conductors apart from each other, each with its own charge and potential.
//!
//! `V = V_0 + sum U_k V_k`, with V_k of unit potential on conductor k and none on the others. The U_k give each the flux `Q_k/eps0` of its
//! charge. A flux is an integral over surface points; what of the flux through a ball about all the integrals lack is
//! shared by area.

use nalgebra::{DMatrix, DVector};
use run::Failure;

use super::{Electric, Fitted, Stood};
use crate::electric::traction::EPS0;
use crate::liquid::effort::failed;
use crate::liquid::vector::dot;
use crate::stencils::region::{Kind, Region};
use crate::stencils::sides::Sides;

/// The drops whose surfaces the points of a field stand on.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Drops {
    /// Number of the drop of each point, those of the surface first.
    pub of: Vec<u32>,
    /// Area of each surface point \[m2\].
    pub area: Vec<f64>,
    /// Charge of each drop \[C\].
    pub charge: Vec<f64>,
}

impl Drops {
    /// Sums of what surface points have by area, by drop, which are `whole` together.
    fn shares(&self, of: impl Fn(usize) -> f64, whole: f64) -> Vec<f64> {
        let mut sums = vec![0.0; self.charge.len()];
        let mut areas = sums.clone();
        for (i, (drop, area)) in self.of.iter().zip(&self.area).enumerate() {
            sums[*drop as usize] += area * of(i);
            areas[*drop as usize] += area;
        }
        let lack = whole - sums.iter().sum::<f64>();
        let over = areas.iter().sum::<f64>().recip();
        let each = sums.iter().zip(&areas);
        each.map(|(sum, area)| sum + lack * area * over).collect()
    }
}

impl Electric {
    /// How many potentials of units a conductor needs.
    pub(super) fn units(&self) -> usize {
        let several = self.drops.as_ref();
        several.map_or(1, |drops| drops.charge.len())
    }

    /// Unit potential on a conductor, none elsewhere.
    pub(super) fn unit(&self, region: &Region<3>, conductor: usize) -> Vec<[f64; 1]> {
        let of = |i: usize| match &self.drops {
            Some(drops) => drops.of.get(i).map(|k| *k as usize) == Some(conductor),
            None => true,
        };
        let on = |(i, kind): (usize, &Kind)| {
            f64::from(u8::from(
                matches!(kind, Kind::Wall { wall: 1, .. }) && of(i),
            ))
        };
        let kinds = region.kinds.iter().enumerate();
        kinds.map(|each| [on(each)]).collect()
    }

    /// Potentials of the conductors that give each its charge \[V\]; `without` is the potential without a liquid.
    pub(super) fn heights(
        &self,
        stood: &Stood,
        fitted: &Fitted,
        without: &[f64],
    ) -> Result<Vec<f64>, Failure> {
        let (applied, units) = (&self.state.potential[0], &self.state.potential[1..]);
        let flux = |v: &[f64]| fitted.open.flux(v);
        let Some(drops) = &self.drops else {
            let wanted = self.applied.charge / EPS0;
            let lack = wanted - flux(applied) + flux(without);
            return Ok(vec![lack / flux(&units[0])]);
        };
        let region = &stood.region;
        let shares =
            |v: &[f64], whole: f64| drops.shares(|i| outward(&fitted.sides, region, v, i), whole);
        let own = shares(applied, flux(applied) - flux(without));
        let of: Vec<Vec<f64>> = units.iter().map(|v| shares(v, flux(v))).collect();
        let matrix = DMatrix::from_fn(of.len(), of.len(), |k, j| of[j][k]);
        let charges = own.iter().zip(&drops.charge);
        let right = charges.map(|(own, charge)| charge / EPS0 - own);
        let right = DVector::from_iterator(of.len(), right);
        let heights = matrix.lu().solve(&right);
        let heights = heights.ok_or_else(|| failed(&"no potentials give drops their charges"))?;
        Ok(heights.as_slice().to_vec())
    }
}

/// Field of a potential outward at a point of the surface of a conductor \[V/m\].
pub(super) fn outward(sides: &Sides<3>, region: &Region<3>, potential: &[f64], i: usize) -> f64 {
    let slope = sides.at_walls().gradient_of(potential, i);
    -dot(&slope, &region.wall_normals[i])
}
