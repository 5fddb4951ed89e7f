//! An infinite conducting cylinder in a uniform alternating field across it.

use std::f64::consts::PI;

use super::bessel::ratio_i;
use super::{C, MU0};

/// The cylinder; its axis is that of z, the field acts along y. Phasors go as `exp(j w t)`.
///
/// The potential is along z. In the field B of y alone it is `-B r cos`, with the cylinder `a I1(k r) cos` inside and
/// `(-B r + b/r) cos` outside, `k^2 = j w mu sigma` (Smythe 1950, chapter XI). A and `dA/dr / mu` are continuous: with
/// `z I1'(z) = z I0(z) - I1(z)` and `p = I1(k R)`, `a = -2 B R mu / (mu p + k R I0(k R) - p)`, mu over that of vacuum.
#[derive(Debug, Clone, Copy)]
pub struct Transverse {
    /// Radius \[m\].
    pub radius: f64,
    /// Conductivity \[S/m\].
    pub conductivity: f64,
    /// Permeability over that of vacuum, which is outside.
    pub permeability: f64,
    /// Frequency \[Hz\].
    pub frequency: f64,
    /// Flux density along y far away \[T\].
    pub flux: f64,
}

impl Transverse {
    fn omega(&self) -> f64 {
        2.0 * PI * self.frequency
    }

    fn wave_number(&self) -> C {
        C::new(
            0.0,
            self.omega() * self.conductivity * self.permeability * MU0,
        )
        .sqrt()
    }

    /// A over cos, and its derivative along r.
    fn radial(&self, r: f64) -> [C; 2] {
        let k = self.wave_number();
        let around = k * self.radius;
        let mu = self.permeability;
        let rim = ratio_i((1, around), (0, around));
        let inner = -2.0 * self.flux * self.radius * mu / (rim * mu + around - rim);
        let first = |r: f64| ratio_i((1, k * r), (0, around)) * inner;
        if r > self.radius {
            let reaction = (first(self.radius) + self.flux * self.radius) * self.radius;
            let slope = -reaction / (r * r) - self.flux;
            return [reaction / r - self.flux * r, slope];
        }
        // I1' = I0 - I1/z, which is 1/2 on the axis.
        let zeroth = ratio_i((0, k * r), (0, around)) * inner * k;
        let value = first(r);
        let slope = if r > 0.0 {
            zeroth - value / r
        } else {
            zeroth * 0.5
        };
        [value, slope]
    }

    /// Potential along z \[V s/m\].
    #[must_use]
    pub fn potential(&self, x: f64, y: f64) -> C {
        let r = x.hypot(y);
        if r > 0.0 {
            self.radial(r)[0] * (x / r)
        } else {
            C::new(0.0, 0.0)
        }
    }

    /// Flux density along x and y \[T\].
    #[must_use]
    pub fn field(&self, x: f64, y: f64) -> [C; 2] {
        let r = x.hypot(y);
        let [value, slope] = self.radial(r);
        if r == 0.0 {
            return [C::new(0.0, 0.0), -slope];
        }
        let [c, s] = [x / r, y / r];
        // B_r = dA/dphi / r, B_phi = -dA/dr.
        let [out, around] = [value * (-s / r), slope * -c];
        [out * c - around * s, out * s + around * c]
    }

    /// Current density along z \[A/m2\] inside.
    #[must_use]
    pub fn current(&self, x: f64, y: f64) -> C {
        self.potential(x, y) * C::new(0.0, -self.omega() * self.conductivity)
    }

    /// Joule heat per length \[W/m\], for an rms field: `w^2 sigma int |A|^2`, with the radial integral
    /// `int |u|^2 r dr = R Im(u' u*) / q` for `lap u = j q u` (after Lommel).
    #[must_use]
    pub fn power(&self) -> f64 {
        let [value, slope] = self.radial(self.radius);
        let integral = self.radius * (slope * value.conj()).im;
        self.omega() * PI / (MU0 * self.permeability) * integral
    }

