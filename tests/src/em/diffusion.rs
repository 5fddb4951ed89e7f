//! A conducting cylinder whose axial field is switched on at time 0.

use std::f64::consts::PI;

use super::MU0;

/// The cylinder. `held` is the field at its surface from time 0 on; before, there is none.
#[derive(Debug, Clone, Copy)]
pub struct Step {
    /// Radius \[m\].
    pub radius: f64,
    /// Conductivity \[S/m\].
    pub conductivity: f64,
    /// Relative permeability.
    pub permeability: f64,
    /// Field at the surface from time 0 on.
    pub held: f64,
}

impl Step {
    /// `mu sigma a^2` \[s\].
    #[must_use]
    pub fn time(&self) -> f64 {
        self.permeability * MU0 * self.conductivity * self.radius * self.radius
    }

    /// Field at radius and time, `H0 (1 - 2 sum J0(z_n r/a) exp(-z_n^2 t/T) / (z_n J1(z_n)))` over the
    /// zeros z_n of J0 (Carslaw and Jaeger 1959, section 7.6). Not for times below 1e-4 T.
    #[must_use]
    pub fn value(&self, r: f64, time: f64) -> f64 {
        let tau = time / self.time();
        let mut sum = 0.0;
        for n in 1..=400 {
            let zero = zero_j0(n);
            let decay = (-zero * zero * tau).exp();
            if decay < 1e-18 {
                break;
            }
            sum += decay * bessel_j(0, zero * r / self.radius) / (zero * bessel_j(1, zero));
        }
        self.held * (1.0 - 2.0 * sum)
    }
}

/// The n-th positive zero of J0: McMahon's expansion, sharpened by Newton's method.
fn zero_j0(n: u32) -> f64 {
    let b = (f64::from(n) - 0.25) * PI;
    let mut z = b + 1.0 / (8.0 * b) - 31.0 / (384.0 * b.powi(3));
    for _ in 0..3 {
        z += bessel_j(0, z) / bessel_j(1, z);
    }
    z
}

/// Bessel function of the first kind by the trapezoidal rule on its integral.
fn bessel_j(n: u32, x: f64) -> f64 {
    let count = 64 + x.abs() as u32;
    let sum: f64 = (0..count)
        .map(|k| {
            let t = PI * (f64::from(k) + 0.5) / f64::from(count);
            (f64::from(n) * t - x * t.sin()).cos()
        })
        .sum();
    sum / f64::from(count)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn unit() -> Step {
        Step {
            radius: 2.0,
            conductivity: 1.0 / (4.0 * MU0),
            permeability: 1.0,
            held: 3.0,
        }
    }

    #[test]
    fn zeros_agree_with_the_tables() {
        // Abramowitz and Stegun (1964), table 9.5.
        for (n, zero) in [
            (1, 2.404_825_557_7),
            (2, 5.520_078_110_3),
            (20, 62.048_469_19),
        ] {
            assert!((zero_j0(n) - zero).abs() < 1e-8, "{}", zero_j0(n));
        }
    }

    #[test]
    fn the_field_diffuses_and_ends_uniform() {
        let s = unit();
        let [r, t, h, dt] = [1.1, 0.13, 1e-3, 1e-5];
        let f = |r: f64, t: f64| s.value(r, t);
        let rate = (f(r, t + dt) - f(r, t - dt)) / (2.0 * dt);
        let second = (f(r - h, t) + f(r + h, t) - 2.0 * f(r, t)) / (h * h);
        let first = (f(r + h, t) - f(r - h, t)) / (2.0 * h);
        // lap H = mu sigma dH/dt with mu sigma = 1/4.
        assert!((second + first / r - 0.25 * rate).abs() < 1e-5);
        assert!((f(0.3, 20.0) - 3.0).abs() < 1e-12);
        assert!((f(2.0, 0.01) - 3.0).abs() < 1e-9);
    }

    #[test]
    fn early_on_the_surface_is_plane() {
        // H0 erfc(x / (2 sqrt(t / (mu sigma)))) to first order in the depth over the radius.
        let s = unit();
        let [t, depth] = [4e-5, 0.02];
        let x = depth / (2.0 * (t / 0.25_f64).sqrt());
        let plane = 3.0 * crate::special::erfc(x) * (1.0 + 0.5 * depth / 2.0);
        assert!((s.value(2.0 - depth, t) / plane - 1.0).abs() < 1e-3);
    }
}
