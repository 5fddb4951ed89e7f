//! Tait's equation of state.

use schemars::JsonSchema;
use serde::Deserialize;

/// What water does below its density at rest.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Tension {
    /// It parts and has no pressure.
    #[default]
    None,
    /// It pulls, as far as the equation of state goes.
    Full,
}

/// p = B ((rho/rho0)^n - 1).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tait {
    /// rho0 \[kg/m3\].
    pub density: f64,
    /// c at rest \[m/s\].
    pub sound_speed: f64,
    /// n.
    pub exponent: f64,
    /// Below rho0.
    pub tension: Tension,
}

impl Tait {
    /// B = c^2 rho0/n \[Pa\] (17).
    #[inline(always)]
    #[must_use]
    pub fn stiffness(&self) -> f64 {
        self.sound_speed * self.sound_speed * self.density / self.exponent
    }

    #[inline(always)]
    fn parted(&self, density: f64) -> bool {
        self.tension == Tension::None && density < self.density
    }

    /// The density by which its mass fills room: that at rest where it has parted. Drops that fly apart do not grow, and
    /// since they have no pressure, what pressure works is what densities store all the same.
    #[inline(always)]
    #[must_use]
    pub fn filling(&self, density: f64) -> f64 {
        if self.parted(density) {
            self.density
        } else {
            density
        }
    }

    /// p \[Pa\] (15).
    #[inline(always)]
    #[must_use]
    pub fn pressure(&self, density: f64) -> f64 {
        if self.parted(density) {
            return 0.0;
        }
        self.stiffness() * ((density / self.density).powf(self.exponent) - 1.0)
    }

    /// The density at a pressure \[Pa\], rho0 below 0 where water does not pull.
    #[must_use]
    pub fn density_at(&self, pressure: f64) -> f64 {
        let pressure = if self.tension == Tension::None {
            pressure.max(0.0)
        } else {
            pressure
        };
        self.density * (1.0 + pressure / self.stiffness()).powf(1.0 / self.exponent)
    }

    /// Energy that a kilogram stores \[J/kg\]: the integral of p/rho^2 from rest.
    #[must_use]
    pub fn energy(&self, density: f64) -> f64 {
        if self.parted(density) {
            return 0.0;
        }
        let (x, n) = (density / self.density, self.exponent);
        let whole = (x.powf(n - 1.0) - 1.0) / (n - 1.0) + (1.0 - x) / x;
        self.stiffness() / self.density * whole
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const WATER: Tait = Tait {
        density: 1000.0,
        sound_speed: 50.0,
        exponent: 7.0,
        tension: Tension::Full,
    };

    #[test]
    fn sound_is_as_fast_as_it_says() {
        let slope = (WATER.pressure(1000.01) - WATER.pressure(999.99)) / 0.02;
        assert!((slope.sqrt() / 50.0 - 1.0).abs() < 1e-6);
    }

    #[test]
    fn energy_is_the_work_of_pressure() {
        for density in [980.0, 1005.0, 1100.0] {
            let slope = (WATER.energy(density + 0.1) - WATER.energy(density - 0.1)) / 0.2;
            let exact = WATER.pressure(density) / (density * density);
            assert!((slope / exact - 1.0).abs() < 1e-5, "{slope} {exact}");
            assert!((WATER.density_at(WATER.pressure(density)) / density - 1.0).abs() < 1e-12);
        }
    }

    #[test]
    fn parted_water_has_no_pressure_and_stores_nothing() {
        let water = Tait {
            tension: Tension::None,
            ..WATER
        };
        assert!(water.pressure(990.0).abs() + water.energy(990.0).abs() <= 0.0);
        assert!(water.pressure(1001.0) > 0.0);
    }
}
