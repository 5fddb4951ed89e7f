//! A conducting sphere around which a uniform field is switched on at time 0, or rises from then on.

use std::f64::consts::PI;

use super::MU0;

/// The sphere; its centre is the origin, the field acts along z from time 0 on; before, there is none.
///
/// The potential around z is `sin(theta) f(r, t)`; outside, `f = B r/2 + b(t)/r^2`, so that `f' + 2 f/r` is `3 B/2` on
/// the surface, where f and f' are continuous. What differs from the final state `f = B r/2` falls in modes
/// `j1(k r) exp(-k^2 t/(mu sigma))` with `j1' + 2 j1/(k r) = j0`, so that `j0(k R) = 0`, `k = n pi/R` (as free decay in
/// Landau and Lifshitz 1960, section 45). With `int_0^R r^3 j1 dr = 3 R^3 j1(n pi)/(k^2 R)` and the norm
/// `R^3 j1(n pi)^2 / 2`, nothing at time 0 asks for
/// `f = B/2 (r - sum 6 R (-1)^(n+1)/(n pi) j1(n pi r/R) exp(-n^2 pi^2 t/T))`, `T = mu sigma R^2`.
///
/// A field that rises as `1 - exp(-t/s)` is switched on bit by bit (Duhamel): `exp(-k t)` becomes
/// `(exp(-t/s) - exp(-k t))/(k s - 1)`, and r in front of the sum is multiplied by the wave.
#[derive(Debug, Clone, Copy)]
pub struct Switched {
    /// Radius \[m\].
    pub radius: f64,
    /// Conductivity \[S/m\].
    pub conductivity: f64,
    /// Flux density along z far away from time 0 on, or in the end \[T\].
    pub flux: f64,
    /// Time s in which it rises \[s\]; at once where there is none.
    pub rise: Option<f64>,
}

impl Switched {
    /// `mu sigma R^2` \[s\].
    #[must_use]
    pub fn time(&self) -> f64 {
        MU0 * self.conductivity * self.radius * self.radius
    }

    /// What the applied field is multiplied by, and its rate \[1/s\].
    #[must_use]
    pub fn wave(&self, time: f64) -> [f64; 2] {
        match self.rise {
            None => [1.0, 0.0],
            Some(s) => [-(-time / s).exp_m1(), (-time / s).exp() / s],
        }
    }

    /// What is left of a mode that decays at a rate \[1/s\], and the rate of that \[1/s\].
    fn left(&self, rate: f64, time: f64) -> [f64; 2] {
        let decay = (-rate * time).exp();
        match self.rise {
            None => [decay, -rate * decay],
            Some(s) => {
                let (rest, over) = ((-time / s).exp(), rate * s - 1.0);
                [(rest - decay) / over, (rate * decay - rest / s) / over]
            }
        }
    }

    /// f, df/dr and df/dt over B/2. Not for times below 1e-4 T.
    fn radial(&self, r: f64, time: f64) -> [f64; 3] {
        let [wave, rate] = self.wave(time);
        if r > self.radius {
            let [value, _, change] = self.radial(self.radius, time);
            let reaction = (value - self.radius * wave) * self.radius.powi(2);
            let moved = (change - self.radius * rate) * self.radius.powi(2);
            let square = r * r;
            return [
                r * wave + reaction / square,
                wave - 2.0 * reaction / r.powi(3),
                r * rate + moved / square,
            ];
        }
        let [mut value, mut slope, mut change] = [r * wave, wave, r * rate];
        let mut sign = 1.0;
        for n in 1..=400 {
            let zero = f64::from(n) * PI;
            let decay = zero * zero / self.time();
            if self.rise.is_none() && (-decay * time).exp() < 1e-18 {
                break;
            }
            let [left, rate] = self.left(decay, time);
            let [j, rise] = spherical(zero * r / self.radius);
            let share = 6.0 * self.radius * sign / zero;
            value -= share * left * j;
            slope -= share * left * rise * zero / self.radius;
            change -= share * rate * j;
            sign = -sign;
        }
        [value, slope, change]
    }

    /// Current density around the axis in the sphere \[A/m2\].
    #[must_use]
    pub fn current(&self, rho: f64, z: f64, time: f64) -> f64 {
        let r = rho.hypot(z).max(f64::MIN_POSITIVE);
        -0.5 * self.conductivity * self.flux * self.radial(r, time)[2] * rho / r
    }

    /// Potential around the axis \[V s/m\] at the distance `rho` from it and the height z.
    #[must_use]
    pub fn potential(&self, rho: f64, z: f64, time: f64) -> f64 {
        let r = rho.hypot(z).max(f64::MIN_POSITIVE);
        0.5 * self.flux * self.radial(r, time)[0] * rho / r
    }

