//! Metal that evaporates into a gas which may already hold its vapour (Komen 2019, eq. 5.24).
//!
//! Between the metal at `T` and the middle of the gas cell, iron passes two resistances in series. At
//! the surface, where the gas is as warm as the metal, Hertz and Knudsen's law lets through
//!
//! ```text
//! J = sqrt(M / (2 pi R T)) (p0(T) - x_s p)
//! ```
//!
//! with the saturation pressure p0 and the partial pressure `x_s p` of the vapour at the surface; the
//! gas between the surface and the cell's middle, with `g = rho D / distance` at film temperature, lets through
//!
//! ```text
//! J = g ln((1 - Y_P) / (1 - Y_s))   where the vapour adds to the gas (Stefan 1873),
//! J = g (Y_s - Y_P)                 where it takes the place of as much gas.
//! ```
//!
//! `Y_s` is the one at which both agree; it lies between `Y_P` and saturation, so that no surface gives off
//! vapour beyond saturation, and a surface below the saturation of its gas takes vapour back.
//!
//! The print divides the partial pressure by the root of the temperature `T_g` of the gas nearby. With
//! `c = sqrt(T / T_g)`
//!
//! ```text
//! J = sqrt(M / (2 pi R T)) (p0(T) - c x_s p),
//! ```
//!
//! which is the law above with `p0` over c and the factor in front times c: gas then holds vapour back only at
//! `1 / c` times the saturation pressure. Either can be chosen; `c = 1` where vapour comes back as warm as the metal.
//!
//! Vapour that takes the place of as much gas can do so up to `Y_s = 1`. A metal that boils gives off more,
//! `J = sqrt(M / (2 pi R T)) (p0 - c p)`, which blows gas and vapour away; where that flow is left out, the gas
//! takes up `g (1 - Y_P)` of it, and the rest is lost or, where it is vented, leaves with its latent heat.

use std::f64::consts::{LN_10, TAU};

use crate::mixture::Molar;

/// Molar gas constant \[J/(mol K)\].
const MOLAR_GAS: f64 = 8.314_462_618;
/// Standard atmosphere \[Pa\].
const ATMOSPHERE: f64 = 101_325.0;
/// Halvings that leave nothing but rounding.
const HALVINGS: usize = 200;
/// Difference from equilibrium below which the flux is linear in it.
const NEAR: f64 = 1e-7;

/// A metal that evaporates.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Evaporating {
    /// `ln(p0 / Pa) = a - b / T`: a.
    pub a: f64,
    /// b \[K\].
    pub b: f64,
    /// Latent heat \[J/kg\].
    pub latent_heat: f64,
    /// Molar mass \[kg/mol\].
    pub molar_mass: f64,
}

/// The gas between a surface and the middle of its cell.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Film {
    /// Mass fraction of iron in the cell.
    pub iron: f64,
    /// Diffusive conductance `rho D / distance` \[kg/(m2 s)\].
    pub conductance: f64,
    /// Pressure \[Pa\].
    pub pressure: f64,
    /// Molar masses.
    pub molar: Molar,
    /// Whether the vapour adds to the gas.
    pub adds: bool,
    /// Whether a metal that boils vents what the gas cannot take.
    pub vents: bool,
    /// Temperature at which vapour comes back \[K\]; absent: that of the metal.
    pub returning: Option<f64>,
}

/// Vapour that passes a surface.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Evaporated {
    /// Mass flux off the metal into the gas \[kg/(m2 s)\]; negative where vapour condenses.
    pub flux: f64,
    /// Mass flux off the metal that the gas cannot take \[kg/(m2 s)\].
    pub vented: f64,
    /// Mass fraction of iron at the surface.
    pub surface: f64,
    /// Mass fraction of iron in the cell at which no more iron gathers there.
    pub equilibrium: f64,
    /// What gathers in the cell over the distance of its fraction from equilibrium \[kg/(m2 s)\], never
    /// negative.
    pub coefficient: f64,
}

