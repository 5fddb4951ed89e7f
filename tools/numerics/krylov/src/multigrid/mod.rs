//! Algebraic multigrid for rows of scattered points, as a preconditioner.
//!
//! Points that are strongly coupled both ways form groups of about a neighbourhood; what is
//! constant on a group is smoothed by one Jacobi step along the rows to interpolate, and along the
//! columns to restrict (smoothed aggregation: Vanek, Mandel and Brezina 1996, Computing 56, 179; for
//! unsymmetric matrices Sala and Tuminaro 2008, SIAM J. Sci. Comput. 31, 143). Where a coefficient
//! jumps, the coupling is strong one way only, so that groups do not cross the jump and weak rows
//! do not reach the equations of strong ones. After each correction incomplete factors smooth.

mod groups;
mod transfer;

use crate::{Coefficient, Direct, Error, Incomplete, Inverse, Keep, Order, Rows, Scalar};
use groups::groups;
use transfer::{coarse, interpolation, restriction, times};

/// An imaginary part of this share of the diagonal needs complex factors.
const LARGE: f64 = 0.2;
/// Factors that answer this many times as much as those of an M-matrix have grown: 1 is usual, 10 to 100 stagnate.
const GROWN: f64 = 4.0;
/// Most levels.
const LEVELS: usize = 8;

/// How the hierarchy is built.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Grids {
    /// A coupling counts as strong from this share of the largest of its row, both ways.
    pub strong: f64,
    /// Step of the smoothing of the interpolation, of the diagonal.
    pub step: f64,
    /// Entries below this share of the largest of their row are not given to the interpolation, nor
    /// to the factors of the finest level. Those of coarser levels take small ones too: there the
    /// sum of many counts, and they are few beside those of the finest.
    pub thin: f64,
    /// Corrections on each coarse level.
    pub visits: usize,
    /// At most this many rows are solved directly.
    pub bottom: usize,
}

impl Default for Grids {
    fn default() -> Self {
        Self {
            strong: 0.25,
            step: 0.66,
            thin: 0.1,
            visits: 1,
            bottom: 1500,
        }
    }
}

/// Factors of a level: complex ones only where the diagonal is complex and large.
enum Smoother<S: Scalar> {
    Real(Incomplete<f32>),
    Full(Incomplete<S::Single>),
}

impl<S: Scalar> Smoother<S>
where
    f32: Coefficient<S>,
{
    fn new<T: Coefficient<S> + Scalar>(a: &Rows<T>, shift: &[S], order: &Order) -> Self {
        let complex = |(i, s): (usize, &S)| {
            let d: S = a.diagonal(i).widened();
            (*s - S::real(s.real_part())).modulus() > LARGE * d.modulus()
        };
        if shift.iter().enumerate().any(complex) {
            Self::Full(Incomplete::new(a, shift, order, Keep::PATTERN))
        } else {
            Self::Real(Incomplete::new(a, shift, order, Keep::PATTERN))
        }
    }

    /// Factors of all entries that are not below `least`, where these do not grow: they suit the rows best; else of `thin`,
    /// which lacks those of the wrong sign too.
    fn of_finest<T: Coefficient<S> + Scalar>(
        a: &Rows<T>,
        thin: &Rows<T>,
        shift: &[S],
        order: &Order,
        least: f64,
    ) -> Self {
        let whole = Self::new(&a.thinned(least, false), shift, order);
        let sound = Self::new(thin, shift, order);
        if whole.growth(a) > GROWN * sound.growth(a) {
            sound
        } else {
            whole
        }
    }

    /// Largest entry of the inverse times the diagonal with scattered signs.
    fn growth<T: Coefficient<S> + Scalar>(&self, a: &Rows<T>) -> f64 {
        let sign = |i: usize| {
            let bits = (i as u64).wrapping_mul(0x9e37_79b9_7f4a_7c15);
            let size = a.diagonal(i).modulus();
            [S::real(if bits >> 63 == 0 { size } else { -size })]
        };
        let signs: Vec<[S; 1]> = (0..a.len()).map(sign).collect();
        let mut out = vec![[S::ZERO; 1]; a.len()];
        self.solve(&signs, &mut out);
        out.iter().fold(0.0, |most: f64, v| {
            if v[0].finite() {
                most.max(v[0].modulus())
            } else {
                f64::INFINITY
            }
        })
    }

    fn solve<const C: usize>(&self, rhs: &[[S; C]], out: &mut [[S; C]]) {
        match self {
            Self::Real(factors) => factors.solve(rhs, out),
            Self::Full(factors) => factors.solve(rhs, out),
        }
    }

    fn bytes(&self) -> usize {
        match self {
            Self::Real(factors) => factors.bytes(),
            Self::Full(factors) => factors.bytes(),
        }
    }
}

