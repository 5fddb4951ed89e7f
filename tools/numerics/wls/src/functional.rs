//! What is asked of a fit, and what it must obey, as rows over the monomials.

use crate::basis::{Basis, TERMS};
use crate::metric::Metric;
use crate::moments::Coefficients;

/// The operators whose weights are wanted.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Wants {
    /// The value of the fit at the point itself (it smooths: a fit does not pass through its points).
    pub value: bool,
    /// First derivatives.
    pub gradient: bool,
    /// Second derivatives, each.
    pub hessian: bool,
    /// The sum of the unmixed second derivatives.
    pub laplacian: bool,
}

/// A condition that a fit obeys exactly, whatever its points say.
///
/// A linear fit under a condition on second derivatives has one square beside its linear terms, along the direction in
/// which its points lie ([`crate::Rules::side`]) or else of the distance, so that the condition says how it bows.
///
/// The datum g of each enters with weights of its own ([`crate::Row::conditions`]), in the order in
/// which the conditions are given; where g = 0 they do not matter.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Condition<const D: usize> {
    /// The value g at a place.
    Value {
        /// Place \[m\].
        at: [f64; D],
    },
    /// The derivative g along a normal at a place: a Neumann row.
    Flux {
        /// Place \[m\].
        at: [f64; D],
        /// Direction; g is the gradient times it.
        normal: [f64; D],
    },
    /// The Laplacian g at a place.
    Laplacian {
        /// Place \[m\].
        at: [f64; D],
    },
    /// The Laplacian and the derivative along a drift together g at a place.
    Drift {
        /// Place \[m\].
        at: [f64; D],
        /// Drift \[1/m\]: the Laplacian and the gradient times it are g.
        drift: [f64; D],
    },
    /// The polynomial is harmonic: its Laplacian is zero everywhere. It has no datum. Bent metrics are taken straight.
    Harmonic,
}

/// Where the rows of each operator stand among those of a fit.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) struct Columns {
    pub(crate) value: Option<usize>,
    pub(crate) gradient: Option<usize>,
    pub(crate) hessian: Option<usize>,
    pub(crate) laplacian: Option<usize>,
    pub(crate) count: usize,
}

impl Columns {
    pub(crate) fn new<const D: usize>(wants: Wants) -> Self {
        let mut count = 0;
        let mut take = |wanted: bool, rows: usize| {
            let start = count;
            count += if wanted { rows } else { 0 };
            wanted.then_some(start)
        };
        let value = take(wants.value, 1);
        let gradient = take(wants.gradient, D);
        let hessian = take(wants.hessian, D * (D + 1) / 2);
        let laplacian = take(wants.laplacian, 1);
        Self {
            value,
            gradient,
            hessian,
            laplacian,
            count,
        }
    }

    /// Place of d2/dx_a dx_b among the second derivatives: xx, xy, xz, yy, yz, zz.
    pub(crate) fn pair<const D: usize>(a: usize, b: usize) -> usize {
        let (a, b) = (a.min(b), a.max(b));
        a * D - a * (a + 1) / 2 + b
    }
}

/// Rows over the monomials of `basis` in coordinates that `metric` and the radius of a support
/// scale: s = M dx / (L radius), or along a surface. Derivatives are taken with respect to x / L.
pub(crate) struct Rows<'a, const D: usize> {
    pub(crate) basis: &'a Basis<D>,
    pub(crate) metric: &'a Metric<D>,
    pub(crate) radius: f64,
}

