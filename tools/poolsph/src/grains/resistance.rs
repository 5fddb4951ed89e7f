//! What resists the motion of grains past each other.

use contact::{Contact, History, Meeting, Normal, Reply, Rolling};
use shapes::frame::Vector;

/// What resists the motion of grains past each other. A trait and no closure: what is called within is then compiled for wide
/// vectors too.
pub(super) trait Resistance {
    /// Force and moments of a contact after a step of `step` \[s\].
    fn reply(&self, meeting: &Meeting, memory: (&mut History, &mut Vector), step: f64) -> Reply;
}

/// Friction alone.
pub(super) struct Sliding<'a, N>(pub(super) &'a Contact<N>);

/// Friction, and resistance to rolling.
pub(super) struct SlidingAndRolling<'a, N>(pub(super) &'a Contact<N>, pub(super) Rolling);

impl<N: Normal> Resistance for Sliding<'_, N> {
    #[inline(always)]
    fn reply(&self, meeting: &Meeting, memory: (&mut History, &mut Vector), step: f64) -> Reply {
        self.0.act(meeting, memory.0, step)
    }
}

impl<N: Normal> Resistance for SlidingAndRolling<'_, N> {
    #[inline(always)]
    fn reply(&self, meeting: &Meeting, memory: (&mut History, &mut Vector), step: f64) -> Reply {
        let (history, rolled) = memory;
        self.0.act_rolling(meeting, self.1, history, rolled, step)
    }
}
