//! A and V together in space, in a sinusoidal steady state.
//!
//! Unknown are the reaction A at all points and `phi = V / (j w)` at those of conductors
//! ([`super::charge`]). With permeability uniform and `div A = 0` (Matsuzawa 2017, eqs 2.64 to 2.66 and 2.69):
//!
//! - in air: `lap A = 0`;
//! - in a conductor: `lap A - j w mu sigma (A + A_s + grad phi) = 0` and `lap phi = 0`;
//! - on an interface: `dA/dn` is continuous, from one-sided gradients that know the Laplacian of
//!   their side; on the surface of a conductor `n.grad phi = -n.(A + A_s)`.
//!
//! `phi` has a row more than it needs and a constant too many: the mean of each body is added to its
//! rows, `lap phi - mean(phi) / s^2 = 0`, so that what the discrete fluxes lack to add up to zero is
//! spread over the body, instead of leaving it at a point.
//!
//! The system is solved whole, by a Krylov method. Its preconditioner solves for A, then for `phi`
//! with the charges that A asks for. In a thin skin the field of these charges is nearly cancelled by
//! currents: of a wave `exp(j q x)` along a plane surface, A and phi together leave the share
//! `2 q / (q + sqrt(q^2 + k^2))` of the normal derivative of phi, with `k^2 = j w mu sigma`. Its
//! inverse is about `1 + k / (2 q)`, and `1 / q` is what the solution for a given normal derivative has
//! on the surface: the charges are corrected by `k / 2` times the potential found first.

use krylov::{Operator, Rows};
use num_complex::Complex;
use rayon::prelude::*;

use super::charge::{Charge, Side};
use super::diffusion::Conductors;
use super::multipole::Multipoles;
use super::region::{Kind, Region};
use super::sides::{Sides, share_along};

/// A complex number.
type C = Complex<f64>;

const ZERO: C = Complex::new(0.0, 0.0);

/// Extents of a body over the length that holds its constant.
const HOLD: f64 = 3.0;

/// Rows that one task gathers.
const ROWS: usize = 512;

/// What the equations are made of.
#[derive(Debug, Clone, Copy)]
pub struct Parts<'a> {
    /// Points.
    pub region: &'a Region<3>,
    /// Stencils of A.
    pub sides: &'a Sides<3>,
    /// `mu sigma` by medium.
    pub conductors: &'a Conductors,
    /// Conductivity by medium \[S/m\].
    pub conductivity: &'a [f64],
    /// Stencils of phi.
    pub charge: &'a Charge,
    /// Angular frequency \[rad/s\].
    pub omega: f64,
}

/// A multipole of the currents, which stands in the rows of walls.
#[derive(Debug, Clone)]
struct Pair {
    /// Points of walls, and what a unit moment gives there.
    walls: Vec<(u32, f64)>,
    /// What `A + A_s` at the point of each unknown adds to the moment.
    potential: Vec<C>,
    /// What phi of each unknown adds along each axis.
    charge: Vec<[C; 3]>,
}

/// The equations. Unknowns: three of A for each point, then those of phi, over [`Self::length`].
#[derive(Debug, Clone)]
pub struct Coupled {
    points: Vec<u32>,
    bodies: Vec<std::ops::Range<usize>>,
    /// The extent of the largest body \[m\]: phi is sought in these times A.
    pub length: f64,
    /// Rows of A without phi, each over its largest coefficient.
    pub rows: Rows<f64>,
    /// Added to their diagonals.
    pub shift: Vec<C>,
    /// Starts of the rows of `drag`.
    starts: Vec<usize>,
    /// What phi adds to the rows of A, over j.
    drag: Vec<(u32, [f64; 3])>,
    /// Rows of phi, each over its largest coefficient.
    pub poisson: Rows<f64>,
    /// What stands before A of the point in the row of phi.
    pub normal: Vec<[f64; 3]>,
    /// What holds the mean of the body in the row of phi.
    pub hold: Vec<f64>,
    /// What the rows of phi have been multiplied by.
    pub scale: Vec<f64>,
    right: Vec<C>,
    pairs: Vec<Pair>,
}

