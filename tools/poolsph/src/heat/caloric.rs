//! Enthalpy, temperature and phase of the metal (Komen 2019, section 4.2.2 and fig. 4.7).
//!
//! ```text
//! h(T) = integral of c from T_0 to T (+ L above the melting point)
//! ```
//!
//! The enthalpy is the state and the temperature follows from it: at the melting point the
//! temperature stands still while the enthalpy passes through the latent heat, and the particle
//! changes its phase halfway, without undercooling or superheating. No energy is lost to the
//! change of phase, since nothing but the enthalpy is ever changed.

use props::{Integral, Table};

use crate::state::LIQUID;

/// Melting of the metal.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Melting {
    /// T_m \[K\].
    pub point: f64,
    /// L \[J/kg\].
    pub latent_heat: f64,
}

/// Thermal properties of the metal.
#[derive(Debug, Clone)]
pub struct Caloric {
    conductivity: Table,
    heat: Integral,
    melting: Option<Melted>,
    fastest: f64,
    least_heat: f64,
    range: (f64, f64),
}

#[derive(Debug, Clone, Copy)]
struct Melted {
    point: f64,
    latent_heat: f64,
    /// h of the solid at the melting point \[J/kg\].
    solidus: f64,
}

impl Caloric {
    /// From kappa(T) \[W/(m K)\], c(T) \[J/(kg K)\], the melting if there is one, and the range of
    /// temperatures \[K\] for which the properties are meant.
    ///
    /// # Errors
    /// When a specific heat or conductivity is not positive.
    pub fn new(
        conductivity: Table,
        specific_heat: &Table,
        melting: Option<Melting>,
        range: (f64, f64),
    ) -> Result<Self, props::Error> {
        let heat = Integral::new(specific_heat)?;
        if let Some((row, &value)) =
            (conductivity.values().iter().enumerate()).find(|v| *v.1 <= 0.0)
        {
            return Err(props::Error::NotPositive { row, value });
        }
        let melting = melting.map(|m| Melted {
            point: m.point,
            latent_heat: m.latent_heat,
            solidus: heat.value(m.point),
        });
        // A ratio of two lines has its extremes at the nodes of both.
        let fastest = (conductivity.nodes().iter())
            .chain(specific_heat.nodes())
            .map(|&t| conductivity.held(t) / specific_heat.held(t))
            .fold(0.0, f64::max);
        let values = specific_heat.values().iter().copied();
        let least_heat = values.fold(f64::INFINITY, f64::min);
        Ok(Self {
            conductivity,
            heat,
            melting,
            fastest,
            least_heat,
            range,
        })
    }

    /// h of the temperature \[J/kg\]; at the melting point that of the solid.
    #[must_use]
    pub fn enthalpy(&self, temperature: f64) -> f64 {
        let sensible = self.heat.value(temperature);
        match self.melting {
            Some(m) if temperature > m.point => sensible + m.latent_heat,
            _ => sensible,
        }
    }

    /// h at the melting point of metal that holds a part of its latent heat, 0 to 1 \[J/kg\]; zero where it does not melt.
    #[must_use]
    pub fn halfway(&self, part: f64) -> f64 {
        self.melting
            .map_or(0.0, |m| m.solidus + part * m.latent_heat)
    }

    /// T of the enthalpy \[K\].
    #[must_use]
    #[inline]
    pub fn temperature(&self, enthalpy: f64) -> f64 {
        match self.melting {
            Some(m) if enthalpy > m.solidus => {
                if enthalpy < m.solidus + m.latent_heat {
                    m.point
                } else {
                    self.heat.inverse(enthalpy - m.latent_heat)
                }
            }
            _ => self.heat.inverse(enthalpy),
        }
    }

    /// Part of the latent heat that the enthalpy holds, 0 to 1: the part of a particle behind the front
    /// of melting.
    #[must_use]
    #[inline]
    pub fn molten(&self, enthalpy: f64) -> f64 {
        match self.melting {
            Some(m) if enthalpy > m.solidus => ((enthalpy - m.solidus) / m.latent_heat).min(1.0),
            _ => 0.0,
        }
    }

    /// What metal of this enthalpy lacks to begin to melt, over its latent heat: the Stefan number of a solid; zero where it does
    /// not melt.
    #[must_use]
    #[inline]
    pub fn stefan(&self, enthalpy: f64) -> f64 {
        self.melting
            .map_or(0.0, |m| ((m.solidus - enthalpy) / m.latent_heat).max(0.0))
    }

