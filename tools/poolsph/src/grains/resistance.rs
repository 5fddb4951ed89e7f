//! What resists the motion of grains past each other.

use contact::{Contact, History, Meeting, Normal, Reply, Rolling};
use shapes::frame::Vector;

/// What resists the motion of grains past each other. A trait and no closure: what is called within is then compiled for wide
/// vectors too. It owns its numbers: what might be changed behind a reference would be read again for each contact, and no
/// loop over contacts would become wide.
pub(super) trait Resistance: Copy {
    /// Force and moments of a contact after a step of `step` \[s\].
    fn reply(&self, meeting: &Meeting, memory: (&mut History, &mut Vector), step: f64) -> Reply;
}

/// Friction alone.
#[derive(Clone, Copy)]
pub(super) struct Sliding<N>(pub(super) Contact<N>);

/// Friction, and resistance to rolling.
#[derive(Clone, Copy)]
pub(super) struct SlidingAndRolling<N>(pub(super) Contact<N>, pub(super) Rolling);

impl<N: Normal + Copy> Resistance for Sliding<N> {
    #[inline(always)]
    fn reply(&self, meeting: &Meeting, memory: (&mut History, &mut Vector), step: f64) -> Reply {
        self.0.act(meeting, memory.0, step)
    }
}

impl<N: Normal + Copy> Resistance for SlidingAndRolling<N> {
    #[inline(always)]
    fn reply(&self, meeting: &Meeting, memory: (&mut History, &mut Vector), step: f64) -> Reply {
        let (history, rolled) = memory;
        self.0.act_rolling(meeting, self.1, history, rolled, step)
    }
}
