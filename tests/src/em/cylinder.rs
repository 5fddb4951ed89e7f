//! An infinite conducting cylinder in an axial alternating field.

use std::f64::consts::PI;

use super::bessel::{ratio_i, scaled_i};
use super::{C, MU0};

/// The cylinder. Phasors go as `exp(j w t)`.
#[derive(Debug, Clone, Copy)]
pub struct Cylinder {
    /// Radius \[m\].
    pub radius: f64,
    /// Conductivity \[S/m\].
    pub conductivity: f64,
    /// Relative permeability.
    pub permeability: f64,
    /// Frequency \[Hz\].
    pub frequency: f64,
    /// Axial field at the surface \[A/m\].
    pub field: f64,
}

impl Cylinder {
    /// `sqrt(j w sigma mu)` \[1/m\].
    #[must_use]
    pub fn wave_number(&self) -> C {
        let w = 2.0 * PI * self.frequency;
        C::new(0.0, w * self.conductivity * self.permeability * MU0).sqrt()
    }

    /// Skin depth \[m\].
    #[must_use]
    pub fn skin_depth(&self) -> f64 {
        1.0 / self.wave_number().re
    }

    /// Axial field at the radius r \[A/m\], Matsuzawa (2017), eq. 3.12.
    #[must_use]
    pub fn magnetic(&self, r: f64) -> C {
        let k = self.wave_number();
        self.field * ratio_i((0, k * r), (0, k * self.radius))
    }

    /// Current density around the axis \[A/m2\], `-dH/dr`.
    #[must_use]
    pub fn current(&self, r: f64) -> C {
        let k = self.wave_number();
        -self.field * k * ratio_i((1, k * r), (0, k * self.radius))
    }

    /// Joule heat per length \[W/m\] if `field` is an rms value, half of it if a peak value: what
    /// Poynting's vector carries in.
    #[must_use]
    pub fn power(&self) -> f64 {
        let z = self.wave_number() * self.radius;
        let slope = self.wave_number() * scaled_i(1, z) / scaled_i(0, z);
        2.0 * PI * self.radius * self.field * self.field * slope.re / self.conductivity
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn paper(frequency: f64) -> Cylinder {
        Cylinder {
            radius: 0.1,
            conductivity: 7.7e6,
            permeability: 1.0,
            frequency,
            field: 1.0,
        }
    }

    #[test]
    fn the_field_diffuses() {
        // 1/r d/dr (r dH/dr) = j w sigma mu H.
        let c = paper(60.0);
        let k = c.wave_number();
        for r in [0.02, 0.07, 0.095] {
            let h = 1e-4;
            let [a, b, d] = [c.magnetic(r - h), c.magnetic(r), c.magnetic(r + h)];
            let laplacian = (a + d - 2.0 * b) / (h * h) + (d - a) / (2.0 * h * r);
            assert!((laplacian - k * k * b).norm() < 1e-4 * (k * k * b).norm());
        }
        assert!((c.magnetic(0.1) - 1.0).norm() < 1e-14);
    }

    #[test]
    fn heat_within_is_what_flows_in() {
        for frequency in [1.0, 60.0, 400.0, 1e4] {
            let c = paper(frequency);
            let count = 20_000;
            let mut sum = 0.0;
            for k in 0..count {
                let r = 0.1 * (f64::from(k) + 0.5) / f64::from(count);
                sum += c.current(r).norm_sqr() * r;
            }
            let heat = sum * 2.0 * PI * 0.1 / f64::from(count) / c.conductivity;
            assert!((heat / c.power() - 1.0).abs() < 1e-4, "{frequency}");
        }
    }

    #[test]
    fn no_frequency_is_too_high() {
        let c = paper(1e9);
        assert!(c.magnetic(0.05).norm() == 0.0);
        assert!((c.magnetic(0.1 - c.skin_depth()).norm() - (-1.0_f64).exp()).abs() < 1e-4);
    }
}