impl Evaporating {
    /// Saturation pressure by Clausius and Clapeyron from the boiling point at 1 atm.
    #[must_use]
    pub fn boiling(boiling: f64, latent_heat: f64, molar_mass: f64) -> Self {
        let b = latent_heat * molar_mass / MOLAR_GAS;
        Self {
            a: ATMOSPHERE.ln() + b / boiling,
            b,
            latent_heat,
            molar_mass,
        }
    }

    /// Saturation pressure `log10(p0/atm) = a - b/T`.
    #[must_use]
    pub fn decimal(a: f64, b: f64, latent_heat: f64, molar_mass: f64) -> Self {
        Self {
            a: ATMOSPHERE.ln() + a * LN_10,
            b: b * LN_10,
            latent_heat,
            molar_mass,
        }
    }

    /// Saturation pressure at `t` \[Pa\].
    #[must_use]
    pub fn saturation(&self, t: f64) -> f64 {
        (self.a - self.b / t).exp()
    }

    /// Hertz and Knudsen's factor of a pressure \[s/m\].
    #[must_use]
    pub fn knudsen(&self, t: f64) -> f64 {
        (self.molar_mass / (TAU * MOLAR_GAS * t)).sqrt()
    }

    /// What passes the surface at `t` \[K\] into or out of `film`.
    #[must_use]
    pub fn pass(&self, t: f64, film: Film) -> Evaporated {
        let comes_back = film.returning.map_or(1.0, |own| (t / own).sqrt());
        let kinetic = self.knudsen(t) * film.pressure * comes_back;
        let wanted = self.saturation(t) / film.pressure / comes_back;
        let boils = wanted >= 1.0;
        let equilibrium = if boils { 1.0 } else { film.molar.mass(wanted) };
        let surface = film.surface(kinetic, wanted, equilibrium);
        let by_gas = film.diffused(surface);
        let by_surface = kinetic * (wanted - film.molar.mole(surface));
        // The side that rounding of the fraction at the surface moves less tells the flux.
        let slope = kinetic * film.molar.mole_slope(surface);
        let held_back = boils && !film.adds && surface >= 1.0;
        let share = if film.adds { 1.0 - surface } else { 1.0 };
        let flux = if slope * share < film.conductance && !held_back {
            by_surface
        } else {
            by_gas
        };
        let part = if film.adds { 1.0 - film.iron } else { 1.0 };
        let distance = equilibrium - film.iron;
        let coefficient = if boils && film.adds {
            flux.max(0.0)
        } else if distance.abs() < NEAR {
            let gas = film.conductance;
            part * slope * gas / (slope * part + gas)
        } else {
            (flux * part / distance).max(0.0)
        };
        let excess = if film.vents && held_back {
            (by_surface - by_gas).max(0.0)
        } else {
            0.0
        };
        Evaporated {
            flux,
            vented: excess,
            surface,
            equilibrium,
            coefficient,
        }
    }
}

impl Evaporated {
    /// Mass flux off the metal in all \[kg/(m2 s)\].
    #[must_use]
    pub fn off(&self) -> f64 {
        self.flux + self.vented
    }
}

impl Film {
    /// Flux through the gas where the surface holds the fraction `surface`.
    fn diffused(&self, surface: f64) -> f64 {
        if self.adds {
            // ln((1 - Y_P)/(1 - Y_s)), exact also for small differences.
            let excess = (surface - self.iron) / (1.0 - surface).max(f64::MIN_POSITIVE);
            self.conductance * excess.ln_1p()
        } else {
            self.conductance * (surface - self.iron)
        }
    }

