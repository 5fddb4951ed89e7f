//! Round bars that carry a net current, and pairs of bars in a weak field across them.
//!
//! - One bar, with `k^2 = j w mu0 sigma`: `J = k I / (2 pi R) I_0(k r) / I_1(k R)`, and inside
//!   `Z = E(R) / I = k / (2 pi R sigma) I_0(k R) / I_1(k R)`, its resistance and internal inductance per length (Smythe 1950,
//!   chapter XI).
//! - A field B along y that is too slow for currents to change it drives `J = -j w sigma B (x_0 - x)`, about the middle `x_0` of
//!   each bar where nothing joins it to others, about that of all where their ends are joined.

use std::f64::consts::{PI, TAU};

use super::bessel::ratio_i;
use super::{C, MU0};

/// One bar.
#[derive(Debug, Clone, Copy)]
pub struct Bar {
    /// \[m\]
    pub radius: f64,
    /// \[S/m\]
    pub conductivity: f64,
    /// \[Hz\]
    pub frequency: f64,
    /// Net current, rms \[A\].
    pub current: f64,
}

impl Bar {
    fn wave(&self) -> C {
        C::new(0.0, TAU * self.frequency * MU0 * self.conductivity).sqrt()
    }

    /// Current density at a distance from the middle \[A/m2\].
    #[must_use]
    pub fn density(&self, r: f64) -> C {
        let k = self.wave();
        let share = ratio_i((0, k * r), (1, k * self.radius));
        k * share * (self.current / (TAU * self.radius))
    }

    /// Internal impedance per length \[Ohm/m\].
    #[must_use]
    pub fn impedance(&self) -> C {
        self.density(self.radius) / (self.conductivity * self.current)
    }

    /// Reactance per length of the field from the surface to a distance \[Ohm/m\].
    #[must_use]
    pub fn outside(&self, distance: f64) -> C {
        C::new(0.0, self.frequency * MU0 * (distance / self.radius).ln())
    }
}

/// Heat of bars in a weak field across the line of their middles \[W/m\]; `lever` is the sum of the squares of their
/// distances from where no current flows over their number.
#[must_use]
pub fn weak_heat(bar: &Bar, flux: f64, number: f64, lever: f64) -> f64 {
    let rate = TAU * bar.frequency * flux;
    let section = PI * bar.radius.powi(2);
    number * bar.conductivity * rate.powi(2) * section * (0.25 * bar.radius.powi(2) + lever)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The density adds up to the current, and is even where the current is slow.
    #[test]
    fn the_density_adds_up() {
        for frequency in [1e-3, 2000.0] {
            let bar = Bar {
                radius: 0.01,
                conductivity: 1e7,
                frequency,
                current: 100.0,
            };
            let steps = 20_000;
            let ring = |n: i32| {
                let r = bar.radius * (f64::from(n) + 0.5) / f64::from(steps);
                bar.density(r) * (TAU * r * bar.radius / f64::from(steps))
            };
            let sum: C = (0..steps).map(ring).sum();
            assert!((sum - 100.0).norm() < 1e-5, "{sum}");
        }
    }
}
