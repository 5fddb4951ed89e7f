//! Sweeps over particles in gather form: each particle takes from others and writes only its own value, and sums are
//! taken over chunks of a fixed size, so that the bits do not depend on the number of threads.

use std::cmp::{Ordering, Reverse};

use rayon::prelude::*;

/// Particles per unit of parallel work where each takes little, and per partial sum.
pub const GRAIN: usize = 256;

/// Gives every particle its value.
pub fn fill<T: Send>(values: &mut [T], value: impl Fn(usize) -> T + Sync) {
    let each = values.par_iter_mut().with_min_len(GRAIN).enumerate();
    each.for_each(|(a, own)| *own = value(a));
}

/// Changes the value of every particle.
pub fn change<T: Send>(values: &mut [T], change: impl Fn(usize, &mut T) + Sync) {
    let each = values.par_iter_mut().with_min_len(GRAIN).enumerate();
    each.for_each(|(a, own)| change(a, own));
}

/// Sum over `n` particles of `N` numbers each.
#[must_use]
pub fn sum<const N: usize>(n: usize, term: impl Fn(usize) -> [f64; N] + Sync) -> [f64; N] {
    let chunks = n.div_ceil(GRAIN);
    let part = |chunk: usize| {
        let mut sum = [0.0; N];
        for a in chunk * GRAIN..n.min((chunk + 1) * GRAIN) {
            let term = term(a);
            (0..N).for_each(|k| sum[k] += term[k]);
        }
        sum
    };
    let parts: Vec<[f64; N]> = (0..chunks).into_par_iter().map(part).collect();
    parts.iter().fold([0.0; N], |mut sum, part| {
        (0..N).for_each(|k| sum[k] += part[k]);
        sum
    })
}

/// Greatest of `n` numbers and the particle that has it; one that is no number counts as the greatest. None of none.
#[must_use]
pub fn greatest(n: usize, value: impl Fn(usize) -> f64 + Sync) -> Option<(usize, f64)> {
    let greater = |a: (usize, f64), b: (usize, f64)| {
        // Of two alike the first.
        let rank = |(place, value): (usize, f64)| {
            (
                value.is_nan(),
                if value.is_nan() { 0.0 } else { value },
                Reverse(place),
            )
        };
        let less = rank(a).partial_cmp(&rank(b)) == Some(Ordering::Less);
        if less { b } else { a }
    };
    let all = (0..n).into_par_iter().with_min_len(GRAIN);
    all.map(|a| (a, value(a))).reduce_with(greater)
}

/// Work in the widest vectors that the machine has. No operation is fused or reordered for it.
#[inline(always)]
pub fn wide(work: impl FnMut()) {
    pulp::Arch::new().dispatch(Wide(work));
}

struct Wide<W>(W);

impl<W: FnMut()> pulp::NullaryFnOnce for Wide<W> {
    type Output = ();

    #[inline(always)]
    fn call(mut self) {
        (self.0)();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn on_threads<T: Send>(threads: usize, work: impl Fn() -> T + Send + Sync) -> T {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
        pool.build().unwrap().install(work)
    }

    #[test]
    fn sums_have_the_same_bits_on_any_number_of_threads() {
        let term = |a: usize| [1.0 / (1.0 + a as f64), (a as f64).sin()];
        let one = on_threads(1, || sum(5000, term));
        for threads in 2..6 {
            let other = on_threads(threads, || sum(5000, term));
            assert_eq!(one.map(f64::to_bits), other.map(f64::to_bits));
        }
    }

    #[test]
    fn the_greatest_is_found_and_what_is_no_number_is_greater() {
        assert_eq!(greatest(0, |_| 0.0), None);
        let values = [1.0, 7.0, -2.0, 7.0];
        assert_eq!(greatest(4, |a| values[a]), Some((1, 7.0)));
        let (place, found) = greatest(4, |a| if a == 2 { f64::NAN } else { values[a] }).unwrap();
        assert!(place == 2 && found.is_nan());
    }
}