    /// The fraction at the surface at which gas and surface let through as much.
    fn surface(&self, kinetic: f64, wanted: f64, equilibrium: f64) -> f64 {
        let lacks = |y: f64| kinetic * (wanted - self.molar.mole(y)) - self.diffused(y);
        let (mut low, mut high) = (self.iron.min(equilibrium), self.iron.max(equilibrium));
        if lacks(high) >= 0.0 {
            return high;
        }
        for _ in 0..HALVINGS {
            let middle = 0.5 * (low + high);
            if middle <= low || middle >= high {
                break;
            }
            if lacks(middle) > 0.0 {
                low = middle;
            } else {
                high = middle;
            }
        }
        0.5 * (low + high)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const IRON: f64 = 0.055_845;

    fn iron() -> Evaporating {
        Evaporating::decimal(6.347, 19_574.0, 6.1e6, IRON)
    }

    fn film(iron: f64, conductance: f64, adds: bool) -> Film {
        Film {
            iron,
            conductance,
            pressure: ATMOSPHERE,
            molar: Molar {
                gas: 0.028_01,
                iron: IRON,
            },
            adds,
            vents: false,
            returning: None,
        }
    }

    #[test]
    fn a_boiling_metal_vents_what_the_gas_cannot_take() {
        let metal = iron();
        let (t, y, g) = (3300.0, 0.4, 0.5);
        let vents = Film {
            vents: true,
            ..film(y, g, false)
        };
        let found = metal.pass(t, vents);
        assert!((found.flux / (g * (1.0 - y)) - 1.0).abs() < 1e-12);
        let want = metal.knudsen(t) * (metal.saturation(t) - ATMOSPHERE);
        assert!((found.off() / want - 1.0).abs() < 1e-12, "{found:?} {want}");
        // What goes off is continuous where venting begins, and below that nothing is vented.
        let start = |t: f64| metal.knudsen(t) * (metal.saturation(t) - ATMOSPHERE) - g * (1.0 - y);
        let (mut low, mut high) = (3084.0, 3300.0);
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if start(middle) < 0.0 {
                low = middle;
            } else {
                high = middle;
            }
        }
        let (before, after) = (
            metal.pass(low - 1e-6, vents),
            metal.pass(high + 1e-6, vents),
        );
        assert!(before.vented.abs() < 1e-15 && after.vented > 0.0);
        assert!((after.off() - before.off()).abs() < 1e-6 * after.off());
        // Where the gas moves aside it takes all.
        let blown = Film {
            vents: true,
            ..film(y, g, true)
        };
        assert!(metal.pass(t, blown).vented.abs() < 1e-15);
    }

    #[test]
    fn vapour_that_comes_back_hotter_comes_back_less() {
        let (metal, t, y, gas) = (iron(), 2700.0, 0.3, 10_800.0);
        let molar = film(y, 1.0, false).molar;
        for adds in [false, true] {
            // Gas that diffuses at once: the surface holds what the cell does, and eq. 5.24 stands as printed.
            let hot = Film {
                returning: Some(gas),
                ..film(y, 1e9, adds)
            };
            let found = metal.pass(t, hot);
            let back = ATMOSPHERE * molar.mole(y) / gas.sqrt();
            let root = (IRON / (TAU * MOLAR_GAS)).sqrt();
            let want = (metal.saturation(t) / t.sqrt() - back) * root;
            assert!((found.flux / want - 1.0).abs() < 1e-6, "{found:?} {want}");
            // A quarter of the speed of return: twice the pressure in equilibrium.
            let full = molar.mole(found.equilibrium) * ATMOSPHERE;
            assert!((full / metal.saturation(t) - 2.0).abs() < 1e-9, "{full}");
            // As warm as the metal: the same bits as where nothing is said.
            let level = Film {
                returning: Some(t),
                ..film(y, 0.5, adds)
            };
            assert_eq!(metal.pass(t, level), metal.pass(t, film(y, 0.5, adds)));
        }
    }

    #[test]
    fn both_laws_of_the_saturation_pressure_boil_at_one_atmosphere() {
        // 19574 / 6.347 = 3084 K, as the source of the two numbers says.
        let boiling = 19_574.0 / 6.347;
        assert!((iron().saturation(boiling) / ATMOSPHERE - 1.0).abs() < 1e-12);
        let other = Evaporating::boiling(3100.0, 6.1e6, IRON);
        assert!((other.saturation(3100.0) / ATMOSPHERE - 1.0).abs() < 1e-12);
        assert!((iron().saturation(1809.0) / 3.40 - 1.0).abs() < 0.02);
    }

