//! Polynomials other than all of an order, as sums of monomials: harmonic ones, and linear ones that bow.
//!
//! Of a polynomial without a Laplacian the coefficients of monomials with at most one power of the last coordinate are
//! free, and the others follow from them: 25 of 35 in space and 9 of 15 in a plane for order 4. A fit over these
//! polynomials has so many unknowns and no conditions, and is much better determined than one that is kept harmonic
//! by conditions.
//!
//! A linear polynomial has no Laplacian that a condition could speak of, and one that has a derivative along a drift
//! instead would have to do without that derivative. With one square beside the linear terms, along the normal of a
//! one-sided fit or alike in all directions, the condition says how the polynomial bows.

use crate::basis::{Basis, TERMS};
use crate::moments::Coefficients;

/// The polynomials over which a fit is made, each a sum of monomials; or all monomials.
#[derive(Debug, Clone, Default)]
pub(crate) struct Reduction {
    /// Where the parts of each polynomial begin; empty for all monomials.
    starts: Vec<usize>,
    /// Monomial and coefficient.
    parts: Vec<(usize, f64)>,
    /// What harmonic polynomials obey, from which these came; empty for others.
    obeyed: Vec<Coefficients>,
}

/// The polynomials of a fit.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Over<'a, const D: usize> {
    /// All of the order of the basis.
    All,
    /// Those that obey rows, which a harmonic polynomial does.
    Harmonic(&'a [Coefficients]),
    /// Linear ones of a basis of order 2, and a square: along a direction of the coordinates, or of the distance.
    Bowed(Option<[f64; D]>),
}

impl Reduction {
    /// Takes polynomials.
    pub(crate) fn choose<const D: usize>(&mut self, basis: &Basis<D>, over: Over<'_, D>) {
        match over {
            Over::All => self.clear(),
            Over::Harmonic(rows) => self.take(basis, rows),
            Over::Bowed(along) => self.bow(basis, along),
        }
    }

    fn bow<const D: usize>(&mut self, basis: &Basis<D>, along: Option<[f64; D]>) {
        self.clear();
        self.starts.push(0);
        let degree = |e: &[u8; D]| e.iter().sum::<u8>();
        for k in (0..basis.len()).filter(|k| degree(&basis.exponents()[*k]) < 2) {
            self.parts.push((k, 1.0));
            self.starts.push(self.parts.len());
        }
        for a in 0..D {
            for b in a..D {
                let mut both = [0; D];
                both[a] += 1;
                both[b] += 1;
                let factor = match along {
                    Some(n) if a == b => n[a] * n[a],
                    Some(n) => 2.0 * n[a] * n[b],
                    None => f64::from(u8::from(a == b)),
                };
                if let Some(k) = basis.number(both).filter(|_| factor != 0.0) {
                    self.parts.push((k, factor));
                }
            }
        }
        self.starts.push(self.parts.len());
    }

    /// Takes all monomials.
    fn clear(&mut self) {
        self.starts.clear();
        self.parts.clear();
        self.obeyed.clear();
    }

    /// Takes the polynomials that obey `rows`: for each monomial of degree two less than the order, in the order of
    /// the basis, its coefficient in the Laplacian.
    fn take<const D: usize>(&mut self, basis: &Basis<D>, rows: &[Coefficients]) {
        // In round metrics every fit of an order has the same.
        if !rows.is_empty() && self.obeyed == rows {
            return;
        }
        self.clear();
        self.obeyed.extend_from_slice(rows);
        let exponents = basis.exponents();
        let degree = |e: &[u8; D]| e.iter().sum::<u8>();
        let low = exponents
            .iter()
            .filter(|e| degree(e) + 2 <= basis.order())
            .map(|e| {
                let mut high = *e;
                high[D - 1] += 2;
                (high[D - 1], basis.number(high))
            });
        let mut bound: Vec<(u8, usize, &Coefficients)> = low
            .zip(rows)
            .filter_map(|((power, number), row)| Some((power, number?, row)))
            .collect();
        // Each holds lower powers of the last coordinate beside its own.
        bound.sort_by_key(|b| b.0);
        self.starts.push(0);
        for (k, e) in exponents.iter().enumerate() {
            if e[D - 1] > 1 {
                continue;
            }
            let mut polynomial = [0.0; TERMS];
            polynomial[k] = 1.0;
            for &(_, own, row) in &bound {
                let known: f64 = row.iter().zip(&polynomial).map(|(r, p)| r * p).sum();
                polynomial[own] = -known / row[own];
            }
            let parts = polynomial.iter().enumerate().filter(|(_, p)| **p != 0.0);
            self.parts.extend(parts.map(|(k, p)| (k, *p)));
            self.starts.push(self.parts.len());
        }
    }

