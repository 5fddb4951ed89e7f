//! Bound currents of magnetised bodies in space, seen from afar: with the harmonic h their moments are
//! `int (1 - nu) B x grad h dV`.

use shapes::frame::cross;

use crate::magnetic::charge::parts::{Parts, add};
use crate::magnetic::charge::potential::Side;
use crate::magnetic::charge::rate::Rate;
use crate::magnetic::medium::interface::Permeable;
use crate::magnetic::medium::mixing::{Mix, mixed};
use crate::magnetic::open::multipoles::Multipoles;
use crate::magnetic::source::{C, Source};
use crate::stencils::region::Region;

/// The moment of bound currents with one harmonic.
#[derive(Debug, Clone, Default)]
pub(crate) struct Bound {
    /// What A of a point adds.
    value: Vec<(u32, Mix)>,
    /// What its rate adds.
    rate: Vec<(u32, Mix)>,
    /// What the rate of phi of an unknown adds.
    charge: Vec<(u32, [f64; 3])>,
}

impl Bound {
    /// The moments of the bound currents, by multipole.
    pub(crate) fn of(
        parts: &Parts<'_>,
        permeable: &Permeable,
        multipoles: &Multipoles,
        length: f64,
    ) -> Vec<Self> {
        let Parts { region, sides, .. } = *parts;
        let count = multipoles.fields.len();
        let mut value = vec![vec![Mix::default(); region.len()]; count];
        let mut found = vec![Self::default(); count];
        for (i, size) in permeable.magnets(region, &multipoles.weights) {
            let own = match region.on_interface(i) {
                true => &sides.inner,
                false => &sides.own,
            };
            let rows: [_; 3] = std::array::from_fn(|axis| own.derivative(i, axis));
            let share: [f64; 3] = std::array::from_fn(|axis| rows[axis].conditions().sum());
            let share = share.map(|s| s * parts.conductors.mu_sigma[region.medium(i) as usize]);
            let harmonics = multipoles.regular(region, i);
            for ((_, gradient), (value, found)) in
                harmonics.iter().zip(value.iter_mut().zip(&mut found))
            {
                let gradient = gradient.map(|g| g * size);
                for (k, j) in rows[0].neighbours.iter().enumerate() {
                    let w = [0, 1, 2].map(|axis: usize| rows[axis].factor * rows[axis].weights[k]);
                    let sum = value[*j as usize].as_flattened_mut().iter_mut();
                    sum.zip(turned(w, gradient).as_flattened())
                        .for_each(|(sum, w)| *sum += w);
                }
                if share.iter().any(|s| *s != 0.0) {
                    let rate = turned(share, gradient);
                    found.rate.push((i as u32, rate));
                    for (q, w) in parts.charge.gradient(i, Side::Inner) {
                        let row = |k: usize| (0..3).map(|l| rate[k][l] * w[l] * length).sum();
                        found.charge.push((q as u32, [row(0), row(1), row(2)]));
                    }
                }
            }
        }
        for (found, value) in found.iter_mut().zip(value) {
            let touched =
                |(i, mix): (usize, Mix)| (mix != Mix::default()).then_some((i as u32, mix));
            found.value = value.into_iter().enumerate().filter_map(touched).collect();
        }
        found
    }

    /// The moment of A.
    pub(crate) fn moment<S: Rate, const K: usize>(&self, a: &[[[S; K]; 3]]) -> [[S; K]; 3] {
        let mut sum = [[S::ZERO; K]; 3];
        for (i, mix) in &self.value {
            mixed(&mut sum, &a[*i as usize], mix);
        }
        sum
    }

    /// The moment of rates of A and of phi.
    pub(crate) fn moved<S: Rate, const K: usize>(
        &self,
        a: &[[[S; K]; 3]],
        phi: &[[S; K]],
    ) -> [[S; K]; 3] {
        let mut sum = [[S::ZERO; K]; 3];
        for (i, mix) in &self.rate {
            mixed(&mut sum, &a[*i as usize], mix);
        }
        for (q, w) in &self.charge {
            for (sum, w) in sum.iter_mut().zip(w) {
                add(sum, &phi[*q as usize], *w);
            }
        }
        sum
    }
}

/// `(w x A) x g = (w.g) A - w (g.A)` as a matrix.
fn turned(w: [f64; 3], g: [f64; 3]) -> Mix {
    let both: f64 = (0..3).map(|k| w[k] * g[k]).sum();
    std::array::from_fn(|k| std::array::from_fn(|l| if k == l { both } else { 0.0 } - w[k] * g[l]))
}

impl Permeable {
    /// What sources make of the bound currents, seen at the walls: right sides, by point.
    #[must_use]
    pub fn far(&self, region: &Region<3>, multipoles: &Multipoles, source: &Source) -> Vec<[C; 3]> {
        let mut moments = vec![[C::default(); 3]; multipoles.fields.len()];
        for (i, size) in self.magnets(region, &multipoles.weights) {
            let flux = source.flux_at(region.places[i]);
            for (sum, (_, gradient)) in moments.iter_mut().zip(multipoles.regular(region, i)) {
                let gradient = gradient.map(|g| g * size);
                let [re, im] =
                    [|b: C| b.re, |b: C| b.im].map(|part| cross(flux.map(part), gradient));
                *sum = std::array::from_fn(|k| sum[k] + C::new(re[k], im[k]));
            }
        }
        let mut right = vec![[C::default(); 3]; region.len()];
        for (walls, moment) in multipoles.fields.iter().zip(moments) {
            for (right, wall) in right.iter_mut().zip(walls) {
                *right = std::array::from_fn(|k| right[k] + moment[k] * *wall);
            }
        }
        right
    }
}
