//! What a solute that gathers at the surface of iron does to its tension (Sahoo, DebRoy and McNallan 1988, Metall. Trans. B
//! 19, 483).
//!
//! ```text
//! gamma(T) = gamma_m - A (T - T_m) - R T G ln(1 + K a)        K = k exp(-H/(R T))
//! d gamma/d T = -A - R G ln(1 + K a) - (G H/T) K a/(1 + K a)
//! ```
//!
//! with the excess G of a surface that is full, the heat of adsorption H, k of its entropy and the activity a, the
//! percentage by weight. Heat drives the solute from the surface: below some temperature the tension grows with it. What
//! several solutes take adds up.

use crate::heat::MOLAR_GAS;

/// A of pure iron \[N/(m K)\].
pub const IRON: f64 = 4.3e-4;

/// A solute of iron.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Solute {
    /// G \[mol/m2\].
    excess: f64,
    /// k.
    factor: f64,
    /// H \[J/mol\].
    heat: f64,
    /// a \[%\].
    activity: f64,
}

impl Solute {
    /// Sulphur, so many per cent by weight.
    #[must_use]
    pub fn sulphur(percent: f64) -> Self {
        Self {
            excess: 1.3e-5,
            factor: 3.18e-3,
            heat: -1.66e5,
            activity: percent,
        }
    }

    /// Oxygen, so many per cent by weight.
    #[must_use]
    pub fn oxygen(percent: f64) -> Self {
        Self {
            excess: 2.03e-5,
            factor: 1.38e-2,
            heat: -1.46e5,
            activity: percent,
        }
    }

    /// K a at the temperature `kelvin`.
    fn filling(&self, kelvin: f64) -> f64 {
        self.factor * (-self.heat / (MOLAR_GAS * kelvin)).exp() * self.activity
    }

    /// Its part of d gamma/d T at the temperature `kelvin` \[N/(m K)\].
    #[must_use]
    pub fn slope(&self, kelvin: f64) -> f64 {
        let filling = self.filling(kelvin);
        let leaves = self.excess * self.heat / kelvin * filling / (1.0 + filling);
        -MOLAR_GAS * self.excess * filling.ln_1p() - leaves
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What it takes of gamma \[N/m\].
    fn taken(solute: &Solute, kelvin: f64) -> f64 {
        MOLAR_GAS * kelvin * solute.excess * solute.filling(kelvin).ln_1p()
    }

    #[test]
    fn the_slope_is_that_of_the_tension() {
        for solute in [
            Solute::sulphur(0.004),
            Solute::sulphur(0.03),
            Solute::oxygen(0.01),
        ] {
            for kelvin in [1700.0, 1900.0, 2300.0, 3100.0] {
                let step = 0.1;
                let rise = taken(&solute, kelvin - step) - taken(&solute, kelvin + step);
                let exact = rise / (2.0 * step);
                let slope = solute.slope(kelvin);
                assert!(
                    (slope / exact - 1.0).abs() < 1e-6,
                    "{solute:?} at {kelvin} K: {slope} {exact}"
                );
            }
        }
    }

    #[test]
    fn without_a_solute_there_is_nothing_and_a_full_surface_has_its_limit() {
        assert!(Solute::sulphur(0.0).slope(2000.0).abs() <= 0.0);
        // K a far beyond one: -R G (ln(k a) + 1/(K a) ...): the heat of adsorption drops out.
        let full = Solute::oxygen(100.0);
        let limit = -MOLAR_GAS * full.excess * (full.factor * full.activity).ln();
        assert!((full.slope(1000.0) / limit - 1.0).abs() < 1e-5);
    }
}