    /// What a frequency so low that the reaction does not count would give \[W/m\]:
    /// `pi w^2 sigma B^2 R^4 / 4`.
    #[must_use]
    pub fn weak_power(&self) -> f64 {
        PI * self.omega().powi(2) * self.conductivity * self.flux.powi(2) * self.radius.powi(4)
            / 4.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn bar(frequency: f64) -> Transverse {
        Transverse {
            radius: 0.01,
            conductivity: 1e7,
            permeability: 1.0,
            frequency,
            flux: 0.02,
        }
    }

    #[test]
    fn at_low_frequency_a_permeable_bar_draws_the_field_in() {
        // B = 2 mu / (mu + 1) times that far away (Jackson 1999, section 5.11, in a plane).
        for mu in [0.5, 20.0, 1e3] {
            let b = Transverse {
                permeability: mu,
                ..bar(1e-6)
            };
            let inside = b.field(0.002, 0.003);
            let wanted = 2.0 * mu / (mu + 1.0) * b.flux;
            assert!(
                (inside[1] - wanted).norm() < 1e-6 * wanted && inside[0].norm() < 1e-6 * wanted
            );
        }
    }

    #[test]
    fn the_field_along_the_surface_is_continuous_over_the_permeability() {
        let b = Transverse {
            permeability: 50.0,
            ..bar(400.0)
        };
        let [low, high] = [1.0 - 1e-12, 1.0 + 1e-12].map(|s| b.radial(s * b.radius));
        assert!((low[0] - high[0]).norm() < 1e-9 * high[0].norm());
        assert!((low[1] / 50.0 - high[1]).norm() < 1e-9 * high[1].norm());
    }

    #[test]
    fn the_potential_diffuses_inside_and_is_harmonic_outside() {
        let b = bar(1e3);
        let h = 1e-5;
        for (x, y) in [(0.004, 0.003), (-0.007, 0.004), (0.012, 0.005)] {
            let a = |dx: f64, dy: f64| b.potential(x + dx, y + dy);
            let sum = a(h, 0.0) + a(-h, 0.0) + a(0.0, h) + a(0.0, -h) - 4.0 * a(0.0, 0.0);
            let k = b.wave_number();
            let inside = x.hypot(y) < b.radius;
            let wanted = if inside {
                k * k * a(0.0, 0.0)
            } else {
                C::new(0.0, 0.0)
            };
            let scale = (k * k * a(0.0, 0.0)).norm();
            assert!((sum / (h * h) - wanted).norm() < 1e-4 * scale, "{x} {y}");
            let [bx, by] = b.field(x, y);
            let slope = |dx: f64, dy: f64| (a(dx, dy) - a(-dx, -dy)) / (2.0 * h);
            assert!((bx - slope(0.0, h)).norm() < 1e-6 * b.flux);
            assert!((by + slope(h, 0.0)).norm() < 1e-6 * b.flux);
        }
    }

    #[test]
    fn potential_and_slope_are_continuous_and_the_field_is_uniform_far_away() {
        let b = bar(2e4);
        let [low, high] = [1.0 - 1e-12, 1.0 + 1e-12].map(|s| b.radial(s * b.radius));
        for k in 0..2 {
            assert!((low[k] - high[k]).norm() < 1e-9 * high[k].norm());
        }
        let far = b.field(3.0, 5.0);
        assert!(far[0].norm() < 1e-4 * b.flux && (far[1] - b.flux).norm() < 1e-4 * b.flux);
    }

    #[test]
    fn heat_is_that_of_the_currents() {
        for frequency in [1.0, 1e3, 1e5] {
            let b = bar(frequency);
            let count = 20_000;
            let ring = |n: u32| {
                let r = b.radius * (f64::from(n) + 0.5) / f64::from(count);
                // The mean of cos^2 is 1/2.
                PI * r * b.current(r, 0.0).norm_sqr()
            };
            let sum: f64 = (0..count).map(ring).sum();
            let heat = sum * b.radius / f64::from(count) / b.conductivity;
            assert!((heat / b.power() - 1.0).abs() < 1e-4, "{frequency}");
        }
        let weak = bar(0.1);
        assert!((weak.power() / weak.weak_power() - 1.0).abs() < 1e-4);
    }
}
