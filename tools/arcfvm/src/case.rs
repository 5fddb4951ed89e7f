//! The assembled problem: grid, materials, edges, and what is solved. Physics reads this, never
//! the scene. The case owns all that is set up; fields borrow it.

use crate::bed::granular::Granular;
pub use crate::current::setup::{PotentialCase, PotentialEdge};
use crate::curve::Surface;
pub use crate::edges::Edges;
pub use crate::flow::setup::{Face, Faces, FlowCase, FlowEdge, Gravity, Inlets};
use crate::grid::Grid;
pub use crate::heat::setup::{
    Conduction, Drops, Electrons, FeedRule, HeatCase, HeatEdge, MovingPlate, Wire,
};
use crate::heat::{Contact, Surfaces};
use crate::material::{GAS, Material};
pub use crate::vapour::setup::{Ionisation, VapourCase, VapourEdge};

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
    /// Granular flux that boils into the cavity, where heat is solved.
    pub bed: Option<Granular>,
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

    /// The bed of granular flux, where its slag is clear.
    #[must_use]
    pub fn clear_bed(&self) -> Option<&Granular> {
        self.bed.as_ref().filter(|bed| bed.melts_within.is_some())
    }

    /// Turns slag to gas and back by the temperature of the cells \[K\]; returns how many of them changed.
    pub(crate) fn boil(&mut self, temperature: &[f64]) -> usize {
        let bed = self.bed.as_mut();
        let changed = bed.map_or(0, |bed| {
            bed.boil(&self.grid, temperature, &mut self.material)
        });
        if changed > 0 {
            self.renew();
        }
        changed
    }

    /// Takes which cells of the bed have boiled, and how often each has changed.
    pub(crate) fn restore_bed(&mut self, boiled: &[u8], changes: Vec<u8>) {
        let Some(bed) = &mut self.bed else {
            return;
        };
        for (k, gas) in bed.cells.iter().zip(boiled) {
            self.material[*k] = if *gas == 1 { GAS } else { bed.material };
        }
        bed.changes = changes;
        self.renew();
    }

    /// Brings what follows from the materials of the cells to what those are now.
    fn renew(&mut self) {
        let (grid, material) = (&self.grid, &self.material);
        if let Some(surfaces) = &mut self.surfaces {
            surfaces.renew(grid, material);
        }
        if let Some(sheath) = self.potential.as_mut().and_then(|p| p.sheath.as_mut()) {
            sheath.renew(grid, material);
        }
        if let Some(flow) = &mut self.flow {
            flow.faces = Faces::new(grid, material, &flow.edges);
        }
    }

    /// A cell with its position, for messages.
    #[must_use]
    pub fn place(&self, k: usize) -> String {
        let (i, j) = (k % self.grid.nr, k / self.grid.nr);
        let (r, z) = (self.grid.rc[i] * 1e3, self.grid.zc[j] * 1e3);
        format!("cell ({i}, {j}) r = {r:.3} mm z = {z:.3} mm")
    }
}
