//! Modified Bessel functions of the first kind for arguments of positive real part, without
//! overflow: ratios, and values scaled by `exp(-z)`.

use std::f64::consts::PI;

use super::C;

/// `exp(-z) I_n(z)`, by the trapezoidal rule on `1/pi int_0^pi exp(z cos t) cos(n t) dt`, which
/// converges faster than any power.
#[must_use]
pub fn scaled_i(n: u32, z: C) -> C {
    let count = 96 + z.norm() as u32 + 4 * n;
    let mut sum = C::new(0.0, 0.0);
    for k in 0..count {
        let t = PI * (f64::from(k) + 0.5) / f64::from(count);
        // cos t - 1 without cancellation.
        let below = -2.0 * (0.5 * t).sin().powi(2);
        sum += (z * below).exp() * (f64::from(n) * t).cos();
    }
    sum / f64::from(count)
}

/// `I_n(u) / I_m(z)` for real parts of u at most those of z.
#[must_use]
pub fn ratio_i(upper: (u32, C), lower: (u32, C)) -> C {
    let [(n, u), (m, z)] = [upper, lower];
    scaled_i(n, u) / scaled_i(m, z) * (u - z).exp()
}

/// `i_n(z) / i_{n-1}(z)` of the modified spherical Bessel functions, for n from 1 to `count` at the
/// places 0 to `count - 1`: the continued fraction of Abramowitz and Stegun (1964), eq. 10.2.18,
/// from below.
#[must_use]
pub fn spherical_ratios(count: usize, z: C) -> Vec<C> {
    let start = count + 20 + (2.0 * z.norm()) as usize;
    let mut ratio = C::new(0.0, 0.0);
    let mut found = vec![ratio; count];
    for n in (1..=start).rev() {
        ratio = z / (C::new(2.0 * n as f64 + 1.0, 0.0) + z * ratio);
        if n <= count {
            found[n - 1] = ratio;
        }
    }
    found
}

/// `exp(-z) i_0(z) = (1 - exp(-2 z)) / (2 z)`.
#[must_use]
pub fn scaled_i0_spherical(z: C) -> C {
    if z.norm() < 1e-2 {
        // sinh(z) / z, of which four terms are exact here.
        let s = z * z;
        let series = C::new(1.0, 0.0) + s / 6.0 * (1.0 + s / 20.0 * (1.0 + s / 42.0));
        return series * (-z).exp();
    }
    (C::new(1.0, 0.0) - (-2.0 * z).exp()) / (2.0 * z)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn close(a: C, b: C, tolerance: f64) {
        assert!((a - b).norm() <= tolerance * b.norm(), "{a} and {b}");
    }

    /// Matsuzawa (2017), eq. 3.13.
    fn series(n: u32, z: C) -> C {
        let mut term = C::new(1.0, 0.0);
        for k in 1..=n {
            term *= z / (2.0 * f64::from(k));
        }
        let mut sum = term;
        for m in 1..80_u32 {
            term *= z * z / (4.0 * f64::from(m) * f64::from(m + n));
            sum += term;
        }
        sum
    }

    #[test]
    fn the_integral_agrees_with_the_series() {
        for z in [C::new(0.3, 0.3), C::new(2.0, 1.0), C::new(6.0, 6.0)] {
            for n in 0..3 {
                close(scaled_i(n, z), series(n, z) * (-z).exp(), 1e-12);
            }
        }
    }

    #[test]
    fn large_arguments_agree_with_the_asymptotic_series() {
        let z = C::new(700.0, 700.0);
        let far = (2.0 * PI * z).sqrt().inv() * (1.0 + (1.0 / 8.0) / z + (9.0 / 128.0) / (z * z));
        close(scaled_i(0, z), far, 1e-9);
    }

    #[test]
    fn spherical_ratios_agree_with_the_closed_forms() {
        for z in [C::new(0.2, 0.2), C::new(5.0, 5.0), C::new(300.0, 300.0)] {
            let r = spherical_ratios(3, z);
            // i_1 / i_0 = coth z - 1/z.
            let e = (-2.0 * z).exp();
            let first = (1.0 + e) / (1.0 - e) - 1.0 / z;
            close(r[0], first, 1e-11);
            // i_2 = i_0 - 3/z i_1.
            close(r[0] * r[1], 1.0 - 3.0 / z * r[0], 1e-9);
        }
    }

    #[test]
    fn the_first_is_smooth_across_its_forms() {
        let [a, b] = [C::new(0.00707, 0.00707), C::new(0.007_08, 0.007_08)];
        let step = scaled_i0_spherical(b) - scaled_i0_spherical(a);
        close(step, -(b - a), 2e-2);
    }
}
