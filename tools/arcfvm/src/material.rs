//! Material laws: what a cell's density, viscosity, conductivities and enthalpy are.

use std::fmt;
use std::sync::Arc;

use props::{Integral, Surface, Table};
use quadrature::SIX;

use crate::mixture::Mixed;

/// Index of the gas among the materials.
pub const GAS: usize = 0;
/// Temperature at which every enthalpy is zero \[K\].
pub const REFERENCE_K: f64 = 300.0;

/// A law in radius \[m\], height \[m\], temperature \[K\] and mass fraction of iron.
pub type Formula = Arc<dyn Fn(f64, f64, f64, f64) -> f64 + Send + Sync>;

/// One property of a material.
#[derive(Clone)]
pub enum Law {
    /// The same everywhere.
    Constant(f64),
    /// Against temperature, held beyond the ends.
    Table(Table),
    /// Against mole fraction of iron and temperature.
    Mixed(Mixed),
    /// A formula in r, z, T and Y.
    Formula(Formula),
}

impl fmt::Debug for Law {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Constant(value) => write!(f, "Constant({value})"),
            Self::Table(table) => write!(f, "Table({} nodes)", table.nodes().len()),
            Self::Mixed(mixed) => write!(f, "Mixed({} rows)", mixed.table.rows().len()),
            Self::Formula(_) => write!(f, "Formula"),
        }
    }
}

impl Law {
    /// The value without iron at radius `r`, height `z`, temperature `t`.
    #[must_use]
    #[inline]
    pub fn at(&self, r: f64, z: f64, t: f64) -> f64 {
        self.within(r, z, t, 0.0)
    }

    /// The value at radius `r`, height `z`, temperature `t` in gas with the mass fraction `y` of iron.
    #[must_use]
    #[inline]
    pub fn within(&self, r: f64, z: f64, t: f64, y: f64) -> f64 {
        match self {
            Self::Constant(value) => *value,
            Self::Table(table) => table.held(t),
            Self::Mixed(mixed) => mixed.at(t, y),
            Self::Formula(formula) => formula(r, z, t, y),
        }
    }

    /// Mean over the temperatures between both of `t` at radius and height `place`, exact for tables, in gas with the
    /// mass fraction `y` of iron.
    #[must_use]
    pub fn mean(&self, [r, z]: [f64; 2], t: [f64; 2], y: f64) -> f64 {
        match self {
            Self::Constant(value) => *value,
            Self::Table(table) => table.mean(t[0], t[1]),
            Self::Mixed(mixed) => mixed.mean(t, y),
            Self::Formula(formula) => {
                let (middle, half) = (0.5 * (t[0] + t[1]), 0.5 * (t[1] - t[0]));
                let pair = |x: f64| {
                    formula(r, z, middle - half * x, y) + formula(r, z, middle + half * x, y)
                };
                let half_of_rule = &SIX[3..];
                half_of_rule.iter().map(|(x, w)| 0.5 * w * pair(*x)).sum()
            }
        }
    }

    /// A law from a formula.
    pub fn formula(f: impl Fn(f64, f64, f64, f64) -> f64 + Send + Sync + 'static) -> Self {
        Self::Formula(Arc::new(f))
    }
}

/// Enthalpy against temperature, zero at 300 K for a gas or a body of one kind.
#[derive(Debug, Clone)]
pub enum Enthalpy {
    /// Constant specific heat \[J/(kg K)\].
    Linear(f64),
    /// The integral of a table, and its value at 300 K.
    Integral(Integral, f64),
    /// Over the mass fraction of iron and temperature, as its table has it.
    Mixed(Arc<Surface>),
}

impl Enthalpy {
    /// From a specific heat that is a table; `melting` adds a latent heat as a triangle of the
    /// specific heat around the melting point.
    ///
    /// # Errors
    /// When the table is not positive.
    pub fn new(specific_heat: &Table, melting: Option<Melting>) -> Result<Self, props::Error> {
        let table = match melting {
            Some(m) => m.add_to(specific_heat)?,
            None => specific_heat.clone(),
        };
        let integral = Integral::new(&table)?;
        let zero = integral.value(REFERENCE_K);
        Ok(Self::Integral(integral, zero))
    }

    /// Enthalpy without iron at `t` \[J/kg\].
    #[must_use]
    #[inline]
    pub fn at(&self, t: f64) -> f64 {
        self.within(t, 0.0)
    }

    /// Enthalpy at `t` with the mass fraction `y` of iron \[J/kg\].
    #[must_use]
    #[inline]
    pub fn within(&self, t: f64, y: f64) -> f64 {
        match self {
            Self::Linear(cp) => cp * (t - REFERENCE_K),
            Self::Integral(integral, zero) => integral.value(t) - zero,
            Self::Mixed(table) => table.extended(y, t),
        }
    }

    /// Specific heat without iron at `t` \[J/(kg K)\].
    #[must_use]
    #[inline]
    pub fn slope(&self, t: f64) -> f64 {
        self.slope_within(t, 0.0)
    }

    /// Specific heat at `t` with the mass fraction `y` of iron \[J/(kg K)\].
    #[must_use]
    #[inline]
    pub fn slope_within(&self, t: f64, y: f64) -> f64 {
        match self {
            Self::Linear(cp) => *cp,
            Self::Integral(integral, _) => integral.slope(t),
            Self::Mixed(table) => table.slope(y, t),
        }
    }