/// One level and the way to the next.
struct Level<T, S: Scalar> {
    rows: Option<Rows<T>>,
    shift: Vec<S>,
    factors: Smoother<S>,
    down: Rows<f32>,
    up: Rows<f32>,
    /// The matrix times the interpolation.
    image: Rows<T>,
    scratch: Vec<S>,
}

/// A hierarchy of ever fewer equations.
pub struct Multigrid<T, S: Scalar> {
    levels: Vec<Level<T, S>>,
    bottom: Direct<S>,
    visits: usize,
    sizes: Vec<(usize, usize)>,
    /// What residuals are multiplied by to become fluxes; none where they are.
    weights: Vec<f64>,
    /// Fluxes.
    weighed: Vec<S>,
}

impl<S: Scalar, T: Coefficient<S> + Scalar> Multigrid<T, S>
where
    f32: Coefficient<S> + Coefficient<T>,
{
    /// The hierarchy of `rows + diag(shift)`, whose rows stand in the order `order` and are scaled
    /// to about the same size.
    ///
    /// # Errors
    /// When the coarsest matrix is singular.
    pub fn new(rows: &Rows<T>, shift: &[S], order: &Order, grids: Grids) -> Result<Self, Error> {
        let (mut levels, mut sizes) = (Vec::new(), vec![(rows.len(), rows.entries())]);
        let mut held: Option<(Rows<T>, Vec<S>)> = None;
        loop {
            let (a, s) = held.as_ref().map_or((rows, shift), |h| (&h.0, &h.1[..]));
            if a.len() <= grids.bottom.max(1) || levels.len() >= LEVELS {
                break;
            }
            let groups = groups(a, grids.strong);
            if 2 * groups.len() > a.len() || groups.len() == 0 {
                break;
            }
            let thin = a.thinned(grids.thin, true);
            let up = interpolation(&thin, &groups, grids.step);
            let down = restriction(&thin, &groups, grids.step);
            let mut lumped = vec![[S::ZERO; 1]; groups.len()];
            down.product(s.as_chunks::<1>().0, &mut lumped, |_, sum, out| *out = sum);
            let natural;
            let order = if levels.is_empty() {
                order
            } else {
                natural = Order::natural(a.len());
                &natural
            };
            let factors = if levels.is_empty() {
                Smoother::of_finest(a, &thin, s, order, grids.thin)
            } else {
                // Coarse rows have entries of the sign of their diagonal, with which incomplete
                // factors can grow without bound; without them they cannot (Meijerink and van der
                // Vorst 1977, Math. Comp. 31, 148).
                Smoother::new(&a.thinned(0.0, true), s, order)
            };
            drop(thin);
            let image = times(a, &up, groups.len());
            let next = coarse(&down, &image, groups.len());
            sizes.push((next.len(), next.entries()));
            let (rows, shift) = held
                .take()
                .map_or((None, shift.to_vec()), |h| (Some(h.0), h.1));
            levels.push(Level {
                rows,
                shift,
                factors,
                down,
                up,
                image,
                scratch: Vec::new(),
            });
            held = Some((next, lumped.into_flattened()));
        }
        let (a, s) = held.as_ref().map_or((rows, shift), |h| (&h.0, &h.1[..]));
        Ok(Self {
            bottom: Direct::new(a, s)?,
            levels,
            visits: grids.visits.max(1),
            sizes,
            weights: Vec::new(),
            weighed: Vec::new(),
        })
    }

    /// The same for rows that become fluxes by the given weights: rows of many neighbours add up to about what
    /// passes the border of these, as the coarse equations ask where coefficients jump.
    ///
    /// # Errors
    /// When the coarsest matrix is singular.
    pub fn of_fluxes(
        rows: &Rows<T>,
        shift: &[S],
        order: &Order,
        weights: Vec<f64>,
        grids: Grids,
    ) -> Result<Self, Error> {
        let mut rows = rows.clone();
        let mut shift = shift.to_vec();
        for (i, (shift, weight)) in shift.iter_mut().zip(&weights).enumerate() {
            for v in rows.values_mut(i) {
                *v = v.times_real(*weight);
            }
            *shift = shift.times_real(*weight);
        }
        let whole = Self::new(&rows, &shift, order, grids)?;
        Ok(Self { weights, ..whole })
    }

    /// Rows and coefficients of each level, the finest first.
    #[must_use]
    pub fn sizes(&self) -> &[(usize, usize)] {
        &self.sizes
    }

    /// Bytes held, without the coarsest factors.
    #[must_use]
    pub fn bytes(&self) -> usize {
        let of = |l: &Level<T, S>| {
            let rows = l.rows.as_ref().map_or(0, Rows::bytes);
            let scratch = size_of::<S>() * (l.shift.capacity() + l.scratch.capacity());
            rows + scratch + l.factors.bytes() + l.down.bytes() + l.up.bytes() + l.image.bytes()
        };
        self.levels.iter().map(of).sum()
    }
}