impl Coupled {
    /// Makes the equations for sources `A_s`, by point; `given` are right sides of the rows of A that currents in coils
    /// make, by point, or nothing.
    #[must_use]
    pub fn new(
        parts: &Parts<'_>,
        (source, given): (&[[C; 3]], &[[C; 3]]),
        multipoles: Option<&Multipoles>,
    ) -> Self {
        use super::diffusion::Unknown::Potential;
        let Parts { region, sides, .. } = *parts;
        let (n, m) = (region.len(), parts.charge.len());
        let mut rows = parts.conductors.rows(region, sides, Potential);
        let rates = parts.conductors.rates(region, sides, Potential);
        let scale: Vec<f64> = (0..n).map(|i| even(rows.values_mut(i))).collect();
        let mut made = Self {
            points: parts.charge.points.clone(),
            bodies: parts.charge.bodies.clone(),
            length: 0.0,
            rows,
            shift: Vec::with_capacity(n),
            starts: vec![0],
            drag: Vec::new(),
            poisson: Rows::default(),
            normal: vec![[0.0; 3]; m],
            hold: vec![0.0; m],
            scale: vec![0.0; m],
            right: vec![ZERO; 3 * n + m],
            pairs: Vec::new(),
        };
        let extents: Vec<f64> = made.bodies.iter().map(|b| extent(parts, b)).collect();
        made.length = extents.iter().copied().fold(0.0, f64::max);
        for i in 0..n {
            let rate = C::new(0.0, parts.omega * rates[i] * scale[i]);
            made.shift.push(-rate);
            for (k, a) in source[i].iter().enumerate() {
                made.right[3 * i + k] = rate * a;
            }
            for (k, given) in given.get(i).into_iter().flatten().enumerate() {
                made.right[3 * i + k] += given * scale[i];
            }
            made.dragged(parts, i, scale[i]);
        }
        made.potential(parts, &extents, source);
        for (moment, field) in multipoles
            .iter()
            .flat_map(|l| l.moments.iter().zip(&l.fields))
        {
            made.pair(parts, (moment, field, &scale), source);
        }
        made
    }

