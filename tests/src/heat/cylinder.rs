//! A cylinder, insulated above and below, heated evenly on its side: Rong and Kisu (2010), eq. 11,
//! after Carslaw and Jaeger (1959), p. 203. The first term is `2 q0 t / (rho c R)`, R being lost in
//! print, and alpha_n are the positive roots of J1.

use std::f64::consts::PI;

use crate::special::bessel_j;

/// The cylinder.
#[derive(Debug, Clone)]
pub struct Cylinder {
    /// R \[m\].
    pub radius: f64,
    /// k \[W/(m K)\].
    pub conductivity: f64,
    /// rho c \[J/(m3 K)\].
    pub capacity: f64,
    /// Into the cylinder \[W/m2\].
    pub flux: f64,
    /// Positive roots of J1, and J0 there.
    roots: Vec<[f64; 2]>,
}

/// Roots beyond this would need more points in the quadrature of the Bessel functions.
const ROOTS: u32 = 30;

impl Cylinder {
    /// A cylinder of `radius` \[m\], `conductivity` \[W/(m K)\], `capacity` \[J/(m3 K)\] and `flux`
    /// \[W/m2\].
    #[must_use]
    pub fn new(radius: f64, conductivity: f64, capacity: f64, flux: f64) -> Self {
        let roots = (1..=ROOTS).map(|n| {
            let root = j1_root(n);
            [root, bessel_j(0, root)]
        });
        Self {
            radius,
            conductivity,
            capacity,
            flux,
            roots: roots.collect(),
        }
    }

    /// The earliest time from which the terms left out are below 1e-14 of `q0 R / k` \[s\].
    #[must_use]
    pub fn earliest(&self) -> f64 {
        let last = self.roots[self.roots.len() - 1][0];
        32.0 * self.capacity * self.radius * self.radius / (self.conductivity * last * last)
    }

    /// The mean rise \[K\] after `time` \[s\].
    #[must_use]
    pub fn mean(&self, time: f64) -> f64 {
        2.0 * self.flux * time / (self.capacity * self.radius)
    }

    /// The rise \[K\] at `r` \[m\] and `time` \[s\].
    #[must_use]
    pub fn rise(&self, r: f64, time: f64) -> f64 {
        let s = r / self.radius;
        let fourier = self.conductivity * time / (self.capacity * self.radius * self.radius);
        let series: f64 = self
            .roots
            .iter()
            .map(|[root, j0]| {
                (-fourier * root * root).exp() * bessel_j(0, s * root) / (root * root * j0)
            })
            .sum();
        let shape = 0.5 * s * s - 0.25 - 2.0 * series;
        self.mean(time) + self.flux * self.radius / self.conductivity * shape
    }
}

/// The n-th positive root of J1, by Newton's method from McMahon's estimate (Abramowitz and Stegun
/// 1964, eq. 9.5.12).
fn j1_root(n: u32) -> f64 {
    let b = PI * (f64::from(n) + 0.25);
    let mut root = b - 3.0 / (8.0 * b);
    for _ in 0..20 {
        // J1' = J0 - J1 / x.
        let j1 = bessel_j(1, root);
        root -= j1 / (bessel_j(0, root) - j1 / root);
    }
    root
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_roots_are_those_of_the_tables() {
        // Abramowitz and Stegun (1964), table 9.5.
        for (n, wanted) in [
            (1, 3.831_705_970_207_512),
            (2, 7.015_586_669_815_619),
            (20, 63.611_356_698_481_23),
        ] {
            assert!((j1_root(n) - wanted).abs() < 1e-11, "{n}: {}", j1_root(n));
        }
    }

    #[test]
    fn it_starts_cold_and_keeps_its_equations() {
        let (radius, k, capacity, flux) = (0.7, 41.26, 900.7, 10.0);
        let cylinder = Cylinder::new(radius, k, capacity, flux);
        let scale = flux * radius / k;
        assert!(cylinder.rise(0.0, cylinder.earliest()).abs() < 1e-9 * scale);
        let (t, h) = (1.3, 1e-4);
        let edge = [0.0, 1.0, 2.0].map(|i| cylinder.rise(radius - i * h, t));
        let slope = (3.0 * edge[0] - 4.0 * edge[1] + edge[2]) / (2.0 * h);
        assert!((k * slope / flux - 1.0).abs() < 1e-5);
        let (r, h) = (0.4, 1e-3);
        let at = |r: f64, t: f64| cylinder.rise(r, t);
        let rate = (at(r, t + 1e-3) - at(r, t - 1e-3)) / 2e-3;
        let bend = (at(r + h, t) - 2.0 * at(r, t) + at(r - h, t)) / (h * h)
            + (at(r + h, t) - at(r - h, t)) / (2.0 * h * r);
        assert!((capacity * rate / (k * bend) - 1.0).abs() < 1e-5);
    }

    #[test]
    fn its_mean_is_the_heat_that_came_in() {
        let cylinder = Cylinder::new(0.7, 41.26, 900.7, 10.0);
        let n = 4000;
        let mean: f64 = (0..n)
            .map(|i| {
                let r = 0.7 * (f64::from(i) + 0.5) / f64::from(n);
                2.0 * r / 0.7 / f64::from(n) * cylinder.rise(r, 2.0)
            })
            .sum();
        assert!((mean / cylinder.mean(2.0) - 1.0).abs() < 1e-6);
    }
}
