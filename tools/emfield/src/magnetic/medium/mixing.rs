//! Media of different permeability in space, where they mix the components of A.
//!
//! A and `div A` are continuous and so is the field along an interface, `nu n x curl A`
//! ([`crate::magnetic::medium::interface`]). With `P = 1 - n n` and a, b the sides that the normal leaves and enters,
//!
//! - `n n.(dA/dn|_a - dA/dn|_b) = 0`;
//! - `P (nu_a (dA/dn - grad(n.A))|_a - nu_b (dA/dn - grad(n.A))|_b) = (nu_a - nu_b) n x B_s`,
//!
//! each side by its own slopes, which know the Laplacian there, and the second over the greater reluctivity. Kept is what
//! these rows have beside those of continuous slopes.
//!
//! Of a wave along a plane interface the normal part of A is that of continuous slopes, and its parts along the interface
//! follow from it by the slopes `nu dA/dn` with the components apart. Rows with these solve for what the first leave along
//! interfaces, and for nothing else: of the normal part they would make too much.

use krylov::Rows;

use crate::magnetic::charge::parts::{Parts, add};
use crate::magnetic::charge::rate::Rate;
use crate::magnetic::diffusion::Conductors;
use crate::magnetic::medium::interface::Permeable;
use crate::magnetic::unknown::Unknown;
use crate::stencils::region::{Face, Kind, Region};
use crate::stencils::sides::Sides;

/// What mixes the components at a point.
pub(crate) type Mix = [[f64; 3]; 3];

/// No row.
const NONE: u32 = u32::MAX;

/// What interfaces of media of different permeability have beside continuous slopes.
#[derive(Debug, Clone)]
pub(crate) struct Magnetised {
    /// Points of the rows.
    pub(crate) points: Vec<u32>,
    /// Normals at them.
    normals: Vec<[f64; 3]>,
    /// The row of each point.
    number: Vec<u32>,
    starts: Vec<usize>,
    mixes: Vec<(u32, Mix)>,
    /// What the rate of A at the point adds.
    rates: Vec<Mix>,
    /// What right sides in the rows of A are multiplied by.
    pub(crate) even: Vec<f64>,
    /// Rows with slopes that reluctivities weight, the components apart.
    pub(crate) along: Apart,
}

/// Rows of A with the components apart, which precondition others.
#[derive(Debug, Clone)]
pub(crate) struct Apart {
    pub(crate) rows: Rows<f64>,
    /// What stands before the rate in them.
    pub(crate) rates: Vec<f64>,
    /// What makes fluxes of them: rows of many neighbours then add up to about what passes the border of these.
    pub(crate) sizes: Vec<f64>,
}

impl Apart {
    /// The rows times `even`, with slopes as reluctivities weight them, if they do.
    pub(crate) fn new(
        region: &Region<3>,
        sides: &Sides<3>,
        conductors: &Conductors,
        even: &[f64],
    ) -> Self {
        let size = |(i, even): (usize, &f64)| {
            let metric = &region.metrics[i];
            let flux = match region.kinds[i] {
                Kind::Inside(m) => -conductors.weight(m) * metric.volume(),
                Kind::Interface(_) => metric.spacing().powi(2),
                Kind::Wall { .. } => metric.spacing(),
            };
            flux / even
        };
        let mut made = Self {
            rows: conductors.rows(region, sides, Unknown::Potential),
            rates: conductors.rates(region, sides, Unknown::Potential),
            sizes: even.iter().enumerate().map(size).collect(),
        };
        for (i, (rate, even)) in made.rates.iter_mut().zip(even).enumerate() {
            made.rows.values_mut(i).iter_mut().for_each(|w| *w *= even);
            *rate *= -even;
        }
        made
    }
}

/// A side of an interface as its rows have it.
struct Half<'a> {
    stencils: &'a wls::Stencils<3>,
    /// 1 on the side that the normal leaves, -1 on the other.
    sign: f64,
    /// Reluctivity over the greater of both sides.
    weight: f64,
    /// `mu sigma`.
    mu_sigma: f64,
}

/// Both sides of a face.
fn halves<'a>(
    sides: &'a Sides<3>,
    conductors: &Conductors,
    permeable: &Permeable,
    face: &Face<3>,
) -> [Half<'a>; 2] {
    let greater = greater(permeable, face);
    let all = [
        (&sides.inner, face.inner, 1.0),
        (&sides.outer, face.outer, -1.0),
    ];
    all.map(|(stencils, medium, sign)| Half {
        stencils,
        sign,
        weight: permeable.weight(medium) / greater,
        mu_sigma: conductors.mu_sigma[medium as usize],
    })
}

/// The greater reluctivity of both sides.
fn greater(permeable: &Permeable, face: &Face<3>) -> f64 {
    let [a, b] = [face.inner, face.outer].map(|m| permeable.weight(m));
    a.max(b)
}

impl Half<'_> {
    /// What slopes `w` of a side add to those that are continuous: `(nu - 1) P n.w - nu (P w) n`.
    fn mix(&self, normal: [f64; 3], w: [f64; 3], scale: f64) -> Mix {
        let along: f64 = (0..3).map(|k| normal[k] * w[k]).sum();
        let unit = |k: usize, l: usize| if k == l { 1.0 } else { 0.0 };
        std::array::from_fn(|k| {
            let flat = w[k] - along * normal[k];
            std::array::from_fn(|l| {
                let within = unit(k, l) - normal[k] * normal[l];
                scale
                    * self.sign
                    * ((self.weight - 1.0) * along * within - self.weight * flat * normal[l])
            })
        })
    }

    /// What a Laplacian of 1 adds to the slopes at point `i`.
    fn share(&self, i: usize) -> [f64; 3] {
        std::array::from_fn(|axis| self.stencils.derivative(i, axis).conditions().sum())
    }
}