    /// True from half of the latent heat on.
    #[must_use]
    #[inline]
    pub fn is_liquid(&self, enthalpy: f64) -> bool {
        self.molten(enthalpy) >= LIQUID
    }

    /// kappa \[W/(m K)\].
    #[must_use]
    #[inline]
    pub fn conductivity(&self, temperature: f64) -> f64 {
        self.conductivity.held(temperature)
    }

    /// T_m \[K\], if the metal melts.
    #[must_use]
    pub fn melting_point(&self) -> Option<f64> {
        self.melting.map(|m| m.point)
    }

    /// Largest kappa/c \[kg/(m s)\], the diffusivity times the density, anywhere in the range.
    #[must_use]
    pub fn fastest(&self) -> f64 {
        self.fastest
    }

    /// Largest kappa anywhere \[W/(m K)\].
    #[must_use]
    pub fn most_conductive(&self) -> f64 {
        let values = self.conductivity.values().iter().copied();
        values.fold(0.0, f64::max)
    }

    /// Least specific heat anywhere \[J/(kg K)\].
    #[must_use]
    pub fn least_heat(&self) -> f64 {
        self.least_heat
    }

    /// Temperatures \[K\] between which the properties hold.
    #[must_use]
    pub fn range(&self) -> (f64, f64) {
        self.range
    }

    /// True if the properties hold at the temperature \[K\].
    #[must_use]
    #[inline]
    pub fn covers(&self, temperature: f64) -> bool {
        temperature >= self.range.0 && temperature <= self.range.1
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Table 4.2 of Komen (2019): 30 to 73 W/(m K), 0.44 to 1.04 kJ/(kg K), 250 kJ/kg at 1750 K.
    pub(crate) fn steel() -> Caloric {
        let conductivity = Table::new(vec![300.0, 1100.0, 1750.0], vec![73.0, 30.0, 35.0]).unwrap();
        let heat = Table::new(
            vec![300.0, 900.0, 1040.0, 1200.0],
            vec![440.0, 700.0, 1040.0, 650.0],
        )
        .unwrap();
        let melting = Melting {
            point: 1750.0,
            latent_heat: 250e3,
        };
        Caloric::new(conductivity, &heat, Some(melting), (250.0, 4000.0)).unwrap()
    }

    /// Constant properties; melts at 1 K above zero if a latent heat is given.
    pub(crate) fn plain(conductivity: f64, heat: f64, melting: Option<Melting>) -> Caloric {
        let flat = |value| Table::new(vec![0.0, 1.0], vec![value, value]).unwrap();
        Caloric::new(flat(conductivity), &flat(heat), melting, (-1e9, 1e9)).unwrap()
    }

    #[test]
    fn latent_heat_is_taken_up_at_the_melting_point() {
        let steel = steel();
        let below = steel.enthalpy(1750.0);
        for part in [0.0, 0.25, 0.5, 0.75, 1.0] {
            assert!((steel.temperature(below + part * 250e3) - 1750.0).abs() < 1e-9);
            assert!((steel.molten(steel.halfway(part)) - part).abs() < 1e-12);
        }
        assert!(!steel.is_liquid(below + 0.49 * 250e3) && steel.is_liquid(below + 0.51 * 250e3));
        assert!((steel.enthalpy(1760.0) - below - 250e3 - 6500.0).abs() < 1e-6);
    }

    #[test]
    fn the_largest_diffusivity_is_found_at_a_node() {
        let plain = plain(30.0, 600.0, None);
        assert!((plain.fastest() - 0.05).abs() < 1e-15);
        assert!((steel().fastest() - 73.0 / 440.0).abs() < 1e-12);
        assert!((steel().least_heat() - 440.0).abs() < 1e-12);
    }

    proptest! {
        #[test]
        fn temperature_and_enthalpy_are_inverse(t in 260.0..3900.0_f64) {
            let steel = steel();
            prop_assert!((steel.temperature(steel.enthalpy(t)) - t).abs() < 1e-8);
        }

        #[test]
        fn temperature_never_falls_with_enthalpy(h in -1e4..3e6_f64, step in 0.0..1e5_f64) {
            let steel = steel();
            prop_assert!(steel.temperature(h + step) >= steel.temperature(h));
        }
    }
}
