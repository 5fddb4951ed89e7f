//! Gas that holds iron vapour: its laws against the mass fraction Y of iron and temperature.
//!
//! A gas table gives every property over the mole fraction x of iron (moles of iron over those of iron
//! and of cold gas) and temperature. Between its nodes a property is bilinear in x and T (Komen 2019,
//! section 5.2.3), which is exact for the density of a perfect gas; the enthalpy, being one per mass, is
//! linear in Y instead, which is exact for gases that mix without heat.

use std::sync::Arc;

use props::Surface;

/// Molar masses of the cold gas and of iron \[kg/mol\].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Molar {
    /// The gas without iron.
    pub gas: f64,
    /// Iron.
    pub iron: f64,
}

impl Molar {
    /// Mole fraction of iron at its mass fraction `y`.
    #[must_use]
    #[inline]
    pub fn mole(&self, y: f64) -> f64 {
        y * self.gas / (y * self.gas + (1.0 - y) * self.iron)
    }

    /// Mass fraction of iron at its mole fraction `x`.
    #[must_use]
    #[inline]
    pub fn mass(&self, x: f64) -> f64 {
        x * self.iron / (x * self.iron + (1.0 - x) * self.gas)
    }

    /// Slope of [`Molar::mole`] with `y`.
    #[must_use]
    pub fn mole_slope(&self, y: f64) -> f64 {
        let sum = y * self.gas + (1.0 - y) * self.iron;
        self.gas * self.iron / (sum * sum)
    }
}

/// A property over mole fraction and temperature.
#[derive(Debug, Clone)]
pub struct Mixed {
    /// The table.
    pub table: Arc<Surface>,
    /// Molar masses, for the mole fraction.
    pub molar: Molar,
}

impl Mixed {
    /// The value at temperature `t` and mass fraction `y`, held beyond the ends.
    #[must_use]
    #[inline]
    pub fn at(&self, t: f64, y: f64) -> f64 {
        self.table.held(self.molar.mole(y), t)
    }

    /// Mean over the temperatures between both of `t` at mass fraction `y`.
    #[must_use]
    pub fn mean(&self, t: [f64; 2], y: f64) -> f64 {
        self.table.mean(self.molar.mole(y), t[0], t[1])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use props::Table;

    const CO_FE: Molar = Molar {
        gas: 0.028_010,
        iron: 0.055_845,
    };

    #[test]
    fn fractions_of_mass_and_of_moles_belong_together() {
        for x in [0.0, 1e-9, 0.1, 0.5, 1.0] {
            let y = CO_FE.mass(x);
            assert!((CO_FE.mole(y) - x).abs() < 1e-15);
            let slope = (CO_FE.mole(y + 1e-6) - CO_FE.mole(y - 1e-6)) / 2e-6;
            assert!((CO_FE.mole_slope(y) / slope - 1.0).abs() < 1e-9);
        }
        // 1 mol of CO and 1 mol of Fe.
        assert!((CO_FE.mass(0.5) - 0.055_845 / 0.083_855).abs() < 1e-15);
    }

    #[test]
    fn the_density_of_a_perfect_mixture_is_exact_between_nodes() {
        // rho = p M / (R T), M = x M1 + (1 - x) M2, on the nodes of T.
        let density = |x: f64, t: f64| (x * CO_FE.iron + (1.0 - x) * CO_FE.gas) / t;
        let t = vec![1000.0, 2000.0];
        let row = |x: f64| {
            let values = t.iter().map(|t| density(x, *t)).collect();
            Table::new(t.clone(), values).unwrap()
        };
        let table = Surface::new(vec![0.0, 1.0], vec![row(0.0), row(1.0)]).unwrap();
        let law = Mixed {
            table: Arc::new(table),
            molar: CO_FE,
        };
        for y in [0.0, 0.2, 0.7, 1.0] {
            let want = density(CO_FE.mole(y), 2000.0);
            assert!((law.at(2000.0, y) / want - 1.0).abs() < 1e-14);
        }
    }
}
