//! The preconditioner of A and V together, and their solution; [`super::coupled`] has the equations.

use krylov::{
    Direct, Error, Grids, Inverse, Method, Multigrid, Options, Order, Rows, Rule, Scratch, Solved,
    minimal_residual,
};
use num_complex::Complex;

use super::coupled::{Coupled, Parts};
use super::region::Kind;

/// A complex number.
type C = Complex<f64>;

const ZERO: C = Complex::new(0.0, 0.0);

/// Bytes of a basis of minimal residuals, about.
const MEMORY: usize = 600 << 20;

/// Factors of one part of the equations.
enum Way {
    Grids(Box<Multigrid<f64, C>>),
    Direct(Box<Direct<C>>),
}

/// Approximate solution of one part, in an order of its own.
struct Block {
    order: Order,
    way: Way,
    given: Vec<C>,
    found: Vec<C>,
}

impl Block {
    fn new(rows: &Rows<f64>, shift: &[C], options: &Options) -> Result<Self, Error> {
        let n = rows.len();
        let direct = match options.method {
            Method::Direct => true,
            Method::Chosen => n <= options.direct,
            _ => false,
        };
        let (order, way);
        if direct {
            order = Order::natural(n);
            way = Way::Direct(Box::new(Direct::new(rows, shift)?));
        } else {
            order = Order::cuthill_mckee(rows);
            let mut mixed = vec![ZERO; n];
            order.forth(shift, &mut mixed);
            let grids = match options.method {
                Method::Multigrid(grids) => grids,
                _ => Grids::default(),
            };
            let made = Multigrid::new(&rows.permuted(&order), &mixed, &order, grids)?;
            way = Way::Grids(Box::new(made));
        }
        Ok(Self {
            order,
            way,
            given: Vec::new(),
            found: Vec::new(),
        })
    }

    fn invert<const K: usize>(&mut self, given: &[[C; K]], found: &mut [[C; K]]) {
        self.given.resize(K * given.len(), ZERO);
        self.found.resize(K * given.len(), ZERO);
        let own = self.given.as_chunks_mut::<K>().0;
        let out = self.found.as_chunks_mut::<K>().0;
        self.order.forth(given, own);
        match &mut self.way {
            Way::Grids(grids) => grids.invert(own, out),
            Way::Direct(factors) => factors.invert(own, out),
        }
        self.order.back(out, found);
    }
}

/// Solves for A, then for the charges that it asks for.
struct Factors<'a> {
    coupled: &'a Coupled,
    potential: Block,
    charge: Block,
    /// `k / 2` in the row of phi where it is that of a surface, with its sign; zero within.
    skin: Vec<C>,
    a: [Vec<[C; 3]>; 2],
    phi: [Vec<[C; 1]>; 2],
}

impl<'a> Factors<'a> {
    fn new(parts: &Parts<'_>, coupled: &'a Coupled, options: &Options) -> Result<Self, Error> {
        let (n, m) = (coupled.points(), coupled.places().len());
        let mut hold = vec![ZERO; m];
        for body in coupled.bodies() {
            for p in body.clone() {
                hold[p] = C::from(coupled.hold[p] * body.len() as f64);
            }
        }
        let rows = &coupled.poisson;
        // Multigrid serves these rows badly: one-sided slopes.
        let own = match options.method {
            Method::Chosen if m <= options.rescue => Options {
                method: Method::Direct,
                ..*options
            },
            _ => *options,
        };
        Ok(Self {
            coupled,
            potential: Block::new(&coupled.rows, &coupled.shift, options)?,
            charge: Block::new(rows, &hold, &own)?,
            skin: (0..m).map(|p| skin(parts, coupled, p)).collect(),
            a: [(); 2].map(|()| vec![[ZERO; 3]; n]),
            phi: [(); 2].map(|()| vec![[ZERO; 1]; m]),
        })
    }
}

/// `k / 2` in the row of phi of a surface: on one between conductors, as much as charges matter there.
fn skin(parts: &Parts<'_>, coupled: &Coupled, p: usize) -> C {
    let i = coupled.places()[p] as usize;
    let wave = |m: u8| {
        let rate = parts.omega * parts.conductors.mu_sigma[m as usize];
        C::new(0.0, rate).sqrt()
    };
    let k = match parts.region.kinds[i] {
        Kind::Inside(_) => ZERO,
        Kind::Wall { medium, .. } => wave(medium),
        Kind::Interface(face) => {
            let face = &parts.region.faces[face as usize];
            let [a, b] = [face.inner, face.outer];
            let [s, t] = [a, b].map(|m| parts.conductivity[m as usize]);
            let better = if s > t { a } else { b };
            wave(better) * ((s - t).abs() / (s + t))
        }
    };
    k * (0.5 * coupled.scale[p])
}

impl Inverse<C> for Factors<'_> {
    fn invert<const K: usize>(&mut self, given: &[[C; K]], found: &mut [[C; K]]) {
        let coupled = self.coupled;
        let start = 3 * coupled.points();
        let [a, b] = &mut self.a;
        let [phi, rest] = &mut self.phi;
        for c in 0..K {
            for (a, given) in a.as_flattened_mut().iter_mut().zip(given) {
                *a = given[c];
            }
            self.potential.invert(a, b);
            for (p, rest) in rest.iter_mut().enumerate() {
                let here = b[coupled.places()[p] as usize];
                let pull: C = (0..3).map(|k| here[k] * coupled.normal[p][k]).sum();
                *rest = [given[start + p][c] - pull];
            }
            self.charge.invert(rest, phi);
            for body in coupled.bodies() {
                let on = || body.clone().filter(|p| self.skin[*p] != ZERO);
                let count = on().count().max(1) as f64;
                let mean = on().map(|p| phi[p][0]).sum::<C>() / count;
                for p in on() {
                    rest[p][0] += self.skin[p] * (phi[p][0] - mean);
                }
            }
            self.charge.invert(rest, phi);
            let all = b.as_flattened().iter().chain(phi.as_flattened());
            for (found, own) in found.iter_mut().zip(all) {
                found[c] = *own;
            }
        }
    }
}

/// A solution: the reaction A \[V s/m\] of all points, phi \[V s\] of those of conductors.
pub type Found = (Vec<[C; 3]>, Vec<C>);

/// Solves the equations, by minimal residuals: stabilised bi-conjugate gradients take twice as many
/// products, and stagnate in thin skins.
///
/// # Errors
/// Where a coefficient is no number, or a part is singular.
pub fn solve(
    parts: &Parts<'_>,
    coupled: &Coupled,
    (options, rule): (&Options, Rule),
) -> Result<(Found, Solved), Error> {
    let mut factors = Factors::new(parts, coupled, options)?;
    let right = coupled.right().as_chunks::<1>().0;
    let mut x = vec![[ZERO; 1]; right.len()];
    let mut scratch = Scratch::default();
    let vectors = (MEMORY / (size_of::<C>() * right.len().max(1))).clamp(20, 120);
    let with = (rule, vectors);
    let solved = minimal_residual(coupled, right, &mut x, &mut factors, with, &mut scratch);
    let (a, phi) = x.as_flattened().split_at(3 * coupled.points());
    let a = a.as_chunks::<3>().0.to_vec();
    let mut phi: Vec<C> = phi.iter().map(|phi| phi * coupled.length).collect();
    for body in coupled.bodies() {
        let own = &mut phi[body.clone()];
        let mean = own.iter().sum::<C>() / own.len() as f64;
        own.iter_mut().for_each(|phi| *phi -= mean);
    }
    Ok(((a, phi), solved))
}
