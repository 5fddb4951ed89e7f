//! Monomials of total degree up to an order, their values and their moments.

use std::ops::Range;

/// Highest order of a fit.
pub const HIGHEST: u8 = 4;
/// Monomials of the highest order in three dimensions.
pub(crate) const TERMS: usize = 35;
/// Distinct products of two of them: monomials of degree eight.
pub(crate) const MOMENTS: usize = 165;
/// Points that are treated together, lane by lane.
pub(crate) const LANES: usize = 4;
/// A number per lane.
pub(crate) type Lanes = [f64; LANES];

/// Number of monomials of total degree up to `degree` in `D` dimensions.
///
/// ```
/// assert_eq!(wls::terms::<3>(2), 10);
/// assert_eq!(wls::terms::<2>(4), 15);
/// ```
#[must_use]
pub const fn terms<const D: usize>(degree: u8) -> usize {
    let p = degree as usize;
    if D == 2 {
        (p + 1) * (p + 2) / 2
    } else {
        (p + 1) * (p + 2) * (p + 3) / 6
    }
}

/// The basis of (2.13), Matsuzawa (2017), for orders 1 to 4 in two and three dimensions.
///
/// Monomials stand by degree, and within a degree so that each block is x times the whole block
/// before it, y times its part without x, and z times its last: all of them come by one product
/// each, without a table. The blocks of an order are the first of every higher one.
#[derive(Debug, Clone)]
pub(crate) struct Basis<const D: usize> {
    order: u8,
    exponents: Vec<[u8; D]>,
    /// For each pair (k, l), l <= k, row after row: the number of the monomial that is the product.
    products: Vec<u8>,
}

impl<const D: usize> Basis<D> {
    pub(crate) fn new(order: u8) -> Self {
        let exponents = exponents::<D>(2 * order);
        let count = terms::<D>(order);
        let mut products = Vec::with_capacity(count * (count + 1) / 2);
        for k in 0..count {
            for l in 0..=k {
                let sum: [u8; D] = std::array::from_fn(|a| exponents[k][a] + exponents[l][a]);
                let found = exponents.iter().position(|e| *e == sum).unwrap_or(0);
                products.push(found as u8);
            }
        }
        Self {
            order,
            exponents,
            products,
        }
    }

    pub(crate) fn order(&self) -> u8 {
        self.order
    }

    /// Number of monomials.
    pub(crate) fn len(&self) -> usize {
        terms::<D>(self.order)
    }

    pub(crate) fn exponents(&self) -> &[[u8; D]] {
        &self.exponents[..self.len()]
    }

    /// The number of the monomial with these exponents, if it belongs to the basis.
    pub(crate) fn number(&self, exponents: [u8; D]) -> Option<usize> {
        self.exponents().iter().position(|e| *e == exponents)
    }

    /// Numbers of the products of monomial `k` with the monomials up to itself.
    pub(crate) fn products(&self, k: usize) -> &[u8] {
        let start = k * (k + 1) / 2;
        &self.products[start..=start + k]
    }

    /// Value of monomial `k`, or of its derivative along the `axes`, at scaled offset `s`.
    pub(crate) fn derivative(&self, k: usize, axes: &[usize], s: [f64; D]) -> f64 {
        let mut exponents = self.exponents[k].map(i32::from);
        let mut value = 1.0;
        for &axis in axes {
            value *= f64::from(exponents[axis]);
            exponents[axis] -= 1;
            if exponents[axis] < 0 {
                return 0.0;
            }
        }
        for a in 0..D {
            value *= s[a].powi(exponents[a]);
        }
        value
    }
}

/// Exponents of all monomials up to `degree`, in the order of [`Basis`].
fn exponents<const D: usize>(degree: u8) -> Vec<[u8; D]> {
    let mut all = vec![[0; D]];
    for d in 1..=degree {
        let start = all.len() - block::<D>(d - 1);
        for axis in 0..D {
            for k in parents::<D>(d, axis) {
                let mut next = all[start + k];
                next[axis] += 1;
                all.push(next);
            }
        }
    }
    all
}

/// Monomials of exactly this degree.
#[inline]
const fn block<const D: usize>(degree: u8) -> usize {
    let d = degree as usize;
    if D == 2 { d + 1 } else { (d + 1) * (d + 2) / 2 }
}

/// Those monomials of the block of degree `d - 1` that `axis` multiplies to give block `d`.
#[inline]
const fn parents<const D: usize>(d: u8, axis: usize) -> Range<usize> {
    let end = block::<D>(d - 1);
    // Without x there remain d monomials of degree d - 1 in three dimensions, 1 in two.
    let start = match (D, axis) {
        (_, 0) => 0,
        (3, 1) => end - d as usize,
        _ => end - 1,
    };
    start..end
}

/// Fills `values` with `first` times each monomial up to `degree` of the offsets `s`, lane by lane.
#[inline]
pub(crate) fn monomials<const D: usize>(
    degree: u8,
    first: &Lanes,
    s: &[Lanes; D],
    values: &mut [Lanes],
) {
    values[0] = *first;
    let (mut start, mut next) = (0, 1);
    for d in 1..=degree {
        let block = next;
        for (axis, factor) in s.iter().enumerate() {
            let from = parents::<D>(d, axis);
            let (known, open) = values.split_at_mut(next);
            let known = &known[start + from.start..start + from.end];
            for (value, parent) in open[..known.len()].iter_mut().zip(known) {
                for lane in 0..LANES {
                    value[lane] = factor[lane] * parent[lane];
                }
            }
            next += known.len();
        }
        start = block;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check<const D: usize>() {
        let s = std::array::from_fn::<f64, D, _>(|a| 0.3 + 0.4 * a as f64);
        for order in 1..=HIGHEST {
            let basis = Basis::<D>::new(order);
            assert_eq!(basis.len(), terms::<D>(order));
            let mut values = [[0.0; LANES]; MOMENTS];
            monomials::<D>(
                2 * order,
                &[2.0; LANES],
                &s.map(|x| [x; LANES]),
                &mut values,
            );
            let value = |e: &[u8; D]| (0..D).map(|a| s[a].powi(i32::from(e[a]))).product::<f64>();
            for (k, e) in basis.exponents.iter().enumerate() {
                assert!((values[k][1] - 2.0 * value(e)).abs() < 1e-15);
            }
            for k in 0..basis.len() {
                for (l, &both) in basis.products(k).iter().enumerate() {
                    let product = value(&basis.exponents[k]) * value(&basis.exponents[l]);
                    assert!((value(&basis.exponents[both as usize]) - product).abs() < 1e-15);
                }
                assert!((basis.derivative(k, &[], s) - value(&basis.exponents[k])).abs() < 1e-15);
            }
        }
    }

    #[test]
    fn monomials_are_what_their_exponents_say() {
        check::<2>();
        check::<3>();
    }

    #[test]
    fn derivatives_follow_the_power_rule() {
        let basis = Basis::<3>::new(3);
        let xxy = basis.number([2, 1, 0]).unwrap();
        let s = [0.5, 0.25, 2.0];
        assert!((basis.derivative(xxy, &[0], s) - 2.0 * 0.5 * 0.25).abs() < 1e-15);
        assert!((basis.derivative(xxy, &[0, 1], s) - 2.0 * 0.5).abs() < 1e-15);
        assert!(basis.derivative(xxy, &[2], s).abs() < 1e-15);
    }
}
