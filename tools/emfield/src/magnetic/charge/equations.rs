//! A and V together in space, whatever the rate of change.
//!
//! Unknown are the reaction A at all points and `phi`, of which V is the rate, at those of conductors ([`crate::magnetic::charge::potential`]).
//! With `div A = 0` (Matsuzawa 2017, eqs 2.64 to 2.66 and 2.69):
//!
//! - in air: `lap A = 0`;
//! - in a conductor: `lap A - mu sigma d(A + A_s + grad phi)/dt = 0` and `lap phi = 0`;
//! - on an interface: `dA/dn` is continuous where permeability is ([`crate::magnetic::medium::mixing`] where it jumps), from one-sided
//!   gradients that know the Laplacian of their side; on the surface of a conductor `n.grad phi = -n.(A + A_s)`.
//!
//! The rows of `phi` hold at each instant, since all have been zero before anything was switched on: a jump of `A_s`
//! makes one of `phi`, where V has none. `A` and `phi` add up to the unknown of a diffusion, `A + grad phi`, whose normal
//! part vanishes on the surface.
//!
//! `d/dt` is `rate` times the unknowns and what the sources and the memory of a march drive: [`crate::magnetic::charge::solution`] solves
//! for a rate, `j w` or `1 / (gamma h)`. Here is what no rate changes.
//!
//! `phi` has a row more than it needs and a constant too many: the mean of each body is added to its
//! rows, `lap phi - mean(phi) / s^2 = 0`, so that what the discrete fluxes lack to add up to zero is
//! spread over the body, instead of leaving it at a point.

use krylov::Rows;
use rayon::prelude::*;

use crate::magnetic::charge::parts::{Parts, ROWS, add, ones};
use crate::magnetic::charge::potential::Side;
use crate::magnetic::charge::rate::Rate;
use crate::magnetic::charge::surface::Surface;
use crate::magnetic::medium::mixing::Magnetised;
use crate::magnetic::open::moments::Pair;
use crate::magnetic::open::multipoles::Multipoles;
use crate::stencils::region::Kind;
use crate::stencils::sides::share_along;

/// Extents of a body over the length that holds its constant.
const HOLD: f64 = 3.0;

/// The equations. Unknowns: three of A for each point, then those of phi, over [`Self::length`].
#[derive(Debug, Clone)]
pub struct Coupled {
    /// Point of each unknown of phi.
    pub points: Vec<u32>,
    /// Unknowns of phi of each body.
    pub bodies: Vec<std::ops::Range<usize>>,
    /// The extent of the largest body \[m\]: phi is sought in these times A.
    pub length: f64,
    /// Rows of A without rates, each over its largest coefficient.
    pub rows: Rows<f64>,
    /// What stands before the rate of A in them, with its sign.
    pub rates: Vec<f64>,
    /// What right sides in them are multiplied by.
    even: Vec<f64>,
    /// Starts of the rows of `drag`.
    starts: Vec<usize>,
    /// What the rate of phi adds to the rows of A.
    drag: Vec<(u32, [f64; 3])>,
    /// Rows of phi, each over its largest coefficient.
    pub poisson: Rows<f64>,
    /// What stands before A of the point in the row of phi.
    pub normal: Vec<[f64; 3]>,
    /// What holds the mean of the body in the row of phi.
    pub hold: Vec<f64>,
    /// `sqrt(mu sigma) / 2` in the row of phi of a surface, with its sign, as much as charges matter there; zero within.
    pub skin: Vec<f64>,
    /// Surfaces of conductors.
    pub surfaces: Vec<Surface>,
    pub(crate) pairs: Vec<Pair>,
    /// What rows have beside where permeability is not uniform.
    pub(crate) magnetised: Option<Magnetised>,
}

