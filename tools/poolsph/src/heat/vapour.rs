//! Vapour that leaves the metal (Komen 2019, eq. 5.24), into a vacuum or through a layer of gas.
//!
//! Vapour leaves the metal at p_v(T), some of what stands above it at p_s falls back, and the rest
//! passes the gas (Stefan 1874; Bird, Stewart and Lightfoot 1960, eq. 17.2-14). Both rates are one:
//!
//! ```text
//! n = (p_v(T) - p_s) / sqrt(2 pi M R T) = (c D / delta) ln( p / (p - p_s) )           [mol/(m2 s)]
//! p_v(T) = 1 atm exp( H_v M / R (1/T_b - 1/T) )
//! ```
//!
//! With s = ln(p / (p - p_s)) the balance falls and is convex in s, so Newton's method climbs to its
//! root from s = 0 without passing it, below the boiling point and above it. Without a gas p_s = 0, the
//! most there can be: at 1 atm several times what is measured over weld pools.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Molar gas constant \[J/(mol K)\].
pub(crate) const MOLAR_GAS: f64 = 8.314_462_618;
/// Pressure at the boiling point \[Pa\].
const ATMOSPHERE: f64 = 101_325.0;
/// Below this part of the boiling point the vapour pressure is under 1e-12 of that at it, for any
/// metal (Trouton's rule), and vapour is left out.
const COLD: f64 = 0.25;
/// Most turns of Newton's method.
const TURNS: usize = 60;
/// Change of s, relative, that ends the search; the next one would be about its square.
const CLOSE: f64 = 1e-9;

/// Vapour of the metal (key `losses.evaporation`).
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Evaporation {
    /// Boiling point T_b at 1 atm.
    #[schemars(extend("x-unit" = "K"), range(min = 100.0, max = 1e4))]
    pub boiling_point_k: f64,
    /// Latent heat of evaporation H_v.
    #[schemars(extend("x-unit" = "J/kg"), range(min = 1.0, max = 1e8))]
    pub latent_heat_j_kg: f64,
    /// Molar mass M of the vapour.
    #[schemars(extend("x-unit" = "kg/mol"), range(min = 1e-3, max = 1.0))]
    pub molar_mass_kg_mol: f64,
    /// Gas that the vapour has to pass; absent: it leaves into a vacuum.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub gas: Option<GasLayer>,
}

/// Layer of gas on the metal, free of vapour at its far side.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct GasLayer {
    /// Pressure p of the gas.
    #[schemars(extend("x-unit" = "Pa"), range(min = 1.0, max = 1e8))]
    pub pressure_pa: f64,
    /// Thickness delta of the layer.
    #[schemars(extend("x-unit" = "m"), range(min = 1e-7, max = 1.0))]
    pub thickness_m: f64,
    /// c D, molar density times diffusion coefficient, at the mean temperature of the layer.
    #[schemars(extend("x-unit" = "mol/(m s)"), range(min = 1e-8, max = 1.0))]
    pub diffusion_mol_m_s: f64,
}

impl Evaporation {
    /// True where vapour is not worth reckoning at `t` \[K\].
    #[must_use]
    pub fn is_cold(&self, t: f64) -> bool {
        t <= COLD * self.boiling_point_k
    }

    /// Heat that vapour carries off at temperature `t` \[K\] \[W/m2\], and its rise with temperature
    /// \[W/(m2 K)\].
    #[must_use]
    pub fn heat(&self, t: f64) -> (f64, f64) {
        let free = self.pressure(t) * self.per_pressure(t);
        let free_rise = free * (self.molar_heat() / (MOLAR_GAS * t) - 0.5) / t;
        let (rate, rise) = self.gas.map_or((free, free_rise), |gas| {
            let (b, back) = (gas.conductance(), gas.pressure_pa * self.per_pressure(t));
            let s = gas.passed(free, back);
            // What falls back slows by half of its part for each part of T.
            let back_rise = -0.5 * back / t * (-(-s).exp_m1());
            (b * s, b * (free_rise - back_rise) / (back * (-s).exp() + b))
        });
        (
            self.molar_heat() * rate,
            (self.molar_heat() * rise).max(0.0),
        )
    }

    /// H_v M \[J/mol\].
    fn molar_heat(&self) -> f64 {
        self.latent_heat_j_kg * self.molar_mass_kg_mol
    }

    /// p_v \[Pa\].
    fn pressure(&self, t: f64) -> f64 {
        let molar = self.molar_heat() / MOLAR_GAS;
        ATMOSPHERE * (molar * (1.0 / self.boiling_point_k - 1.0 / t)).exp()
    }