    /// Number of polynomials, of `all` monomials.
    pub(crate) fn many(&self, all: usize) -> usize {
        self.starts.len().checked_sub(1).unwrap_or(all)
    }

    fn parts(&self, f: usize) -> &[(usize, f64)] {
        &self.parts[self.starts[f]..self.starts[f + 1]]
    }

    /// A form over monomials as one over the polynomials.
    pub(crate) fn forth(&self, form: &Coefficients) -> Coefficients {
        if self.starts.is_empty() {
            return *form;
        }
        let mut out = [0.0; TERMS];
        for (f, out) in out.iter_mut().enumerate().take(self.starts.len() - 1) {
            *out = self.parts(f).iter().map(|(k, p)| p * form[*k]).sum();
        }
        out
    }

    /// Coefficients of polynomials as those of monomials.
    pub(crate) fn back(&self, coefficients: &Coefficients) -> Coefficients {
        if self.starts.is_empty() {
            return *coefficients;
        }
        let mut out = [0.0; TERMS];
        let many = self.starts.len() - 1;
        for (f, coefficient) in coefficients.iter().enumerate().take(many) {
            for (k, p) in self.parts(f) {
                out[*k] += p * coefficient;
            }
        }
        out
    }

    /// The lower triangle of a symmetric matrix over `all` monomials as that over the polynomials.
    #[expect(
        clippy::needless_range_loop,
        reason = "two rows of one matrix at a time"
    )]
    pub(crate) fn square(
        &self,
        all: usize,
        gram: &mut [Coefficients; TERMS],
        spare: &mut [Coefficients; TERMS],
    ) {
        if self.starts.is_empty() {
            return;
        }
        for k in 0..all {
            for l in k + 1..all {
                gram[k][l] = gram[l][k];
            }
        }
        let many = self.many(all);
        for (f, half) in spare.iter_mut().enumerate().take(many) {
            *half = [0.0; TERMS];
            for (k, p) in self.parts(f) {
                for (h, g) in half.iter_mut().zip(&gram[*k]).take(all) {
                    *h += p * g;
                }
            }
        }
        for (f, half) in spare.iter().enumerate().take(many) {
            for g in 0..=f {
                gram[f][g] = self.parts(g).iter().map(|(k, p)| p * half[*k]).sum();
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::functional::{Condition, Rows};
    use crate::metric::Metric;

    #[test]
    fn every_polynomial_is_harmonic_and_none_is_missing() {
        let n = [0.48, 0.6, 0.64];
        for metric in [Metric::round(0.3), Metric::layered(n, 0.1, 0.4)] {
            for (order, many) in [(1, 4), (2, 9), (3, 16), (4, 25)] {
                let basis = Basis::<3>::new(order);
                let rows = Rows {
                    basis: &basis,
                    metric: &metric,
                    radius: 2.5,
                };
                let mut conditions = Vec::new();
                rows.condition(&Condition::Harmonic, [0.0; 3], |row, _| {
                    conditions.push(row);
                });
                let mut reduction = Reduction::default();
                reduction.take(&basis, &conditions);
                assert_eq!(reduction.many(basis.len()), many);
                for f in 0..many {
                    let mut one = [0.0; TERMS];
                    one[f] = 1.0;
                    let polynomial = reduction.back(&one);
                    for row in &conditions {
                        let left: f64 = row.iter().zip(&polynomial).map(|(r, p)| r * p).sum();
                        let size = row.iter().map(|r| r.abs()).fold(0.0, f64::max);
                        assert!(left.abs() < 1e-9 * size, "{order} {f}: {left}");
                    }
                }
            }
        }
    }
}