impl<const D: usize> Rows<'_, D> {
    fn value(&self, s: [f64; D]) -> Coefficients {
        self.sum(|k| self.basis.derivative(k, &[], s))
    }

    /// Row of the derivative along a vector, at the offset `dx` with its coordinates `s`.
    fn first(&self, along: [f64; D], dx: &[f64; D], s: [f64; D]) -> Coefficients {
        let scaled = self.metric.turned(along, dx).map(|x| x / self.radius);
        self.sum(|k| {
            (0..D)
                .map(|b| scaled[b] * self.basis.derivative(k, &[b], s))
                .sum()
        })
    }

    /// sum over (a, b) of `pairs` of d2/dx_a dx_b.
    fn second(&self, pairs: &[(usize, usize)], dx: &[f64; D], s: [f64; D]) -> Coefficients {
        let mut product = [[0.0; D]; D];
        let mut bend = [0.0; D];
        let axis = |a: usize| std::array::from_fn(|c| f64::from(u8::from(a == c)));
        for &(a, b) in pairs {
            let [first, second] = [a, b].map(|a| self.metric.turned(axis(a), dx));
            for (sums, x) in product.iter_mut().zip(first) {
                for (sum, y) in sums.iter_mut().zip(second) {
                    *sum += x * y / (self.radius * self.radius);
                }
            }
            for (sum, x) in bend.iter_mut().zip(self.metric.bend(a, b)) {
                *sum += x / self.radius;
            }
        }
        self.sum(|k| {
            let mut value = 0.0;
            for (c, row) in product.iter().enumerate() {
                for (d, factor) in row.iter().enumerate() {
                    value += factor * self.basis.derivative(k, &[c, d], s);
                }
                value += bend[c] * self.basis.derivative(k, &[c], s);
            }
            value
        })
    }

    fn laplacian(&self, dx: &[f64; D], s: [f64; D]) -> Coefficients {
        let pairs: [(usize, usize); D] = std::array::from_fn(|a| (a, a));
        self.second(&pairs, dx, s)
    }

    fn sum(&self, value: impl Fn(usize) -> f64) -> Coefficients {
        let mut row = [0.0; TERMS];
        for (k, entry) in row.iter_mut().enumerate().take(self.basis.len()) {
            *entry = value(k);
        }
        row
    }

    /// Rows of all wanted operators at the point itself.
    pub(crate) fn functionals(&self, columns: &Columns, rows: &mut Vec<Coefficients>) {
        let (dx, s) = (&[0.0; D], [0.0; D]);
        rows.clear();
        if columns.value.is_some() {
            rows.push(self.value(s));
        }
        if columns.gradient.is_some() {
            for a in 0..D {
                let along = std::array::from_fn(|b| f64::from(u8::from(a == b)));
                rows.push(self.first(along, dx, s));
            }
        }
        if columns.hessian.is_some() {
            for a in 0..D {
                for b in a..D {
                    rows.push(self.second(&[(a, b)], dx, s));
                }
            }
        }
        if columns.laplacian.is_some() {
            rows.push(self.laplacian(dx, s));
        }
    }

    /// Rows of a condition seen from `place`; each with the power of the spacing by which its datum
    /// must be multiplied, none where it has no datum.
    pub(crate) fn condition(
        &self,
        condition: &Condition<D>,
        place: [f64; D],
        mut push: impl FnMut(Coefficients, Option<i32>),
    ) {
        let offset = |at: [f64; D]| -> [f64; D] { std::array::from_fn(|a| at[a] - place[a]) };
        let coordinates = |dx: [f64; D]| self.metric.scaled(dx).map(|x| x / self.radius);
        match *condition {
            Condition::Value { at } => push(self.value(coordinates(offset(at))), Some(0)),
            Condition::Flux { at, normal } => {
                let dx = offset(at);
                push(self.first(normal, &dx, coordinates(dx)), Some(1));
            }
            Condition::Laplacian { at } => {
                let dx = offset(at);
                push(self.laplacian(&dx, coordinates(dx)), Some(2));
            }
            Condition::Drift { at, drift } => {
                let dx = offset(at);
                let s = coordinates(dx);
                let along = drift.map(|part| part * self.metric.spacing());
                let mut row = self.laplacian(&dx, s);
                for (sum, first) in row.iter_mut().zip(self.first(along, &dx, s)) {
                    *sum += first;
                }
                push(row, Some(2));
            }
            Condition::Harmonic => self.harmonic(push),
        }
    }

    /// All coefficients of the Laplacian of the polynomial, in straight coordinates.
    fn harmonic(&self, mut push: impl FnMut(Coefficients, Option<i32>)) {
        let mut product = [[0.0; D]; D];
        for a in 0..D {
            let axis = std::array::from_fn(|c| f64::from(u8::from(a == c)));
            let row = self.metric.turned(axis, &[0.0; D]);
            for (sums, x) in product.iter_mut().zip(row) {
                for (sum, y) in sums.iter_mut().zip(row) {
                    *sum += x * y;
                }
            }
        }
        let exponents = self.basis.exponents();
        let degree = |e: &[u8; D]| e.iter().sum::<u8>();
        for low in exponents
            .iter()
            .filter(|e| degree(e) + 2 <= self.basis.order())
        {
            let mut row = [0.0; TERMS];
            for (c, factors) in product.iter().enumerate() {
                for (d, factor) in factors.iter().enumerate() {
                    let mut high = *low;
                    high[c] += 1;
                    let first = f64::from(high[c]);
                    high[d] += 1;
                    if let Some(k) = self.basis.number(high) {
                        row[k] += factor * first * f64::from(high[d]);
                    }
                }
            }
            push(row, None);
        }
    }
}