    /// 1 / sqrt(2 pi M R T) \[mol/(m2 s Pa)\].
    fn per_pressure(&self, t: f64) -> f64 {
        (std::f64::consts::TAU * self.molar_mass_kg_mol * MOLAR_GAS * t)
            .sqrt()
            .recip()
    }
}

impl GasLayer {
    /// c D / delta \[mol/(m2 s)\].
    fn conductance(&self) -> f64 {
        self.diffusion_mol_m_s / self.thickness_m
    }

    /// s of `free - back (1 - exp(-s)) = b s`: `free` leaves the metal, `back` would fall back from
    /// vapour at the pressure of the gas \[mol/(m2 s)\].
    fn passed(&self, free: f64, back: f64) -> f64 {
        let b = self.conductance();
        let mut s = 0.0_f64;
        for _ in 0..TURNS {
            let excess = free + back * (-s).exp_m1() - b * s;
            let change = excess / (back * (-s).exp() + b);
            s += change;
            if change.abs() <= CLOSE * s {
                break;
            }
        }
        s
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const IRON: Evaporation = Evaporation {
        boiling_point_k: 3134.0,
        latent_heat_j_kg: 6.09e6,
        molar_mass_kg_mol: 0.055_845,
        gas: None,
    };

    fn through(gas: GasLayer) -> Evaporation {
        Evaporation {
            gas: Some(gas),
            ..IRON
        }
    }

    const LAYER: GasLayer = GasLayer {
        pressure_pa: 101_325.0,
        thickness_m: 9e-5,
        diffusion_mol_m_s: 6e-3,
    };

    /// Both rates of the balance, from the pressure above the metal that they share.
    #[test]
    fn what_leaves_the_metal_passes_the_gas() {
        for t in [900.0, 2000.0, 2900.0, 3133.0, 3500.0, 5000.0] {
            let iron = through(LAYER);
            let rate = iron.heat(t).0 / (6.09e6 * 0.055_845);
            let above = 101_325.0 * -(-rate * 9e-5 / 6e-3).exp_m1();
            let left = IRON.heat(t).0 / (6.09e6 * 0.055_845);
            let back = above / (std::f64::consts::TAU * 0.055_845 * MOLAR_GAS * t).sqrt();
            assert!(((left - back) / rate - 1.0).abs() < 1e-9, "{t} K");
            assert!(above <= 101_325.0, "{t} K: {above} Pa");
        }
    }

    #[test]
    fn thin_and_thick_layers_have_their_limits() {
        let thin = GasLayer {
            thickness_m: 1e-7,
            diffusion_mol_m_s: 1.0,
            ..LAYER
        };
        // What falls back at 1 atm, 1,100 mol/(m2 s), is 1.1e-4 of the conductance.
        assert!((through(thin).heat(2800.0).0 / IRON.heat(2800.0).0 - 1.0).abs() < 2e-4);
        // A thick layer: vapour above the metal is saturated, and little of it diffuses.
        let thick = GasLayer {
            thickness_m: 1e-2,
            ..LAYER
        };
        let part = (6.09e6 * 0.055_845 / MOLAR_GAS * (1.0 / 3134.0 - 1.0 / 2000.0)).exp();
        let diffused = 6.09e6 * 0.055_845 * 6e-3 / 1e-2 * -(1.0 - part).ln();
        assert!((through(thick).heat(2000.0).0 / diffused - 1.0).abs() < 1e-3);
    }

    #[test]
    fn the_slope_is_that_of_the_heat() {
        for iron in [IRON, through(LAYER)] {
            for t in [1500.0, 2800.0, 3134.0, 3600.0] {
                let rise = (iron.heat(t + 0.01).0 - iron.heat(t - 0.01).0) / 0.02;
                assert!((iron.heat(t).1 / rise - 1.0).abs() < 1e-5, "{t} K");
            }
        }
    }

    #[test]
    fn extremes_stay_finite() {
        for pressure_pa in [1.0, 1e8] {
            for thickness_m in [1e-7, 1.0] {
                for diffusion_mol_m_s in [1e-8, 1.0] {
                    let iron = through(GasLayer {
                        pressure_pa,
                        thickness_m,
                        diffusion_mol_m_s,
                    });
                    for t in [800.0, 3134.0, 1e4] {
                        let ((q, rise), (most, _)) = (iron.heat(t), IRON.heat(t));
                        assert!(q > 0.0 && q <= most * (1.0 + 1e-12), "{q} of {most}");
                        assert!(rise.is_finite());
                    }
                }
            }
        }
    }
}
