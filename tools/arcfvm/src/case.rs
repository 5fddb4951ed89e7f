//! The assembled problem: grid, materials, edges, and what is solved. Physics reads this, never
//! the scene.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::curve::Surface;
use crate::fields::sheath::Sheath;
use crate::grid::Grid;
use crate::heat::evaporation::Evaporating;
use crate::heat::granular::Granular;
use crate::heat::{Contact, Surfaces};
use crate::material::{GAS, Material};
use crate::mixture::Molar;

/// One value per face of the four sides of the domain.
#[derive(Debug, Clone, PartialEq)]
pub struct Edges<T> {
    /// Smallest radius (the axis, if that is zero), `[nz]`.
    pub inner: Vec<T>,
    /// Largest radius, `[nz]`.
    pub outer: Vec<T>,
    /// Lowest height, `[nr]`.
    pub bottom: Vec<T>,
    /// Greatest height, `[nr]`.
    pub top: Vec<T>,
}

impl<T: Clone> Edges<T> {
    /// The same value everywhere.
    #[must_use]
    pub fn uniform(grid: &Grid, value: T) -> Self {
        Self {
            inner: vec![value.clone(); grid.nz],
            outer: vec![value.clone(); grid.nz],
            bottom: vec![value.clone(); grid.nr],
            top: vec![value; grid.nr],
        }
    }
}

/// What the potential meets at an edge face.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum PotentialEdge {
    /// No current crosses.
    Insulated,
    /// Fixed potential \[V\].
    Voltage(f64),
    /// Current into the domain \[A\].
    Current(f64),
    /// The one potential at which all such faces together let in the driven current.
    Driven,
}

/// What the flow meets at an edge face.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum FlowEdge {
    /// Fixed velocity, radial and axial \[m/s\]: a wall (zero) or an inlet.
    Velocity([f64; 2]),
    /// Fixed pressure \[Pa\]; gas drawn in comes from rest.
    Open(f64),
    /// No flow through, no stress along: the axis or a plane of symmetry.
    Slip,
}

/// What heat meets at an edge face.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum HeatEdge {
    /// No conduction; what flows in is as warm as the cell.
    Insulated,
    /// Fixed temperature \[K\].
    Temperature(f64),
    /// Heat flux into the domain \[W/m2\].
    Flux(f64),
}

/// The potential, where it is solved.
#[derive(Debug, Clone)]
pub struct PotentialCase {
    /// Edges.
    pub edges: Edges<PotentialEdge>,
    /// Current into the domain through all driven faces \[A\].
    pub driven: Option<f64>,
    /// Current source of each cell \[A\], `[nr nz]`; manufactured solutions only.
    pub source: Option<Vec<f64>>,
    /// Gas close to electrodes that conducts as the gas beyond.
    pub sheath: Option<Sheath>,
}

/// Gravity acting on the excess of density.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Gravity {
    /// Downward acceleration \[m/s2\].
    pub acceleration: f64,
    /// Density of the gas at rest around \[kg/m3\], whose weight the pressure leaves out.
    pub reference_density: f64,
}

/// The flow, where it is solved.
#[derive(Debug, Clone)]
pub struct FlowCase {
    /// Edges.
    pub edges: Edges<FlowEdge>,
    /// Gravity.
    pub gravity: Option<Gravity>,
    /// Given forces on radial and axial faces \[N/m3\]; manufactured solutions only.
    pub force: Option<[Vec<f64>; 2]>,
    /// Whether no edge fixes the pressure, so that it is known up to a constant.
    pub closed: bool,
}

/// Heat that a moving plate carries away (Komen 2019, eq. 5.22).
#[derive(Debug, Clone, PartialEq)]
pub struct MovingPlate {
    /// Welding speed \[m/s\].
    pub speed: f64,
    /// Distance ahead at which the plate is compared \[m\].
    pub ahead: f64,
    /// Widths of a ring that sweep the plate.
    pub swept: f64,
    /// Material of the plate.
    pub material: usize,
    /// Temperature beyond the edge of the domain, by row \[K\].
    pub beyond: Vec<f64>,
}

/// How fast a wire is fed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum FeedRule {
    /// Given speed \[m/s\].
    Speed(f64),
    /// As fast as it melts, the tip being as warm as this in the mean \[K\] (Komen 2019, eq. 5.27).
    Melting(f64),
    /// As fast as lets this part of the wire boil off its tip, whose temperature follows.
    Boiling {
        /// Part of the mass that is fed.
        share: f64,
        /// Heat that it takes \[J/kg\].
        latent_heat: f64,
        /// Enthalpy at the boiling point, of which the first guess of the speed is made \[J/kg\].
        at_most: f64,
    },
}

/// What the drops of a wire take along.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Drops {
    /// This part of the enthalpy of the tip: 1 where they are as warm as that. A tip of told temperature needs drops that follow
    /// it: with drops of one enthalpy its feed balances the heat at any temperature.
    Part(f64),
    /// This enthalpy \[J/kg\], or that of the tip where the tip holds less.
    Enthalpy(f64),
}

impl Drops {
    /// Enthalpy of the drops of a tip that holds `tip` \[J/kg\].
    #[must_use]
    pub fn of(self, tip: f64) -> f64 {
        match self {
            Self::Part(part) => part * tip,
            Self::Enthalpy(own) => own.min(tip),
        }
    }
}

