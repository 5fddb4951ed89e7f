//! What a march of drops counts, and what must never rise.

use crate::liquid::groups::told::Totals;

/// How often groups have changed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) struct Counts {
    /// Drops that met another.
    pub(super) joined: u64,
    /// Times that sheets of a drop met and closed.
    pub(super) closed: u64,
    /// Parts and parcels of drops that parted.
    pub(super) parted: u64,
    /// Parcels that drops took up.
    pub(super) taken: u64,
}

/// What never rises but by the work of fields, and what is lost from sight.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Ledger {
    /// Kinetic and surface energy at the start \[J\].
    pub(super) first: f64,
    /// Least sum of the energies so far, and greatest rise above it \[J\].
    pub(super) least: f64,
    pub(super) rise: f64,
    /// Greatest share of the volume that was parcels.
    pub(super) strewn: f64,
    /// Work of fields so far \[J\], and their power \[W\].
    pub(super) work: f64,
    pub(super) power: f64,
    /// Energy that was taken from the flow so that the sum does not rise \[J\].
    pub(super) calmed: f64,
}

impl Ledger {
    pub(super) fn look(&mut self, totals: &Totals) {
        let energy = totals.energy() - self.work;
        if self.first == 0.0 {
            self.first = totals.kinetic + totals.surface;
            self.least = energy;
        }
        self.least = self.least.min(energy);
        self.rise = self.rise.max(energy - self.least);
        self.strewn = self.strewn.max(totals.volume[1] / totals.volume[0]);
    }

    /// Adds what fields do at some power `dt` \[s\] after the last one.
    pub(super) fn work(&mut self, power: f64, dt: f64) {
        self.work += 0.5 * dt * (self.power + power);
        self.power = power;
    }

    /// Notes the energy of a part of a step of drops without a field, and what was taken of it.
    pub(super) fn calmed(&mut self, energy: f64, taken: f64) {
        self.least = self.least.min(energy - taken);
        self.calmed += taken;
    }

    /// What was taken from the flow, over the energy at the start.
    pub(super) fn taken(&self) -> f64 {
        if self.first > 0.0 {
            self.calmed / self.first
        } else {
            0.0
        }
    }

    /// Rise of the energy over that at the start.
    pub(super) fn risen(&self) -> f64 {
        if self.first > 0.0 {
            self.rise / self.first
        } else {
            0.0
        }
    }
}