    /// Temperature at enthalpy `h` \[K\] with the mass fraction `y` of iron.
    #[must_use]
    #[inline]
    pub fn temperature(&self, h: f64, y: f64) -> f64 {
        match self {
            Self::Linear(cp) => REFERENCE_K + h / cp,
            Self::Integral(integral, zero) => integral.inverse(h + zero),
            Self::Mixed(table) => table.inverse(y, h),
        }
    }
}

/// A latent heat spread over a range of temperature.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Melting {
    /// Middle of the range \[K\].
    pub point: f64,
    /// Half of the range \[K\].
    pub half_range: f64,
    /// Latent heat \[J/kg\].
    pub latent_heat: f64,
}

impl Melting {
    fn add_to(&self, table: &Table) -> Result<Table, props::Error> {
        let (low, high) = (self.point - self.half_range, self.point + self.half_range);
        let mut nodes: Vec<f64> = table.nodes().to_vec();
        nodes.extend([low, self.point, high]);
        nodes.sort_by(f64::total_cmp);
        nodes.dedup_by(|a, b| (*a - *b).abs() < 1e-9);
        let peak = self.latent_heat / self.half_range;
        let rise = |t: f64| peak * (1.0 - (t - self.point).abs() / self.half_range).max(0.0);
        let values = nodes.iter().map(|t| table.held(*t) + rise(*t)).collect();
        Table::new(nodes, values)
    }
}

/// What fills a cell. Absent laws belong to fields that the scene does not solve.
#[derive(Debug, Clone, Default)]
pub struct Material {
    /// Name, for messages.
    pub name: String,
    /// Density \[kg/m3\].
    pub density: Option<Law>,
    /// Dynamic viscosity \[Pa s\]; a gas only.
    pub viscosity: Option<Law>,
    /// Thermal conductivity \[W/(m K)\].
    pub thermal_conductivity: Option<Law>,
    /// Electric conductivity \[S/m\].
    pub electric_conductivity: Option<Law>,
    /// Net emission, a loss of volume \[W/m3\]; a gas only.
    pub net_emission: Option<Law>,
    /// Electrons \[1/m3\]; a gas whose table tells them.
    pub electron_density: Option<Law>,
    /// Diffusion coefficient of iron \[m2/s\]; a gas with vapour only.
    pub iron_diffusion: Option<Law>,
    /// Enthalpy \[J/kg\].
    pub enthalpy: Option<Enthalpy>,
    /// Melting; its latent heat is part of the enthalpy.
    pub melting: Option<Melting>,
    /// The table that the laws come from, where they come from a file.
    pub table: Option<TableRange>,
    /// Properties that may not be taken beyond their tables.
    pub strict: Vec<Strict>,
}

/// What a gas table covers.
#[derive(Debug, Clone, PartialEq)]
pub struct TableRange {
    /// File, for messages.
    pub name: String,
    /// First and last temperature \[K\].
    pub temperature: [f64; 2],
    /// Pressure \[Pa\].
    pub pressure: f64,
    /// Whether a solution beyond the last temperature is an error.
    pub is_error: bool,
}

/// A table of a scene beyond whose ends nothing may be taken.
#[derive(Debug, Clone, PartialEq)]
pub struct Strict {
    /// JSON path of the table.
    pub path: String,
    /// First and last temperature \[K\].
    pub temperature: [f64; 2],
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn latent_heat_adds_exactly_once() {
        let cp = Table::new(vec![300.0, 3000.0], vec![600.0, 600.0]).unwrap();
        let melting = Melting {
            point: 1750.0,
            half_range: 25.0,
            latent_heat: 250e3,
        };
        let h = Enthalpy::new(&cp, Some(melting)).unwrap();
        assert!((h.at(1700.0) - 600.0 * 1400.0).abs() < 1e-6);
        assert!((h.at(2000.0) - (600.0 * 1700.0 + 250e3)).abs() < 1e-6);
        for t in [310.0, 1749.0, 1751.0, 2500.0, 3500.0] {
            assert!((h.temperature(h.at(t), 0.0) - t).abs() < 1e-8, "{t}");
        }
    }

    #[test]
    fn the_temperature_of_a_mixture_is_found_again() {
        let row = |cp: f64| {
            let t = vec![300.0, 1000.0, 5000.0, 20_000.0];
            let h = vec![0.0, cp * 700.0, cp * 9000.0, cp * 3e4];
            Table::new(t, h).unwrap()
        };
        let table = Surface::new(vec![0.0, 0.4, 1.0], vec![row(1e3), row(8e2), row(5e2)]).unwrap();
        let h = Enthalpy::Mixed(Arc::new(table));
        for y in [0.0, 0.1, 0.4, 0.83, 1.0] {
            for t in [250.0, 300.0, 4000.0, 19_999.0, 30_000.0] {
                assert!((h.temperature(h.within(t, y), y) - t).abs() < 1e-9 * t);
                let slope = (h.within(t + 0.1, y) - h.within(t - 0.1, y)) / 0.2;
                if t > 301.0 {
                    assert!((h.slope_within(t, y) / slope - 1.0).abs() < 1e-9);
                }
            }
        }
    }

    #[test]
    fn enthalpy_is_zero_at_the_reference() {
        let cp = Table::new(vec![200.0, 900.0], vec![500.0, 900.0]).unwrap();
        let h = Enthalpy::new(&cp, None).unwrap();
        assert!(h.at(REFERENCE_K).abs() < 1e-9);
        assert!(h.at(250.0) < 0.0);
        assert!((Enthalpy::Linear(1000.0).temperature(2e5, 0.0) - 500.0).abs() < 1e-12);
    }
}