impl Coupled {
    /// Makes the equations.
    #[must_use]
    pub fn new(parts: &Parts<'_>, multipoles: Option<&Multipoles>) -> Self {
        use crate::magnetic::unknown::Unknown::Potential;
        let Parts { region, sides, .. } = *parts;
        let (n, m) = (region.len(), parts.charge.len());
        let smooth = parts.conductors.smooth();
        let mut rows = smooth.rows(region, sides, Potential);
        let even: Vec<f64> = (0..n).map(|i| even(rows.values_mut(i))).collect();
        let rates = smooth.rates(region, sides, Potential);
        let mut made = Self {
            points: parts.charge.points.clone(),
            bodies: parts.charge.bodies.clone(),
            length: 0.0,
            rows,
            rates: rates.iter().zip(&even).map(|(r, e)| -r * e).collect(),
            even,
            starts: vec![0],
            drag: Vec::new(),
            poisson: Rows::default(),
            normal: vec![[0.0; 3]; m],
            hold: vec![0.0; m],
            skin: vec![0.0; m],
            surfaces: Vec::new(),
            pairs: Vec::new(),
            magnetised: None,
        };
        let extents: Vec<f64> = made.bodies.iter().map(|b| extent(parts, b)).collect();
        made.length = extents.iter().copied().fold(0.0, f64::max);
        for i in 0..n {
            made.dragged(parts, i);
        }
        made.potential(parts, &extents);
        if let Some(multipoles) = multipoles {
            made.pairs = Pair::all(parts, multipoles, &made.even, made.length);
        }
        made.magnetised = Magnetised::of(parts, &made.even);
        if let Some(magnetised) = &made.magnetised {
            made.even.clone_from(&magnetised.even);
        }
        made
    }

    /// What the rate of phi adds to the rows of A at point `i`: `-mu sigma grad`.
    fn dragged(&mut self, parts: &Parts<'_>, i: usize) {
        let scale = self.even[i] * self.length;
        let mut add = |side: Side, rate: f64| {
            let mixed = Magnetised::dragged(parts, i, side == Side::Inner, scale);
            for (q, w) in parts.charge.gradient(i, side) {
                let own = w.map(|w| -rate * scale * w);
                let beside = mixed.as_ref().map_or([0.0; 3], |mixed| mixed(w));
                let all = std::array::from_fn(|k| own[k] + beside[k]);
                self.drag.push((q as u32, all));
            }
        };
        let mu_sigma = |m: u16| parts.conductors.mu_sigma[m as usize];
        match parts.region.kinds[i] {
            Kind::Inside(m) => add(Side::Inner, mu_sigma(m)),
            Kind::Wall { .. } => {}
            Kind::Interface(face) => {
                let face = &parts.region.faces[face as usize];
                let share = |stencils| share_along(stencils, i, face.normal);
                add(
                    Side::Outer,
                    mu_sigma(face.outer) * share(&parts.sides.outer),
                );
                add(
                    Side::Inner,
                    -mu_sigma(face.inner) * share(&parts.sides.inner),
                );
            }
        }
        self.starts.push(self.drag.len());
    }

    /// The rows of phi.
    fn potential(&mut self, parts: &Parts<'_>, extents: &[f64]) {
        let (region, conductivity) = (parts.region, parts.conductivity);
        let length = self.length;
        self.poisson = Rows::gathered(self.points.len(), 0.0, |p, row| {
            parts.charge.row(p, region, conductivity, row);
            row.iter_mut().for_each(|(_, w)| *w *= length);
        });
        for (body, extent) in self.bodies.iter().zip(extents) {
            for p in body.clone() {
                let scale = even(self.poisson.values_mut(p));
                let i = self.points[p] as usize;
                if let Kind::Inside(_) = parts.region.kinds[i] {
                    let far = (HOLD * extent).powi(2);
                    self.hold[p] = -scale * length / (far * body.len() as f64);
                }
                self.skin[p] = 0.5 * scale * length * skin(parts, i);
                let leaving = parts.charge.leaving(p, region, conductivity);
                self.normal[p] = leaving.map(|n| n * scale);
                if insulated(parts, i) {
                    self.surfaces.push(Surface {
                        point: i as u32,
                        unknown: p as u32,
                        normal: leaving,
                        share: 1.0 / scale,
                    });
                }
            }
        }
    }

