//! Diffusion of iron in a gas where its table does not tell it.

use crate::material::Law;

/// The constant of eq. 5.25, by experiments.
const BETA: f64 = 1.385;

/// Density and viscosity of a pure gas.
#[derive(Debug, Clone)]
pub struct Pure {
    /// Density \[kg/m3\].
    pub density: Law,
    /// Viscosity \[Pa s\].
    pub viscosity: Law,
    /// Molar mass \[kg/mol\].
    pub molar: f64,
}

impl Pure {
    /// `(rho^2 / (beta^2 mu^2 M))^(1/4)` at `t`.
    fn root(&self, t: f64) -> f64 {
        let ratio = self.density.at(0.0, 0.0, t) / (BETA * self.viscosity.at(0.0, 0.0, t));
        (ratio / self.molar.sqrt()).sqrt()
    }
}

/// Diffusion coefficient of iron in a gas from the viscosities of both \[m2/s\] (Komen 2019, eq. 5.25).
///
/// ```text
/// D = 2 sqrt(2) sqrt(1/M1 + 1/M2) / ((rho1^2/(beta^2 mu1^2 M1))^(1/4) + (rho2^2/(beta^2 mu2^2 M2))^(1/4))^2
/// ```
///
/// The print lacks the square root over the sum of the inverse masses and the masses under the fourth
/// roots; with both the units are right and a gas in itself diffuses with `beta mu / rho`.
#[must_use]
pub fn diffusion(iron: &Pure, gas: &Pure, t: f64) -> f64 {
    let masses = (1.0 / iron.molar + 1.0 / gas.molar).sqrt();
    let roots = iron.root(t) + gas.root(t);
    2.0 * std::f64::consts::SQRT_2 * masses / (roots * roots)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_gas_in_itself_diffuses_with_beta_mu_over_rho() {
        let gas = |molar: f64| Pure {
            density: Law::Constant(0.3),
            viscosity: Law::Constant(6e-5),
            molar,
        };
        let found = diffusion(&gas(0.04), &gas(0.04), 3000.0);
        assert!((found / (BETA * 6e-5 / 0.3) - 1.0).abs() < 1e-14);
        // It does not matter in which unit masses are measured, nor which gas is called iron.
        let mixed = diffusion(&gas(0.04), &gas(0.05), 3000.0);
        assert!((diffusion(&gas(40.0), &gas(50.0), 3000.0) / mixed - 1.0).abs() < 1e-14);
        assert!((diffusion(&gas(0.05), &gas(0.04), 3000.0) / mixed - 1.0).abs() < 1e-14);
    }
}