impl<S: Scalar, T: Coefficient<S> + Scalar, const C: usize> Inverse<S, C> for Multigrid<T, S>
where
    f32: Coefficient<S>,
{
    fn invert(&mut self, rhs: &[[S; C]], out: &mut [[S; C]]) {
        let (bottom, visits) = (&mut self.bottom, self.visits);
        if self.weights.is_empty() {
            cycle(&mut self.levels, bottom, visits, rhs, out);
            return;
        }
        self.weighed.resize(rhs.len() * C, S::ZERO);
        let weighed = self.weighed.as_chunks_mut::<C>().0;
        for ((weighed, rhs), weight) in weighed.iter_mut().zip(rhs).zip(&self.weights) {
            *weighed = rhs.map(|r| r.times_real(*weight));
        }
        cycle(&mut self.levels, bottom, visits, weighed, out);
    }
}

/// `out` becomes the correction for `rhs` on the first of the levels.
fn cycle<S: Scalar, T: Coefficient<S> + Scalar, const C: usize>(
    levels: &mut [Level<T, S>],
    bottom: &mut Direct<S>,
    visits: usize,
    rhs: &[[S; C]],
    out: &mut [[S; C]],
) where
    f32: Coefficient<S>,
{
    let Some((level, rest)) = levels.split_first_mut() else {
        bottom.invert(rhs, out);
        return;
    };
    let (n, m) = (level.up.len(), level.down.len());
    if level.scratch.len() < (2 * n + 4 * m) * C {
        level.scratch.resize((2 * n + 4 * m) * C, S::ZERO);
    }
    let scratch = level.scratch.as_chunks_mut::<C>().0;
    let (left, scratch) = scratch.split_at_mut(n);
    let (smooth, scratch) = scratch.split_at_mut(n);
    let (below, scratch) = scratch.split_at_mut(m);
    let (sum, scratch) = scratch.split_at_mut(m);
    let (again, scratch) = scratch.split_at_mut(m);
    let more = &mut scratch[..m];
    level.down.product(rhs, below, |_, sum, out| *out = sum);
    cycle(rest, bottom, visits, below, sum);
    for _ in 1..visits {
        let Some(next) = rest.first() else { break };
        let Some(rows) = &next.rows else { break };
        rows.product(sum, again, |i, product, out| {
            for c in 0..C {
                out[c] = below[i][c] - product[c] - next.shift[i] * sum[i][c];
            }
        });
        cycle(rest, bottom, visits, again, more);
        crate::columns::add(sum, [S::ONE; C], more);
    }
    level.up.product(sum, out, |_, sum, out| *out = sum);
    let x = &*out;
    level.image.product(sum, left, |i, product, left| {
        for c in 0..C {
            left[c] = rhs[i][c] - product[c] - level.shift[i] * x[i][c];
        }
    });
    level.factors.solve(left, smooth);
    crate::columns::add(out, [S::ONE; C], smooth);
}
