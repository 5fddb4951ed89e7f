//! Maxwellian moments of a cross-section over energy.
//!
//! With `x = E / kT`, E the energy of the motion of both particles relative to each other (Hirschfelder, Curtiss and Bird
//! 1954; Devoto 1967, Phys. Fluids 10, 2105):
//!
//! ```text
//! Q^(1,s) = 1/(s+1)! integral of Q_m(x kT) x^(s+1) e^-x dx from 0 to infinity,   s = 1 ... 5.
//! ```

use quadrature::SIX;

use super::FIRST_ORDERS;

/// Where the Maxwellian has died: `x^6 e^-x / 6!` is below 1e-12 of its peak.
const TAIL: f64 = 60.0;
/// No step of the quadrature is longer than this in x.
const STEP: f64 = 1.0;

/// `Q^(1,1)` to `Q^(1,5)` of `area(x)`, which may bend at `kinks` (rising values of x).
pub(super) fn moments(
    kinks: impl Iterator<Item = f64>,
    area: impl Fn(f64) -> f64,
) -> [f64; FIRST_ORDERS] {
    let mut sums = [0.0; FIRST_ORDERS];
    let mut from = 0.0;
    for to in kinks.filter(|&x| x < TAIL).chain([TAIL]) {
        let pieces = ((to - from) / STEP).ceil().max(1.0);
        let width = (to - from) / pieces;
        let mut start = from;
        // Counted in whole steps: at most 60 and one for each kink.
        while start < to - 0.5 * width {
            add(&mut sums, &area, [start, start + width]);
            start += width;
        }
        from = to;
    }
    let mut factorial = 1.0;
    for (order, sum) in (2..).zip(&mut sums) {
        factorial *= f64::from(order);
        *sum /= factorial;
    }
    sums
}

fn add(sums: &mut [f64; FIRST_ORDERS], area: &impl Fn(f64) -> f64, [from, to]: [f64; 2]) {
    let half = 0.5 * (to - from);
    for (node, weight) in SIX {
        let x = from + half * (1.0 + node);
        let mut term = half * weight * area(x) * (-x).exp() * x;
        for sum in sums.iter_mut() {
            term *= x;
            *sum += term;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// `Q = x^n` has `Q^(1,s) = (s+1+n)!/(s+1)!`.
    #[test]
    fn powers_have_their_exact_moments() {
        for n in 0..4 {
            let found = moments(std::iter::empty(), |x| x.powi(n));
            for (s, found) in (1..).zip(found) {
                let exact: f64 = (1..=n).map(|k| f64::from(s + 1 + k)).product();
                assert!(
                    (found / exact - 1.0).abs() < 1e-10,
                    "{n} {s} {found} {exact}"
                );
            }
        }
    }
}