    /// Flux density away from and along the axis \[T\].
    #[must_use]
    pub fn field(&self, rho: f64, z: f64, time: f64) -> [f64; 2] {
        let r = rho.hypot(z);
        if r < 1e-9 * self.radius {
            return [0.0, self.flux * self.radial(r, time)[1]];
        }
        let [sine, cosine] = [rho / r, z / r];
        let [value, slope, _] = self.radial(r, time);
        // B_r = 2 cos f/r, B_theta = -sin (f' + f/r).
        let outward = self.flux * cosine * value / r;
        let polar = -0.5 * self.flux * sine * (slope + value / r);
        [
            outward * sine + polar * cosine,
            outward * cosine - polar * sine,
        ]
    }
}

/// `j1` and its derivative.
fn spherical(x: f64) -> [f64; 2] {
    if x < 1e-2 {
        let s = x * x;
        return [
            x / 3.0 * (1.0 - s / 10.0 * (1.0 - s / 28.0)),
            (1.0 - 0.3 * s * (1.0 - 5.0 / 84.0 * s)) / 3.0,
        ];
    }
    let j = (x.sin() / x - x.cos()) / x;
    [j, x.sin() / x - 2.0 * j / x]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn unit() -> Switched {
        Switched {
            radius: 2.0,
            conductivity: 1.0 / (4.0 * MU0),
            flux: 3.0,
            rise: None,
        }
    }

    fn rising() -> Switched {
        Switched {
            rise: Some(0.05),
            ..unit()
        }
    }

    #[test]
    fn functions_join_where_the_series_ends() {
        for x in [1e-2, 3e-3] {
            let [j, rise] = spherical(x);
            let h = 1e-4;
            let both = [spherical(x + h)[0], spherical(x - h)[0]];
            assert!((rise - (both[0] - both[1]) / (2.0 * h)).abs() < 1e-8);
            assert!((j - x / 3.0 + x.powi(3) / 30.0).abs() < 1e-12);
        }
        // Abramowitz and Stegun (1964), table 10.1: j1(1).
        assert!((spherical(1.0)[0] - 0.301_168_678_939_757).abs() < 1e-14);
    }

    #[test]
    fn the_potential_diffuses_and_drives_the_current() {
        for s in [unit(), rising()] {
            let (rho, z, t) = (1.1, 0.6, 0.13);
            let [h, dt] = [1e-3, 1e-5];
            let f = |rho: f64, z: f64, t: f64| s.potential(rho, z, t);
            let rate = (f(rho, z, t + dt) - f(rho, z, t - dt)) / (2.0 * dt);
            let own = f(rho, z, t);
            let [up, down] = [f(rho + h, z, t), f(rho - h, z, t)];
            let around = f(rho, z + h, t) + f(rho, z - h, t);
            let laplacian = (up + down + around - 4.0 * own) / (h * h)
                + (up - down) / (2.0 * h * rho)
                - own / (rho * rho);
            // lap A = mu sigma dA/dt with mu sigma = 1/4.
            assert!((laplacian - 0.25 * rate).abs() < 1e-5, "{laplacian} {rate}");
            let current = s.current(rho, z, t) / s.conductivity;
            assert!(
                (current + rate).abs() < 1e-6 * rate.abs(),
                "{current} {rate}"
            );
        }
    }

    #[test]
    fn what_rises_in_no_time_is_switched_on() {
        let fast = Switched {
            rise: Some(1e-7),
            ..unit()
        };
        let [a, b] = [unit(), fast].map(|s| s.potential(1.2, 0.4, 0.2));
        assert!((a / b - 1.0).abs() < 1e-5, "{a} {b}");
        let [a, b] = [unit(), fast].map(|s| s.current(1.2, 0.4, 0.2));
        assert!((a / b - 1.0).abs() < 1e-5, "{a} {b}");
    }

    #[test]
    fn the_flux_is_the_curl_and_ends_uniform() {
        let s = unit();
        let h = 1e-5;
        for (rho, z) in [(0.7, 0.9), (1.9, -1.4)] {
            let f = |rho: f64, z: f64| s.potential(rho, z, 0.2);
            let [away, along] = s.field(rho, z, 0.2);
            assert!((away + (f(rho, z + h) - f(rho, z - h)) / (2.0 * h)).abs() < 1e-7);
            let turn = |rho: f64| rho * f(rho, z);
            let exact = (turn(rho + h) - turn(rho - h)) / (2.0 * h * rho);
            assert!((along - exact).abs() < 1e-7);
        }
        let [middle, beside] = [0.0, 1e-6].map(|z| s.field(0.0, z, 0.2)[1]);
        assert!((middle / beside - 1.0).abs() < 1e-9);
        let end = s.field(0.3, 0.4, 30.0);
        assert!(end[0].abs() < 1e-12 && (end[1] - 3.0).abs() < 1e-12);
    }

    #[test]
    fn at_first_the_sphere_keeps_the_field_out() {
        let s = unit();
        // The dipole of a sphere without resistance: f = B/2 (r - R^3/r^2).
        let early = s.potential(3.0, 0.0, 1e-4);
        let perfect = 1.5 * (3.0 - 8.0 / 9.0);
        assert!((early / perfect - 1.0).abs() < 0.03);
        assert!(s.potential(0.5, 0.3, 1e-3).abs() < 1e-9);
    }
}
