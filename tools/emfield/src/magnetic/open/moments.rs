//! Multipoles of currents in the rows of walls, where A and V are sought together.

use crate::magnetic::charge::parts::{Parts, add};
use crate::magnetic::charge::potential::Side;
use crate::magnetic::charge::rate::Rate;
use crate::magnetic::open::bound::Bound;
use crate::magnetic::open::multipoles::Multipoles;

/// A multipole of the currents, which stands in the rows of walls.
#[derive(Debug, Clone)]
pub(crate) struct Pair {
    /// Points of walls, and what a unit moment gives there.
    pub(crate) walls: Vec<(u32, f64)>,
    /// Points that conduct, and what the rate of `A + A_s` adds to the moment.
    potential: Vec<(u32, f64)>,
    /// What that of phi of each unknown adds along each axis.
    charge: Vec<[f64; 3]>,
    /// Moment of the bound currents, where permeability is not uniform.
    bound: Option<Bound>,
}

impl Pair {
    /// All of them, with rows of A that have been multiplied by `even` and phi over `length`.
    pub(crate) fn all(
        parts: &Parts<'_>,
        multipoles: &Multipoles,
        even: &[f64],
        length: f64,
    ) -> Vec<Self> {
        let permeable = parts.conductors.permeable.as_ref();
        let bound = permeable.map(|p| Bound::of(parts, p, multipoles, length));
        let mut bound = bound.into_iter().flatten();
        let each = multipoles.moments.iter().zip(&multipoles.fields);
        each.map(|(moment, field)| {
            let far = field.iter().enumerate().filter(|(_, f)| **f != 0.0);
            let walls = far.map(|(i, f)| (i as u32, f * even[i])).collect();
            Self {
                bound: bound.next(),
                ..Self::new(parts, moment, walls, length)
            }
        })
        .collect()
    }

    fn new(parts: &Parts<'_>, moment: &[f64], walls: Vec<(u32, f64)>, length: f64) -> Self {
        let Parts {
            region,
            conductors,
            charge,
            ..
        } = *parts;
        let weight = |i: usize| conductors.current(region.medium(i)) * moment[i];
        let conducts = |i: &usize| conductors.current(region.medium(*i)) > 0.0;
        let mut made = Self {
            walls,
            potential: Vec::new(),
            charge: vec![[0.0; 3]; charge.len()],
            bound: None,
        };
        if charge.is_empty() {
            let points = (0..region.len()).filter(conducts);
            made.potential = points.map(|i| (i as u32, weight(i))).collect();
        }
        for i in &charge.points {
            let weight = weight(*i as usize);
            made.potential.push((*i, weight));
            for (q, w) in charge.gradient(*i as usize, Side::Inner) {
                for (sum, w) in made.charge[q].iter_mut().zip(w) {
                    *sum += weight * (length * w);
                }
            }
        }
        made
    }

    /// What stands in the rows of walls of rates of A and of phi.
    pub(crate) fn moment<S: Rate, const K: usize>(
        &self,
        a: &[[[S; K]; 3]],
        phi: &[[S; K]],
    ) -> [[S; K]; 3] {
        let mut moment = [[S::ZERO; K]; 3];
        for (p, (i, weight)) in self.potential.iter().enumerate() {
            for (k, sum) in moment.iter_mut().enumerate() {
                add(sum, &a[*i as usize][k], *weight);
                if let Some(phi) = phi.get(p) {
                    add(sum, phi, self.charge[p][k]);
                }
            }
        }
        if let Some(bound) = &self.bound {
            less(&mut moment, bound.moved(a, phi));
        }
        moment
    }

    /// What stands there of values of A.
    pub(crate) fn still<S: Rate, const K: usize>(&self, a: &[[[S; K]; 3]]) -> Option<[[S; K]; 3]> {
        let mut moment = [[S::ZERO; K]; 3];
        less(&mut moment, self.bound.as_ref()?.moment(a));
        Some(moment)
    }
}

/// Takes one moment from another.
fn less<S: Rate, const K: usize>(from: &mut [[S; K]; 3], what: [[S; K]; 3]) {
    let from = from.as_flattened_mut().iter_mut();
    from.zip(what.as_flattened())
        .for_each(|(from, what)| *from -= *what);
}