/// The wire that is fed down.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Wire {
    /// Material of the wire.
    pub material: usize,
    /// Columns `0..columns` hold the wire.
    pub columns: usize,
    /// Lowest row of the wire.
    pub tip: usize,
    /// Cross-section \[m2\].
    pub section: f64,
    /// Density of the wire \[kg/m3\].
    pub density: f64,
    /// What its drops take along.
    pub drops: Drops,
    /// Feeding, if there is any.
    pub feed: Option<FeedRule>,
}

/// What electrons carry through the gas.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Electrons {
    /// Their enthalpy, against the current: heat of 5/2 k/e j . grad T (Hsu, Etemadi and Pfender 1983).
    Enthalpy,
}

/// Conductivity of the way from one cell to the next, and through a film.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Conduction {
    /// That of each half at the temperature of its cell, and of a film at the mean of its ends.
    #[default]
    Cells,
    /// The mean over all temperatures between both ends, from the integral of the conductivity (Kirchhoff): where that
    /// jumps within a few kelvin, heat between cells does not.
    Integral,
}

/// Heat, where it is solved.
#[derive(Debug, Clone)]
pub struct HeatCase {
    /// Edges.
    pub edges: Edges<HeatEdge>,
    /// Heat source of each cell \[W\], `[nr nz]`; manufactured solutions only.
    pub source: Option<Vec<f64>>,
    /// Plates and beds of flux that move past the arc.
    pub plates: Vec<MovingPlate>,
    /// Granular flux that boils into the cavity.
    pub granular: Option<Granular>,
    /// What electrons carry through the gas.
    pub electrons: Option<Electrons>,
    /// Conductivity of the way from one cell to the next.
    pub conduction: Conduction,
}

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

/// The base metal: the lowest electrode.
#[derive(Debug, Clone, PartialEq)]
pub struct Base {
    /// Its material.
    pub material: usize,
    /// Row above its highest cell, by column; nothing where a column holds none of it, `[nr]`.
    pub above: Vec<Option<usize>>,
    /// The curve that its highest cells follow, where they are not level.
    pub curve: Option<Surface>,
}

impl Base {
    /// Row above its highest cell of all.
    #[must_use]
    pub fn top(&self) -> usize {
        self.above.iter().flatten().copied().max().unwrap_or(0)
    }

    /// Whether it lies deeper in some columns than in others.
    #[must_use]
    pub fn is_deformed(&self) -> bool {
        let top = self.top();
        self.above.iter().flatten().any(|row| *row != top)
    }
}

/// The whole problem.
#[derive(Debug, Clone)]
pub struct Case {
    /// Grid.
    pub grid: Grid,
    /// Material of each cell, `[nr nz]`.
    pub material: Vec<usize>,
    /// Materials; the first is the gas.
    pub materials: Vec<Material>,
    /// Temperature at the start \[K\], `[nr nz]`.
    pub start: Vec<f64>,
    /// Current and potential.
    pub potential: Option<PotentialCase>,
    /// Flow and pressure.
    pub flow: Option<FlowCase>,
    /// Heat and temperature.
    pub heat: Option<HeatCase>,
    /// Iron vapour.
    pub vapour: Option<VapourCase>,
    /// Surfaces of electrodes, where heat or vapour meets them.
    pub surfaces: Option<Surfaces>,
    /// The wire, where there is one.
    pub wire: Option<Wire>,
    /// The base metal, where there is one.
    pub base: Option<Base>,
}

impl Case {
    /// Whether cell `(i, j)` holds gas.
    #[must_use]
    #[inline]
    pub fn is_gas(&self, i: usize, j: usize) -> bool {
        self.material[self.grid.cell(i, j)] == GAS
    }

    /// The material of cell `k`.
    #[must_use]
    #[inline]
    pub fn of(&self, k: usize) -> &Material {
        &self.materials[self.material[k]]
    }

    /// Whether heat is conducted by the integral of the conductivity over temperature.
    #[must_use]
    pub fn integrates_conduction(&self) -> bool {
        let conduction = self.heat.as_ref().map(|heat| heat.conduction);
        conduction == Some(Conduction::Integral)
    }

    /// Faces of electrodes to the gas.
    #[must_use]
    pub fn contacts(&self) -> &[Contact] {
        self.surfaces.as_ref().map_or(&[], |s| &s.contacts)
    }

    /// The bed of granular flux.
    #[must_use]
    pub fn bed(&self) -> Option<&Granular> {
        self.heat.as_ref()?.granular.as_ref()
    }

    /// The bed of granular flux, where its slag is clear.
    #[must_use]
    pub fn clear_bed(&self) -> Option<&Granular> {
        let granular = self.bed()?;
        granular.melts_within.and(Some(granular))
    }

    /// A cell with its position, for messages.
    #[must_use]
    pub fn place(&self, k: usize) -> String {
        let (i, j) = (k % self.grid.nr, k / self.grid.nr);
        let (r, z) = (self.grid.rc[i] * 1e3, self.grid.zc[j] * 1e3);
        format!("cell ({i}, {j}) r = {r:.3} mm z = {z:.3} mm")
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