    /// What phi adds to the rows of A at point `i`: `-j w mu sigma grad phi`.
    fn dragged(&mut self, parts: &Parts<'_>, i: usize, scale: f64) {
        let mut add = |side: Side, rate: f64| {
            let factor = -parts.omega * rate * scale * self.length;
            for (q, w) in parts.charge.gradient(i, side) {
                self.drag.push((q as u32, w.map(|w| factor * w)));
            }
        };
        let mu_sigma = |m: u8| parts.conductors.mu_sigma[m as usize];
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
    fn potential(&mut self, parts: &Parts<'_>, extents: &[f64], source: &[[C; 3]]) {
        let (n, m) = (parts.region.len(), self.points.len());
        let at = (parts.region, parts.conductivity);
        let length = self.length;
        self.poisson = Rows::gathered(m, 0.0, |p, row| {
            parts.charge.row(p, at, row);
            row.iter_mut().for_each(|(_, w)| *w *= length);
        });
        for (body, extent) in self.bodies.iter().zip(extents) {
            for p in body.clone() {
                let scale = even(self.poisson.values_mut(p));
                let i = self.points[p] as usize;
                if let Kind::Inside(_) = parts.region.kinds[i] {
                    let far = (HOLD * extent).powi(2);
                    self.hold[p] = -scale * self.length / (far * body.len() as f64);
                }
                self.scale[p] = scale * self.length;
                self.normal[p] = parts.charge.leaving(p, at).map(|n| n * scale);
                let given = (0..3).map(|k| source[i][k] * self.normal[p][k]);
                self.right[3 * n + p] = -given.sum::<C>();
            }
        }
    }

    /// The rows of walls for one multipole.
    fn pair(
        &mut self,
        parts: &Parts<'_>,
        (moment, field, scale): (&[f64], &[f64], &[f64]),
        source: &[[C; 3]],
    ) {
        let far = field.iter().enumerate().filter(|(_, f)| **f != 0.0);
        let walls: Vec<(u32, f64)> = far.map(|(i, f)| (i as u32, f * scale[i])).collect();
        let mut pair = Pair {
            walls,
            potential: vec![ZERO; self.points.len()],
            charge: vec![[ZERO; 3]; self.points.len()],
        };
        let mut given = [ZERO; 3];
        for (p, i) in self.points.iter().enumerate() {
            let i = *i as usize;
            let mu_sigma = parts.conductors.mu_sigma[parts.region.medium(i) as usize];
            let weight = C::new(0.0, parts.omega * mu_sigma * moment[i]);
            pair.potential[p] = weight;
            for k in 0..3 {
                given[k] += weight * source[i][k];
            }
            for (q, w) in parts.charge.gradient(i, Side::Inner) {
                for (sum, w) in pair.charge[q].iter_mut().zip(w) {
                    *sum += weight * (self.length * w);
                }
            }
        }
        for (i, u) in &pair.walls {
            for (k, given) in given.iter().enumerate() {
                self.right[3 * *i as usize + k] -= given * *u;
            }
        }
        self.pairs.push(pair);
    }

    /// Number of points.
    #[must_use]
    pub fn points(&self) -> usize {
        self.shift.len()
    }

    /// Right sides.
    #[must_use]
    pub fn right(&self) -> &[C] {
        &self.right
    }

    /// Point of each unknown of phi.
    #[must_use]
    pub fn places(&self) -> &[u32] {
        &self.points
    }

    /// Unknowns of phi of each body.
    #[must_use]
    pub fn bodies(&self) -> &[std::ops::Range<usize>] {
        &self.bodies
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

/// Adds `w x` to a sum, column by column.
fn add<const K: usize>(sum: &mut [C; K], x: &[C; K], w: f64) {
    for (sum, x) in sum.iter_mut().zip(x) {
        *sum += x * w;
    }
}

impl Operator<C> for Coupled {
    fn len(&self) -> usize {
        self.right.len()
    }

    fn apply<const K: usize>(&self, x: &[[C; K]], out: &mut [[C; K]]) {
        let (a, phi) = x.split_at(3 * self.points());
        let (out_a, out_phi) = out.split_at_mut(3 * self.points());
        let a = a.as_chunks::<3>().0;
        let out_a = out_a.as_chunks_mut::<3>().0;
        out_a
            .par_iter_mut()
            .with_min_len(ROWS)
            .enumerate()
            .for_each(|(i, out)| {
                let [mut own, mut charge] = [[[ZERO; K]; 3]; 2];
                for (j, w) in self.rows.pairs(i) {
                    for k in 0..3 {
                        add(&mut own[k], &a[j][k], w);
                    }
                }
                for (q, w) in &self.drag[self.starts[i]..self.starts[i + 1]] {
                    for k in 0..3 {
                        add(&mut charge[k], &phi[*q as usize], w[k]);
                    }
                }
                let shift = self.shift[i];
                for k in 0..3 {
                    for c in 0..K {
                        out[k][c] = own[k][c] + a[i][k][c] * shift + charge[k][c] * C::I;
                    }
                }
            });
        for pair in &self.pairs {
            let mut moment = [[ZERO; K]; 3];
            for (p, i) in self.points.iter().enumerate() {
                let (here, weight) = (&a[*i as usize], pair.potential[p]);
                for k in 0..3 {
                    for c in 0..K {
                        moment[k][c] += weight * here[k][c] + pair.charge[p][k] * phi[p][c];
                    }
                }
            }
            for (i, u) in &pair.walls {
                for k in 0..3 {
                    for c in 0..K {
                        out_a[*i as usize][k][c] += moment[k][c] * *u;
                    }
                }
            }
        }
        self.apply_potential(a, phi, out_phi);
    }
}

impl Coupled {
    /// The rows of phi.
    fn apply_potential<const K: usize>(
        &self,
        a: &[[[C; K]; 3]],
        phi: &[[C; K]],
        out: &mut [[C; K]],
    ) {
        out.par_iter_mut()
            .with_min_len(ROWS)
            .enumerate()
            .for_each(|(p, out)| {
                let mut sum = [ZERO; K];
                for (q, w) in self.poisson.pairs(p) {
                    add(&mut sum, &phi[q], w);
                }
                let here = &a[self.points[p] as usize];
                for (here, normal) in here.iter().zip(self.normal[p]) {
                    add(&mut sum, here, normal);
                }
                *out = sum;
            });
        for body in &self.bodies {
            let mut total = [ZERO; K];
            for phi in &phi[body.clone()] {
                add(&mut total, phi, 1.0);
            }
            for p in body.clone() {
                add(&mut out[p], &total, self.hold[p]);
            }
        }
    }
}
