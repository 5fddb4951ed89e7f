//! How much of the excess of density a step takes away, so that the volume does not drift (Pozorski and Wawrenczuk 2002).

use super::filled::Filled;
use super::operators::Sums;
use crate::forces::capillary;
use crate::motion::step::Step;
use crate::near::Near;

/// Part of the excess of density that a step takes away.
const RELAXED: f64 = 0.02;
/// The same without a surface, while the velocity gradient turns or strains by one: there volume cannot drift. A strained lattice
/// has an excess of some per cent however fine it is; what each step takes of it moves vortices by 3 % of their speed.
const RELAXED_INSIDE: f64 = 0.3;
/// The same where tension acts, in the time in which the shortest waves of the surface go half their length: a surface that
/// swings draws its layers together and apart, and must not be stiff for it.
const SLOW: f64 = 0.004;
/// Most excess that counts.
const MOST: f64 = 0.05;

/// What goes in a step.
#[derive(Debug, Clone, Copy)]
pub(super) struct Excess {
    filled: Filled,
    dt: f64,
    /// No particle has a surface.
    closed: bool,
    /// Greatest part.
    most: f64,
}

impl Excess {
    /// Of the liquid in `near` in a step; `closed` where none of it has a surface.
    pub(super) fn of(near: &Near, filled: Filled, step: Step, closed: bool) -> Self {
        let most = if near.tension.is_empty() {
            RELAXED
        } else {
            RELAXED.min(SLOW * step.dt / capillary::limit(near, step.metal))
        };
        Self {
            filled,
            dt: step.dt,
            closed,
            most,
        }
    }

    /// What goes of that of the particle `a`; at the surface, where neighbours are lacking, there is no lack.
    #[inline]
    pub(super) fn goes(&self, near: &Near, a: usize, row: &Sums) -> f64 {
        let mut excess = near.number[a].max(near.kernel.value(0.0)) / self.filled.number - 1.0;
        if row.missing > 0.0 {
            excess = excess.max(0.0);
        }
        let inside = self.most.min(RELAXED_INSIDE * self.dt * row.steep());
        let relaxed = if self.closed { inside } else { self.most };
        relaxed * excess.clamp(-MOST, MOST)
    }
}
