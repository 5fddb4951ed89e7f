//! What changes when slag boils into the cavity or comes back: cells, faces, sheath and walls.

use crate::material::GAS;
use crate::solver::Arc;

/// Iterations between two looks at what boils.
const LOOK_EVERY: usize = 5;
/// Iterations before the first look.
const FIRST_LOOK: usize = 20;
/// Part of all heat that may be out of balance where one looks.
const SETTLED: f64 = 1e-1;

impl Arc {
    /// Lets slag boil where it is time to look; returns the part of the bed that changed when last looked, or the part of the heat
    /// that is out of balance while that is too much to look.
    ///
    /// What boils does not come back beside hot gas, and any wider cavity is at rest too, its wall the colder: slag that boiled in a bed
    /// on its way to its temperatures would leave a cavity that tells of the way.
    pub(crate) fn boil(&mut self) -> Option<f64> {
        let cells = self.case.bed.as_ref()?.cells.len();
        let temperature = &self.heating.as_ref()?.energy.temperature;
        if self.iteration < FIRST_LOOK {
            return Some(1.0);
        }
        if self.iteration.is_multiple_of(LOOK_EVERY) {
            self.boiled = None;
            if self.unsettled <= SETTLED {
                let before = self.case.material.clone();
                let changed = self.case.boil(temperature);
                self.boiled = Some(changed as f64 / cells.max(1) as f64);
                if changed > 0 {
                    self.follow(&before);
                }
            }
        }
        self.boiled
            .or_else(|| Some(self.unsettled.clamp(SETTLED, 1.0)))
    }

    /// The bed as it is, for a checkpoint: what boiled, and how often each cell changed.
    pub(crate) fn bed(&self) -> Option<[Vec<u8>; 2]> {
        let bed = self.case.bed.as_ref()?;
        let gas = |k: &usize| u8::from(self.case.material[*k] == GAS);
        Some([bed.cells.iter().map(gas).collect(), bed.changes.clone()])
    }

    /// Takes the bed from a checkpoint.
    pub(crate) fn restore_bed(&mut self, boiled: &[u8], changes: Vec<u8>) {
        self.case.restore_bed(boiled, changes);
        // Pressures come from the checkpoint: no cell is new.
        self.follow(&self.case.material.clone());
    }

    /// Lets the fields follow the materials of the cells, which were others `before`.
    fn follow(&mut self, before: &[usize]) {
        let case = &self.case;
        if let Some(heating) = &mut self.heating {
            heating.energy.follow(case);
            heating.sources.look_again();
        }
        if let Some((setup, flowing)) = case.flow.as_ref().zip(self.flowing.as_mut()) {
            let was_gas = |k: usize| before[k] == GAS;
            flowing.flow.follow(case, setup, was_gas);
        }
    }
}