    #[test]
    fn a_vacuum_takes_all_that_hertz_and_knudsen_let_go() {
        let metal = iron();
        for adds in [false, true] {
            // Gas that diffuses at once stays at Y_P: nothing comes back.
            let found = metal.pass(2600.0, film(0.0, 1e9, adds));
            let want = metal.saturation(2600.0) * metal.knudsen(2600.0);
            assert!((found.flux / want - 1.0).abs() < 1e-6, "{found:?} {want}");
        }
    }

    #[test]
    fn a_slow_gas_saturates_and_diffusion_alone_counts() {
        let metal = iron();
        let t = 2900.0;
        let molar = film(0.0, 1.0, false).molar;
        let full = molar.mass(metal.saturation(t) / ATMOSPHERE);
        let slow = metal.pass(t, film(0.02, 1e-6, false));
        assert!((slow.flux / (1e-6 * (full - 0.02)) - 1.0).abs() < 1e-6);
        assert!(slow.surface <= full && slow.surface > full - 1e-6);
        let blown = metal.pass(t, film(0.02, 1e-6, true));
        let want = 1e-6 * (0.98 / (1.0 - full)).ln();
        assert!((blown.flux / want - 1.0).abs() < 1e-6);
    }

    #[test]
    fn no_cell_is_driven_beyond_saturation() {
        let metal = iron();
        for adds in [false, true] {
            for t in [300.0, 1500.0, 2500.0, 3000.0, 3084.0, 3500.0, 6000.0] {
                for y in [0.0, 1e-9, 0.1, 0.5, 0.99, 1.0 - 1e-9, 1.0] {
                    for g in [1e-6, 1e-2, 1.0, 1e4] {
                        let found = metal.pass(t, film(y, g, adds));
                        assert!(found.coefficient >= 0.0 && found.coefficient.is_finite());
                        assert!(found.flux.is_finite(), "{t} {y} {g} {found:?}");
                        let (low, high) = (y.min(found.equilibrium), y.max(found.equilibrium));
                        assert!(found.surface >= low && found.surface <= high);
                        // It goes towards equilibrium; only a boiling metal blows into its own vapour.
                        let boils = found.equilibrium >= 1.0 && adds;
                        let towards = found.flux * (found.equilibrium - y);
                        assert!(towards >= 0.0 || boils, "{t} {y} {g} {found:?}");
                    }
                }
            }
        }
    }

    #[test]
    fn vapour_condenses_on_a_cold_surface() {
        let found = iron().pass(1000.0, film(0.3, 1e4, false));
        let molar = film(0.3, 1.0, false).molar;
        let want = -iron().knudsen(1000.0) * ATMOSPHERE * molar.mole(0.3);
        assert!((found.flux / want - 1.0).abs() < 1e-2 && found.flux < 0.0);
    }

    #[test]
    fn a_metal_that_boils_gives_off_what_its_excess_of_pressure_drives() {
        let metal = iron();
        let found = metal.pass(3300.0, film(1.0, 0.5, true));
        let want = metal.knudsen(3300.0) * (metal.saturation(3300.0) - ATMOSPHERE);
        assert!((found.flux / want - 1.0).abs() < 1e-9, "{found:?} {want}");
        // Without added mass the gas takes up no more than diffuses away.
        let found = metal.pass(3300.0, film(0.4, 0.5, false));
        assert!((found.flux - 0.5 * 0.6).abs() < 1e-9, "{found:?}");
    }

    #[test]
    fn the_coefficient_is_continuous_through_equilibrium() {
        let metal = iron();
        let full = metal.pass(2700.0, film(0.0, 0.3, true)).equilibrium;
        for adds in [false, true] {
            let at = |y: f64| metal.pass(2700.0, film(y, 0.3, adds)).coefficient;
            let (near, there) = (at(full + 1e-5), at(full));
            assert!((near / there - 1.0).abs() < 1e-3, "{near} {there}");
        }
    }
}
