//! What is set up of the vapour.

use crate::edges::Edges;
use crate::mixture::Molar;
use crate::vapour::evaporation::Evaporating;

/// What iron vapour meets at an edge face.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum VapourEdge {
    /// No iron diffuses through; what flows in holds as much as the cell.
    Sealed,
    /// Fixed mass fraction.
    Fraction(f64),
}

/// How iron lowers the ionisation voltage of the gas.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ionisation {
    /// Ionisation voltage of iron \[V\].
    pub voltage: f64,
    /// Whether the voltage is linear in the mass fraction of iron, or in its mole fraction.
    pub by_mass: bool,
}

impl Ionisation {
    /// The fraction that the voltage goes with, where the mass fraction of iron is `y`.
    #[must_use]
    pub fn fraction(&self, molar: Molar, y: f64) -> f64 {
        if self.by_mass { y } else { molar.mole(y) }
    }
}

/// Iron vapour, where it is solved.
#[derive(Debug, Clone)]
pub struct VapourCase {
    /// Edges.
    pub edges: Edges<VapourEdge>,
    /// Mass fraction at the start, `[nr nz]`.
    pub start: Vec<f64>,
    /// Source of each cell \[kg/s\], `[nr nz]`; manufactured solutions only.
    pub source: Option<Vec<f64>>,
    /// How the metal of each electrode evaporates, where it does.
    pub metals: Vec<Option<Evaporating>>,
    /// Whether vapour adds to the mass of the gas, or takes the place of as much gas.
    pub adds: bool,
    /// Molar masses of gas and iron.
    pub molar: Molar,
    /// Pressure \[Pa\].
    pub pressure: f64,
    /// Ionisation of iron, where it counts.
    pub ionisation: Option<Ionisation>,
    /// Whether a metal that boils vents what the gas cannot take.
    pub vents: bool,
    /// Whether vapour comes back to metal as warm as the gas nearby, or as the metal.
    pub returns_hot: bool,
    /// The wall that takes iron up: its material, and the mass fraction at it.
    pub wall: Option<(usize, f64)>,
}

impl VapourCase {
    /// Mass fraction at a face to `material`, if that takes iron up.
    #[must_use]
    #[inline]
    pub fn at_wall(&self, material: usize) -> Option<f64> {
        self.wall
            .filter(|(own, _)| *own == material)
            .map(|(_, y)| y)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn iron_counts_by_its_mass_or_by_its_moles() {
        let molar = Molar {
            gas: 0.028,
            iron: 0.056,
        };
        let by = |by_mass| Ionisation {
            voltage: 7.9,
            by_mass,
        };
        // Two thirds of the mass are half of the moles, where iron is twice as heavy.
        let y = 2.0 / 3.0;
        assert!((by(false).fraction(molar, y) - 0.5).abs() < 1e-12);
        assert!((by(true).fraction(molar, y) - y).abs() < 1e-15);
    }
}
