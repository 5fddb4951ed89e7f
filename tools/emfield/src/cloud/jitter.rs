//! Random numbers that depend on seed and number alone.

/// Mixes bits (splitmix64).
pub(crate) fn mix(number: u64) -> u64 {
    let mut z = number.wrapping_add(0x9E37_79B9_7F4A_7C15);
    z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    z ^ (z >> 31)
}

/// A number between -1 and 1.
pub(crate) fn signed(seed: u64, number: u64, axis: u64) -> f64 {
    let bits = mix(mix(seed ^ 0x5851_F42D_4C95_7F2D).wrapping_add(4 * number + axis));
    (bits >> 11) as f64 * (2.0 / (1_u64 << 53) as f64) - 1.0
}