    /// Number of points.
    #[must_use]
    pub fn points(&self) -> usize {
        self.rates.len()
    }

    /// Number of unknowns.
    #[must_use]
    pub fn len(&self) -> usize {
        3 * self.points() + self.points.len()
    }

    /// No unknowns at all.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.rates.is_empty()
    }

    /// What rates of A and phi add to the rows of A at point `i`.
    pub(crate) fn moved<S: Rate, const K: usize>(
        &self,
        i: usize,
        a: &[[[S; K]; 3]],
        phi: &[[S; K]],
    ) -> [[S; K]; 3] {
        let mut sum = [[S::ZERO; K]; 3];
        for (sum, a) in sum.iter_mut().zip(&a[i]) {
            add(sum, a, self.rates[i]);
        }
        for (q, w) in &self.drag[self.starts[i]..self.starts[i + 1]] {
            for (sum, w) in sum.iter_mut().zip(w) {
                add(sum, &phi[*q as usize], *w);
            }
        }
        sum
    }

    /// The rows of A of values at a rate, without multipoles; without phi where none is given.
    pub(crate) fn rows_of_a<S: Rate, const K: usize>(
        &self,
        rate: S,
        a: &[[[S; K]; 3]],
        phi: &[[S; K]],
        out: &mut [[[S; K]; 3]],
    ) {
        let row = |(i, out): (usize, &mut [[S; K]; 3])| {
            let mut own = [[S::ZERO; K]; 3];
            for (j, w) in self.rows.pairs(i) {
                for (own, a) in own.iter_mut().zip(&a[j]) {
                    add(own, a, w);
                }
            }
            let moved = self.moved(i, a, phi);
            for k in 0..3 {
                for c in 0..K {
                    out[k][c] = own[k][c] + rate * moved[k][c];
                }
            }
        };
        let rows = out.par_iter_mut().with_min_len(ROWS);
        rows.enumerate().for_each(row);
        if let Some(magnetised) = &self.magnetised {
            magnetised.apply(a, rate, out);
        }
    }

    /// What a potential by point adds to the row of unknown `p` of phi.
    #[must_use]
    pub fn pull<S: Rate>(&self, p: usize, potential: &[[S; 3]]) -> S {
        let here = potential[self.points[p] as usize].iter();
        here.zip(self.normal[p]).map(|(a, n)| a.times_real(n)).sum()
    }

    /// Right sides: `driven` are the rates that sources and memory make of all unknowns. Where the wave of the sources is
    /// 1, `pull` is what they add to the rows of phi, `given` what currents in coils make in the rows of A, by point, or
    /// nothing.
    #[must_use]
    pub fn right<S: Rate>(&self, driven: &[S], wave: f64, pull: &[S], given: &[[S; 3]]) -> Vec<S> {
        let (a, phi) = driven.split_at(3 * self.points());
        let (a, phi) = (ones(a).as_chunks::<3>().0, ones(phi));
        let mut right: Vec<[S; 3]> = (0..self.points())
            .map(|i| self.moved(i, a, phi).map(|[moved]| -moved))
            .collect();
        for ((right, given), even) in right.iter_mut().zip(given).zip(&self.even) {
            for (right, given) in right.iter_mut().zip(given) {
                *right += given.times_real(even * wave);
            }
        }
        if let Some(magnetised) = &self.magnetised {
            for (i, right) in right.iter_mut().enumerate() {
                for (right, [moved]) in right.iter_mut().zip(magnetised.moved(i, &a[i])) {
                    *right -= moved;
                }
            }
        }
        for pair in &self.pairs {
            let moment = pair.moment(a, phi);
            for (i, u) in &pair.walls {
                for (right, [moment]) in right[*i as usize].iter_mut().zip(moment) {
                    *right -= moment.times_real(*u);
                }
            }
        }
        let mut right = right.into_flattened();
        right.extend(pull.iter().map(|pull| pull.times_real(-wave)));
        right
    }

    /// What the rates of unknowns, `rate` times them and what is driven, put into the rows of A, by unknown.
    pub(crate) fn rated(&self, rate: f64, unknown: &[f64], driven: &[f64]) -> Vec<f64> {
        let both = unknown.iter().zip(driven);
        let rates: Vec<f64> = both.map(|(u, driven)| rate * u + driven).collect();
        let (a, phi) = rates.split_at(3 * self.points());
        let (a, phi) = (ones(a).as_chunks::<3>().0, ones(phi));
        let row = |(i, even): (usize, &f64)| self.moved(i, a, phi).map(|[m]| m / even);
        self.even.iter().enumerate().flat_map(row).collect()
    }

    /// Adds what else stands on the right of the rows of A, by unknown.
    pub(crate) fn beside(&self, more: &[f64], right: &mut [f64]) {
        let rows = right.as_chunks_mut::<3>().0.iter_mut();
        for ((right, more), even) in rows.zip(more.as_chunks::<3>().0).zip(&self.even) {
            *right = std::array::from_fn(|k| right[k] + even * more[k]);
        }
    }

    /// A potential that was found, by unknown of phi: whole, its mean over each body zero.
    #[must_use]
    pub fn whole<S: Rate>(&self, phi: &[S]) -> Vec<S> {
        let mut phi: Vec<S> = phi.iter().map(|phi| phi.times_real(self.length)).collect();
        for body in &self.bodies {
            let own = &mut phi[body.clone()];
            let mean = own.iter().copied().sum::<S>();
            let mean = mean.times_real(1.0 / own.len() as f64);
            own.iter_mut().for_each(|phi| *phi -= mean);
        }
        phi
    }
}

