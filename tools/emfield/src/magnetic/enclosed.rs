//! Force and heat of what closed surfaces enclose.

use shapes::frame::{Vector, difference};

use super::fields::{Fields, Solution, cross_mean};
use super::problem::Problem;
use super::source::{C, Source};
use super::totals::Totals;
use crate::frames::Found;
use crate::surface::fits::Enclosed;
use crate::surface::ways::push;

impl<const D: usize> Problem<'_, D> {
    /// Adds the forces and the heat of eddy currents; `totals` are those of all conductors.
    pub(crate) fn enclosed<const K: usize>(
        &self,
        solution: Solution<'_, K>,
        fields: &Fields,
        totals: &Totals,
        source: &Source,
        all: &mut Found,
    ) {
        for one in &self.enclosed {
            let surface = &one.surface;
            let mu = self.parameters.laws[surface.medium as usize].permeability(0.0);
            let (stress, heat) = self.stress(one, solution.found, source);
            let kept = |i: usize| surface.within[i];
            let bodies = Totals::bodies(&self.region, fields, &self.weights, self.acting(), kept);
            let mut ways = vec![
                stress.map(|f| f / mu),
                bodies.force_volume,
                bodies.force_stress,
            ];
            let mut points = self.weights.iter().enumerate();
            if points.all(|(i, w)| *w == 0.0 || kept(i)) {
                ways.push(totals.force_coil);
            }
            push(
                self.cloud.geometry,
                &format!("{}.force", surface.name),
                &ways,
                all,
            );
            if let Some(heat) = heat {
                let unit = self.cloud.geometry.unit_of_power();
                let name = format!("{}.power", surface.name);
                all.totals.push((name, unit, heat / mu));
            }
        }
    }

    /// Force over a surface, and in a sinusoidal steady state heat within, both times the permeability.
    ///
    /// Sources alone exert no force and bring no heat where the surface encloses none: what they give by themselves is
    /// left out, which near coils is most of what the sum over the places errs by. A potential V of charges, which is not
    /// computed in air, adds nothing to the heat: `grad V x H = curl(V H)` where no current flows.
    fn stress<const K: usize>(
        &self,
        one: &Enclosed<D>,
        found: &[[C; K]],
        source: &Source,
    ) -> (Vector, Option<f64>) {
        let surface = &one.surface;
        let alone = source.flux(&surface.places);
        let own = one.magnetic(self.parameters.unknown, found);
        let flux: Vec<[C; 3]> = own
            .iter()
            .zip(&alone)
            .map(|(a, s)| sum(&a.flux, s))
            .collect();
        let force = difference(surface.stress(&flux), surface.stress(&alone));
        // What is applied along bars has no part in the potential beyond them.
        let omega = self.parameters.omega.filter(|_| self.bars.is_empty());
        let heat = omega.map(|omega| {
            let given = one.potential(
                self.parameters.unknown,
                &self.given::<K>(source, &surface.places),
            );
            let rate = C::new(0.0, -omega);
            let flow = |n: usize| {
                let electric = |a: &[C; 3]| a.map(|a| rate * a);
                let total = sum(&own[n].potential, &given[n]);
                let all = cross_mean(electric(&total), flux[n]);
                difference(all, cross_mean(electric(&given[n]), alone[n]))
            };
            surface.inward((0..own.len()).map(flow))
        });
        (force, heat)
    }
}

fn sum(a: &[C; 3], b: &[C; 3]) -> [C; 3] {
    std::array::from_fn(|k| a[k] + b[k])
}