impl Magnetised {
    /// The rows of all interfaces where permeability jumps, each times `even`; none where it is uniform.
    pub(crate) fn of(parts: &Parts<'_>, even: &[f64]) -> Option<Self> {
        let permeable = parts.conductors.permeable.as_ref()?;
        let Parts {
            region,
            sides,
            conductors,
            ..
        } = *parts;
        let jumps = |face: &&Face<3>| permeable.jump(face) != 0.0;
        let mut scaled = even.to_vec();
        for face in region.faces.iter().filter(jumps) {
            scaled[face.point as usize] /= greater(permeable, face);
        }
        let mut made = Self {
            points: Vec::new(),
            normals: Vec::new(),
            number: vec![NONE; region.len()],
            starts: vec![0],
            mixes: Vec::new(),
            rates: Vec::new(),
            along: Apart::new(region, sides, conductors, &scaled),
            even: scaled,
        };
        for face in region.faces.iter().filter(jumps) {
            made.add(face, halves(sides, conductors, permeable, face), even);
        }
        Some(made)
    }

    /// The row of a face.
    fn add(&mut self, face: &Face<3>, halves: [Half<'_>; 2], even: &[f64]) {
        let i = face.point as usize;
        let mut rate = Mix::default();
        for half in halves {
            let rows: [_; 3] = std::array::from_fn(|axis| half.stencils.derivative(i, axis));
            for (k, j) in rows[0].neighbours.iter().enumerate() {
                let w = [0, 1, 2].map(|axis: usize| rows[axis].factor * rows[axis].weights[k]);
                self.mixes.push((*j, half.mix(face.normal, w, even[i])));
            }
            let own = half.mix(face.normal, half.share(i), even[i] * half.mu_sigma);
            for (sum, own) in rate.as_flattened_mut().iter_mut().zip(own.as_flattened()) {
                *sum += own;
            }
        }
        self.number[i] = self.points.len() as u32;
        self.points.push(face.point);
        self.normals.push(face.normal);
        self.rates.push(rate);
        self.starts.push(self.mixes.len());
    }

    /// What a gradient that the rate of A has beside it adds to the row of point `i`, on one side.
    pub(crate) fn dragged(
        parts: &Parts<'_>,
        i: usize,
        inner: bool,
        even: f64,
    ) -> Option<impl Fn([f64; 3]) -> [f64; 3] + use<>> {
        let permeable = parts.conductors.permeable.as_ref()?;
        let Kind::Interface(face) = parts.region.kinds[i] else {
            return None;
        };
        let face = &parts.region.faces[face as usize];
        let [own, other] = halves(parts.sides, parts.conductors, permeable, face);
        let half = if inner { own } else { other };
        let rate = half.mix(face.normal, half.share(i), even * half.mu_sigma);
        (permeable.jump(face) != 0.0).then_some(move |w: [f64; 3]| {
            let row = |k: usize| (0..3).map(|l| rate[k][l] * w[l]).sum();
            [row(0), row(1), row(2)]
        })
    }

    /// Adds the rows of values, and of the rates of them.
    pub(crate) fn apply<S: Rate, const K: usize>(
        &self,
        a: &[[[S; K]; 3]],
        rate: S,
        out: &mut [[[S; K]; 3]],
    ) {
        use rayon::prelude::*;
        let row = |number: usize| {
            let mut sum = [[S::ZERO; K]; 3];
            for (j, mix) in &self.mixes[self.starts[number]..self.starts[number + 1]] {
                mixed(&mut sum, &a[*j as usize], mix);
            }
            let here = a[self.points[number] as usize];
            mixed(
                &mut sum,
                &here.map(|a| a.map(|a| rate * a)),
                &self.rates[number],
            );
            sum
        };
        let found: Vec<[[S; K]; 3]> = (0..self.points.len()).into_par_iter().map(row).collect();
        for (i, found) in self.points.iter().zip(found) {
            let out = out[*i as usize].iter_mut().flatten();
            out.zip(found.as_flattened())
                .for_each(|(out, found)| *out += *found);
        }
    }

    /// Keeps of rows their parts along the interfaces alone.
    pub(crate) fn keep<S: Rate>(&self, rows: &mut [[S; 3]]) {
        let mut kept = vec![[S::ZERO; 3]; rows.len()];
        for (i, n) in self.points.iter().zip(&self.normals) {
            let row = rows[*i as usize];
            let through: S = row.iter().zip(n).map(|(r, n)| r.times_real(*n)).sum();
            kept[*i as usize] = std::array::from_fn(|k| row[k] - through.times_real(n[k]));
        }
        rows.copy_from_slice(&kept);
    }

    /// What rates of A at point `i` add to its row.
    pub(crate) fn moved<S: Rate, const K: usize>(&self, i: usize, a: &[[S; K]; 3]) -> [[S; K]; 3] {
        let mut sum = [[S::ZERO; K]; 3];
        if self.number[i] != NONE {
            mixed(&mut sum, a, &self.rates[self.number[i] as usize]);
        }
        sum
    }
}

/// Adds mixed components to a sum, column by column.
pub(crate) fn mixed<S: Rate, const K: usize>(sum: &mut [[S; K]; 3], a: &[[S; K]; 3], mix: &Mix) {
    for (sum, mix) in sum.iter_mut().zip(mix) {
        for (a, w) in a.iter().zip(mix) {
            add(sum, a, *w);
        }
    }
}