/// Does one side alone conduct at point `i`?
fn insulated(parts: &Parts<'_>, i: usize) -> bool {
    let conducts = |m: u16| parts.conductivity[m as usize] > 0.0;
    match parts.region.kinds[i] {
        Kind::Interface(face) => {
            let face = &parts.region.faces[face as usize];
            conducts(face.inner) != conducts(face.outer)
        }
        Kind::Inside(_) | Kind::Wall { .. } => false,
    }
}

/// `sqrt(mu sigma)` on a surface, with the sign of its row: between conductors as much as charges matter there.
fn skin(parts: &Parts<'_>, i: usize) -> f64 {
    let wave = |m: u16| parts.conductors.mu_sigma[m as usize].sqrt();
    match parts.region.kinds[i] {
        Kind::Inside(_) => 0.0,
        Kind::Wall { medium, .. } => wave(medium),
        Kind::Interface(face) => {
            let face = &parts.region.faces[face as usize];
            let [a, b] = [face.inner, face.outer];
            let [s, t] = [a, b].map(|m| parts.conductivity[m as usize]);
            let better = if s > t { a } else { b };
            wave(better) * ((s - t).abs() / (s + t))
        }
    }
}

/// Divides a row by its largest coefficient; the factor.
fn even(row: &mut [f64]) -> f64 {
    let largest = row.iter().fold(0.0, |m: f64, w| m.max(w.abs()));
    let scale = if largest > 0.0 { 1.0 / largest } else { 1.0 };
    row.iter_mut().for_each(|w| *w *= scale);
    scale
}

/// Half the diagonal of the box about a body \[m\].
fn extent(parts: &Parts<'_>, body: &std::ops::Range<usize>) -> f64 {
    let places = parts.charge.points[body.clone()].iter();
    let places = places.map(|i| parts.region.places[*i as usize]);
    let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
    for x in places {
        for k in 0..3 {
            low[k] = low[k].min(x[k]);
            high[k] = high[k].max(x[k]);
        }
    }
    let square: f64 = (0..3).map(|k| (high[k] - low[k]).powi(2)).sum();
    0.5 * square.sqrt()
}
