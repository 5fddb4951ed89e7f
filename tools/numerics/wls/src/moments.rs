//! Sums over the points of one support, four points at a time.

use crate::basis::{Basis, LANES, Lanes, MOMENTS, TERMS, monomials};
use crate::weight::quartic;

/// Functionals of one fit at most: value, three first and six second derivatives, Laplacian.
pub(crate) const ROWS: usize = 11;

/// Vectors in the space of the monomials.
pub(crate) type Coefficients = [f64; TERMS];

/// Offsets and weights of the points of a support, in units of its radius.
#[derive(Debug, Clone, Default)]
pub(crate) struct Points<const D: usize> {
    count: usize,
    offsets: Vec<[f64; LANES]>,
    weights: Vec<Lanes>,
}

impl<const D: usize> Points<D> {
    /// Takes scaled offsets `s`; `radius` is that of the support in the same unit.
    pub(crate) fn load(&mut self, s: &[[f64; D]], radius: f64) {
        let inverse = radius.recip();
        self.count = s.len();
        self.offsets.clear();
        self.weights.clear();
        for chunk in s.chunks(LANES) {
            let mut offsets = [[0.0; LANES]; D];
            let mut weights = [0.0; LANES];
            for (lane, point) in chunk.iter().enumerate() {
                let mut square = 0.0;
                for a in 0..D {
                    let x = point[a] * inverse;
                    offsets[a][lane] = x;
                    square += x * x;
                }
                weights[lane] = quartic(square.sqrt());
            }
            self.offsets.extend_from_slice(&offsets);
            self.weights.push(weights);
        }
    }

    /// Multiplies the weights of the first points.
    pub(crate) fn weigh(&mut self, rooms: &[f64]) {
        for (j, room) in rooms.iter().enumerate() {
            self.weights[j / LANES][j % LANES] *= room;
        }
    }

    /// Number of points.
    pub(crate) fn len(&self) -> usize {
        self.count
    }

    /// Offset and weight of point `j`.
    pub(crate) fn point(&self, j: usize) -> ([f64; D], f64) {
        let (chunk, lane) = (j / LANES, j % LANES);
        let s = std::array::from_fn(|a| self.offsets[D * chunk + a][lane]);
        (s, self.weights[chunk][lane])
    }

    /// Leaves point `j` out.
    pub(crate) fn drop_point(&mut self, j: usize) {
        self.weights[j / LANES][j % LANES] = 0.0;
    }

    fn chunks(&self) -> impl Iterator<Item = (&[Lanes; D], &Lanes)> {
        let (offsets, _) = self.offsets.as_chunks::<D>();
        offsets.iter().zip(&self.weights)
    }

    /// Weighted sums of the monomials up to twice the order of `basis`, put into the matrix of the
    /// normal equations: lower triangle by rows of [`TERMS`].
    pub(crate) fn gram(&self, basis: &Basis<D>, gram: &mut [Coefficients; TERMS]) {
        let degree = 2 * basis.order();
        let many = crate::basis::terms::<D>(degree);
        let mut values = [[0.0; LANES]; MOMENTS];
        let mut sums = [[0.0; LANES]; MOMENTS];
        for (s, weight) in self.chunks() {
            monomials::<D>(degree, weight, s, &mut values);
            for (sum, value) in sums[..many].iter_mut().zip(&values[..many]) {
                for lane in 0..LANES {
                    sum[lane] += value[lane];
                }
            }
        }
        let mut moments = [0.0; 256];
        for (moment, sum) in moments.iter_mut().zip(&sums) {
            *moment = (sum[0] + sum[1]) + (sum[2] + sum[3]);
        }
        for (k, row) in gram.iter_mut().enumerate().take(basis.len()) {
            for (entry, &both) in row.iter_mut().zip(basis.products(k)) {
                *entry = moments[usize::from(both)];
            }
        }
    }

    /// Adds to each row of `weights`, of [`Points::len`] numbers each, the weights
    /// w_j sum_k c_k p_k(s_j) of the coefficients c in `rows`, and subtracts the moments
    /// sum_j weights_j p_k(s_j) of what was added from `rest`.
    pub(crate) fn spread(
        &self,
        basis: &Basis<D>,
        rows: &[Coefficients],
        weights: &mut [f64],
        rest: &mut [Coefficients],
    ) {
        let many = basis.len();
        let mut values = [[0.0; LANES]; TERMS];
        let mut sums = [[[0.0; LANES]; TERMS]; ROWS];
        for (chunk, (s, weight)) in self.chunks().enumerate() {
            monomials::<D>(basis.order(), &[1.0; LANES], s, &mut values);
            let used = LANES.min(self.count - LANES * chunk);
            for (f, (row, sums)) in rows.iter().zip(&mut sums).enumerate() {
                let mut all = [0.0; LANES];
                for (c, value) in row[..many].iter().zip(&values[..many]) {
                    for lane in 0..LANES {
                        all[lane] += c * value[lane];
                    }
                }
                for lane in 0..LANES {
                    all[lane] *= weight[lane];
                }
                let start = f * self.count + LANES * chunk;
                for (out, one) in weights[start..start + used].iter_mut().zip(all) {
                    *out += one;
                }
                for (sum, value) in sums[..many].iter_mut().zip(&values[..many]) {
                    for lane in 0..LANES {
                        sum[lane] += all[lane] * value[lane];
                    }
                }
            }
        }
        for (rest, sums) in rest.iter_mut().zip(&sums).take(rows.len()) {
            for (r, sum) in rest[..many].iter_mut().zip(sums) {
                *r -= (sum[0] + sum[1]) + (sum[2] + sum[3]);
            }
        }
    }
}
