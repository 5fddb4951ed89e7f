//! What drives eddy currents in a sinusoidal steady state: right sides, and what walls know of the currents.

use krylov::Pair;

use crate::magnetic::diffusion::Conductors;
use crate::magnetic::medium::interface::Bound;
use crate::magnetic::open::multipoles::Multipoles;
use crate::magnetic::source::C;
use crate::magnetic::unknown::Unknown;
use crate::stencils::region::Region;

/// What drives currents in a sinusoidal steady state.
#[derive(Debug, Clone)]
pub struct Drive<const K: usize> {
    /// Angular frequency \[rad/s\].
    pub omega: f64,
    /// What sources give of the unknown, by point: `A_s` \[V s/m\], `A_s / r`; nothing of `H_z`.
    pub source: Vec<[C; K]>,
    /// What the unknown is held at where it is held; zero for a reaction.
    pub held: [C; K],
}

impl<const K: usize> Drive<K> {
    /// Right sides: `j w mu sigma A_s` in conductors; `rates` are [`Conductors::rates`].
    #[must_use]
    pub fn right<const D: usize>(
        &self,
        conductors: &Conductors,
        region: &Region<D>,
        unknown: Unknown,
        rates: &[f64],
    ) -> Vec<[C; K]> {
        (0..region.len())
            .map(|i| {
                if conductors.held(region, unknown, i) {
                    return self.held;
                }
                let rate = C::new(0.0, self.omega * rates[i]);
                self.source[i].map(|a| rate * a)
            })
            .collect()
    }

    /// Puts the multipoles of the currents into the rows of walls: low-rank pairs, and what the
    /// sources give through them on the right side.
    #[must_use]
    pub fn pairs<const D: usize>(
        &self,
        conductors: &Conductors,
        region: &Region<D>,
        unknown: Unknown,
        multipoles: &Multipoles,
        right: &mut [[C; K]],
    ) -> Vec<Pair<C>> {
        let mut found = Vec::new();
        for (u, v) in each_pair(conductors, region, unknown, multipoles) {
            let v: Vec<C> = v.iter().map(|v| C::new(0.0, self.omega * v)).collect();
            let mut given = [C::new(0.0, 0.0); K];
            for (v, source) in v.iter().zip(&self.source) {
                for k in 0..K {
                    given[k] += v * source[k];
                }
            }
            for (right, u) in right.iter_mut().zip(u) {
                for k in 0..K {
                    right[k] -= given[k] * *u;
                }
            }
            found.push(Pair::new(u.iter().map(|u| C::from(*u)), v));
        }
        found
    }

    /// Puts the multipoles of bound currents into the rows of walls, and what the sources give through the rates of slopes
    /// on the right side.
    #[must_use]
    pub fn bound(&self, bound: &[Bound], right: &mut [[C; K]]) -> Vec<Pair<C>> {
        let pair = |bound: &Bound| {
            let rates = || bound.rate.iter().map(|rate| C::new(0.0, self.omega * rate));
            let mut given = [C::new(0.0, 0.0); K];
            for (rate, source) in rates().zip(&self.source) {
                given = std::array::from_fn(|k| given[k] + rate * source[k]);
            }
            for (right, wall) in right.iter_mut().zip(&bound.walls) {
                *right = std::array::from_fn(|k| right[k] + given[k] * *wall);
            }
            let walls = bound.walls.iter().map(|u| C::from(*u));
            let values = bound.value.iter().zip(rates());
            Pair::new(walls, values.map(|(value, rate)| -(rate + *value)))
        };
        bound.iter().map(pair).collect()
    }
}

/// What the multipoles of the currents put into the rows of walls: `u` times the sum of
/// `v d(A + A_s)/dt`, for each pair `(u, v)`.
#[must_use]
pub fn pairs<const D: usize>(
    conductors: &Conductors,
    region: &Region<D>,
    unknown: Unknown,
    multipoles: &Multipoles,
) -> Vec<(Vec<f64>, Vec<f64>)> {
    let pairs = each_pair(conductors, region, unknown, multipoles);
    pairs.map(|(u, v)| (u.to_vec(), v)).collect()
}

/// [`pairs`], one after another: there is not room for all at once where there are many points.
fn each_pair<'a, const D: usize>(
    conductors: &'a Conductors,
    region: &'a Region<D>,
    unknown: Unknown,
    multipoles: &'a Multipoles,
) -> impl Iterator<Item = (&'a [f64], Vec<f64>)> {
    let weight = move |(i, moment): (usize, &f64)| {
        // The unknown is A over the distance from the axis.
        let arm = if unknown == Unknown::Around {
            region.places[i][0]
        } else {
            1.0
        };
        conductors.current(region.medium(i)) * moment * arm
    };
    let each = multipoles.moments.iter().zip(&multipoles.fields);
    each.map(move |(moment, field)| {
        let v = moment.iter().enumerate().map(weight).collect();
        (field.as_slice(), v)
    })
}
