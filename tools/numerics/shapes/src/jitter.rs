//! Numbers that look like chance and are always the same: what shakes places.
//!
//! Output `k` of the generator splitmix64 depends on its seed and on `k` alone (Steele, Lea and Flood 2014), so that points may be
//! shaken in any order.

/// What the state of the generator grows by from output to output: 2^64 over the golden ratio.
const STEP: u64 = 0x9E37_79B9_7F4A_7C15;

/// Output number `number` from `seed`.
#[must_use]
pub fn bits(seed: u64, number: u64) -> u64 {
    let mut z = seed.wrapping_add(number.wrapping_add(1).wrapping_mul(STEP));
    z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    z ^ (z >> 31)
}

/// The same as a number from -1 to 1, 1 excluded.
///
/// ```
/// let shaken = |x: f64, number: u64| x + 0.1 * shapes::jitter::signed(7, number);
/// assert!((shaken(1.0, 3) - 1.0).abs() <= 0.1 && shaken(1.0, 3) != shaken(1.0, 4));
/// ```
#[must_use]
pub fn signed(seed: u64, number: u64) -> f64 {
    (bits(seed, number) >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_outputs_are_those_of_the_published_generator() {
        let first = [0, 1, 2].map(|k| bits(0, k));
        assert_eq!(
            first,
            [
                0xE220_A839_7B1D_CDAF,
                0x6E78_9E6A_A1B9_65F4,
                0x06C4_5D18_8009_454F
            ]
        );
        // One output later from one step less is the same state.
        assert_eq!(bits(STEP, 4), bits(0, 5));
    }

    /// Mean 0 and variance 1/3, each within four standard errors of 100,000 numbers.
    #[test]
    fn numbers_are_even_between_their_ends() {
        let all = (0..100_000).map(|k| signed(3, k));
        assert!(all.clone().all(|x| (-1.0..1.0).contains(&x)));
        let [sum, square] = all.fold([0.0; 2], |[s, q], x| [s + x, q + x * x]);
        let (mean, variance) = (sum / 1e5, square / 1e5);
        assert!(mean.abs() < 4.0 * (1.0_f64 / 3e5).sqrt(), "{mean}");
        assert!(
            (variance - 1.0 / 3.0).abs() < 4.0 * (4.0_f64 / 45e5).sqrt(),
            "{variance}"
        );
    }
}
