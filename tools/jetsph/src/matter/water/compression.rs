//! How far water that is to be nearly incompressible is compressed.
//!
//! The speed of sound of the scene stands for that of real water, which is much greater. Densities then change by the
//! square of the Mach number: where much of the water changes by more, its pressures and forces are those of another liquid.

use particles::{Set, sweep};

use super::tait::{Tait, Tension};
use crate::state::{DENSITY, MASS};

/// Part by which densities may change: that of water which stops from a third of the speed of sound.
const SLIGHT: f64 = 0.05;
/// Part of the water that may change by more, on average over time.
const FEW: f64 = 0.05;

/// Compressed water, summed over time.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Compression {
    /// All water \[kg s\].
    whole: f64,
    /// Water that is compressed by more than [`SLIGHT`] \[kg s\].
    much: f64,
    /// The greatest part by which a particle is \[1\].
    most: f64,
}

impl Compression {
    /// Looks at the water at the end of a step of `dt` \[s\].
    pub(super) fn over(&mut self, dt: f64, set: &Set, law: &Tait) {
        let (mass, density) = (set.column(&MASS), set.column(&DENSITY));
        let part = |a: usize| {
            let part = density[a] / law.density - 1.0;
            if law.tension == Tension::Full {
                part.abs()
            } else {
                part
            }
        };
        let [whole, much] = sweep::sum(set.len(), |a| {
            let is_much = part(a) > SLIGHT;
            [mass[a], if is_much { mass[a] } else { 0.0 }]
        });
        self.whole += dt * whole;
        self.much += dt * much;
        let most = sweep::greatest(set.len(), part);
        self.most = most.map_or(0.0, |(_, most)| most).max(self.most);
    }

    /// What to tell where much of the water is compressed.
    pub(super) fn warning(&self, law: &Tait) -> Option<String> {
        let share = self.much / self.whole;
        (share > FEW).then(|| {
            format!(
                "the speed of sound of {} m/s is too low for how the water moves: on average {:.1} % of it was compressed by more \
                 than {} %, at most by {:.0} %; give a greater 'sound_speed_m_s' or 'reference_speed_m_s'",
                law.sound_speed,
                100.0 * share,
                100.0 * SLIGHT,
                100.0 * self.most
            )
        })
    }

    /// The numbers that a checkpoint keeps.
    pub(super) fn save(&self) -> [f64; 3] {
        [self.whole, self.much, self.most]
    }

    /// Takes back what [`Compression::save`] gave.
    pub(super) fn restored([whole, much, most]: [f64; 3]) -> Self {
        Self { whole, much, most }
    }
}
